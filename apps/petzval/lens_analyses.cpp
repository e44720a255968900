// SPDX-License-Identifier: BSD-3-Clause
// The analyses of petzval lens: their options, and one way to print and to write them.
#include <fmt/format.h>
#include <petzval/base/units.h>
#include <petzval/base/whole_file.h>
#include <petzval/simulate/analysis.h>

#include <memory>

#include "camera_option.h"
#include "field_option.h"
#include "flare_option.h"
#include "ghost_drawing.h"
#include "lens_commands.h"
#include "loss_option.h"
#include "option_names.h"
#include "output_option.h"
#include "plot_output.h"
#include "table_output.h"

namespace petzval::app {

namespace {

struct AnalysisCommand {
  LensChoice lens;
  FieldChoice fields;
  CameraChoice camera;
  LossChoice losses;
  AnalysisRequest request;
  std::string name, plot, csv, map, zernike_order = "fringe";
  GhostDrawing ghost;
  std::string scatter;
  bool by_light = false, about_chief = false, as_psf = false;
};

std::string drawn(const AnalysisResult& result) {
  return plot_grid_svg(result.plots, result.plots_across, result.plots_title);
}

void write_map(const AnalysisCommand& command, const Lens& lens, AnalysisRequest request,
               const Context& context) {
  const bool numbers = command.map.ends_with(".csv");
  request.plots = !numbers;
  const AnalysisResult map = analyse("wavefront-map", lens, request, context);
  if (numbers)
    write_whole_file(command.map, to_csv(map.rows()));
  else
    write_drawing(command.map, drawn(map));
}

void print_as_json(const AnalysisResult& result) {
  nlohmann::ordered_json json = {{"lens", result.lens},
                                 {"field_definition", field_definition(result.field_kind)},
                                 {"reference_wavelength_nm", result.reference_wavelength_nm},
                                 {"rows", nullptr}};
  for (const auto& [name, fact] : result.facts)
    std::visit([&, key = name](const auto& value) { json[key] = value; }, fact);
  for (const AnalysisTable& each : result.tables) json[each.key] = rows_json(each.table);
  print_json(json);
}

void print_as_text(const AnalysisResult& result) {
  bool first = true;
  for (const AnalysisTable& each : result.tables) {
    if (each.key == "residuals") continue;  // the remarks have them in words
    if (!each.heading.empty() && first) fmt::print("{}: {}\n", result.lens, each.heading);
    if (!each.heading.empty() && !first) fmt::print("\n{}\n", each.heading);
    print_table(each.table);
    first = false;
  }
  for (const std::string& remark : result.remarks) fmt::print("{}\n", with_option_names(remark));
}

/// Frame, and fields and frequencies that nobody gave: centre, half way and corner of the sensor; quarter,
/// half and whole of its Nyquist frequency.
void fit_to_sensor(const AnalysisCommand& command, const Lens& lens, AnalysisRequest& request,
                   const Context& context) {
  const SensorGeometry frame = read_sensor(command.camera.sensor, command.camera.sensor_settings).geometry;
  note_short_field(lens, frame, context);
  request.frame = FrameSize{frame.width_mm(), frame.height_mm()};
  if (command.fields.fields.empty()) {
    request.at.field_kind = Fields::Kind::real_image_height_mm;
    request.at.fields = {0, frame.half_diagonal_mm() / 2, frame.half_diagonal_mm()};
  }
  const double nyquist_cpmm = 1 / (2 * frame.pitch_um * mm_per_um);
  if (request.mtf.frequencies_cpmm.empty())
    request.mtf.frequencies_cpmm = {nyquist_cpmm / 4, nyquist_cpmm / 2, nyquist_cpmm};
}

void run(const AnalysisCommand& command, const Shared& shared) {
  if (!command.plot.empty()) require_drawing(command.plot, "a plot");
  if (!command.csv.empty()) require_extension(command.csv, {".csv"}, "a table");
  if (!command.map.empty()) require_drawing(command.map, "a wavefront map", {".csv"});
  command.ghost.check();
  Context context = context_of(shared);
  context.progress = {};
  const Lens read = command.lens.read(shared);
  // Distortion is about chief rays: what clips the others does not matter.
  const Lens clipped = command.name == "distortion" ? read : command.fields.prepare(read, shared);
  const Lens lens = command.camera.used(clipped, command.fields.request(clipped), shared);
  AnalysisRequest request = command.request;
  request.at = command.fields.request(lens);
  request.at.azimuth_deg = command.camera.field_azimuth_deg;
  if (!command.camera.sensor.empty()) fit_to_sensor(command, lens, request, context);
  request.at.losses = command.losses.losses(lens, shared);
  if (!command.scatter.empty()) request.glare.surfaces_scatter = read_scatter_option(command.scatter);
  request.plots = !command.plot.empty();
  request.spot_weight = command.by_light ? RayWeight::light : RayWeight::stop_area;
  request.zernike_order = command.zernike_order == "noll" ? ZernikeOrder::noll : ZernikeOrder::fringe;
  request.encircled_energy.about_centroid = !command.about_chief;
  if (command.as_psf) request.mtf.model = {PupilModel::Amplitude::light, PupilModel::Phase::plane_waves};

  const AnalysisResult result = analyse(command.name, lens, request, context);
  if (!command.plot.empty()) write_drawing(command.plot, drawn(result));
  if (!command.csv.empty()) write_whole_file(command.csv, to_csv(result.rows()));
  if (!command.map.empty()) write_map(command, lens, request, context);
  command.ghost.draw(lens, request.at, request.sensor_reflectance, shared);
  shared.json ? print_as_json(result) : print_as_text(result);
}

void add_encircled_energy(CLI::App& app, AnalysisCommand& command) {
  app.add_option("--radii", command.request.encircled_energy.radii_um,
                 "Radii on the sensor [um], separated by commas; default: 32 out to the wings")
      ->delimiter(',')
      ->check(number_not_negative());
  app.add_flag("--about-chief-ray", command.about_chief, "Circles about the chief ray, not the centroid");
}

void add_wavefront(CLI::App& app, AnalysisCommand& command) {
  app.add_option("--map", command.map,
                 "Also write the wavefront over the stop, as pictures (.svg) or numbers (.csv)")
      ->check(output_file());
  app.add_option("--samples", command.request.map_samples, "Samples a side of a map")
      ->check(CLI::Range(3, 1025));
}

void add_mtf(CLI::App& app, AnalysisCommand& command) {
  AnalysisRequest& request = command.request;
  app.add_option(
         "--frequencies", request.mtf.frequencies_cpmm,
         "Spatial frequencies on the sensor [cycles/mm], separated by commas; default: 0 to 100 by 10")
      ->delimiter(',')
      ->check(number_not_negative());
  app.add_flag("--polychromatic", request.polychromatic_mtf, "All wavelengths together, with equal weights");
  app.add_option("--weights", request.mtf.weights,
                 "All wavelengths together, with these weights, separated by commas: the light of each")
      ->delimiter(',')
      ->check(number_not_negative());
  app.add_flag("--over-field", request.mtf_over_field, "At 21 even fields; the plot runs over the field");
  app.add_option(
         "--through-focus", request.mtf_through_focus_mm,
         "At 33 places of the sensor up to this far [mm] on both sides of the image surface; the plot "
         "runs over them")
      ->check(positive_number());
  app.add_flag("--geometric", request.mtf.geometric, "Of the rays alone, without diffraction");
  app.add_flag("--as-psf", command.as_psf,
               "The exact transform of `lens psf`; default: an evenly bright pupil on the reference sphere");
}

/// What an analysis has of its own on the command line.
struct OwnOptions {
  const char *name, *example;
  void (*add)(CLI::App& app, AnalysisCommand& command) = nullptr;
};

const OwnOptions own_options[] = {
    {"distortion", "petzval lens distortion edmund-54852 --fields 0,2.1,3 --wavelengths 587.56"},
    {"illumination", "petzval lens illumination edmund-54852 --plot illumination.svg",
     [](CLI::App& app, AnalysisCommand& command) { command.losses.add_to(app); }},
    {"encircled-energy", "petzval lens encircled-energy double-gauss --radii 2,5,10,20 --plot encircled.svg",
     add_encircled_energy},
    {"spots", "petzval lens spots cooke-triplet --plot spots.svg",
     [](CLI::App& app, AnalysisCommand& command) {
       app.add_flag("--by-light", command.by_light,
                    "Weight rays by the light they carry, not by their area on the stop");
     }},
    {"wavefront",
     "petzval lens wavefront double-gauss --wavelengths 587.56 --map map.svg --plot wavefront.svg",
     add_wavefront},
    {"fans", "petzval lens fans cooke-triplet --rays 11 --plot fans.svg",
     [](CLI::App& app, AnalysisCommand& command) {
       app.add_option("--rays", command.request.fan_rays, "Rays a fan")->check(CLI::Range(3, 100001));
       app.add_flag("--opd", command.request.opd_fans,
                    "Plot the wavefront instead of the transverse aberration");
     }},
    {"zernike",
     "petzval lens zernike cooke-triplet --wavelengths 550 --order noll --terms 15 --plot zernike.svg",
     [](CLI::App& app, AnalysisCommand& command) {
       app.add_option("--order", command.zernike_order, "Which set: fringe (rim 1) or noll (RMS 1)")
           ->check(CLI::IsMember({"fringe", "noll"}));
       app.add_option("--terms", command.request.zernike_terms,
                      "How many terms; default: 37 of Fringe, 36 of Noll")
           ->check(CLI::Range(1, 231));
     }},
    {"field-curvature", "petzval lens field-curvature double-gauss --plot curves.svg"},
    {"colour", "petzval lens colour cooke-triplet --plot colour.svg"},
    {"vignetting", "petzval lens vignetting dgauss-50mm --plot vignetting.svg"},
    {"chief-ray-angle", "petzval lens chief-ray-angle edmund-54852 --plot angle.svg"},
    {"polarisation", "petzval lens polarisation dgauss-50mm --coating mgf2 --plot polarisation.svg",
     [](CLI::App& app, AnalysisCommand& command) { command.losses.add_to(app); }},
    {"ghosts",
     "petzval lens ghosts cooke-triplet --coating 0.005 --sensor-reflectance 0.05 --plot ghosts.svg",
     [](CLI::App& app, AnalysisCommand& command) {
       command.losses.add_to(app);
       app.add_option("--sensor-reflectance", command.request.sensor_reflectance,
                      "Share of the light that the sensor's surface reflects; 0: no ghosts of it")
           ->check(CLI::Range(0.0, 1.0));
       app.add_option("--source-diameter", command.request.source_diameter_deg,
                      "Angle under which the lens sees the source [degrees]; default: the Sun's")
           ->check(positive_number());
       app.add_option("--ghost-reflections", command.request.ghost_reflections,
                      "2, or 4: light that is reflected four times, too, down to 1e-4 of the brightest")
           ->check(CLI::IsMember({2, 4}))
           ->capture_default_str();
       app.add_option("--draw", command.ghost.pair,
                      "Draw the way of one ghost: the surfaces that reflect first and second, as in 4,1; "
                      "or all four");
       app.add_option("-o,--output", command.ghost.output, "The drawing of --draw: .svg, .png or .pdf")
           ->check(output_file());
     }},
    {"glare", "petzval lens glare cooke-triplet --scatter roughness=1.5,dust=0.02 --plot glare.svg",
     [](CLI::App& app, AnalysisCommand& command) {
       command.losses.add_to(app);
       app.add_option("--scatter", command.scatter, scatter_help);
       app.add_option(
              "--hole", command.request.glare.hole_percent,
              "Diameter of the black hole's image [% of the frame's diagonal, or of the widest field's]")
           ->check(positive_number())
           ->capture_default_str();
       app.add_option("--surround-angle", command.request.glare.surround_deg,
                      "How far from the axis the bright surround reaches [degrees]")
           ->check(positive_number())
           ->capture_default_str();
       app.add_flag("--ghosts", command.request.glare.ghosts,
                    "Count the light that two surfaces reflect, too");
       app.add_option("--sensor-reflectance", command.request.sensor_reflectance,
                      "Share of the light that the sensor's surface reflects, for --ghosts")
           ->check(CLI::Range(0.0, 1.0));
     }},
    {"mtf", "petzval lens mtf cooke-triplet --frequencies 10,20,40 --polychromatic --plot mtf.svg", add_mtf},
    {"focus", "petzval lens focus cooke-triplet --frequency 40 --plot focus.svg",
     [](CLI::App& app, AnalysisCommand& command) {
       app.add_option("--frequency", command.request.focus_frequency_cpmm,
                      "Spatial frequency of the MTF [cycles/mm]")
           ->check(positive_number());
     }}};

}  // namespace

void add_lens_analyses(CLI::App& lens, Shared& shared) {
  for (const Analysis& analysis : analyses()) {
    if (analysis.name == "wavefront-map") continue;  // `wavefront --map`
    const OwnOptions* own = nullptr;
    for (const OwnOptions& each : own_options)
      if (analysis.name == each.name) own = &each;
    auto command = std::make_shared<AnalysisCommand>();
    command->name = analysis.name;
    CLI::App* app =
        add_command(lens, shared, analysis.name, analysis.description,
                    own ? own->example : fmt::format("petzval lens {} cooke-triplet", analysis.name), true,
                    [=, &shared] { run(*command, shared); });
    command->lens.add_to(*app);
    command->fields.add_to(*app);
    command->camera.add_to(*app);
    command->camera.add_sensor(*app,
                               "By name or file, or 768x576@6.25: fields to its corners and frequencies to "
                               "Nyquist, unless others are given");
    app->add_option("--plot", command->plot, "Also draw the result: .svg, .png or .pdf")
        ->check(output_file());
    app->add_option("--csv", command->csv, "Also write the table into this CSV file, with every digit")
        ->check(output_file());
    if (own && own->add) own->add(*app, *command);
  }
}

}  // namespace petzval::app
