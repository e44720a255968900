// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>

#include <utility>

namespace petzval {

namespace {

ErrorParts parts_of(const std::string& file, int line, int column, const std::string& message) {
  ErrorParts parts{.file = file, .line = line, .column = column};
  const std::size_t end = message.find("; ");
  parts.problem = message.substr(0, end);
  if (end != std::string::npos) parts.remedy = message.substr(end + 2);
  const std::size_t open = message.find('`');
  const std::size_t close = open == std::string::npos ? open : message.find('`', open + 1);
  if (close != std::string::npos) parts.parameter = message.substr(open + 1, close - open - 1);
  return parts;
}

}  // namespace

std::string ErrorParts::text() const {
  std::string text = file;
  const auto add_number = [&](int number) {
    if (number <= 0) return;
    text += ':';
    text += std::to_string(number);
  };
  add_number(line);
  if (line > 0) add_number(column);
  if (!text.empty()) text += ": ";
  text += problem;
  if (!remedy.empty()) text += "; " + remedy;
  return text;
}

InputError::InputError(ErrorParts parts) : Error(parts.text()), parts_(std::move(parts)) {}

InputError::InputError(const std::string& message) : InputError(parts_of("", 0, 0, message)) {}

InputError::InputError(const std::string& file, const std::string& message)
    : InputError(parts_of(file, 0, 0, message)) {}

InputError::InputError(const std::string& file, int line, const std::string& message)
    : InputError(parts_of(file, line, 0, message)) {}

InputError::InputError(const std::string& file, int line, int column, const std::string& message)
    : InputError(parts_of(file, line, column, message)) {}

}  // namespace petzval
