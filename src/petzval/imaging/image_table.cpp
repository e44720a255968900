// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/field_choice.h>
#include <petzval/imaging/image_table.h>
#include <petzval/imaging/place_choice.h>
#include <petzval/optics/frame_build.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>

namespace petzval {

namespace {

/// For finer pictures than previews PSFs may lie so much closer than the fields that are asked for.
constexpr int finer_fields = 8;

std::vector<std::size_t> all_wavelengths(const LensDataTable& table) {
  std::vector<std::size_t> wavelengths(table.wavelengths_nm.size());
  std::iota(wavelengths.begin(), wavelengths.end(), std::size_t{0});
  return wavelengths;
}

/// How far the building of a table is, of whose entries some are made before it is known how many there will
/// be.
class TableProgress {
 public:
  TableProgress(const ProgressCallback& progress, std::size_t expected)
      : progress_(progress), expected_(double(expected)) {}
  /// Of what is made first: no farther than half.
  ProgressCallback first() {
    if (!progress_) return {};
    return [this](double, const std::string& what) {
      progress_(0.5 * double(++made_) / (double(made_) + expected_), what);
    };
  }
  ProgressCallback rest() {
    if (!progress_) return {};
    const double from = 0.5 * double(made_) / (double(made_) + expected_);
    return [this, from](double fraction, const std::string& what) {
      progress_(from + (1 - from) * fraction, what);
    };
  }

 private:
  const ProgressCallback& progress_;
  const double expected_;
  std::atomic<std::size_t> made_{0};
};

LensDataTable table_over_frame(const Lens& lens, const TableOptions& options, const SpreadWanted& wanted,
                               const ProgressCallback& progress) {
  FrameTable parts(lens, options);
  TableProgress both(progress, parts.table().psf.size());
  const ChosenPlaces chosen = choose_places(parts, wanted, both.first());
  parts.add_psfs(chosen.places, all_wavelengths(parts.table()), both.rest());
  LensDataTable table = std::move(parts).finished();
  table.interpolation_error = chosen.error;
  return table;
}

enum class Psfs { where_chosen, at_all_fields };

LensDataTable table_by_height(const Lens& lens, const TableOptions& asked, const SpreadWanted& wanted,
                              Psfs psfs, const ProgressCallback& progress) {
  TableOptions options = asked;
  if (wanted.of_a_preview() && wanted.contrast == 1 && psfs == Psfs::where_chosen)
    options.coarse = {wanted.cell_um, wanted.tolerance};
  if (options.field_count < fewest_to_choose) return build_lens_data_table(lens, options, progress);
  constexpr int most_fields = 1000;  // TableOptions::validate()
  const int finer =
      wanted.of_a_preview() ? 1 : std::clamp((most_fields - 1) / (asked.field_count - 1), 1, finer_fields);
  options.field_count = finer * (asked.field_count - 1) + 1;
  HeightTable parts(lens, options);
  TableProgress both(progress, parts.table().psf.size() / std::size_t(finer));
  const ChosenFields chosen = choose_fields(parts, options, std::size_t(finer), wanted, both.first());
  std::vector<std::size_t> kept = chosen.fields;
  for (std::size_t field = 0; field < parts.table().fields.size(); field += std::size_t(finer))
    kept.push_back(field);
  std::ranges::sort(kept);
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  parts.add_missing_psfs(psfs == Psfs::at_all_fields ? kept : chosen.fields, both.rest());
  LensDataTable table = std::move(parts).finished(kept);
  table.interpolation_error = chosen.error;
  return table;
}

bool is_over_frame(const Lens& lens, const TableOptions& options) {
  return options.places == TableOptions::Places::over_frame ||
         (options.places == TableOptions::Places::automatic && needs_places_over_frame(lens));
}

}  // namespace

LensDataTable build_image_table(const Lens& lens, const TableOptions& options, const SpreadWanted& wanted,
                                const ProgressCallback& progress) {
  if (!is_over_frame(lens, options))
    return table_by_height(lens, options, wanted, Psfs::where_chosen, progress);
  if (needs_places_over_frame(lens)) return table_over_frame(lens, options, wanted, progress);
  return build_lens_data_table(lens, options, progress);
}

LensDataTable build_table_of_pictures(const Lens& lens, const TableOptions& options,
                                      const SpreadWanted& wanted, const ProgressCallback& progress) {
  if (is_over_frame(lens, options)) return build_lens_data_table(lens, options, progress);
  return table_by_height(lens, options, wanted, Psfs::at_all_fields, progress);
}

}  // namespace petzval
