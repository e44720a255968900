// SPDX-License-Identifier: BSD-3-Clause
// MAT files of version 7.3, which are HDF5.
#pragma once

#include <string>
#include <vector>

namespace petzval {

/// Writes those of these variables that a MAT file of version 7.3 has to `descriptor`, as records
/// (mat_records.h), one behind the other. Of every variable: a 1 × 1 struct with its fields (members of a
/// group, or references to what they are), numbers and texts (data sets whose dimensions run the other way
/// round, so that the bytes are in MATLAB's order), empty arrays; sparse and complex arrays, cells, objects,
/// functions and arrays of structs are passed as "other". Numbers go through memory in pieces. The layout is
/// that of files that MATLAB writes (attributes MATLAB_class, MATLAB_empty).
///
/// HDF5 does not stand damaged files, and some keep it busy without end: to be called in a child process
/// (run_in_child). It has one state a process.
/// \throws InputError for files that HDF5 refuses; for arrays of more than `most_mat_array_bytes`, or larger
/// than what is stored of them can be, before anything is read; for structs that are nested without end; for
/// data in other files. Failure when the disk is full.
void write_mat_hdf5_records(const std::string& path, const std::vector<std::string>& variables,
                            int descriptor);

}  // namespace petzval
