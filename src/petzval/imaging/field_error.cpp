// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/field_error.h>
#include <petzval/imaging/height_kernels.h>
#include <petzval/imaging/psf_tails.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

/// The PSFs of one wavelength of a table at some of its fields, and one more, whose PSF stays out.
LensDataTable one_wavelength(const LensDataTable& table, std::size_t wavelength,
                             std::vector<std::size_t> fields, std::optional<std::size_t> without) {
  if (without) fields.insert(std::ranges::lower_bound(fields, *without), *without);
  LensDataTable part;
  part.wavelengths_nm = {table.wavelengths_nm[wavelength]};
  for (const std::size_t field : fields) {
    const std::size_t entry = table.index(field, wavelength);
    part.fields.push_back(table.fields[field]);
    part.real_image_height_mm.push_back(table.real_image_height_mm[entry]);
    part.g_source_sr.push_back(table.g_source_sr[entry]);
    part.g_sensor_sr.push_back(table.g_sensor_sr[entry]);
    part.psf.push_back(field == without ? Psf{} : table.psf[entry]);
  }
  return part;
}

/// Of light whose chief ray lands at a height, and about it, by the PSFs of a table of one wavelength.
Kernel kernel_about_chief(const LensDataTable& table, double height_mm, double cell_um, LatticeSteps steps) {
  return HeightKernels(table, table.wavelengths_nm[0], cell_um, PsfInterpolation::psf, {}, steps)
      .lone_kernel(height_mm);
}

/// Light that is formed on cells of a size.
struct SpreadPart {
  LensDataTable table;
  double cell_um;
};

std::vector<SpreadPart> parts_of(LensDataTable whole, const SpreadWanted& wanted) {
  constexpr int cells_of_tail = 4;  // a pixel of tails is an eighth of where they begin (tail_coarseness())
  if (wanted.tail_um > 0)
    if (std::optional<TailSplit> split = split_tails(whole, wanted.tail_um))
      return {{std::move(split->sharp), wanted.cell_um},
              {std::move(split->tails), wanted.tail_um / cells_of_tail}};
  return {{std::move(whole), wanted.cell_um}};
}

}  // namespace

FrameRings::FrameRings(const std::array<double, 2>& half_frame_mm) {
  for (int row = 0; row < places; ++row)
    for (int column = 0; column < places; ++column)
      height_mm_.push_back(
          std::hypot((column + 0.5) / places * half_frame_mm[0], (row + 0.5) / places * half_frame_mm[1]));
  std::sort(height_mm_.begin(), height_mm_.end());
}

double FrameRings::share(double from_mm, double to_mm) const {
  const auto below = [&](double mm) {
    return std::lower_bound(height_mm_.begin(), height_mm_.end(), mm) - height_mm_.begin();
  };
  return double(below(to_mm) - below(from_mm)) / double(height_mm_.size());
}

double FieldMisfit::error() const {
  double square = 0;
  for (const Part& part : parts) square += part.error * part.error;
  return std::sqrt(square);
}

FieldMisfit field_misfit(const LensDataTable& table, std::size_t wavelength,
                         const std::vector<std::size_t>& fields, std::size_t left_out,
                         const SpreadWanted& wanted) {
  const std::vector<SpreadPart> said = parts_of(one_wavelength(table, wavelength, fields, left_out), wanted),
                                own = parts_of(one_wavelength(table, wavelength, {left_out}, {}), wanted);
  const double on_axis = table.g_source_sr[table.index(0, wavelength)],
               at_mm = table.real_image_height_mm[table.index(left_out, wavelength)];
  const std::vector<double>& with_middle = said[0].table.real_image_height_mm;
  const auto middle = std::size_t(std::ranges::find(with_middle, at_mm) - with_middle.begin());
  FieldMisfit misfit;
  for (std::size_t i = 0; i < std::min(said.size(), own.size()); ++i) {
    const double light = own[i].table.g_source_sr[0] / on_axis;
    const Kernel by_others = kernel_about_chief(said[i].table, at_mm, said[i].cell_um, wanted.steps()),
                 by_own = kernel_about_chief(own[i].table, at_mm, own[i].cell_um, wanted.steps());
    const double moved_mm =
        std::abs(by_others.moments().mean[1] - by_own.moments().mean[1]) * own[i].cell_um * mm_per_um;
    const double brighter = said[i].table.g_source_sr[middle] / on_axis - light;
    misfit.parts.push_back(
        {std::hypot(light * kernel_difference(by_others, by_own, wanted.contrast), brighter),
         light * moved_mm});
  }
  return misfit;
}

double error_between_fields(const LensDataTable& table, const std::array<double, 2>& half_frame_mm,
                            const SpreadWanted& wanted) {
  constexpr std::size_t fewest_fields = 7;
  const std::size_t wavelength = table.wavelengths_nm.size() / 2, count = table.fields.size();
  if (table.frame || count < fewest_fields) return 0;
  const auto height_mm = [&](std::size_t field) {
    return table.real_image_height_mm[table.index(field, wavelength)];
  };
  for (std::size_t field = 0; field < count; ++field)
    if (!table.has_psf(table.index(field, wavelength))) return 0;
  // Of the frame alone.
  std::size_t last = count - 1;
  const double corner_mm = std::hypot(half_frame_mm[0], half_frame_mm[1]);
  while (last > fewest_fields - 1 && height_mm(last - 1) >= corner_mm) --last;
  struct Look {
    double share = 0, by_two = 0, by_four = 0;
  };
  std::vector<Look> looks(last - 1);  // of the fields between the ends
  const FrameRings frame(half_frame_mm);
  for (std::size_t i = 0; i < looks.size(); ++i)
    looks[i].share =
        frame.share(i == 0 ? 0 : 0.5 * (height_mm(i) + height_mm(i + 1)),
                    i + 2 == last ? height_mm(last) : 0.5 * (height_mm(i + 1) + height_mm(i + 2)));
  parallel_tasks(2 * looks.size(), [&](std::size_t task) {
    Look& look = looks[task / 2];
    const std::size_t apart = task % 2 + 1, at = task / 2 + 1;
    if (at < apart || at + apart >= count) return;  // between no two
    std::vector<std::size_t> others;
    for (const int step : {-3, -1, 1, 3}) {
      const auto field = std::ptrdiff_t(at) + step * std::ptrdiff_t(apart);
      if (field >= 0 && field < std::ptrdiff_t(count)) others.push_back(std::size_t(field));
    }
    (apart == 1 ? look.by_two : look.by_four) = field_misfit(table, wavelength, others, at, wanted).error();
  });
  double all = 0, by_two = 0, by_four = 0;
  for (const Look& look : looks) {
    all += look.share * look.by_two * look.by_two;
    if (look.by_four == 0) continue;
    by_two += look.share * look.by_two * look.by_two;
    by_four += look.share * look.by_four * look.by_four;
  }
  if (!(by_two > 0)) return 0;
  // Mixtures of PSFs gain a fourth by each halving where the PSF bends evenly; less than half is never sure.
  const double halving = std::clamp(std::sqrt(by_two / by_four), 0.25, 0.5);
  return over_interval * halving * std::sqrt(all);
}

}  // namespace petzval
