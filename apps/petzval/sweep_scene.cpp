// SPDX-License-Identifier: BSD-3-Clause
#include "sweep_scene.h"

#include <fmt/format.h>
#include <petzval/base/version.h>
#include <petzval/render/pbrt/scene_files.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "image_option.h"

namespace petzval::app {

namespace {

using Json = nlohmann::ordered_json;

/// Reads the command line of `image` and works with what it asks for. What is wrong with a point, the point
/// itself will say.
void with_choice(std::vector<std::string> arguments,
                 const std::function<void(const ImageChoice&, const Shared&)>& work) {
  CLI::App program{"", "petzval"};
  Shared shared;
  ImageChoice choice;
  CLI::App* const command =
      add_command(program, shared, "image", "", "", true, [&] { work(choice, shared); });
  choice.add_to(*command);
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
  try {
    program.parse(std::move(arguments));
  } catch (const std::exception&) {
  }
}

bool fills_frame(const std::vector<std::string>& arguments) {
  bool fills = false;
  with_choice(arguments, [&](const ImageChoice& choice, const Shared& shared) {
    fills = !choice.image.least_scene_angle_deg &&
            petzval::fills_frame(choice.scene.request(), choice.read_optics(shared), choice.image_options());
  });
  return fills;
}

struct Widths {
  double least_deg = INFINITY, greatest_deg = 0;
};

Widths widths_of(const std::vector<std::vector<std::string>>& command_lines) {
  Widths widths;
  for (const std::vector<std::string>& arguments : command_lines)
    with_choice(arguments, [&](const ImageChoice& choice, const Shared& shared) {
      const double angle_deg = filling_angle_deg(choice.scene.request(), choice.read_optics(shared),
                                                 choice.image_options(), {.threads = shared.threads})
                                   .value();
      widths.least_deg = std::min(widths.least_deg, angle_deg);
      widths.greatest_deg = std::max(widths.greatest_deg, angle_deg);
    });
  return widths;
}

/// Tells whether widths are of the same points.
std::string fingerprint(const std::vector<std::vector<std::string>>& command_lines) {
  Json points = Json::array({version()});
  for (const std::vector<std::string>& arguments : command_lines)
    points.push_back({arguments, checksums_of_files(arguments, arguments.back())});
  return render::hash_text(points.dump());
}

/// The widths that an earlier run has found of these points, or else found now.
Widths known_widths(const std::vector<std::vector<std::string>>& command_lines, SweepFolder& folder) {
  const std::string points = fingerprint(command_lines);
  const Json& before = folder.scene();
  const auto entry = [&](const char* key) {
    return before.is_object() && before.contains(key) ? before[key] : Json();
  };
  const Json least = entry("least_deg"), greatest = entry("greatest_deg");
  if (entry("points") == Json(points) && least.is_number() && greatest.is_number())
    return {least.get<double>(), greatest.get<double>()};
  const Widths widths = widths_of(command_lines);
  if (widths.greatest_deg > 0)
    folder.remember_scene(
        {{"points", points}, {"least_deg", widths.least_deg}, {"greatest_deg", widths.greatest_deg}});
  return widths;
}

void note_width(const Widths& widths, const std::string& angle, const Shared& shared) {
  constexpr double same = 1 + 1e-6;
  if (widths.greatest_deg <= widths.least_deg * same)
    return note(
        shared,
        fmt::format("the scene is made {} degrees wide, to fill the frame (--scene-angle sets another)",
                    angle));
  note(shared, fmt::format("the scene is made {} degrees wide at all points, to fill the widest frame; the "
                           "narrowest would need {:.3g} (--scene-width each fits the "
                           "scene to each frame, --scene-angle sets another width)",
                           angle, widths.least_deg));
}

}  // namespace

std::vector<std::string> scene_angles(const CLI::App& app, const SweepCommand& options,
                                      const std::vector<SweepPoint>& points, SweepFolder& folder,
                                      const Shared& shared) {
  std::vector<std::string> angles(points.size());
  if (options.command != "image" || options.scene_width == "each") return angles;
  std::vector<std::vector<std::string>> command_lines;
  std::vector<std::size_t> filling;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<std::string> arguments = arguments_of(app, options, points[i], shared);
    arguments.insert(arguments.end(), {"-o", options.folder + "/" + name_of_point(i) + ".png"});
    if (!fills_frame(arguments)) continue;
    command_lines.push_back(std::move(arguments));
    filling.push_back(i);
  }
  if (filling.size() < 2) return angles;  // it fills its frame by itself
  const Widths widths = known_widths(command_lines, folder);
  if (!(widths.greatest_deg > 0)) return angles;
  constexpr double reserve = 1.01;  // widths are found to a per cent
  const std::string angle = fmt::format("{:.4g}", reserve * widths.greatest_deg);
  note_width(widths, angle, shared);
  for (const std::size_t i : filling) angles[i] = angle;
  return angles;
}

void check_scene_angle(const PointResult& result, const std::string& angle, const Shared& shared) {
  const auto made = result.numbers.find("scene_angle_deg");
  if (angle.empty() || made == result.numbers.end() || !made->is_number()) return;
  constexpr double rounding = 1 + 1e-9;
  if (made->get<double>() > std::stod(angle) * rounding)
    note(shared,
         fmt::format("{}: this frame needs a scene {:.4g} degrees wide, so that its scale is not that of "
                     "the others; --scene-angle {:.4g} would be right for all",
                     result.picture, made->get<double>(), std::ceil(made->get<double>())));
}

}  // namespace petzval::app
