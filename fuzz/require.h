// SPDX-License-Identifier: BSD-3-Clause
// What entries hold what they read to.
#pragma once

#include <petzval/base/error.h>

namespace petzval::fuzz {

/// Aborts with the message unless it holds.
void require(bool holds, const char* what);
/// A refusal is one line that is not endless.
void require_one_line(const InputError& error);

/// Whether the work is done without a refusal.
template <typename Work>
bool accepted(Work work) {
  try {
    work();
  } catch (const InputError& error) {
    require_one_line(error);
    return false;
  }
  return true;
}

}  // namespace petzval::fuzz
