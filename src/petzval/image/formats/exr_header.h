// SPDX-License-Identifier: BSD-3-Clause
// A first look at an OpenEXR file, before the library allocates what its header asks for.
#pragma once

#include <string>

namespace petzval {

/// Walks the header of an OpenEXR file and compares what it promises with the size of the file.
/// \throws InputError if the file is no OpenEXR file, has several parts or deep data, ends within its header,
/// or has a picture so large that this file cannot hold it.
void check_exr_header(const std::string& path);

}  // namespace petzval
