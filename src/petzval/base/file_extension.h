// SPDX-License-Identifier: BSD-3-Clause
// The ending by which formats are told apart.
#pragma once

#include <string>

namespace petzval {

/// The extension of a path with its dot, in lower case: ".exr" of "out/Light.EXR"; empty if there is none.
std::string extension_of(const std::string& path);

}  // namespace petzval
