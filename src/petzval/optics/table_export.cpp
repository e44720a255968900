// SPDX-License-Identifier: BSD-3-Clause
#include "table_export.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/staged_files.h>
#include <petzval/optics/common_grid.h>
#include <petzval/optics/formats/iset_mat_table.h>
#include <petzval/optics/formats/ray_trace_data.h>
#include <petzval/optics/formats/zemax_table.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

namespace petzval {

namespace {

constexpr int most_samples = 4096;
/// Of all PSFs on one grid, as floats and once more as doubles on their way into a file.
constexpr double most_exported = 4.0 * (1 << 30), bytes_a_sample = 12;

bool has_one_grid(const LensDataTable& table) {
  return std::all_of(table.psf.begin(), table.psf.end(),
                     [&](const Psf& psf) { return psf.spacing_um == table.psf.front().spacing_um; });
}

/// The grid that is asked for. \throws InputError if its PSFs would be larger than can be written.
PsfGridSize asked_grid(const TableExport& how, const LensDataTable& table) {
  PsfGridSize grid = common_grid(table);
  const double width_um = grid.size * grid.spacing_um,
               spacing_um = how.psf_spacing_um.value_or(grid.spacing_um);
  const double size = how.psf_size ? *how.psf_size : std::max(2.0, std::floor(width_um / spacing_um));
  const double bytes = bytes_a_sample * static_cast<double>(table.psf.size()) * size * size;
  if (size > most_samples || bytes > most_exported) {
    const double fit = std::min<double>(
        most_samples, std::sqrt(most_exported / bytes_a_sample / static_cast<double>(table.psf.size())));
    throw InputError(fmt::format(
        "{} PSFs of {:.4g} x {:.4g} samples of {:g} um would take {:.3g} GiB; up to {:g} GiB and {} "
        "samples a side are written: `psf_size` {:.0f} or less, or `psf_spacing_um` {:.3g} or more, "
        "would be right",
        table.psf.size(), size, size, spacing_um, bytes / (1 << 30), most_exported / (1 << 30), most_samples,
        std::floor(fit), 1.01 * width_um / std::floor(fit)));
  }
  // A grid of the same samples stays as it is, where nothing is asked.
  if (how.psf_spacing_um || how.psf_size) grid = {static_cast<int>(size), spacing_um};
  return grid;
}

/// The least share of its light that a PSF keeps on the new grid. \throws InputError if it is less than is
/// wanted.
void check_light(const TableExport& how, const LensDataTable& before, const LensDataTable& after) {
  constexpr double usual_least = 0.99;
  double kept = 1;
  for (std::size_t i = 0; i < before.psf.size(); ++i)
    kept = std::min(kept, after.psf[i].captured / before.psf[i].captured);
  if (kept >= how.psf_light.value_or(usual_least)) return;
  const Psf& psf = after.psf.front();
  throw InputError(fmt::format(
      "PSFs of {0} x {0} samples of {1:g} um keep {2:.3g} % of the light; `psf_size` {3} keeps 99 %, "
      "and `psf_light` {4:.2g} allows it",
      psf.size, psf.spacing_um, 100 * kept, size_for_light(before, psf.spacing_um, usual_least), 0.9 * kept));
}

void check_export(const TableExport& how) {
  const auto refuse = [](const char* parameter, double value, const char* right) {
    throw InputError(fmt::format("`{}` {:g}; {} would be right", parameter, value, right));
  };
  if (how.psf_spacing_um && !(*how.psf_spacing_um > 0 && std::isfinite(*how.psf_spacing_um)))
    refuse("psf_spacing_um", *how.psf_spacing_um, "a positive length");
  if (how.psf_size && (*how.psf_size < 2 || *how.psf_size > most_samples))
    refuse("psf_size", *how.psf_size, "2 to 4096 samples");
  if (how.psf_light && !(*how.psf_light >= 0 && *how.psf_light <= 1))
    refuse("psf_light", *how.psf_light, "a share from 0 to 1");
}

/// The structure of a table with its PSFs on one grid, if they may be brought there.
RayTraceData data_of(const LensDataTable& table, const TableExport& how, std::vector<std::string>& notes) {
  check_export(how);
  table.validate();
  require_by_height(table, "ISET's files hold centred lenses");
  const bool given = how.psf_spacing_um || how.psf_size;
  if (!given && (!how.resample || has_one_grid(table))) return ray_trace_data(table);
  const PsfGridSize grid = asked_grid(how, table);
  const LensDataTable gridded = on_common_grid(table, grid);
  check_light(how, table, gridded);
  double least = 1;
  for (const Psf& psf : gridded.psf) least = std::min(least, psf.captured);
  notes.push_back(fmt::format(
      "the PSFs are resampled to {} x {} samples of {:g} um, which hold at least {:.3g} % of the light",
      grid.size, grid.size, grid.spacing_um, 100 * least));
  return ray_trace_data(gridded);
}

/// A name for files, from that of the lens.
std::string base_name_of(const std::string& lens) {
  std::string name;
  for (const char c : lens)
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' ? c : '_';
  return name.empty() ? "lens" : name;
}

void write_text_files(const RayTraceData& data, const std::string& folder, std::vector<std::string>& notes) {
  std::error_code error;
  const bool made = std::filesystem::create_directory(folder, error);
  if (error) throw InputError(folder, "cannot be made a folder: " + error.message());
  try {
    StagedFiles files;
    for (const std::string& text : write_zemax_table(data, folder, base_name_of(data.lens_file), files))
      notes.push_back(folder + ": " + text);
    files.commit();
  } catch (...) {
    if (made) std::filesystem::remove(folder, error);
    throw;
  }
}

}  // namespace

std::vector<std::string> export_table(const LensDataTable& table, TableTarget target,
                                      const std::string& output, const TableExport& how) {
  std::vector<std::string> notes;
  const RayTraceData data = data_of(table, how, notes);
  if (target == TableTarget::zemax)
    write_text_files(data, output, notes);
  else
    write_iset_mat_table(data, output);
  return notes;
}

}  // namespace petzval
