// SPDX-License-Identifier: BSD-3-Clause
// What a .npy file begins with.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace petzval {

enum class NpyOrder { c, fortran };

/// Magic, version 1.0 and the header, padded with spaces so that the data start at a multiple of 64.
/// \param type  as NumPy writes it: "<f4".
std::string npy_header(std::string_view type, std::span<const std::size_t> shape, NpyOrder order);

}  // namespace petzval
