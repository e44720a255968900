// SPDX-License-Identifier: BSD-3-Clause
// petzval target: synthetic targets of exactly known sharpness.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/staged_files.h>
#include <petzval/base/units.h>
#include <petzval/base/whole_file.h>
#include <petzval/report/target_plot.h>
#include <petzval/simulate/target.h>
#include <petzval/target/exact_sfr.h>
#include <petzval/target/formats/polygon_file.h>
#include <petzval/target/formats/svg_shapes.h>
#include <petzval/target/printed_chart.h>
#include <petzval/target/stroke_font.h>
#include <petzval/target/test_charts.h>
#include <petzval/target/visible_regions.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "command.h"
#include "field_option.h"
#include "output_option.h"
#include "plot_output.h"
#include "target_optics.h"
#include "target_output.h"

namespace petzval::app {

namespace {

struct TargetCommand {
  TargetOptics optics;
  TargetOutput output;
  std::string sensor, rectangle, polygons, chart, text, text_height = "40", at, size, bayer, exact_sfr, plot;
  std::optional<double> half_plane_deg;
  double noise = 0;
};

/// "100x80@5", the angle being optional.
Contour rectangle_of(const std::string& text, Vertex centre) {
  const std::size_t sign = text.find('@');
  const auto [width, height] = pair_of(text.substr(0, sign), 'x', "--rectangle");
  const double angle =
      sign == std::string::npos ? 0 : pair_of(text.substr(sign + 1) + "@0", '@', "--rectangle").first;
  return rectangle(centre, width, height, angle);
}

struct Frame {
  int columns = 0, rows = 0;
};

std::optional<Frame> frame_of(const std::string& size) {
  if (size.empty()) return std::nullopt;
  const auto [columns, rows] = pair_of(size, 'x', "--size");
  if (columns != std::floor(columns) || rows != std::floor(rows) || !(columns >= 1 && rows >= 1) ||
      !(columns * rows <= static_cast<double>(1 << 28)))
    throw InputError(
        fmt::format("--size {}: whole numbers of pixels, 1x1 to 2^28 pixels in all, are right", size));
  return Frame{static_cast<int>(columns), static_cast<int>(rows)};
}

/// Around polygons: from the origin to their far corner and as far again as their near corner lies from it.
Frame frame_around(const TargetScene& scene) {
  double left = HUGE_VAL, top = HUGE_VAL, right = 0, bottom = 0;
  for (const Polygon& polygon : scene.polygons)
    for (const Contour& contour : polygon.contours)
      for (const Vertex& v : contour) {
        left = std::min(left, v.x), right = std::max(right, v.x);
        top = std::min(top, v.y), bottom = std::max(bottom, v.y);
      }
  constexpr double largest = 16384;
  const auto side = [=](double from, double to) {
    return static_cast<int>(std::clamp(std::ceil(to + std::max(from, 20.0)), 1.0, largest));
  };
  return {side(left, right), side(top, bottom)};
}

struct Picture {
  TargetScene scene;
  Frame frame;
};

/// In the middle of a picture that leaves twice the letters' height around it.
Picture picture_of_text(const TargetCommand& command, const std::optional<Frame>& asked) {
  TextStyle style;
  const std::size_t sign = command.text_height.find('@');
  const std::string whole = command.text_height + (sign == std::string::npos ? "@0" : "");
  std::tie(style.height_px, style.angle_deg) = pair_of(whole, '@', "--text-height");
  const double width = text_width(command.text, style), height = style.height_px;
  const double c = std::cos(style.angle_deg * pi / 180), s = std::sin(style.angle_deg * pi / 180);
  const auto side = [&](double extent) {
    return static_cast<int>(std::clamp(std::ceil(extent + 4 * height), 64.0, 16384.0));
  };
  const double across = std::abs(c) * width + std::abs(s) * height,
               down = std::abs(s) * width + std::abs(c) * height;
  Picture picture;
  picture.frame = asked.value_or(Frame{side(across), side(down)});
  Vertex centre{0.5 * picture.frame.columns, 0.5 * picture.frame.rows};
  if (!command.at.empty()) std::tie(centre.x, centre.y) = pair_of(command.at, ',', "--at");
  const Vertex corner{centre.x - 0.5 * (c * width - s * height), centre.y - 0.5 * (s * width + c * height)};
  picture.scene.polygons = text_polygons(command.text, corner, style);
  return picture;
}

Picture picture_of(const TargetCommand& command) {
  const int given = !command.rectangle.empty() + !command.polygons.empty() + !command.chart.empty() +
                    !command.text.empty() + command.half_plane_deg.has_value();
  if (given != 1)
    throw InputError(
        "give one target: --rectangle WxH@DEG, --half-plane DEG, --polygons FILE, --text WORDS or --chart "
        "NAME");
  Picture picture;
  const std::optional<Frame> asked = frame_of(command.size);
  if (!command.polygons.empty()) {
    if (!command.at.empty())
      throw InputError("--at places a rectangle or half-plane; polygons say where they stand");
    const bool svg = std::filesystem::path(command.polygons).extension() == ".svg";
    picture.scene = svg ? read_svg_shapes(command.polygons) : read_polygon_file(command.polygons);
    picture.frame = asked ? *asked : frame_around(picture.scene);
    return picture;
  }
  Frame usual{240, 240};
  if (!command.chart.empty()) {
    if (!command.at.empty())
      throw InputError("--at places a rectangle or half-plane; a chart stands in the middle");
    usual = {640, 640};
  } else if (!command.rectangle.empty()) {
    const auto [width, height] =
        pair_of(command.rectangle.substr(0, command.rectangle.find('@')), 'x', "--rectangle");
    const int side = static_cast<int>(std::clamp(2.4 * std::max(width, height), 64.0, 16384.0));
    usual = {side, side};
  }
  if (!command.text.empty()) return picture_of_text(command, asked);
  picture.frame = asked.value_or(usual);
  if (!command.chart.empty()) {
    picture.scene = test_chart(command.chart, picture.frame.columns, picture.frame.rows);
    return picture;
  }
  Vertex centre{0.5 * picture.frame.columns, 0.5 * picture.frame.rows};
  if (!command.at.empty()) std::tie(centre.x, centre.y) = pair_of(command.at, ',', "--at");
  picture.scene.polygons.push_back({{command.half_plane_deg ? half_plane(centre, *command.half_plane_deg)
                                                            : rectangle_of(command.rectangle, centre)},
                                    0,
                                    0});
  return picture;
}

std::string plot_title(const TargetCommand& command, const TargetOptions& options) {
  const TargetOptics& optics = command.optics;
  const bool has_f_number = optics.psf != "gaussian" && optics.psf != "lens";
  return fmt::format("{} PSF{}, {} photosite, {:g} um pixels", optics.psf,
                     has_f_number ? fmt::format(" at f/{:g}", optics.f_number) : "",
                     command.sensor.empty() ? optics.photosite : options.photosite.text(), options.pitch_um);
}

/// Levels as files of levels show them.
TargetImage levels_of(const TargetCommand& command, const TargetRequest& request, const Shared& shared) {
  const Context context = context_of(shared);
  TargetImage image = command.bayer.empty() ? relative_target(request, context)
                                            : mosaic_target(request, command.bayer, context);
  add_target_noise(image, command.noise, shared.seed);
  const auto& paths = command.output.paths;
  const bool wanted =
      std::ranges::any_of(paths, [&](const auto& path) { return !command.output.holds_light(path); });
  if (!request.sensor || !wanted) return image;
  return recorded_levels(image, *request.sensor, command.output.shot.sense.options(), context);
}

TargetRequest request_of(const TargetCommand& command, const CLI::App& app, const Shared& shared) {
  TargetRequest request;
  if (!command.sensor.empty()) {
    request.sensor = read_sensor(command.sensor);
    request.sensor->require_electronics();
  }
  command.optics.fill(request, shared);
  command.output.validate(app);
  Picture picture = picture_of(command);
  request.scene = std::move(picture.scene);
  request.columns = picture.frame.columns, request.rows = picture.frame.rows;
  request.black = command.output.black, request.white = command.output.white;
  for (const std::string& path : command.output.paths)
    if (command.output.holds_light(path) && (command.noise != 0 || !command.bayer.empty()))
      throw InputError(path,
                       "light has neither --noise nor a --bayer mosaic, a --sensor has; .npy, .tif and "
                       ".png take them");
  return request;
}

/// A chart to print, at its true size.
void print_chart(const TargetCommand& command, const Shared& shared) {
  const auto [width, height] = pair_of(command.size.substr(0, command.size.size() - 2), 'x', "--size");
  if (command.chart.empty())
    throw InputError(
        fmt::format("--size {}: a --chart has a size in mm, to be printed; other targets have "
                    "pixels",
                    command.size));
  if (!command.exact_sfr.empty() || !command.plot.empty())
    throw InputError("a chart to print has no optics, and so no --exact-sfr and no --plot");
  for (const std::string& path : command.output.paths) {
    require_extension(path, {".svg", ".pdf"}, "a chart to print");
    require_drawing(path, "a chart to print");
  }
  const TargetScene scene = printed_chart(command.chart, width, height);
  StagedFiles files;
  for (const std::string& path : command.output.paths)
    write_drawing(files.stage(path), printed_chart_svg(scene, width, height), path);
  files.commit();
  if (shared.json)
    return print_json({{"width_mm", width}, {"height_mm", height}, {"polygons", scene.polygons.size()}});
  fmt::print(
      "{:g} x {:g} mm, {} polygons\nprint it at 100 %, and measure its photographs with sfr --chart-size "
      "{:g}x{:g}\n",
      width, height, scene.polygons.size(), width, height);
}

void run(const TargetCommand& command, const CLI::App& app, const Shared& shared) {
  if (command.size.ends_with("mm")) return print_chart(command, shared);
  const TargetRequest request = request_of(command, app, shared);
  if (!command.exact_sfr.empty()) require_extension(command.exact_sfr, {".csv"}, "a table of exact SFRs");
  if (!command.plot.empty()) require_drawing(command.plot, "a plot");
  const TargetOptions options = target_options(request);
  const std::shared_ptr<const Otf> otf = target_otf(request);
  const TargetImage image = levels_of(command, request, shared);

  StagedFiles files;
  for (const std::string& path : command.output.paths)
    if (!command.output.holds_light(path)) command.output.write_levels(files.stage(path), image);
  command.output.write_light(request, files, context_of(shared));
  if (!command.exact_sfr.empty())
    write_whole_file(files.stage(command.exact_sfr), exact_sfr_csv(exact_sfr(request.scene, *otf, options)));
  if (!command.plot.empty())
    write_drawing(files.stage(command.plot), target_plot_svg(*otf, options, plot_title(command, options)),
                  command.plot);
  files.commit();
  if (!meets_frame(request.scene, options.columns, options.rows))
    note(shared,
         fmt::format("no part of the target lies within the {} x {} pixels of the picture; --size or --at "
                     "brings it in",
                     options.columns, options.rows));
  print_target_summary(request, command.optics.psf, *otf, image, shared);
}

}  // namespace

void add_target_command(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<TargetCommand>();
  CLI::App* command =
      add_command(app, shared, "target",
                  "Synthetic targets of exactly known sharpness: polygons through diffraction and photosites",
                  "petzval target --rectangle 100x100@5 --psf airy --f-number 8 --wavelength 550 "
                  "--pixel-pitch 4.73 -o target.png",
                  true, [options, &shared, &app] { run(*options, *app.get_subcommand("target"), shared); });
  command->add_option("--rectangle", options->rectangle,
                      "A dark rectangle WxH@DEG [pixels, degrees clockwise]");
  command->add_option("--half-plane", options->half_plane_deg,
                      "A dark half-plane; DEG: from +x towards +y, the direction into it");
  command->add_option("--polygons", options->polygons,
                      "Polygons: MTF Mapper's text format, or the shapes of an .svg");
  command->add_option("--chart", options->chart,
                      fmt::format("A chart: {}", fmt::join(test_chart_names(), ", ")));
  command->add_option("--text", options->text,
                      "Writing in straight strokes; small letters are small capitals");
  command
      ->add_option("--text-height", options->text_height,
                   "Height of the capitals H@DEG [pixels, degrees clockwise]")
      ->capture_default_str();
  command->add_option(
      "--at", options->at,
      "Where X,Y the middle of the rectangle, the writing or the half-plane's edge is [pixels]; "
      "default: the middle");
  command->add_option(
      "--size", options->size,
      "Size WxH of the picture [pixels]; default: what the target needs. Of a --chart to print into "
      ".svg or .pdf: 277x190mm");
  options->optics.add_to(*command);
  options->output.add_to(*command);
  command->add_option("--bayer", options->bayer,
                      "A mosaic, rggb and so on, with a wavelength for each colour");
  command->add_option("--noise", options->noise,
                      "Standard deviation of Gaussian noise, on the scale of --white");
  CLI::Option* sensor = command->add_option(
      "--sensor", options->sensor,
      "Sensor, by name or file: its pitch, photosite, low-pass filter, noise, well and converter");
  for (const char* settled : {"--pixel-pitch", "--photosite", "--fill-factor", "--low-pass", "--noise"})
    sensor->excludes(command->get_option(settled));
  for (const char* exposing :
       {"--exposure", "--metering", "--exposure-compensation", "--conversion-gain", "--gain", "--temperature",
        "--serial", "--frames", "--bracket", "--without", "--exit-pupil", "--date-time", "--picture"})
    command->get_option(exposing)->needs(sensor);
  command->add_option("--exact-sfr", options->exact_sfr, "Write the true SFR along every edge: .csv")
      ->check(output_file());
  command->add_option("--plot", options->plot, "Draw PSF and MTF: .svg, .png or .pdf")->check(output_file());
}

}  // namespace petzval::app
