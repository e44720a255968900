// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/report/html.h>
#include <petzval/report/lens_drawing.h>
#include <petzval/report/ray_animation.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr double seconds = 6;
/// Of each turn, how long the whole picture stands still at the end.
constexpr double moving_share = 0.8;

/// A ray as a line in lens space from where it sets out, with the optical path to each point.
struct Track {
  std::vector<std::array<double, 3>> points;
  std::vector<double> opl_mm;
};

/// All rays set out where the one that is listed is `lead_mm` before the lens: with the same optical path
/// from the object, or from a plane across the beam.
Track track_of(const AnimatedRay& ray, const RayStep& listed, double lead_mm) {
  const RayStep& first = ray.steps.front();
  const auto& d = first.direction_before;
  const double stretch = std::max(lead_mm + first.path_mm - listed.path_mm, 0.0);
  Track track;
  track.points.push_back({first.point_mm[0] - stretch * d[0], first.point_mm[1] - stretch * d[1],
                          first.point_mm[2] - stretch * d[2]});
  track.opl_mm.push_back(0);
  double opl = stretch;
  for (std::size_t i = 0; i < ray.steps.size(); ++i) {
    if (i > 0) opl += ray.steps[i].index_before * ray.steps[i].path_mm;
    track.points.push_back(ray.steps[i].point_mm);
    track.opl_mm.push_back(opl);
  }
  return track;
}

/// Key frames that uncover a line of length 1 as light runs along it, in one view.
std::string key_frames(const std::string& name, const Track& track, std::size_t axis, double last_opl_mm) {
  std::vector<double> length{0};
  for (std::size_t i = 1; i < track.points.size(); ++i)
    length.push_back(length.back() + std::hypot(track.points[i][2] - track.points[i - 1][2],
                                                track.points[i][axis] - track.points[i - 1][axis]));
  std::string frames = fmt::format("@keyframes {}{{", name);
  for (std::size_t i = 0; i < length.size(); ++i)
    frames += fmt::format("{:.3f}%{{stroke-dashoffset:{:.5f}}}",
                          100 * moving_share * std::max(track.opl_mm[i], 0.0) / last_opl_mm,
                          1 - length[i] / length.back());
  return frames + "100%{stroke-dashoffset:0}}\n";
}

}  // namespace

Table ray_steps_table(const std::vector<RayStep>& steps) {
  Table table{{{"surface", "", 0, "surface"},
               {"x", "mm", 5, "x_mm"},
               {"y", "mm", 5, "y_mm"},
               {"z", "mm", 5, "z_mm"},
               {"normal x", "", 5, "normal_x"},
               {"normal y", "", 5, "normal_y"},
               {"normal z", "", 5, "normal_z"},
               {"n before", "", 5, "index_before"},
               {"n after", "", 5, "index_after"},
               {"incidence", "deg", 4, "incidence_deg"},
               {"refraction", "deg", 4, "refraction_deg"},
               {"L after", "", 6, "L"},
               {"M after", "", 6, "M"},
               {"N after", "", 6, "N"},
               {"path", "mm", 5, "path_mm"},
               {"optical path", "mm", 5, "opl_mm"}},
              {}};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const RayStep& step = steps[i];
    const bool image = i + 1 == steps.size() && i > 0 && step.surface > steps[i - 1].surface;
    const std::string name = image ? "image" : fmt::format("{}", step.surface);
    table.rows.push_back({name, step.point_mm[0], step.point_mm[1], step.point_mm[2], step.normal[0],
                          step.normal[1], step.normal[2], step.index_before, step.index_after,
                          step.incidence_deg, step.refraction_deg, step.direction_after[0],
                          step.direction_after[1], step.direction_after[2], step.path_mm, step.opl_mm});
  }
  return table;
}

std::string ray_animation_html(const Lens& lens, const std::vector<AnimatedRay>& rays, std::size_t listed) {
  if (rays.empty() || listed >= rays.size()) throw InputError("an animation needs rays");
  for (const AnimatedRay& ray : rays)
    if (ray.steps.size() < 2) throw InputError("a ray of an animation has no steps");
  const double lead_mm = 0.25 * lens.total_track_mm();
  std::vector<Track> tracks;
  double last_opl_mm = 0;
  for (const AnimatedRay& ray : rays) {
    tracks.push_back(track_of(ray, rays[listed].steps.front(), lead_mm));
    last_opl_mm = std::max(last_opl_mm, tracks.back().opl_mm.back());
  }
  html::Page page(lens.name, "Light on its way through the lens, ray by ray");
  std::string style;
  for (const std::size_t axis : {std::size_t{1}, std::size_t{0}}) {
    const char* view = axis == 1 ? "y" : "x";
    std::vector<DrawnRay> drawn;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const std::string name = fmt::format("run-{}{}", view, i);
      DrawnRay line{{}, rays[i].colour, name};
      for (const auto& point : tracks[i].points) line.zy_mm.push_back({point[2], point[axis]});
      drawn.push_back(std::move(line));
      style += fmt::format(".{0}{{stroke-dasharray:1;animation:{0} {1}s linear infinite}}\n", name, seconds) +
               key_frames(name, tracks[i], axis, last_opl_mm);
    }
    LensDrawingOptions options;
    options.lead_mm = lead_mm;
    options.title = fmt::format("{}-z", view);
    page.section(axis == 1 ? "From the side: y upwards" : "From above: x upwards", view);
    page.add(html::drawing(draw_lens(lens, drawn, options)));
  }
  // Moves on a screen, for those who have not asked for stillness.
  page.add({"<style>@media screen and (prefers-reduced-motion:no-preference){\n" + style + "}</style>\n"});
  page.section("Step by step", "steps");
  page.add(
      html::paragraph("One ray at each surface: where it meets it, the normal there, the indices, the angles "
                      "against the normal, the direction behind it, and its path."));
  const Table table = ray_steps_table(rays[listed].steps);
  page.add(html::table(table));
  page.add(html::download("ray_steps.csv", "text/csv", to_csv(table), "data (CSV)"));
  return page.html();
}

}  // namespace petzval
