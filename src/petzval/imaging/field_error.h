// SPDX-License-Identifier: BSD-3-Clause
// What the PSFs of a table by field height miss of light between its fields.
#pragma once

#include <petzval/imaging/spread_wanted.h>
#include <petzval/optics/lens_data_table.h>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace petzval {

/// How much of a frame lies between two heights.
class FrameRings {
 public:
  explicit FrameRings(const std::array<double, 2>& half_frame_mm);
  double share(double from_mm, double to_mm) const;

 private:
  static constexpr int places = 32;  ///< along a side of a quadrant
  std::vector<double> height_mm_;
};

/// What PSFs at some fields say of the light at one that is left out.
struct FieldMisfit {
  struct Part {           ///< of light near its chief ray, and of tails that are formed apart
    double error = 0;     ///< relative to the light on the axis
    double moved_mm = 0;  ///< its centre, times that light
  };
  std::vector<Part> parts;

  double error() const;
};

/// \param fields  increasing, of PSFs that the table has; `left_out` lies between two of them and has one,
/// too.
FieldMisfit field_misfit(const LensDataTable& table, std::size_t wavelength,
                         const std::vector<std::size_t>& fields, std::size_t left_out,
                         const SpreadWanted& wanted);

/// In the middle between two fields a mixture of their PSFs is at its worst: over the interval it is off by
/// so much of that, (16 t² (1 − t)²)² on average.
inline constexpr double over_interval = 0.64;

/// Relative L2 error of an image by what the PSFs of a table miss between its fields, at its middle
/// wavelength. Fields are left out, between neighbours that lie two and four fields apart; how that differs
/// says what is left where they lie one apart. 0 for tables over the frame and those of fewer than seven
/// fields, which do not say.
double error_between_fields(const LensDataTable& table, const std::array<double, 2>& half_frame_mm,
                            const SpreadWanted& wanted);

}  // namespace petzval
