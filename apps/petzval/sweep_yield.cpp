// SPDX-License-Identifier: BSD-3-Clause
#include "sweep_yield.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/measure/sfr/corner_sharpness.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "output_option.h"
#include "sweep_tables.h"

namespace petzval::app {

using Json = nlohmann::ordered_json;

std::string Criterion::text() const {
  return fmt::format("{} {} {:g}", column, at_least ? ">=" : "<=", value);
}

Criterion parse_criterion(const std::string& text) {
  const std::size_t at = text.find_first_of("<>");
  const auto value = at != text.npos && at > 0 && text.substr(at + 1, 1) == "="
                         ? parse_number(text.substr(at + 2))
                         : std::nullopt;
  if (!value)
    throw InputError(fmt::format(
        "--accept \"{}\": COLUMN>=VALUE or COLUMN<=VALUE, as in corners.least_cpp>=0.2, would be right",
        text));
  return {text.substr(0, at), text[at] == '>', *value};
}

namespace {

constexpr std::array<const char*, 4> corner_names{"top_left_cpp", "top_right_cpp", "bottom_left_cpp",
                                                  "bottom_right_cpp"};

}  // namespace

std::vector<std::string> corner_columns() {
  std::vector<std::string> columns(corner_names.begin(), corner_names.end());
  columns.insert(columns.end(), {"least_cpp", "symmetry", "colour_px"});
  for (std::string& column : columns) column.insert(0, "corners.");
  return columns;
}

void measure_corners(PointResult& result, const Shared& shared) {
  const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(); };
  CornerSharpness corners;
  corners.mtf50_cpp.fill(std::numeric_limits<double>::quiet_NaN());
  corners.least_cpp = corners.symmetry = std::numeric_limits<double>::quiet_NaN();
  try {
    const PicturePlanes picture = read_picture_planes(result.picture);
    SfrRequest request;
    request.channel = picture.rgb ? "all" : "luminance";
    Context context = context_of(shared);
    context.progress = {};
    context.note = {};
    corners = corner_sharpness(measure_sfr(picture, request, result.picture, context), picture.columns,
                               picture.rows);
  } catch (const InputError&) {
    // Blurred beyond any edge: not measured, and so not good.
  }
  Json measured = Json::object();
  for (std::size_t i = 0; i < 4; ++i) measured[corner_names[i]] = number(corners.mtf50_cpp[i]);
  measured["least_cpp"] = number(corners.least_cpp);
  measured["symmetry"] = number(corners.symmetry);
  if (corners.colour_px) measured["colour_px"] = number(*corners.colour_px);
  result.numbers["corners"] = measured;
}

std::vector<JudgedPoint> judged_points(const std::vector<PointResult>& results,
                                       const std::vector<Criterion>& criteria) {
  std::vector<JudgedPoint> judged;
  for (const PointResult& result : results) {
    JudgedPoint point{result.done, std::numeric_limits<double>::quiet_NaN()};
    for (const Json& row : rows_of({result}))
      for (std::size_t k = 0; k < criteria.size(); ++k) {
        const auto found = row.find(criteria[k].column);
        if (found == row.end() || !found->is_number()) {
          point.good = false;
          continue;
        }
        const double value = found->get<double>(), sign = criteria[k].at_least ? 1 : -1;
        if (!(sign * value >= sign * criteria[k].value)) point.good = false;
        if (k == 0 && !(sign * value >= sign * point.value)) point.value = value;  // the worst row
      }
    judged.push_back(point);
  }
  return judged;
}

std::size_t good_points(const std::vector<JudgedPoint>& points) {
  return static_cast<std::size_t>(std::ranges::count_if(points, &JudgedPoint::good));
}

std::string yield_text(const std::vector<JudgedPoint>& points, const std::vector<Criterion>& criteria) {
  const std::size_t good = good_points(points);
  const Yield yield = yield_of(good, points.size());
  std::vector<std::string> texts;
  for (const Criterion& criterion : criteria) texts.push_back(criterion.text());
  return fmt::format("yield: {} of {}, {:.1f} % (95 % interval {:.1f} to {:.1f} %), with {}", good,
                     points.size(), 100 * yield.share, 100 * yield.low, 100 * yield.high,
                     fmt::join(texts, ", "));
}

}  // namespace petzval::app
