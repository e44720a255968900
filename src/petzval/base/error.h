// SPDX-License-Identifier: BSD-3-Clause
// Errors, by what the user can do about them.
#pragma once

#include <stdexcept>
#include <string>

namespace petzval {

/// Base of every exception that Petzval throws on purpose. `what()` is one line, without a trailing newline.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The input is wrong: a bad file, option, lens or number. The message says what is wrong and what would be
/// right. The program exits with 2.
class InputError : public Error {
 public:
  using Error::Error;
  /// "<file>: message"
  InputError(const std::string& file, const std::string& message);
  /// "<file>:<line>: message", line counted from 1.
  InputError(const std::string& file, int line, const std::string& message);
};

/// The input was right but the work could not be done: a full disk, no memory. The program exits with 1.
class Failure : public Error {
 public:
  using Error::Error;
};

}  // namespace petzval
