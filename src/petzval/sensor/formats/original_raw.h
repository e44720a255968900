// SPDX-License-Identifier: BSD-3-Clause
// A raw file within another one, as DNG keeps what it was made of (DNG 1.4, OriginalRawFileData).
#pragma once

#include <optional>
#include <string>

namespace petzval {

/// The bytes of `dng` with `original` in it, deflated; programs that do not look for it pass over it.
/// \throws InputError if `dng` is no TIFF file with the low byte first, or above 4 GB with it.
std::string with_original_raw(const std::string& dng, const std::string& original);

/// What with_original_raw() put in; absent if there is nothing. \throws InputError if it is damaged.
std::optional<std::string> original_raw(const std::string& dng);

}  // namespace petzval
