// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/simulate/lens_on_sensor.h>

#include <cmath>
#include <functional>
#include <optional>
#include <string>

namespace petzval {

namespace {

std::string number(double value, int digits = 4) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits)
         : std::isnan(value)  ? "none"
                              : "infinity";
}

std::string depth_text(const std::optional<DepthOfField>& depth) {
  if (!depth) return "none";
  return fmt::format("{} to {}", number(depth->near_m, 5), number(depth->far_m, 5));
}

/// "0.75 / 0.61": tangential and sagittal.
std::string both(double tangential, double sagittal) {
  if (!std::isfinite(tangential)) return "no light";
  return fmt::format("{:.3f} / {:.3f}", tangential, sagittal);
}

}  // namespace

Table lens_on_sensor_table(const std::vector<LensOnSensor>& lenses) {
  Table table{{{"lens"}}, {}};
  for (const LensOnSensor& lens : lenses) table.columns.push_back({lens.lens});
  const auto row = [&](const std::string& name, const std::function<std::string(const LensOnSensor&)>& text) {
    std::vector<TableCell> cells{name};
    for (const LensOnSensor& lens : lenses) cells.emplace_back(text(lens));
    table.rows.push_back(std::move(cells));
  };
  const bool far = lenses.front().view.at_infinity;
  const char* unit = far ? "deg" : "mm";
  row("focal length [mm]", [](const auto& lens) { return number(lens.efl_mm, 5); });
  row("f-number, working", [](const auto& lens) {
    return fmt::format("{}, {}", number(lens.f_number, 3), number(lens.working_f_number, 3));
  });
  row(fmt::format("seen [{}]", unit), [](const auto& lens) {
    return fmt::format("{} x {}", number(lens.view.width), number(lens.view.height));
  });
  row(fmt::format("a pixel [{}]", unit), [](const auto& lens) { return number(lens.per_pixel); });
  if (!far) row("magnification", [](const auto& lens) { return number(lens.magnification); });
  row("image circle, diagonal [mm]", [](const auto& lens) {
    return fmt::format("{}, {}", number(lens.image_circle_mm), number(lens.sensor_diagonal_mm));
  });
  row("sharp to a pixel [m]", [](const auto& lens) { return depth_text(lens.geometric); });
  row("sharp by MTF [m]", [](const auto& lens) { return depth_text(lens.by_mtf); });
  row("hyperfocal distance [m]", [](const auto& lens) { return number(lens.hyperfocal_m); });
  const char* const names[] = {"middle", "half way", "corner"};
  for (std::size_t i = 0; i < 3; ++i)
    row(fmt::format("light, {}", names[i]),
        [i](const auto& lens) { return number(lens.places[i].relative_illumination, 3); });
  for (std::size_t i = 0; i < 3; ++i) {
    row(fmt::format("MTF Nyquist/2, {}", names[i]), [i](const auto& lens) {
      return both(lens.places[i].half_nyquist_tangential, lens.places[i].half_nyquist_sagittal);
    });
    row(fmt::format("MTF Nyquist, {}", names[i]), [i](const auto& lens) {
      return both(lens.places[i].nyquist_tangential, lens.places[i].nyquist_sagittal);
    });
  }
  return table;
}

}  // namespace petzval
