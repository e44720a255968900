// SPDX-License-Identifier: BSD-3-Clause
#include "require.h"

#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace petzval::fuzz {

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz: %s\n", what);
  std::abort();
}

void require_one_line(const InputError& error) {
  const std::string_view message = error.what();
  constexpr std::size_t longest = 1000;
  require(!message.empty() && message.size() < longest, "an empty or endless message");
  require(message.find_first_of("\n\r") == message.npos, "a message of several lines");
}

}  // namespace petzval::fuzz
