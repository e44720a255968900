// SPDX-License-Identifier: BSD-3-Clause
// NumPy's array files (.npy, NEP 1: versions 1.0 to 3.0).
#pragma once

#include <petzval/image/spectral_image.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace petzval {

/// An array in C order (the last index runs fastest). A .npy file carries no units and no wavelengths:
/// whoever writes one says them elsewhere.
struct NpyArray {
  std::vector<std::size_t> shape;
  std::variant<std::vector<float>, std::vector<double>> values;
};

/// Writes float32, float64 or int32, little-endian, version 1.0: `numpy.load(path)` opens it.
/// \throws InputError if `values` does not fill `shape`, and as WholeFile; Failure.
void write_npy(const std::string& path, std::span<const std::size_t> shape, std::span<const float> values);
void write_npy(const std::string& path, std::span<const std::size_t> shape, std::span<const double> values);
void write_npy(const std::string& path, std::span<const std::size_t> shape,
               std::span<const std::int32_t> values);
/// An image as float32 of shape (rows, columns, bands) [W·m⁻²·nm⁻¹]; a large one (is_large_npy) in Fortran
/// order.
void write_npy(const std::string& path, const SpectralImage& image);
/// The same for an image whose values nobody needs any more. Those of a large image are given up while they
/// are written, so that there need not be room for both; everything else of the image stays.
void write_npy(const std::string& path, SpectralImage&& image);

/// Reads floating-point numbers of 16 to 64 bits and whole numbers of 8 to 64 bits (beyond 2^53 to double
/// precision), of either byte order, in C or Fortran order.
/// \throws InputError for another type, a damaged header, or a file shorter or longer than its shape
/// says.
NpyArray read_npy(const std::string& path);
class NpyFile;
/// The same of an open file.
NpyArray array_of(const NpyFile& file);

}  // namespace petzval
