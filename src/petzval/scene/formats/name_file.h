// SPDX-License-Identifier: BSD-3-Clause
// Complaints that name the file they are about.
#pragma once

#include <petzval/base/error.h>

#include <string>

namespace petzval {

/// Does the work, and puts the file's name in front of complaints of those who do not know it: the scene's
/// and spectra's.
template <typename Work>
auto naming_file(const std::string& path, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    const std::string message = error.what();
    if (message.starts_with(path)) throw;
    throw InputError(path, message);
  }
}

}  // namespace petzval
