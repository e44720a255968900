// SPDX-License-Identifier: BSD-3-Clause
// MAT files of version 7.3, read where a damaged one does no harm.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace petzval {

/// Whether a file says that it is a MAT file of version 7.3. \throws InputError if it cannot be read.
bool is_mat_hdf5(const std::string& path);

/// Records (mat_records.h) in memory that lives as long as `memory`.
struct MappedRecords {
  std::shared_ptr<void> memory;
  std::span<std::byte> records;
};

/// write_mat_hdf5_records in a program of its own (petzval-read-hdf5), into a file without a name. \throws
/// InputError, Failure as it does; InputError if HDF5 crashed on the file, or found no end.
MappedRecords mat_hdf5_records(const std::string& path, const std::vector<std::string>& variables);

}  // namespace petzval
