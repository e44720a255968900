// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/report/colours.h>
#include <petzval/report/field_curves.h>
#include <petzval/report/heat_map.h>
#include <petzval/report/pupil_plots.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

void draw_circle(Plot& plot, double x, double y, double radius) {
  std::vector<double> xs, ys;
  constexpr int steps = 72;
  for (int i = 0; i <= steps; ++i) {
    xs.push_back(x + radius * std::cos(2 * pi * i / steps));
    ys.push_back(y + radius * std::sin(2 * pi * i / steps));
  }
  PlotSeries& circle = plot.line("", xs, ys);
  circle.colour = "#000000";
  circle.width_px = 1.2;
}

void draw_figure(Plot& plot, const ApertureFigure& figure) {
  std::vector<double> xs, ys;
  constexpr int steps = 72;
  const double c = std::cos(radians(figure.rotation_deg)), s = std::sin(radians(figure.rotation_deg));
  for (int i = 0; i <= steps; ++i) {
    double across = std::cos(2 * pi * i / steps), along = std::sin(2 * pi * i / steps);
    if (figure.kind == ApertureFigure::Kind::rectangle) {
      // Along the same direction to the edge of the square.
      const double far = std::max(std::abs(across), std::abs(along));
      across /= far, along /= far;
    }
    const double x = figure.half_width_x_mm * across, y = figure.half_width_y_mm * along;
    xs.push_back(figure.decentre_x_mm + c * x - s * y);
    ys.push_back(figure.decentre_y_mm + s * x + c * y);
  }
  PlotSeries& edge = plot.line("", xs, ys);
  edge.colour = "#000000";
  edge.width_px = 1.2;
}

}  // namespace

std::vector<Plot> spot_plots(Fields::Kind kind, const std::vector<SpotDiagram>& diagrams,
                             const std::vector<SpotRow>& rows) {
  constexpr double side_px = 320, stroke_px = 1.5, margin = 1.1;
  const std::size_t wavelengths = wavelengths_of(rows), fields = rows.size() / wavelengths;
  std::vector<Plot> plots;
  for (std::size_t f = 0; f < fields; ++f) {
    const std::size_t first = f * wavelengths;
    const double airy_um = rows[first].airy_radius_um;
    double reach = airy_um;
    for (std::size_t i = first; i < first + wavelengths; ++i) {
      const double above_um = diagrams[i].height_um - diagrams[first].height_um;  // lateral colour
      for (std::size_t k = 0; k < diagrams[i].x_um.size(); ++k)
        reach = std::max({reach, std::abs(diagrams[i].x_um[k]), std::abs(diagrams[i].y_um[k] + above_um)});
    }
    Plot plot;
    plot.title =
        fmt::format("{}: RMS {:.2f} µm", field_text(kind, rows[first].field), rows[first].rms_radius_um);
    plot.x = {"sagittal", "µm", PlotScale::linear, -margin * reach, margin * reach};
    plot.y = {"from the chief ray", "µm", PlotScale::linear, -margin * reach, margin * reach};
    plot.equal_aspect = true;
    plot.width_px = side_px;
    const double stroke = stroke_px * 2 * margin * reach / side_px;
    for (std::size_t w = 0; w < wavelengths; ++w) {
      const SpotDiagram& diagram = diagrams[first + w];
      const double above_um = diagram.height_um - diagrams[first].height_um;
      std::vector<double> xs, ys;
      for (std::size_t k = 0; k < diagram.x_um.size(); ++k) {
        // A stroke as short as it is thick: markers of the plot would hide each other.
        const double x = diagram.x_um[k], y = diagram.y_um[k] + above_um;
        xs.insert(xs.end(), {x - 0.5 * stroke, x + 0.5 * stroke, std::nan("")});
        ys.insert(ys.end(), {y, y, y});
      }
      PlotSeries& dots = plot.line(f == 0 ? wavelength_text(rows[first + w].wavelength_nm) : "", xs, ys);
      dots.colour = wavelength_colour(rows[first + w].wavelength_nm).hex();
      dots.width_px = stroke_px;
    }
    draw_circle(plot, 0, 0, airy_um);
    plots.push_back(std::move(plot));
  }
  return plots;
}

std::vector<Plot> footprint_plots(Fields::Kind kind, const Lens& lens,
                                  const std::vector<Footprint>& footprints) {
  constexpr double side_px = footprint_plot_px, margin = 1.08;
  constexpr double widest_figure = 1.5;  // of the light that it limits, where all of it is to be seen
  std::vector<Plot> plots;
  const std::size_t surfaces = lens.surfaces.size(), fields = footprints.size() / surfaces;
  for (std::size_t s = 0; s < surfaces; ++s) {
    const double clear = lens.surfaces[s].semi_diameter_mm.value_or(0);
    double light = 0;
    for (std::size_t f = 0; f < fields; ++f) {
      const Footprint& footprint = footprints[s * fields + f];
      for (std::size_t k = 0; k < footprint.x_mm.size(); ++k)
        light = std::max({light, std::abs(footprint.x_mm[k]), std::abs(footprint.y_mm[k])});
    }
    double reach = std::max(clear, light);
    for (const ApertureFigure& figure : lens.surfaces[s].apertures)
      reach = std::max(reach, std::min(figure.farthest_mm(), widest_figure * light));
    Plot plot;
    plot.title = fmt::format("surface {}{}", s, s == lens.stop_index() ? ", the stop" : "");
    plot.x = {"x", "mm", PlotScale::linear, -margin * reach, margin * reach};
    plot.y = {"y", "mm", PlotScale::linear, -margin * reach, margin * reach};
    plot.equal_aspect = true;
    plot.width_px = side_px;
    for (std::size_t f = 0; f < fields; ++f) {
      const Footprint& footprint = footprints[s * fields + f];
      plot.line(s == 0 ? field_text(kind, footprint.field) : "", footprint.x_mm, footprint.y_mm).colour =
          series_colour(f).hex();
    }
    if (clear > 0) draw_circle(plot, 0, 0, clear);
    for (const ApertureFigure& figure : lens.surfaces[s].apertures) draw_figure(plot, figure);
    plots.push_back(std::move(plot));
  }
  return plots;
}

std::vector<Plot> fan_plots(Fields::Kind kind, const std::vector<AberrationFans>& rows,
                            FanQuantity quantity) {
  const bool opd = quantity == FanQuantity::opd;
  double reach = 0;
  const auto value = [&](const FanPoint& point, bool tangential) {
    return opd ? point.opd_waves : tangential ? point.y_um : point.x_um;
  };
  for (const AberrationFans& row : rows) {
    for (const FanPoint& point : row.tangential) reach = std::max(reach, std::abs(value(point, true)));
    for (const FanPoint& point : row.sagittal) reach = std::max(reach, std::abs(value(point, false)));
  }
  std::vector<Plot> plots;
  const std::size_t wavelengths = wavelengths_of(rows);
  for (std::size_t first = 0; first < rows.size(); first += wavelengths)
    for (const bool tangential : {true, false}) {
      Plot plot;
      plot.title =
          fmt::format("{}, {}", field_text(kind, rows[first].field), tangential ? "tangential" : "sagittal");
      plot.x = {tangential ? "stop y" : "stop x", "radii", PlotScale::linear, -1.0, 1.0};
      plot.y = {opd          ? "W"
                : tangential ? "y"
                             : "x",
                opd ? "waves" : "µm", PlotScale::linear, -1.05 * reach, 1.05 * reach};
      plot.width_px = 400;
      plot.height_px = 260;
      plot.guides = {{PlotGuide::At::x, 0}, {PlotGuide::At::y, 0}};
      for (std::size_t w = 0; w < wavelengths; ++w) {
        std::vector<double> pupil, values;
        for (const FanPoint& point : tangential ? rows[first + w].tangential : rows[first + w].sagittal) {
          pupil.push_back(point.pupil);
          values.push_back(value(point, tangential));
        }
        const double wavelength = rows[first + w].wavelength_nm;
        plot.line(first == 0 && tangential ? wavelength_text(wavelength) : "", pupil, values).colour =
            wavelength_colour(wavelength).hex();
      }
      plots.push_back(std::move(plot));
    }
  return plots;
}

std::vector<Plot> wavefront_map_plots(Fields::Kind kind, const std::vector<WavefrontMap>& maps) {
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (const WavefrontMap& map : maps)
    for (const double waves : map.waves)
      if (std::isfinite(waves)) {
        lowest = std::min(lowest, waves);
        highest = std::max(highest, waves);
      }
  if (!(highest - lowest > 1e-9)) {  // a perfect wavefront has no colours
    lowest -= 1;
    highest += 1;
  }
  std::vector<Plot> plots;
  for (const WavefrontMap& map : maps) {
    const std::vector<float> values(map.waves.begin(), map.waves.end());
    HeatMapOptions options;
    options.map = ColourMap::viridis;
    options.black = lowest;
    options.white = highest;
    options.first_row_on_top = false;
    Plot plot;
    double low = highest, high = lowest;
    for (const double waves : map.waves)
      if (std::isfinite(waves)) {
        low = std::min(low, waves);
        high = std::max(high, waves);
      }
    plot.title =
        fmt::format("{}, {}: {} to {} waves", field_text(kind, map.field), wavelength_text(map.wavelength_nm),
                    short_number(std::round(100 * low) / 100), short_number(std::round(100 * high) / 100));
    const double edge = 1 + 1.0 / (map.size - 1);
    plot.images.push_back({heat_map_png(values, map.size, map.size, options), -edge, edge, -edge, edge});
    plot.x = {"stop x", "radii", PlotScale::linear, -edge, edge};
    plot.y = {"stop y", "radii", PlotScale::linear, -edge, edge};
    plot.equal_aspect = true;
    plot.width_px = 390;
    plot.grid = false;
    plots.push_back(std::move(plot));
  }
  return plots;
}

Plot wavefront_plot(Fields::Kind kind, const std::vector<WavefrontRow>& rows) {
  Plot plot;
  plot.title = "RMS wavefront aberration, piston removed";
  plot.x = field_axis(kind);
  plot.y = {"RMS wavefront aberration", "waves", PlotScale::linear, 0.0, {}};
  add_curves(
      plot, rows, [](const WavefrontRow& row) { return row.field; },
      [](const WavefrontRow& row) { return row.rms_waves; });
  for (PlotSeries& series : plot.series) series.marker = PlotMarker::dot;
  return plot;
}

Plot zernike_plot(Fields::Kind kind, const std::vector<WavefrontZernikeRow>& rows, ZernikeOrder order) {
  Plot plot;
  plot.title = order == ZernikeOrder::noll ? "Zernike coefficients (Noll), without piston"
                                           : "Zernike coefficients (Fringe), without piston";
  plot.x = {"term", ""};
  plot.y = {"coefficient", "waves"};
  plot.width_px = 900;
  plot.guides.push_back({PlotGuide::At::y, 0});
  const double room = 0.8 / static_cast<double>(std::max<std::size_t>(rows.size(), 1));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<double> x, y;
    for (std::size_t j = 1; j < rows[i].coefficients.size(); ++j) {
      const double at = static_cast<double>(j + 1) + room * (static_cast<double>(i) + 0.5) - 0.4;
      x.insert(x.end(), {at, at, at});
      y.insert(y.end(), {0, rows[i].coefficients[j], std::nan("")});
    }
    PlotSeries& bars = plot.line(
        fmt::format("{}, {}", field_text(kind, rows[i].field), wavelength_text(rows[i].wavelength_nm)), x, y);
    bars.width_px = 2.2;
  }
  return plot;
}

}  // namespace petzval
