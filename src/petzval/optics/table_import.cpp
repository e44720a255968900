// SPDX-License-Identifier: BSD-3-Clause
#include "table_import.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>
#include <petzval/base/units.h>
#include <petzval/base/whole_file.h>
#include <petzval/optics/formats/psf_map.h>
#include <petzval/optics/formats/zemax_table.h>
#include <petzval/optics/table_file.h>

#include <filesystem>

namespace petzval {

namespace {

TableSource source_of(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return TableSource::zemax;
  const std::string extension = extension_of(path);
  if (extension == ".mat") return TableSource::iset;
  if (extension == ".txt") return TableSource::zemax;
  if (extension == ".csv") return TableSource::measured;
  if (extension == ".npz") return TableSource::map;
  return TableSource::hdf5;
}

/// Complaints of the conversion do not know the file.
template <typename File>
ImportedTable converted(const File& file, const std::string& path, const TableImport& how) {
  try {
    ImportedTable imported = table_of(file.data, how.reading);
    imported.notes.insert(imported.notes.begin(), file.notes.begin(), file.notes.end());
    return imported;
  } catch (const InputError& error) {
    throw InputError(path, error.what());
  }
}

MeasuredFile read_measurement(const std::string& path, const TableImport& how) {
  constexpr std::size_t most_bytes = std::size_t{1} << 30;
  const std::string text = read_whole_file(path, most_bytes);
  const std::string curves = how.curves.empty() ? "" : read_whole_file(how.curves, most_bytes);
  if (!how.curves.empty() && curves.empty())
    throw InputError(
        how.curves,
        "is empty; columns field_mm and paraxial_height_mm or relative_illumination would be right");
  return read_measured(text, path, curves, how.curves, how.measured);
}

/// Refuses what says nothing of this kind of file, and numbers that no lens has.
void check_import(const std::string& path, const TableImport& how, TableSource source) {
  const auto refuse = [&](bool given, const char* parameters, const char* of) {
    if (given)
      throw InputError(path, fmt::format("{} have no meaning for it; they are for {}", parameters, of));
  };
  refuse(source != TableSource::measured && (!how.curves.empty() || how.measured.clip_negative),
         "`curves` and `clip_negative`", "measurements (.csv)");
  const bool says_lie =
      source == TableSource::measured || source == TableSource::map || source == TableSource::hdf5;
  refuse(says_lie && (how.lie.away || how.lie.centre), "`psf_away` and `psf_centre`",
         "PSFs of ISET, Zemax and CODE V");
  refuse(source == TableSource::hdf5 && how.reading.says_something(),
         "`g_axis_sr`, `relative_illumination` and `vertex_to_sensor_mm`",
         "files that do not say it themselves");
  if (how.reading.g_axis_sr.value_or(0) > pi)
    throw InputError(fmt::format(
        "`g_axis_sr` {:g}: up to π = {:.4f} sr would be right; a whole hemisphere of light gives no more",
        *how.reading.g_axis_sr, pi));
}

}  // namespace

ImportedTable import_table(const std::string& path, const TableImport& how) {
  const TableSource source = how.source == TableSource::automatic ? source_of(path) : how.source;
  check_import(path, how, source);
  if (source == TableSource::hdf5) return {read_table(path, TableOrigin::elsewhere), {}};
  if (source == TableSource::map) return read_psf_map(path, how.reading);
  if (source == TableSource::iset) return converted(read_iset_mat_table(path, how.lie), path, how);
  if (source == TableSource::measured) return converted(read_measurement(path, how), path, how);
  const ListingProgram program = source == TableSource::codev ? ListingProgram::codev : ListingProgram::zemax;
  return converted(read_zemax_table(path, program, how.lie), path, how);
}

}  // namespace petzval
