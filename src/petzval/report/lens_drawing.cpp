// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/surface_shape.h>
#include <petzval/report/lens_drawing.h>
#include <petzval/report/surface_profile.h>
#include <petzval/report/ticks.h>
#include <petzval/report/xml.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

constexpr double number_row_px = 14;

std::vector<double> vertices_z_mm(const Lens& lens) {
  std::vector<double> z{0};
  for (const Surface& surface : lens.surfaces) z.push_back(z.back() + surface.thickness_mm);
  return z;  // the last one is the image surface
}

/// The largest height at which a ray meets a surface, 0 if none does. Rays usually have a point on each
/// surface; the crossings of straight stretches are asked only when no point is on it.
double ray_height_mm(const Surface& surface, double vertex_z_mm, const std::vector<DrawnRay>& rays) {
  constexpr double on_surface_mm = 1e-6;
  const ShapeData<double> shape = shape_of(surface);
  double on_it = 0, crossing = 0;
  for (const DrawnRay& ray : rays) {
    double before = std::nan("");
    for (std::size_t i = 0; i < ray.zy_mm.size(); ++i) {
      const auto [z, y] = ray.zy_mm[i];
      const double ahead = z - vertex_z_mm - surface_point(shape, 0, y).sag;
      if (std::abs(ahead) < on_surface_mm) on_it = std::max(on_it, std::abs(y));
      if (before * ahead < 0) {
        const double last_y = ray.zy_mm[i - 1][1];
        crossing = std::max(crossing, std::abs(last_y + (y - last_y) * before / (before - ahead)));
      }
      before = ahead;
    }
  }
  return on_it > 0 ? on_it : crossing;
}

/// Heights still at 0 take that of the nearest surface that has one.
void fill_from_neighbours(std::vector<double>& heights, double fallback) {
  const std::vector<double> known = heights;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    for (std::size_t step = 1; heights[i] == 0 && step < heights.size(); ++step) {
      if (i >= step) heights[i] = known[i - step];
      if (i + step < known.size()) heights[i] = std::max(heights[i], known[i + step]);
    }
    if (heights[i] == 0) heights[i] = fallback;
  }
}

struct View {
  double z_left, y_half, px_per_mm;  ///< what is seen [mm], and the scale
  double width_px, height_px;        ///< of the window on the lens
  double top_px;                     ///< how far down the drawing that window begins
  double x(double z_mm) const { return (z_mm - z_left) * px_per_mm; }
  double y(double y_mm) const { return (y_half - y_mm) * px_per_mm; }
};

std::string path_of(const View& view, const std::vector<PlanePoint>& points, bool closed) {
  std::string path;
  bool pen_down = false;
  for (const auto& [z, y] : points) {
    const bool finite = std::isfinite(z) && std::isfinite(y);
    if (finite)
      path += fmt::format("{}{} {}", pen_down ? 'L' : 'M', svg_number(view.x(z)), svg_number(view.y(y)));
    pen_down = finite;
  }
  return closed ? path + "Z" : path;
}

/// What is drawn, in mm; all sizes finite.
struct Scene {
  const Lens& lens;
  const std::vector<DrawnRay>& rays;
  std::vector<double> vertex_z, semi_diameter;
  std::vector<std::vector<PlanePoint>> profiles;  ///< of the surfaces, then of the image
  double image_half_height = 0;
};

double default_image_half_height_mm(const std::vector<DrawnRay>& rays, double image_z_mm, double fallback) {
  double height = 0;
  for (const DrawnRay& ray : rays) {
    if (ray.zy_mm.empty()) continue;
    const auto [z, y] = ray.zy_mm.back();
    if (std::abs(z - image_z_mm) < 1e-6 * (1 + std::abs(image_z_mm)) && std::isfinite(y))
      height = std::max(height, std::abs(y));
  }
  return height > 0 ? height : fallback;
}

Scene make_scene(const Lens& lens, const std::vector<DrawnRay>& rays, const LensDrawingOptions& options) {
  Scene scene{lens, rays, vertices_z_mm(lens), drawn_semi_diameters_mm(lens, rays, options), {}, 0};
  const double largest = *std::max_element(scene.semi_diameter.begin(), scene.semi_diameter.end());
  scene.image_half_height = options.image_half_height_mm.value_or(
      default_image_half_height_mm(rays, scene.vertex_z.back(), 0.5 * largest));
  const std::vector<Frame> frames = frames_of(lens);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const bool sensor = i == lens.surfaces.size();
    const double vertex_z = scene.vertex_z[i];
    const auto designed = sensor ? profile(Surface{}, vertex_z, scene.image_half_height)
                                 : profile(lens.surfaces[i], vertex_z, scene.semi_diameter[i]);
    scene.profiles.push_back(placed(designed, frames[i].turned(-radians(options.azimuth_deg)), vertex_z));
  }
  return scene;
}

/// The largest height of a ray to the right of z_left, where straight stretches are cut.
double highest_ray_mm(const std::vector<DrawnRay>& rays, double z_left) {
  double height = 0;
  const auto include = [&](double y) {
    if (std::isfinite(y)) height = std::max(height, std::abs(y));
  };
  for (const DrawnRay& ray : rays) {
    for (std::size_t i = 0; i < ray.zy_mm.size(); ++i) {
      const auto [z, y] = ray.zy_mm[i];
      if (z < z_left) continue;
      include(y);
      if (i == 0 || !(ray.zy_mm[i - 1][0] < z_left)) continue;
      const auto [last_z, last_y] = ray.zy_mm[i - 1];
      include(y + (last_y - y) * (z - z_left) / (z - last_z));
    }
  }
  return height;
}

View make_view(const Scene& scene, const LensDrawingOptions& options) {
  constexpr double smallest_mm = 1e-9, side_px = 24, most_for_rays = 1.3;
  double z_front = scene.vertex_z.back(), z_back = scene.vertex_z.back(), y_most = scene.image_half_height;
  for (const auto& points : scene.profiles) {
    for (const auto& [z, y] : points) {
      if (!std::isfinite(z)) continue;
      z_front = std::min(z_front, z);
      z_back = std::max(z_back, z);
      y_most = std::max(y_most, scene.lens.has_mirrors() ? std::abs(y) : y);
    }
  }
  const double length = std::max(z_back - z_front, smallest_mm);
  const double lead = std::max(options.lead_mm.value_or(0.2 * length), 0.0);
  const double seen = length + lead;
  View view{};
  view.z_left = z_front - lead;
  const double rays_need = std::min(highest_ray_mm(scene.rays, view.z_left), most_for_rays * y_most);
  view.y_half = std::max(1.06 * std::max(y_most, rays_need), smallest_mm);
  view.px_per_mm = options.px_per_mm.value_or(
      std::min((options.width_px - side_px) / seen, options.tallest_px / (2 * view.y_half)));
  view.width_px = seen * view.px_per_mm + side_px;
  view.height_px = 2 * view.y_half * view.px_per_mm;
  return view;
}

void draw_elements(XmlWriter& xml, const Scene& scene, const View& view) {
  const auto& surfaces = scene.lens.surfaces;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    // Of a ray transfer, what lies between its planes is a box.
    if (surfaces[i].mirror) {
      xml.leaf("path", {{"class", "pz-line"},
                        {"d", path_of(view, scene.profiles[i], false)},
                        {"fill", "none"},
                        {"stroke-width", 3.0}});
      continue;
    }
    if (!surfaces[i].material.is_air() || surfaces[i].transfer) {
      const auto outline = element_outline(scene.profiles[i], scene.profiles[i + 1]);
      xml.leaf("path", {{"class", "pz-glass"},
                        {"d", path_of(view, outline, true)},
                        {"stroke-width", 1.2},
                        {"stroke-linejoin", "round"}});
    }
    const bool dummy = surfaces[i].material.is_air() &&
                       (i == 0 || scene.lens.medium_behind(i - 1).is_air()) && !surfaces[i].stop;
    if (dummy)
      xml.leaf("path", {{"class", "pz-frame"},
                        {"d", path_of(view, scene.profiles[i], false)},
                        {"stroke-width", 0.8},
                        {"stroke-dasharray", "3 3"}});
  }
}

void draw_stop(XmlWriter& xml, const Scene& scene, const View& view, double azimuth_deg) {
  constexpr double foot_px = 5;
  for (std::size_t i = 0; i < scene.lens.surfaces.size(); ++i) {
    // That of a ray transfer is somewhere in its box.
    if (!scene.lens.surfaces[i].stop || scene.lens.surfaces[i].transfer) continue;
    StopBlades blades = scene.lens.surfaces[i].blades;
    blades.rotation_deg -= azimuth_deg;
    const auto& [bottom, top] = std::pair{scene.profiles[i].front(), scene.profiles[i].back()};
    const double middle = 0.5 * (top[1] + bottom[1]), y = 0.5 * (top[1] - bottom[1]);
    const double neighbour =
        std::max(scene.profiles[i == 0 ? 0 : i - 1].back()[1], scene.profiles[i + 1].back()[1]);
    for (const double side : {1.0, -1.0}) {
      const double x = view.x((side > 0 ? top : bottom)[0]), outer = std::max(1.3 * y, neighbour);
      const double inner = middle + side * y * blades.reach(0, side);
      xml.leaf("path", {{"class", "pz-line"},
                        {"stroke-width", 2.4},
                        {"d", fmt::format("M{0} {2}V{3}M{1} {3}h{4}", svg_number(x), svg_number(x - foot_px),
                                          svg_number(view.y(side * outer)), svg_number(view.y(inner)),
                                          svg_number(2 * foot_px))}});
    }
  }
}

void draw_rays(XmlWriter& xml, const Scene& scene, const View& view) {
  for (const DrawnRay& ray : scene.rays)
    xml.leaf("path", {{"class", std::string(ray.colour.empty() ? "pz-line" : "pz-data") +
                                    (ray.style_class.empty() ? "" : " " + ray.style_class)},
                      {"pathLength", ray.style_class.empty() ? "" : "1"},
                      {"d", path_of(view, ray.zy_mm, false)},
                      {"fill", "none"},
                      {"stroke", ray.colour},
                      {"stroke-width", 1.0},
                      {"stroke-linejoin", "round"},
                      {"stroke-opacity", "0.9"}});
}

void draw_axis_and_image(XmlWriter& xml, const Scene& scene, const View& view) {
  xml.leaf("line", {{"class", "pz-frame"},
                    {"x1", 0.0},
                    {"y1", view.y(0)},
                    {"x2", view.width_px},
                    {"y2", view.y(0)},
                    {"stroke-width", 0.8},
                    {"stroke-dasharray", "12 3 2 3"}});
  xml.leaf("path",
           {{"class", "pz-line"}, {"d", path_of(view, scene.profiles.back(), false)}, {"stroke-width", 2.2}});
}

/// Numbers stand above the surfaces in rows, so that they do not touch: the row of each, 0 lowest.
std::vector<std::size_t> number_rows(const Scene& scene, const View& view) {
  constexpr double digit_px = 7, gap_px = 3;
  std::vector<double> row_ends;
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < scene.lens.surfaces.size(); ++i) {
    const double x = view.x(scene.profiles[i].back()[0]);
    const double half = digit_px * static_cast<double>(std::to_string(i).size()) / 2;
    const auto free_row =
        std::find_if(row_ends.begin(), row_ends.end(), [&](double end) { return x - half >= end; });
    const auto row = static_cast<std::size_t>(free_row - row_ends.begin());
    if (row == row_ends.size()) row_ends.push_back(0);
    row_ends[row] = x + half + gap_px;
    rows.push_back(row);
  }
  return rows;
}

void draw_surface_numbers(XmlWriter& xml, const Scene& scene, const View& view,
                          const std::vector<std::size_t>& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto [z, y] = scene.profiles[i].back();
    const double x = view.x(z), text_y = view.top_px - 6 - number_row_px * static_cast<double>(rows[i]);
    xml.leaf(
        "line",
        {{"class", "pz-grid"}, {"x1", x}, {"y1", text_y + 3}, {"x2", x}, {"y2", view.top_px + view.y(y)}});
    xml.text("text",
             {{"class", "pz-soft"}, {"x", x}, {"y", text_y}, {"text-anchor", "middle"}, {"font-size", 11.0}},
             std::to_string(i));
  }
}

void draw_scale_bar(XmlWriter& xml, const View& view) {
  const double length = nice_length(view.width_px / view.px_per_mm / 6), length_px = length * view.px_per_mm;
  const double y = view.top_px + view.height_px + 16;
  xml.leaf("path",
           {{"class", "pz-line"},
            {"stroke-width", 1.4},
            {"d", fmt::format("M12 {0}v6m0 -3h{1}m0 -3v6", svg_number(y - 3), svg_number(length_px))}});
  xml.text("text", {{"class", "pz-ink"}, {"x", 12 + length_px + 8}, {"y", y + 4}},
           short_number(length) + " mm");
}

/// A long title is written smaller.
double title_size_px(const std::string& title, double width_px) {
  constexpr double usual = 15, smallest = 8, width_of_letter = 0.58, side_px = 24;
  const double letters = static_cast<double>(character_count(title));
  return std::clamp((width_px - side_px) / (width_of_letter * letters), smallest, usual);
}

void draw_title_and_legend(XmlWriter& xml, const LensDrawingOptions& options, double width_px) {
  if (!options.title.empty())
    xml.text("text",
             {{"class", "pz-ink"},
              {"x", 12.0},
              {"y", 24.0},
              {"font-size", title_size_px(options.title, width_px)},
              {"font-weight", "600"}},
             options.title);
  double x = 12;
  const double y = options.title.empty() ? 18 : 46;
  for (const LegendLabel& label : options.legend) {
    xml.leaf("line", {{"x1", x},
                      {"y1", y - 4},
                      {"x2", x + 18},
                      {"y2", y - 4},
                      {"stroke", label.colour},
                      {"stroke-width", 2.0}});
    xml.text("text", {{"class", "pz-ink"}, {"x", x + 24}, {"y", y}}, label.text);
    x += 24 + 7.0 * static_cast<double>(character_count(label.text)) + 18;
  }
}

}  // namespace

std::vector<double> drawn_semi_diameters_mm(const Lens& lens, const std::vector<DrawnRay>& rays,
                                            const LensDrawingOptions& options) {
  constexpr double margin = 1.04, just_inside_rim = 0.9999;
  const std::vector<double> z = vertices_z_mm(lens);
  std::vector<double> heights;
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
    const Surface& surface = lens.surfaces[i];
    const bool asked = i < options.semi_diameters_mm.size() && options.semi_diameters_mm[i] > 0;
    double height = surface.semi_diameter_mm.value_or(asked ? options.semi_diameters_mm[i] : 0);
    const bool box = surface.transfer || (i > 0 && lens.surfaces[i - 1].transfer);
    if (box || height <= 0) height = ray_height_mm(surface, z[i], rays) * (surface.stop && !box ? 1 : margin);
    heights.push_back(std::isfinite(height) ? height : 0);
  }
  for (std::size_t i = 0; i + 1 < heights.size(); ++i)
    if (lens.surfaces[i].transfer) heights[i] = heights[i + 1] = std::max(heights[i], heights[i + 1]);
  fill_from_neighbours(heights, std::max(std::abs(z.back()) / 6, 1e-9));
  for (std::size_t i = 0; i < heights.size(); ++i)
    heights[i] = std::min(heights[i], just_inside_rim * rim_mm(shape_of(lens.surfaces[i])));
  return heights;
}

namespace {

constexpr double scale_bar_px = 34;

/// A drawing, laid out.
struct Sheet {
  Scene scene;
  View view;
  std::vector<std::size_t> rows;  ///< of the surfaces' numbers

  double height_px() const { return view.top_px + view.height_px + scale_bar_px; }
};

Sheet lay_out_lens(const Lens& lens, const std::vector<DrawnRay>& rays, const LensDrawingOptions& options) {
  if (lens.surfaces.empty()) throw InputError("a lens without surfaces cannot be drawn");
  constexpr double number_gap_px = 6;
  Scene scene = make_scene(lens, rays, options);
  View view = make_view(scene, options);
  std::vector<std::size_t> rows =
      options.surface_numbers ? number_rows(scene, view) : std::vector<std::size_t>();
  view.top_px = 8 + (options.title.empty() ? 0 : 26) + (options.legend.empty() ? 0 : 20);
  if (!rows.empty())
    view.top_px +=
        number_gap_px + number_row_px * static_cast<double>(1 + *std::max_element(rows.begin(), rows.end()));
  return {std::move(scene), view, std::move(rows)};
}

void draw_sheet(XmlWriter& xml, const Sheet& sheet, const LensDrawingOptions& options) {
  const View& view = sheet.view;
  draw_title_and_legend(xml, options, view.width_px);
  if (options.surface_numbers) draw_surface_numbers(xml, sheet.scene, view, sheet.rows);
  xml.open(
      "svg",
      {{"y", view.top_px}, {"width", view.width_px}, {"height", view.height_px}, {"overflow", "hidden"}});
  draw_axis_and_image(xml, sheet.scene, view);
  draw_elements(xml, sheet.scene, view);
  draw_rays(xml, sheet.scene, view);
  draw_stop(xml, sheet.scene, view, options.azimuth_deg);
  xml.close();
  draw_scale_bar(xml, view);
}

}  // namespace

std::string draw_lens(const Lens& lens, const std::vector<DrawnRay>& rays,
                      const LensDrawingOptions& options) {
  const Sheet sheet = lay_out_lens(lens, rays, options);
  XmlWriter xml;
  open_svg(xml, sheet.view.width_px, sheet.height_px(),
           "Layout of " + (lens.name.empty() ? "a lens" : lens.name));
  draw_sheet(xml, sheet, options);
  return std::move(xml).finish();
}

std::string draw_states(const std::vector<DrawnState>& states) {
  if (states.empty()) throw InputError("a lens without states cannot be drawn in them");
  double px_per_mm = std::numeric_limits<double>::infinity();
  for (const DrawnState& state : states)
    px_per_mm = std::min(px_per_mm, lay_out_lens(state.lens, state.rays, state.options).view.px_per_mm);
  std::vector<Sheet> sheets;
  double width_px = 0, height_px = 0;
  for (const DrawnState& state : states) {
    LensDrawingOptions options = state.options;
    options.px_per_mm = px_per_mm;
    sheets.push_back(lay_out_lens(state.lens, state.rays, options));
    width_px = std::max(width_px, sheets.back().view.width_px);
    height_px += sheets.back().height_px();
  }
  XmlWriter xml;
  open_svg(xml, width_px, height_px, "States of " + states.front().lens.name);
  double y = 0;
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    // Sensors stand one above the other: what moves is the glass.
    xml.open("svg", {{"x", width_px - sheets[i].view.width_px},
                     {"y", y},
                     {"width", sheets[i].view.width_px},
                     {"height", sheets[i].height_px()},
                     {"overflow", "visible"}});
    draw_sheet(xml, sheets[i], states[i].options);
    xml.close();
    y += sheets[i].height_px();
  }
  return std::move(xml).finish();
}

}  // namespace petzval
