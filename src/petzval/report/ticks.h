// SPDX-License-Identifier: BSD-3-Clause
// Where an axis has its ticks, and what is written at them.
#pragma once

#include <string>
#include <vector>

namespace petzval {

enum class PlotScale { linear, logarithmic };

/// The range of an axis and its ticks, all inside the range and increasing.
struct Ticks {
  double from = 0, to = 1;
  std::vector<double> values;       ///< labelled
  std::vector<std::string> labels;  ///< one for each value, with a true minus sign
  std::vector<double> minor;        ///< unlabelled
  int exponent = 0;                 ///< labels are values / 10^exponent (linear axes with awkward magnitudes)
};

/// Ticks at 1, 2 or 5 times a power of ten, about `wanted` of them; on a logarithmic axis at powers of ten,
/// with 2 and 5 between them when there are few decades. \param round_outwards  the range grows to the next
/// tick at both ends; else it is kept. Any range is served: ends are exchanged if need be, an empty one is
/// widened about its value, ends that are not finite (or, on a logarithmic axis, not positive) are replaced
/// by the nearest that make sense.
Ticks make_ticks(PlotScale scale, double from, double to, int wanted, bool round_outwards);

/// 10 to a power, in superscript: "10⁻⁵".
std::string power_of_ten(int exponent);

/// A "nice" length of 1, 2 or 5 times a power of ten: the largest that is not above `length` (> 0).
double nice_length(double length);

/// The shortest decimal text of a number with at most `digits` significant digits, with a true minus sign.
std::string short_number(double value, int digits = 6);

}  // namespace petzval
