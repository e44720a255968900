// SPDX-License-Identifier: BSD-3-Clause
// libFuzzer's side of one format; PETZVAL_FUZZ_FORMAT names it.
#include "formats.h"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const petzval::fuzz::Format* format = petzval::fuzz::find_format(PETZVAL_FUZZ_FORMAT);
  format->entry({reinterpret_cast<const char*>(data), size});
  return 0;
}
