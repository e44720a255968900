// SPDX-License-Identifier: BSD-3-Clause
// Pictures that a command line names, one by one or by their folder.
#pragma once

#include <string>
#include <vector>

namespace petzval::app {

/// The files themselves, and of a folder those of its files, not of folders in it, that end in one of the
/// extensions, by name. \throws InputError for a folder that cannot be listed or has no such file.
std::vector<std::string> pictures_in(const std::vector<std::string>& files_and_folders,
                                     const std::vector<std::string>& extensions);

}  // namespace petzval::app
