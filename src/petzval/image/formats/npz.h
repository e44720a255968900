// SPDX-License-Identifier: BSD-3-Clause
// NumPy's archives of named arrays (.npz): a ZIP file with a .npy file an array.
#pragma once

#include <petzval/image/formats/npy.h>

#include <string>
#include <vector>

namespace petzval {

struct NamedArray {
  std::string name;  ///< without .npy
  NpyArray array;
};

/// `numpy.load(path)["name"]` gives each back. Not compressed, the same bytes for the same arrays. \throws
/// InputError for values that do not fill a shape, and as WholeFile; Failure.
void write_npz(const std::string& path, const std::vector<NamedArray>& arrays);

/// As numpy.savez and numpy.savez_compressed write it; arrays of text are left out. \throws InputError for a
/// damaged file, and for more than 4 GiB of numbers.
std::vector<NamedArray> read_npz(const std::string& path);

/// The array of a name. \throws InputError naming those that are there.
const NpyArray& find_array(const std::vector<NamedArray>& arrays, const std::string& name,
                           const std::string& path);

/// The values of an array in double precision.
std::vector<double> double_values(const NpyArray& array);

}  // namespace petzval
