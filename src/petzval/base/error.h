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

/// What is wrong with an input, in parts; the text of an InputError is made of them.
struct ErrorParts {
  std::string file = {};       ///< empty: no file is at fault
  int line = 0, column = 0;    ///< counted from 1; 0: not known
  std::string problem = {};    ///< what is wrong
  std::string remedy = {};     ///< what would be right; may be empty
  std::string parameter = {};  ///< the parameter at fault, by its name in the library; empty: none is named

  /// "<file>:<line>:<column>: <problem>; <remedy>", less what is not known.
  std::string text() const;
};

/// The input is wrong: a bad file, parameter, lens or number. The program exits with 2.
///
///     try {
///       camera.sensor = read_sensor("third-inch-1280x96");
///     } catch (const InputError& error) {
///       std::cerr << error.parts().problem << "; " << error.parts().remedy << '\n';
///     }
///
/// A message says what is wrong, and behind its first "; " what would be right. It names a parameter of the
/// library in backquotes: "`surround` beyond: error, zero or extend would be right". The first one so named
/// is the parameter at fault. Each user interface puts its own name there: an option, a keyword.
class InputError : public Error {
 public:
  explicit InputError(ErrorParts parts);
  explicit InputError(const std::string& message);
  InputError(const std::string& file, const std::string& message);
  /// Lines and columns count from 1.
  InputError(const std::string& file, int line, const std::string& message);
  InputError(const std::string& file, int line, int column, const std::string& message);

  const ErrorParts& parts() const { return parts_; }

 private:
  ErrorParts parts_;
};

/// The input was right but the work could not be done: a full disk, no memory. The program exits with 1.
class Failure : public Error {
 public:
  using Error::Error;
};

}  // namespace petzval
