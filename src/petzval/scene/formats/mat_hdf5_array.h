// SPDX-License-Identifier: BSD-3-Clause
// Arrays of MAT files of version 7.3: how numbers and texts lie in HDF5.
#pragma once

#include <matio.h>
#include <petzval/scene/formats/hdf5_handle.h>
#include <petzval/scene/formats/mat_records.h>

#include <string>
#include <vector>

namespace petzval {

/// A class of numbers or text: what MATLAB calls it, how it is read, and how matio calls it.
struct MatArrayClass {
  const char* word;
  hid_t (*type)();
  std::size_t size;
  matio_classes class_type;
  matio_types data_type;

  bool is_text() const { return class_type == MAT_C_CHAR; }
};

/// Null for what is no array of numbers or characters.
const MatArrayClass* find_mat_array_class(const std::string& word);

/// What every complaint about a damaged file of this version says.
[[noreturn]] void refuse_damaged_mat(const std::string& path, const std::string& message);

/// As much as a scene in double precision may hold.
inline constexpr hsize_t most_mat_array_bytes = hsize_t{1} << 34;

/// Writes a record and the numbers of a data set, piece by piece. \param full  its name, for messages.
/// \throws InputError for one that is larger than `most_mat_array_bytes` or than what is stored of it can be,
/// before it is read; for one that is kept in another file, packed by what MATLAB does not use, or damaged.
void write_mat_array(hid_t data, const MatArrayClass& kind, const std::string& name, const std::string& full,
                     const std::string& path, MatRecordWriter& writer);

}  // namespace petzval
