// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace petzval {

/// Version of the library, "major.minor.patch".
const char* version();

}  // namespace petzval
