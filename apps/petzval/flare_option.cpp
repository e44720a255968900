// SPDX-License-Identifier: BSD-3-Clause
#include "flare_option.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>
#include <petzval/base/units.h>
#include <petzval/simulate/outputs.h>

#include <cmath>
#include <utility>

#include "command.h"
#include "output_option.h"

namespace petzval::app {

std::optional<Scatter> read_scatter_option(const std::string& text) {
  return text == "lens" ? std::nullopt : std::optional(parse_scatter(text));
}

void FlareChoice::add_to(CLI::App& command, bool scene) {
  const std::string before = command.option_defaults()->get_group();
  command.option_defaults()->group("Light that goes astray");
  command.add_flag("--ghosts", ghosts,
                   "Add the light of bright sources that two surfaces of the lens reflect (see lens ghosts)");
  command
      .add_option("--ghost-layer", ghost_layer,
                  "Also write the irradiance of the ghosts alone (.exr, .npy); without them the picture is "
                  "the output minus this")
      ->check(output_file());
  command.add_flag("--starburst", starburst,
                   "Add the light of bright sources that the edges of the stop diffract; blades give it "
                   "its rays");
  command.add_option("--scatter", scatter, scatter_help);
  command
      .add_option(
          "--scatter-layer", scatter_layer,
          "Also write what --scatter adds and takes (.exr, .npy); without it the picture is the output "
          "minus this")
      ->check(output_file());
  command
      .add_option(
          "--scatter-surround", scatter_surround,
          "What scatters in from beyond the frame besides bright sources: dark (nothing; the default) "
          "or mean (as bright as the frame on the whole, half a frame far)")
      ->check(CLI::IsMember({"dark", "mean"}));
  if (scene)
    command
        .add_option("--ghost-threshold", flare.search.threshold,
                    "Samples of the scene brighter than this times its mean are sources of ghosts and stars")
        ->check(positive_number())
        ->capture_default_str();
  command
      .add_option("--ghost-neglect", flare.neglected_share,
                  "Share of the light of all ghosts that may be left out, the faintest first; 0: none")
      ->capture_default_str();
  command
      .add_option("--ghost-reflections", flare.ghost_reflections,
                  "2, or 4: ghosts of light that is reflected four times, too")
      ->check(CLI::IsMember({2, 4}))
      ->capture_default_str();
  command
      .add_option("--sun", suns,
                  "Add a sun: degrees to the right and up from the middle of the picture, and its "
                  "illuminance at the lens [lx] if it is not 100000: 20,15 or 20,15:80000; repeatable")
      ->allow_extra_args(false);
  command.add_option("--sun-diameter", sun_diameter_deg, "Of suns [degrees]; 0: points")
      ->capture_default_str();
  command.add_option("--sun-light", sun_light, "Illuminant of suns")->capture_default_str();
  command.option_defaults()->group(before);
}

FlareOptions FlareChoice::options() const {
  FlareOptions options = flare;
  options.ghosts = ghosts || !ghost_layer.empty();
  options.starburst = starburst;
  options.scatter = !scatter.empty();
  if (options.scatter) options.surfaces_scatter = read_scatter_option(scatter);
  if (!options.scatter && (!scatter_layer.empty() || !scatter_surround.empty()))
    throw InputError("--scatter-layer and --scatter-surround have no effect without --scatter");
  if (scatter_surround == "mean") options.scatter_surround = ScatterLightOptions::Surround::mean;
  if (!scatter_layer.empty()) require_extension(scatter_layer, {".exr", ".npy"}, "a layer of scatter");
  for (const std::string& text : suns) {
    Sun sun = parse_sun(text);
    sun.diameter_deg = sun_diameter_deg;
    sun.light = sun_light;
    options.suns.push_back(std::move(sun));
  }
  const FlareOptions usual;
  if (!options.ghosts &&
      (flare.neglected_share != usual.neglected_share || flare.ghost_reflections != usual.ghost_reflections))
    throw InputError("--ghost-neglect and --ghost-reflections have no effect without --ghosts");
  if (!options.seeks() && flare.search.threshold != usual.search.threshold)
    throw InputError("--ghost-threshold has no effect without --ghosts, --starburst or --scatter");
  if (suns.empty() && (sun_diameter_deg != Sun().diameter_deg || sun_light != Sun().light))
    throw InputError("--sun-diameter and --sun-light have no effect without --sun");
  if (!ghost_layer.empty()) require_extension(ghost_layer, {".exr", ".npy"}, "a layer of ghosts");
  return options;
}

void FlareChoice::write(const FlareLayers& layers, StagedFiles& files) const {
  const auto write_layer = [&](const std::string& path, const std::optional<SpectralImage>& layer) {
    if (path.empty()) return;
    SpectralImage light = *layer;
    write_outputs(std::move(light), {path}, {}, {}, files, {});
  };
  write_layer(ghost_layer, layers.ghosts);
  write_layer(scatter_layer, layers.scatter);
}

nlohmann::ordered_json flare_json(const FlareLayers& layers) {
  nlohmann::ordered_json json;
  json["sources"] = nlohmann::ordered_json::array();
  for (const BrightSource& source : layers.sources)
    json["sources"].push_back({{"name", source.name},
                               {"right_deg", degrees(std::atan(source.right))},
                               {"up_deg", degrees(std::atan(source.up))},
                               {"radius_deg", degrees(source.radius_rad)}});
  json["ways"] = layers.report.followed;
  json["ways_neglected"] = layers.report.neglected;
  json["neglected_share"] = layers.report.neglected_share;
  json["flux_w_per_nm"] = layers.report.ghost_flux_w;
  json["frame_flux_w_per_nm"] = layers.report.frame_flux_w;
  if (layers.scatter)
    json["scatter"] = {{"scattered_share", layers.scatter_report.scattered_share},
                       {"returned_share", layers.scatter_report.returned_share},
                       {"outside_sources", layers.scatter_report.outside_sources}};
  json["pairs"] = nlohmann::ordered_json::array();
  for (const GhostPairReport& pair : layers.report.pairs) {
    nlohmann::ordered_json& one = json["pairs"].emplace_back();
    one = {{"first", pair.pair.first}, {"second", pair.pair.second}};
    if (pair.pair.reflections() == 4) one["third"] = pair.pair.third, one["fourth"] = pair.pair.fourth;
    if (pair.pair.order != GratingOrder()) one["order"] = {pair.pair.order.right, pair.pair.order.up};
    one["flux_w_per_nm"] = pair.flux_w;
    one["rays"] = pair.rays;
    one["seconds"] = pair.seconds;
  }
  return json;
}

void print_flare(const FlareLayers& layers) {
  if (layers.sun_count > 0) fmt::print("  suns        {}, as their rays give them\n", layers.sun_count);
  if (layers.stars) fmt::print("  stars       of {} sources\n", layers.sources.size());
  if (layers.scatter)
    fmt::print(
        "  scatter     {:.3g} % of the light taken, {:.3g} % come back; {} sources outside the frame\n",
        100 * layers.scatter_report.scattered_share, 100 * layers.scatter_report.returned_share,
        layers.scatter_report.outside_sources);
  if (!layers.ghosts) return;
  const GhostLightReport& report = layers.report;
  fmt::print(
      "  ghosts      of {} sources, {} ways followed, {} neglected with at most {:.1e} of their light\n",
      layers.sources.size(), report.followed, report.neglected, report.neglected_share);
}

}  // namespace petzval::app
