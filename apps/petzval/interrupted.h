// SPDX-License-Identifier: BSD-3-Clause
// The end of a command that Ctrl-C stopped, but not in vain.
#pragma once

#include <petzval/base/error.h>

namespace petzval::app {

/// Stopped by the user; the message says what was kept, and how to go on. (Cancelled is for work that leaves
/// nothing.)
class Interrupted : public Error {
 public:
  using Error::Error;
};

}  // namespace petzval::app
