// SPDX-License-Identifier: BSD-3-Clause
// Numbers as text, so that none is changed on the way through a file.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace petzval {

/// The shortest decimal that reads back as the same double; always with a point or an exponent.
std::string number_text(double value);
/// The same for value·10^power_of_ten, to be read back by parse_scaled_number() with the opposite power.
std::string scaled_number_text(double value, int power_of_ten);

/// The whole of `word` as a finite number; nothing if it is not one.
std::optional<double> parse_number(std::string_view word);
/// As parse_number(), times a power of ten, without a rounding of its own: "0.5875618" µm is 587.5618 nm.
std::optional<double> parse_scaled_number(std::string_view word, int power_of_ten);
std::optional<int> parse_integer(std::string_view word);

/// Whether a number has more digits than a double can hold, which is 17.
bool is_beyond_double(std::string_view number);

/// Files give radii, a surface has a curvature, and one double in six is the reciprocal of no double. So a
/// radius is written with as many digits as its curvature needs, mostly those of a double, sometimes up to
/// four more: curvature_from_radius(radius_text(c)) == c for every c ≠ 0.
std::string radius_text(double curvature_per_mm);
/// 1/radius in double precision; in extended precision if the text has more digits than a double holds.
double curvature_from_radius(std::string_view radius);

}  // namespace petzval
