// SPDX-License-Identifier: BSD-3-Clause
// The points of a sweep: which parameters take which values.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace petzval::app {

/// One `--vary KEY=VALUES`.
struct SweptParameter {
  std::string key;  ///< surfaces[4].thickness_mm, f-number, sensor, …
  std::vector<std::string> values;
};

/// "KEY=START:STEP:STOP" (START, START + STEP and so on, not beyond STOP), all three in one unit if they have
/// one (1m:0.05m:3m), or "KEY=A,B,…". \param notes  gains what the user should know: an end that is not met,
/// values that stand there twice. \param frames  if given, "KEY=START:STOP" are so many values evenly between
/// them. \throws InputError saying what would be right, or for more than 10,000 values.
SweptParameter parse_swept(const std::string& text, std::vector<std::string>& notes,
                           std::optional<int> frames = {});

/// Values of all parameters at one point, in the order of the parameters.
using SweepPoint = std::vector<std::pair<std::string, std::string>>;

/// All combinations, the last parameter fastest. \throws InputError for a parameter given twice or more than
/// 10,000 points.
std::vector<SweepPoint> sweep_points(const std::vector<SweptParameter>& parameters);

/// The column of a table of points that names them and is no parameter.
inline constexpr const char* label_key = "label";

/// The points of a CSV file: a line of keys, then a line a point, with as many values. \throws InputError
/// with the line.
std::vector<SweepPoint> read_sweep_points(const std::string& path);

/// All values of each key of such points.
std::vector<SweptParameter> parameters_of(const std::vector<SweepPoint>& points);

}  // namespace petzval::app
