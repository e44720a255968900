// SPDX-License-Identifier: BSD-3-Clause
// Lens data tables that other programs and laboratories made, from any of their files.
#pragma once

#include <petzval/optics/formats/iset_mat_table.h>
#include <petzval/optics/formats/measured.h>
#include <petzval/optics/formats/ray_trace_data.h>

#include <string>

namespace petzval {

enum class TableSource {
  automatic,  ///< by the name: .mat iset, .txt or a folder zemax, .csv measured, .npz map, else hdf5
  iset,       ///< a MAT file with ISET's rayTrace structure
  zemax,      ///< ISETPARMS.TXT, or its folder
  codev,      ///< likewise, by CODE V's conventions
  measured,   ///< CSV of PSFs or MTFs
  map,        ///< NumPy arrays of PSFs over the frame (read_psf_map())
  hdf5        ///< Petzval's own layout without its checksum; a damaged file may crash the program
};

/// What the file does not say. What says nothing of its kind of file is refused.
struct TableImport {
  TableSource source = TableSource::automatic;
  PsfLie lie = {};               ///< iset, zemax, codev
  RayTraceReading reading = {};  ///< all but hdf5
  MeasuredOptions measured = {};
  std::string curves = {};  ///< of measurements: a CSV file of distortion and illumination; empty: none
};

/// Reads a table of another program.
///
///     TableImport how;
///     how.reading.g_axis_sr = 0.2;
///     const ImportedTable bench = import_table("mtf.csv", how);
///     write_table(bench.table, "bench.h5");
///
/// \throws InputError with the file.
ImportedTable import_table(const std::string& path, const TableImport& how = {});

}  // namespace petzval
