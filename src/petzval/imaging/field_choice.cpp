// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/field_choice.h>
#include <petzval/imaging/height_kernels.h>
#include <petzval/imaging/psf_tails.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

namespace petzval {

namespace {

/// PSFs at first: both ends and two between, for cubics.
constexpr std::size_t first_intervals = (fewest_to_choose - 1) / 2;

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

/// An interval between two fields with PSFs.
struct Interval {
  std::size_t from, to;
  std::size_t middle() const { return (from + to) / 2; }
};

/// How much of a frame lies between two heights.
class FrameRings {
 public:
  explicit FrameRings(const TableOptions& options) {
    const double side_mm = options.max_image_height_mm / std::sqrt(2.0);
    const std::array<double, 2> half_mm = options.half_frame_mm.value_or(std::array{side_mm, side_mm});
    for (int row = 0; row < places; ++row)
      for (int column = 0; column < places; ++column)
        height_mm_.push_back(
            std::hypot((column + 0.5) / places * half_mm[0], (row + 0.5) / places * half_mm[1]));
    std::sort(height_mm_.begin(), height_mm_.end());
  }
  double share(double from_mm, double to_mm) const {
    const auto below = [&](double mm) {
      return std::lower_bound(height_mm_.begin(), height_mm_.end(), mm) - height_mm_.begin();
    };
    return double(below(to_mm) - below(from_mm)) / double(height_mm_.size());
  }

 private:
  static constexpr int places = 32;  ///< along a side of a quadrant
  std::vector<double> height_mm_;
};

/// Finds the fields that an image needs.
class FieldChoice {
 public:
  FieldChoice(HeightTable& parts, const TableOptions& options, const SpreadWanted& wanted,
              const ProgressCallback& progress)
      : parts_(parts), frame_(options), wanted_(wanted), progress_(progress) {
    const std::size_t last = parts.table().fields.size() - 1;
    for (std::size_t i = 0; i <= first_intervals; ++i) taken_.push_back(i * last / first_intervals);
  }

  /// Takes what a wavelength needs beyond what others took.
  void look_at(std::size_t wavelength) {
    wavelength_ = wavelength;
    squares_ = 0;
    parts_.add_psfs(taken_, std::array{wavelength_}, progress_);
    std::vector<Interval> open;
    for (std::size_t i = 0; i + 1 < taken_.size(); ++i) open.push_back({taken_[i], taken_[i + 1]});
    while (true) {
      std::erase_if(open, [](const Interval& interval) { return interval.to - interval.from < 2; });
      if (open.empty()) break;
      open = refined(open);
    }
    error_ = std::max(error_, std::sqrt(squares_));
  }
  ChosenFields chosen() && { return {std::move(taken_), error_}; }

 private:
  /// What the PSFs about an interval miss in its middle.
  struct Misfit {
    double of_allowed;  ///< over what they may
    double error;       ///< of the light there, relative to that on the axis
  };
  /// Light that is formed on cells of a size.
  struct SpreadPart {
    LensDataTable table;
    double cell_um;
  };

  /// The halves of those that are too wide.
  std::vector<Interval> refined(const std::vector<Interval>& open) {
    std::vector<std::size_t> middles;
    for (const Interval& interval : open) middles.push_back(interval.middle());
    parts_.add_psfs(middles, std::array{wavelength_}, progress_);
    std::vector<Misfit> misfits(open.size());
    parallel_for(open.size(), [&](std::size_t i) { misfits[i] = misfit(open[i]); });
    std::vector<Interval> halves;
    for (std::size_t i = 0; i < open.size(); ++i) {
      const Interval& interval = open[i];
      // In the middle a mixture is at its worst: over an interval it is off by two thirds as much, (16 t² (1
      // − t)²)² on average. Halves of an interval miss a quarter of it or less.
      constexpr double over_interval = 0.64, of_halves = 4;
      const double share = frame_.share(height_mm(interval.from), height_mm(interval.to));
      const double error = over_interval * misfits[i].error;
      if (misfits[i].of_allowed <= 1) {
        squares_ += share * error * error;
        parts_.remove_psf(interval.middle(), wavelength_);
        continue;
      }
      taken_.push_back(interval.middle());
      const bool last = misfits[i].of_allowed <= of_halves || interval.to - interval.from < 4;
      if (last) squares_ += share * std::pow(error / of_halves, 2);
      if (misfits[i].of_allowed <= of_halves) continue;
      halves.push_back({interval.from, interval.middle()});
      halves.push_back({interval.middle(), interval.to});
    }
    std::sort(taken_.begin(), taken_.end());
    return halves;
  }

  double height_mm(std::size_t field) const {
    return parts_.table().real_image_height_mm[parts_.table().index(field, wavelength_)];
  }
  /// Those between which an interval lies, and one more on either side: what cubics go through.
  std::vector<std::size_t> about(const Interval& interval) const {
    const auto from = std::lower_bound(taken_.begin(), taken_.end(), interval.from);
    return {from == taken_.begin() ? from : from - 1, std::min(from + 3, taken_.end())};
  }
  std::vector<SpreadPart> parts_of(const std::vector<std::size_t>& fields,
                                   std::optional<std::size_t> without = {}) const {
    constexpr int cells_of_tail = 4;  // a pixel of tails is an eighth of where they begin (tail_coarseness())
    LensDataTable whole = one_wavelength(parts_.table(), wavelength_, fields, without);
    if (wanted_.tail_um > 0)
      if (std::optional<TailSplit> split = split_tails(whole, wanted_.tail_um))
        return {{std::move(split->sharp), wanted_.cell_um},
                {std::move(split->tails), wanted_.tail_um / cells_of_tail}};
    return {{std::move(whole), wanted_.cell_um}};
  }

  Misfit misfit(const Interval& interval) const {
    constexpr double of_tolerance = 0.3, of_centre = 0.1, most_at_rim = 4;
    const LensDataTable& table = parts_.table();
    const double from_mm = height_mm(interval.from), to_mm = height_mm(interval.to),
                 at_mm = height_mm(interval.middle());
    const double evenly = 1 / std::sqrt((first_intervals + 1) * frame_.share(from_mm, to_mm));
    const double allowed = of_tolerance * wanted_.tolerance * std::clamp(evenly, 1.0, most_at_rim);
    const double moved_allowed = wanted_.of_a_preview() ? of_centre * wanted_.tolerance : allowed;
    const std::vector<SpreadPart> said = parts_of(about(interval), interval.middle()),
                                  own = parts_of({interval.middle()});
    const double on_axis = table.g_source_sr[table.index(0, wavelength_)];
    const std::vector<double>& with_middle = said[0].table.real_image_height_mm;
    const auto middle = std::size_t(std::ranges::find(with_middle, at_mm) - with_middle.begin());
    Misfit worst{0, 0};
    for (std::size_t i = 0; i < std::min(said.size(), own.size()); ++i) {
      const double light = own[i].table.g_source_sr[0] / on_axis;
      const Kernel by_others = kernel_about_chief(said[i].table, at_mm, said[i].cell_um, wanted_.steps()),
                   by_own = kernel_about_chief(own[i].table, at_mm, own[i].cell_um, wanted_.steps());
      // A bump of the centre's height in an interval moves light together by four times its slope.
      const double moved_mm =
          std::abs(by_others.moments().mean[1] - by_own.moments().mean[1]) * own[i].cell_um * mm_per_um;
      const double brighter = said[i].table.g_source_sr[middle] / on_axis - light;
      const double error = std::hypot(light * kernel_difference(by_others, by_own), brighter);
      worst.of_allowed = std::max(
          {worst.of_allowed, error / allowed, 4 * light * moved_mm / (moved_allowed * (to_mm - from_mm))});
      worst.error = std::hypot(worst.error, error);
    }
    return worst;
  }

  HeightTable& parts_;
  const FrameRings frame_;
  const SpreadWanted wanted_;
  const ProgressCallback& progress_;
  std::size_t wavelength_ = 0;
  std::vector<std::size_t> taken_;  ///< increasing
  double squares_ = 0, error_ = 0;
};

}  // namespace

ChosenFields choose_fields(HeightTable& parts, const TableOptions& options, const SpreadWanted& wanted,
                           const ProgressCallback& progress) {
  FieldChoice choice(parts, options, wanted, progress);
  const std::size_t last = parts.table().wavelengths_nm.size() - 1;
  choice.look_at((last + 1) / 2);
  if (!wanted.of_a_preview() && last > 1)
    for (const std::size_t end : {std::size_t{0}, last}) choice.look_at(end);
  return std::move(choice).chosen();
}

}  // namespace petzval
