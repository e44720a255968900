// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/field_choice.h>
#include <petzval/imaging/field_error.h>

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

/// An interval between two fields with PSFs.
struct Interval {
  std::size_t from, to;
};

std::array<double, 2> half_frame_of(const TableOptions& options) {
  const double side_mm = options.max_image_height_mm / std::sqrt(2.0);
  return options.half_frame_mm.value_or(std::array{side_mm, side_mm});
}

/// Finds the fields that an image needs.
class FieldChoice {
 public:
  FieldChoice(HeightTable& parts, const TableOptions& options, std::size_t finer, const SpreadWanted& wanted,
              const ProgressCallback& progress)
      : parts_(parts),
        frame_(half_frame_of(options)),
        finer_(finer),
        last_rising_(parts.last_rising_field()),
        wanted_(wanted),
        progress_(progress) {
    const std::size_t last = parts.table().fields.size() - 1;
    for (std::size_t i = 0; i <= first_intervals; ++i)
      taken_.push_back(i == first_intervals ? last : field_at(i * last / first_intervals));
  }

  /// Takes what a wavelength needs beyond what others took.
  void look_at(std::size_t wavelength) {
    wavelength_ = wavelength;
    squares_ = 0;
    parts_.add_psfs(taken_, std::array{wavelength_}, progress_);
    std::vector<Interval> open;
    for (std::size_t i = 0; i + 1 < taken_.size(); ++i) open.push_back({taken_[i], taken_[i + 1]});
    while (true) {
      std::erase_if(open, [&](const Interval& interval) { return !can_be_parted(interval); });
      if (open.empty()) break;
      open = refined(open);
    }
    error_ = std::max(error_, std::sqrt(squares_));
  }
  ChosenFields chosen() && { return {std::move(taken_), error_}; }

 private:
  /// A field, or the one before it that was asked for.
  std::size_t field_at(std::size_t field) const {
    return field <= last_rising_ ? field : field - field % finer_;
  }
  /// Where an interval is parted, if it can be.
  std::size_t middle_of(const Interval& interval) const {
    return field_at((interval.from + interval.to) / 2);
  }
  bool can_be_parted(const Interval& interval) const { return middle_of(interval) > interval.from; }
  /// Of the frame.
  double share_of(const Interval& interval) const {
    return std::max(0.0, frame_.share(height_mm(interval.from), height_mm(interval.to)));
  }

  /// What the PSFs about an interval miss in its middle.
  struct Misfit {
    double of_allowed;  ///< over what they may
    double error;       ///< of the light there, relative to that on the axis
  };

  /// The halves of those that are too wide.
  std::vector<Interval> refined(const std::vector<Interval>& open) {
    std::vector<std::size_t> middles;
    for (const Interval& interval : open) middles.push_back(middle_of(interval));
    parts_.add_psfs(middles, std::array{wavelength_}, progress_);
    std::vector<Misfit> misfits(open.size());
    parallel_for(open.size(), [&](std::size_t i) { misfits[i] = misfit(open[i]); });
    std::vector<Interval> halves;
    for (std::size_t i = 0; i < open.size(); ++i) {
      const Interval& interval = open[i];
      constexpr double of_halves = 4;  // Halves of an interval miss a quarter of it or less.
      const std::size_t middle = middle_of(interval);
      const double error = over_interval * misfits[i].error;
      if (misfits[i].of_allowed <= 1) {
        squares_ += share_of(interval) * error * error;
        parts_.remove_psf(middle, wavelength_);
        continue;
      }
      taken_.push_back(middle);
      for (const Interval& half : {Interval{interval.from, middle}, Interval{middle, interval.to}}) {
        if (misfits[i].of_allowed > of_halves && can_be_parted(half))
          halves.push_back(half);
        else
          squares_ += share_of(half) * std::pow(error / of_halves, 2);
      }
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
  Misfit misfit(const Interval& interval) const {
    constexpr double of_tolerance = 0.3, of_centre = 0.1, most_at_rim = 4;
    const LensDataTable& table = parts_.table();
    const double from_mm = height_mm(interval.from), to_mm = height_mm(interval.to);
    const double evenly = 1 / std::sqrt((first_intervals + 1) * frame_.share(from_mm, to_mm));
    const double allowed = of_tolerance * wanted_.tolerance * std::clamp(evenly, 1.0, most_at_rim);
    const double moved_allowed = wanted_.of_a_preview() ? of_centre * wanted_.tolerance : allowed;
    const FieldMisfit found = field_misfit(table, wavelength_, about(interval), middle_of(interval), wanted_);
    Misfit worst{0, found.error()};
    // A bump of the centre's height in an interval moves light together by four times its slope.
    for (const FieldMisfit::Part& part : found.parts)
      worst.of_allowed = std::max(
          {worst.of_allowed, part.error / allowed, 4 * part.moved_mm / (moved_allowed * (to_mm - from_mm))});
    return worst;
  }

  HeightTable& parts_;
  const FrameRings frame_;
  const std::size_t finer_, last_rising_;
  const SpreadWanted wanted_;
  const ProgressCallback& progress_;
  std::size_t wavelength_ = 0;
  std::vector<std::size_t> taken_;  ///< increasing
  double squares_ = 0, error_ = 0;
};

}  // namespace

ChosenFields choose_fields(HeightTable& parts, const TableOptions& options, std::size_t finer,
                           const SpreadWanted& wanted, const ProgressCallback& progress) {
  FieldChoice choice(parts, options, finer, wanted, progress);
  const std::size_t last = parts.table().wavelengths_nm.size() - 1;
  choice.look_at((last + 1) / 2);
  if (!wanted.of_a_preview() && last > 1)
    for (const std::size_t end : {std::size_t{0}, last}) choice.look_at(end);
  return std::move(choice).chosen();
}

}  // namespace petzval
