// SPDX-License-Identifier: BSD-3-Clause
// Distances, ranges and sizes as users write them: one grammar, whoever asks.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace petzval {

/// "1.2m", "250mm", "30cm", "2km", "12um", and "infinity" or "inf", in metres; nothing for any other text. A
/// bare number is none: it could be metres or millimetres.
std::optional<double> parse_length_m(std::string_view text);

/// The same, positive. \param parameter  for messages. \throws InputError, for a bare number with the two
/// lengths that it could have meant.
double parse_distance_m(std::string_view text, std::string_view parameter);

/// "1.2m", "250mm" below a metre, "infinity": what parse_length_m() reads back to six digits.
std::string distance_text(double distance_m);

/// "0,7,14", "0:5:20" (start:step:stop, both ends taken) or both, parted by commas. \param parameter  for
/// messages. \throws InputError, for start:stop:step with what would be right.
std::vector<double> parse_number_list(std::string_view text, std::string_view parameter);

/// Columns and rows of pixels or samples.
struct GridSize {
  int columns = 0, rows = 0;
};

/// "768x576". \param parameter  for messages. \throws InputError.
GridSize parse_grid_size(std::string_view text, std::string_view parameter);

}  // namespace petzval
