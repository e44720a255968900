// SPDX-License-Identifier: BSD-3-Clause
// What a lens may have become when it was built, as numbers that a fit can find.
#pragma once

#include <petzval/lens/lens.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace petzval {

/// One number of a built lens, 0 as designed.
struct BuildNumber {
  enum class Kind {
    defocus_mm,  ///< of the sensor along the axis, away from the lens
    tolerance,   ///< of a ToleranceKind
    sag_um       ///< of a surface, growing with a power of r, at its clear aperture
  };
  Kind kind = Kind::defocus_mm;
  Tolerance tolerance = {};     ///< of Kind::tolerance its kind, else the surface alone; `limit` is 1
  int power = 0;                ///< of Kind::sag_um
  char axis = ' ';              ///< 'x' or 'y' where the number has a direction, else ' '
  std::optional<int> map = {};  ///< of Kind::defocus_mm: that of one photograph alone
  std::optional<double> deviation = {};  ///< standard deviation that is expected beforehand, in its unit

  /// "element_tilt_deg@2-3 x".
  std::string name() const;
  /// "mm", "deg", "um" or that of the tolerance.
  std::string unit() const;
  /// A step that a good lens shows: 0.01 mm, 0.05 deg, 0.1 %, 0.1 um.
  double scale() const;
};

/// What a text stands for:
///
/// | text | numbers |
/// |---|---|
/// | `defocus_mm` | one |
/// | `sensor_tilt_deg` | about x and about y |
/// | `element_decentre_mm@2-3`, `element_tilt_deg@2-3` and the other kinds of tolerances | one, or x and y |
/// | `sag4_um@0`, `sag6_um@0` | one: a term of r⁴ or r⁶, as spherical aberration has it |
///
/// followed by `=LIMIT` for what a maker keeps: half of it is the standard deviation that is expected.
/// \throws InputError saying what is wrong and what would be right.
std::vector<BuildNumber> parse_build_numbers(const Lens& lens, std::string_view text);

/// The lens with a number off by `value`, in its unit.
Lens with_number(Lens lens, const BuildNumber& number, double value);

}  // namespace petzval
