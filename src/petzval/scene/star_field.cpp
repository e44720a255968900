// SPDX-License-Identifier: BSD-3-Clause
// The night sky: real stars at their places, as bright and of the colour that they are.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/units.h>
#include <petzval/base/whole_file.h>
#include <petzval/colour/illuminants.h>
#include <petzval/scene/star_field.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

namespace petzval {

namespace {

struct NamedField {
  const char* name;
  SkyPlace centre;
};

constexpr std::array named_fields = {
    NamedField{"cassiopeia", {14, 60.5}},  NamedField{"crux", {187.5, -60}},
    NamedField{"cygnus", {305, 40.5}},     NamedField{"leo", {163, 16}},
    NamedField{"lyra", {283, 36}},         NamedField{"orion", {83.8, -1}},
    NamedField{"pleiades", {56.75, 24.1}}, NamedField{"scorpius", {252, -32}},
    NamedField{"taurus", {67, 17}},        NamedField{"ursa-major", {183, 56}},
};

std::vector<double> numbers_of(std::string_view line) {
  std::vector<double> numbers;
  while (!line.empty()) {
    const std::size_t comma = std::min(line.find(','), line.size());
    if (const std::optional<double> number = parse_number(line.substr(0, comma))) numbers.push_back(*number);
    line.remove_prefix(std::min(comma + 1, line.size()));
  }
  return numbers;
}

}  // namespace

std::vector<Star> bright_stars() {
  const std::string text = read_whole_file(find_data_file("stars", ".csv", "bright-stars", "star catalogue"));
  std::vector<Star> stars;
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    constexpr std::size_t columns = 5;
    const std::vector<double> row = numbers_of(line);
    if (row.size() == columns) stars.push_back({static_cast<int>(row[0]), {row[1], row[2]}, row[3], row[4]});
  }
  return stars;
}

SkyPlace sky_place(const std::string& text) {
  for (const NamedField& field : named_fields)
    if (text == field.name) return field.centre;
  const std::vector<double> numbers = numbers_of(text);
  if (numbers.size() == 2 && std::abs(numbers[0]) <= 360 && std::abs(numbers[1]) <= 90)
    return {numbers[0], numbers[1]};
  std::vector<std::string> names;
  for (const NamedField& field : named_fields) names.emplace_back(field.name);
  throw InputError(fmt::format(
      "scene stars:{}: right ascension and declination in degrees, as in stars:83.8,-1, or {} would be right",
      text, fmt::join(names, ", ")));
}

double star_temperature_k(double b_minus_v) {
  return 4600 * (1 / (0.92 * b_minus_v + 1.7) + 1 / (0.92 * b_minus_v + 0.62));
}

std::vector<double> star_irradiance(const Star& star, const std::vector<double>& wavelengths_nm) {
  const double temperature_k = star_temperature_k(star.b_minus_v);
  const double level = irradiance_of_magnitude_0 * std::pow(10.0, -0.4 * star.magnitude) /
                       blackbody_radiance(visual_band_nm, temperature_k);
  std::vector<double> irradiance;
  for (const double nm : wavelengths_nm) irradiance.push_back(level * blackbody_radiance(nm, temperature_k));
  return irradiance;
}

namespace {

/// From sky to the tangents of object angles, north up and east on the left, as one sees it. \returns z of
/// the direction, below 0 behind the camera.
double project(SkyPlace star, SkyPlace centre, Point& tangents) {
  const double turn = radians(star.right_ascension_deg - centre.right_ascension_deg),
               high = radians(star.declination_deg), middle = radians(centre.declination_deg);
  const double ahead = std::sin(middle) * std::sin(high) + std::cos(middle) * std::cos(high) * std::cos(turn);
  tangents = {
      -std::cos(high) * std::sin(turn) / ahead,
      (std::cos(middle) * std::sin(high) - std::sin(middle) * std::cos(high) * std::cos(turn)) / ahead};
  return ahead;
}

/// Adds a star to the four samples about it, so that its light and its centre are kept.
void add_star(Scene& scene, Point at, const std::vector<double>& radiance) {
  const double x = at.x - 0.5, y = at.y - 0.5;
  const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
  for (const auto& [i, j] : std::array<std::pair<int, int>, 4>{{{0, 0}, {1, 0}, {0, 1}, {1, 1}}}) {
    const int c = column + i, r = row + j;
    if (c < 0 || r < 0 || c >= scene.columns() || r >= scene.rows()) continue;
    const double share = (1 - std::abs(x - c)) * (1 - std::abs(y - r));
    const auto sample =
        static_cast<std::size_t>(r) * static_cast<std::size_t>(scene.columns()) + static_cast<std::size_t>(c);
    for (int band = 0; band < scene.bands(); ++band)
      scene.band(band)[sample] += static_cast<float>(share * radiance[static_cast<std::size_t>(band)]);
  }
}

}  // namespace

Scene star_field(const ChartOptions& options, SkyPlace centre) {
  Scene scene(options.columns, options.rows,
              options.wavelengths_nm.empty() ? default_bands_nm() : options.wavelengths_nm,
              options.horizontal_angle_deg, std::nullopt);
  const double sky =
      irradiance_of_magnitude_0 * std::pow(10.0, -0.4 * dark_sky_magnitude) / steradians_of_square_arcsecond;
  for (int band = 0; band < scene.bands(); ++band)
    std::ranges::fill(scene.band(band), static_cast<float>(sky));
  const double step = scene.tangent_per_sample();
  for (const Star& star : bright_stars()) {
    Point tangents;
    const double ahead = project(star.place, centre, tangents);
    if (ahead <= 0) continue;
    const Point at{options.columns / 2.0 + tangents.x / step, options.rows / 2.0 - tangents.y / step};
    if (at.x < 0 || at.y < 0 || at.x > options.columns || at.y > options.rows) continue;
    // A sample of the plane is seen under step² cos³ of the object angle.
    std::vector<double> radiance = star_irradiance(star, scene.wavelengths_nm());
    for (double& value : radiance) value /= step * step * ahead * ahead * ahead;
    add_star(scene, at, radiance);
  }
  return scene;
}

}  // namespace petzval
