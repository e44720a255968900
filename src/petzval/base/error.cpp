// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>

namespace petzval {

InputError::InputError(const std::string& file, const std::string& message) : Error(file + ": " + message) {}

InputError::InputError(const std::string& file, int line, const std::string& message)
    : Error(file + ":" + std::to_string(line) + ": " + message) {}

}  // namespace petzval
