// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/report/analysis_plots.h>
#include <petzval/report/field_curves.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace petzval {

namespace {

/// Curves along x with the field upwards, and the axis x = 0 between them.
Plot upright_plot(const std::string& title, const PlotAxis& x, const PlotAxis& y) {
  Plot plot;
  plot.title = title;
  plot.x = x;
  plot.y = y;
  plot.y.from = 0;
  plot.width_px = 380;
  plot.height_px = 420;
  plot.guides.push_back({PlotGuide::At::x, 0});
  return plot;
}

}  // namespace

Plot seidel_plot(const SeidelSums& sums) {
  struct Term {
    const char* label;
    double SeidelTerms::*value;
  };
  constexpr Term terms[] = {{"S1 spherical", &SeidelTerms::s1},     {"S2 coma", &SeidelTerms::s2},
                            {"S3 astigmatism", &SeidelTerms::s3},   {"S4 Petzval", &SeidelTerms::s4},
                            {"S5 distortion", &SeidelTerms::s5},    {"CL axial colour", &SeidelTerms::cl},
                            {"CT lateral colour", &SeidelTerms::ct}};
  constexpr double bar = 0.11;  // of the room of a surface
  Plot plot;
  plot.title = "Seidel coefficients by surface";
  plot.x = {"surface", "", PlotScale::linear, -0.7, static_cast<double>(sums.surfaces.size()) + 1.7};
  plot.y = {"coefficient", "mm"};
  plot.width_px = 900;
  plot.height_px = 380;
  plot.guides = {{PlotGuide::At::y, 0}, {PlotGuide::At::x, static_cast<double>(sums.surfaces.size()), "sum"}};
  const double room_px = 0.9 * plot.width_px / static_cast<double>(sums.surfaces.size() + 2);
  for (std::size_t t = 0; t < std::size(terms); ++t) {
    std::vector<double> x, y;
    const auto add = [&](double place, const SeidelTerms& values) {
      const double at = place + bar * (static_cast<double>(t) - 3);
      x.insert(x.end(), {at, at, at});
      y.insert(y.end(), {0, values.*terms[t].value, std::nan("")});
    };
    for (std::size_t i = 0; i < sums.surfaces.size(); ++i) add(static_cast<double>(i), sums.surfaces[i]);
    add(static_cast<double>(sums.surfaces.size()) + 1, sums.sum);
    plot.line(terms[t].label, x, y).width_px = std::clamp(0.6 * bar * room_px, 1.2, 4.0);
  }
  return plot;
}

Plot mtf_plot(Fields::Kind kind, const std::vector<MtfRow>& rows, std::size_t frequencies) {
  Plot plot;
  plot.title = "MTF, tangential solid, sagittal dashed";
  plot.x = {"spatial frequency", "cycles/mm"};
  plot.y = {"modulation transfer", "", PlotScale::linear, 0.0, 1.0};
  for (std::size_t first = 0; first + frequencies <= rows.size(); first += frequencies) {
    std::vector<double> frequency, tangential, sagittal;
    for (std::size_t k = first; k < first + frequencies; ++k) {
      frequency.push_back(rows[k].frequency_cpmm);
      tangential.push_back(rows[k].tangential);
      sagittal.push_back(rows[k].sagittal);
    }
    const std::string colour = series_colour(first / frequencies).hex();
    const double wavelength = rows[first].wavelength_nm;
    plot.line(
            field_text(kind, rows[first].field) + (wavelength > 0 ? ", " + wavelength_text(wavelength) : ""),
            frequency, tangential)
        .colour = colour;
    PlotSeries& dashed = plot.line("", frequency, sagittal);
    dashed.colour = colour;
    dashed.stroke = PlotStroke::dashed;
  }
  return plot;
}

Plot mtf_field_plot(Fields::Kind kind, const std::vector<MtfRow>& rows, std::size_t frequencies) {
  Plot plot;
  plot.title = "MTF over the field, tangential solid, sagittal dashed";
  plot.x = field_axis(kind);
  plot.y = {"modulation transfer", "", PlotScale::linear, 0.0, 1.0};
  const std::size_t per_field = wavelengths_of(rows);  // wavelengths × frequencies
  for (std::size_t curve = 0; curve < per_field && frequencies > 0; ++curve) {
    std::vector<double> field, tangential, sagittal;
    for (std::size_t i = curve; i < rows.size(); i += per_field) {
      field.push_back(rows[i].field);
      tangential.push_back(rows[i].tangential);
      sagittal.push_back(rows[i].sagittal);
    }
    const std::string colour = series_colour(curve).hex();
    const double wavelength = rows[curve].wavelength_nm;
    plot.line(fmt::format("{:g} cycles/mm{}", rows[curve].frequency_cpmm,
                          wavelength > 0 ? ", " + wavelength_text(wavelength) : ""),
              field, tangential)
        .colour = colour;
    PlotSeries& dashed = plot.line("", field, sagittal);
    dashed.colour = colour;
    dashed.stroke = PlotStroke::dashed;
  }
  return plot;
}

Plot mtf_focus_plot(Fields::Kind kind, const std::vector<MtfRow>& rows) {
  Plot plot;
  plot.title = "MTF through focus, tangential solid, sagittal dashed";
  plot.x = {"sensor behind the image surface", "mm"};
  plot.y = {"modulation transfer", "", PlotScale::linear, 0.0, 1.0};
  plot.guides.push_back({PlotGuide::At::x, 0});
  std::size_t per_shift = 0;
  while (per_shift < rows.size() && rows[per_shift].sensor_shift_mm == rows[0].sensor_shift_mm) ++per_shift;
  for (std::size_t curve = 0; curve < per_shift; ++curve) {
    std::vector<double> shift, tangential, sagittal;
    for (std::size_t i = curve; i < rows.size(); i += per_shift) {
      shift.push_back(rows[i].sensor_shift_mm);
      tangential.push_back(rows[i].tangential);
      sagittal.push_back(rows[i].sagittal);
    }
    const std::string colour = series_colour(curve).hex();
    std::string label =
        fmt::format("{}, {:g} cycles/mm", field_text(kind, rows[curve].field), rows[curve].frequency_cpmm);
    if (rows[curve].wavelength_nm > 0) label += ", " + wavelength_text(rows[curve].wavelength_nm);
    plot.line(label, shift, tangential).colour = colour;
    PlotSeries& dashed = plot.line("", shift, sagittal);
    dashed.colour = colour;
    dashed.stroke = PlotStroke::dashed;
  }
  return plot;
}

std::vector<double> even_shifts(double reach_mm) {
  constexpr int steps = 16;
  std::vector<double> shifts;
  for (int i = -steps; i <= steps; ++i) shifts.push_back(reach_mm * i / steps);
  return shifts;
}

Plot longitudinal_plot(const std::vector<AxialFocusRow>& rows) {
  Plot plot = upright_plot("Longitudinal aberration", {"focus from the image surface", "mm"},
                           {"height at the stop", "radii", PlotScale::linear, 0.0, 1.0});
  std::size_t wavelengths = 0;
  while (wavelengths < rows.size() && rows[wavelengths].zone == rows[0].zone) ++wavelengths;
  for (std::size_t w = 0; w < wavelengths; ++w) {
    std::vector<double> focus, zone;
    for (std::size_t i = w; i < rows.size(); i += wavelengths) {
      focus.push_back(rows[i].focus_mm);
      zone.push_back(rows[i].zone);
    }
    plot.line(wavelength_text(rows[w].wavelength_nm), focus, zone).colour =
        wavelength_colour(rows[w].wavelength_nm).hex();
  }
  return plot;
}

Plot field_curvature_plot(Fields::Kind kind, const std::vector<FieldCurvatureRow>& rows,
                          const std::vector<FieldCurvatureRow>& reference) {
  Plot plot = upright_plot("Field curves: T solid, S dashed", {"focus from the image surface", "mm"},
                           field_axis(kind));
  const auto field = [](const FieldCurvatureRow& row) { return row.field; };
  add_curves(
      plot, rows, [](const FieldCurvatureRow& row) { return row.tangential_mm; }, field);
  add_curves(
      plot, rows, [](const FieldCurvatureRow& row) { return row.sagittal_mm; }, field, PlotStroke::dashed,
      false);
  std::vector<double> petzval, fields;
  for (const FieldCurvatureRow& row : reference) {
    petzval.push_back(row.petzval_mm);
    fields.push_back(row.field);
  }
  PlotSeries& parabola =
      plot.line(fmt::format("Petzval, {:g} nm", reference.front().wavelength_nm), petzval, fields);
  parabola.colour = "#777777";
  parabola.stroke = PlotStroke::dotted;
  return plot;
}

Plot distortion_plot(Fields::Kind kind, const std::vector<DistortionRow>& rows) {
  Plot plot = upright_plot("Distortion", {"distortion", "%"}, field_axis(kind));
  add_curves(
      // On the axis itself a ratio of two zeros: the curve begins beside it.
      plot, rows, [](const DistortionRow& row) { return row.field == 0 ? NAN : row.distortion_percent; },
      [](const DistortionRow& row) { return row.field; });
  return plot;
}

Plot distortion_grid_plot(const DistortionGrid& grid) {
  Plot plot;
  plot.title = fmt::format("Square grid at {}, grey without distortion", wavelength_text(grid.wavelength_nm));
  plot.x = {"image x", "mm"}, plot.y = {"image y", "mm"};
  plot.equal_aspect = true;
  plot.grid = false;
  const auto lines = static_cast<std::size_t>(grid.lines);
  const auto draw = [&](const std::vector<double>& x, const std::vector<double>& y, const char* colour,
                        double width_px) {
    std::vector<double> xs, ys;
    for (const bool across : {true, false})
      for (std::size_t i = 0; i < lines; ++i) {
        for (std::size_t k = 0; k < lines; ++k) {
          const std::size_t at = across ? i * lines + k : k * lines + i;
          xs.push_back(x[at]), ys.push_back(y[at]);
        }
        xs.push_back(NAN), ys.push_back(NAN);
      }
    PlotSeries& series = plot.line("", xs, ys);
    series.colour = colour, series.width_px = width_px;
  };
  draw(grid.ideal_x_mm, grid.ideal_y_mm, "#b0b0b0", 1);
  draw(grid.x_mm, grid.y_mm, wavelength_colour(grid.wavelength_nm).hex().c_str(), 1.4);
  return plot;
}

Plot encircled_energy_plot(Fields::Kind kind, const std::vector<EncircledEnergyRow>& rows) {
  Plot plot;
  plot.title = "Encircled energy, dashed without aberration";
  plot.x = {"radius", "µm"};
  plot.x.from = 0;
  plot.y = {"share of the light", ""};
  plot.y.from = 0;
  plot.y.to = 1;
  for (std::size_t start = 0, end = 0; start < rows.size(); start = end) {
    std::vector<double> radius, share, airy;
    for (end = start; end < rows.size() && rows[end].field == rows[start].field &&
                      rows[end].wavelength_nm == rows[start].wavelength_nm;
         ++end) {
      radius.push_back(rows[end].radius_um);
      share.push_back(rows[end].encircled_energy);
      airy.push_back(rows[end].airy);
    }
    const std::string colour = series_colour(plot.series.size() / 2).hex();
    PlotSeries& line = plot.line(
        fmt::format("{:g} {}, {:g} nm", rows[start].field, field_unit(kind), rows[start].wavelength_nm),
        radius, share);
    line.colour = colour;
    PlotSeries& limit = plot.line("", radius, airy);
    limit.colour = colour;
    limit.stroke = PlotStroke::dashed;
    limit.width_px = 1;
  }
  return plot;
}

Plot lateral_colour_plot(Fields::Kind kind, const std::vector<LateralColourRow>& rows) {
  Plot plot;
  plot.title = "Lateral colour against the reference wavelength";
  plot.x = field_axis(kind);
  plot.y = {"height of the chief ray, less the reference", "µm"};
  plot.guides.push_back({PlotGuide::At::y, 0});
  add_curves(
      plot, rows, [](const LateralColourRow& row) { return row.field; },
      [](const LateralColourRow& row) { return row.lateral_colour_um; });
  return plot;
}

Plot illumination_plot(const std::vector<IlluminationRow>& rows) {
  Plot plot;
  plot.title = "Relative illumination";
  plot.x = {"real image height", "mm"};
  plot.y = {"g_sensor / g_sensor on axis", "", PlotScale::linear, 0.0, {}};
  add_curves(
      plot, rows, [](const IlluminationRow& row) { return row.real_image_height_mm; },
      [](const IlluminationRow& row) { return row.relative_illumination; });
  return plot;
}

Plot vignetting_plot(Fields::Kind kind, const std::vector<VignettingRow>& rows) {
  Plot plot;
  plot.title = "Filled share of the stop";
  plot.x = field_axis(kind);
  plot.y = {"share of the stop's area", "", PlotScale::linear, 0.0, 1.05};
  add_curves(
      plot, rows, [](const VignettingRow& row) { return row.field; },
      [](const VignettingRow& row) { return row.open_share; });
  return plot;
}

namespace {

/// Whether the name of a ghost would stand clear of the others.
bool has_room(const std::vector<PlotNote>& names, const Ghost& ghost) {
  constexpr double across = 2, up = 1.5;  // on logarithmic axes
  return std::none_of(names.begin(), names.end(), [&](const PlotNote& name) {
    return std::abs(std::log(name.x / ghost.diameter_mm)) < std::log(across) &&
           std::abs(std::log(name.y / ghost.relative_irradiance)) < std::log(up);
  });
}

}  // namespace

Plot ghost_plot(const std::vector<Ghost>& rows, std::size_t sensor) {
  constexpr std::size_t most_named = 6;
  Plot plot;
  plot.title = "Ghosts";
  plot.x = {"diameter on the sensor", "mm", PlotScale::logarithmic};
  plot.y = {"irradiance over the image's", "", PlotScale::logarithmic};
  std::map<double, std::pair<std::vector<double>, std::vector<double>>> by_wavelength;
  for (const Ghost& ghost : rows) {
    auto& [x, y] = by_wavelength[ghost.wavelength_nm];
    if (plot.notes.size() < most_named && has_room(plot.notes, ghost))
      plot.notes.push_back(
          {ghost.diameter_mm, ghost.relative_irradiance,
           fmt::format(" {}, {}{}", ghost.first == sensor ? "sensor" : fmt::format("{}", ghost.first),
                       ghost.second,
                       ghost.third ? fmt::format(", {}, {}", *ghost.third, *ghost.fourth) : "")});
    x.push_back(ghost.diameter_mm);
    y.push_back(ghost.relative_irradiance);
  }
  for (const auto& [wavelength_nm, points] : by_wavelength) {
    PlotSeries& dots = plot.line(fmt::format("{:g} nm", wavelength_nm), points.first, points.second);
    dots.colour = wavelength_colour(wavelength_nm).hex();
    dots.stroke = PlotStroke::none;
    dots.marker = PlotMarker::dot;
  }
  return plot;
}

Plot chief_ray_angle_plot(const std::vector<ChiefRayAngleRow>& rows) {
  Plot plot;
  plot.title = "Chief-ray angle at the sensor";
  plot.x = {"real image height", "mm"};
  plot.y = {"angle against the normal", "deg"};
  add_curves(
      plot, rows, [](const ChiefRayAngleRow& row) { return row.real_image_height_mm; },
      [](const ChiefRayAngleRow& row) { return row.chief_ray_angle_deg; });
  return plot;
}

}  // namespace petzval
