// SPDX-License-Identifier: BSD-3-Clause
// Light that goes astray in a lens: suns, ghosts, stars.
#include <fmt/format.h>
#include <petzval/base/units.h>

#include <cmath>

#include "constructor.h"
#include "keywords.h"

namespace petzval::python {

FlareOptions flare_options(const std::vector<SunChoice>& suns, bool ghosts, bool starburst,
                           double ghost_threshold, double ghost_neglect, int ghost_reflections,
                           const Maybe<std::string>& scatter, const std::string& scatter_surround) {
  FlareOptions options;
  for (const SunChoice& each : suns)
    options.suns.push_back(std::holds_alternative<Sun>(each) ? std::get<Sun>(each)
                                                             : parse_sun(std::get<std::string>(each)));
  options.ghosts = ghosts, options.starburst = starburst;
  options.search.threshold = ghost_threshold, options.neglected_share = ghost_neglect;
  options.ghost_reflections = ghost_reflections;
  using Surround = ScatterLightOptions::Surround;
  options.scatter = scatter.has_value();
  if (scatter && *scatter != "lens") options.surfaces_scatter = parse_scatter(*scatter);
  options.scatter_surround = choice<Surround>("scatter_surround", scatter_surround,
                                              {{"dark", Surround::dark}, {"mean", Surround::mean}});
  return options;
}

namespace {

nb::list sources_of(const FlareLayers& layers) {
  nb::list sources;
  for (const BrightSource& source : layers.sources) {
    nb::dict one;
    one["name"] = source.name;
    one["right_deg"] = degrees(std::atan(source.right));
    one["up_deg"] = degrees(std::atan(source.up));
    one["radius_deg"] = degrees(source.radius_rad);
    sources.append(one);
  }
  return sources;
}

nb::list pairs_of(const FlareLayers& layers) {
  nb::list pairs;
  for (const GhostPairReport& pair : layers.report.pairs) {
    nb::dict one;
    one["first"] = pair.pair.first;
    one["second"] = pair.pair.second;
    if (pair.pair.reflections() == 4) one["third"] = pair.pair.third, one["fourth"] = pair.pair.fourth;
    if (pair.pair.order != GratingOrder()) {
      nb::list order;
      order.append(pair.pair.order.right), order.append(pair.pair.order.up);
      one["order"] = order;
    }
    one["flux_w_per_nm"] = pair.flux_w;
    one["rays"] = pair.rays;
    one["seconds"] = pair.seconds;
    pairs.append(one);
  }
  return pairs;
}

/// A layer without a copy, or None.
template <std::optional<SpectralImage> FlareLayers::*layer>
SpectralImage* layer_of(FlareLayers& layers) {
  return layers.*layer ? &*(layers.*layer) : nullptr;
}

std::string repr(const FlareLayers& layers) {
  std::vector<std::string> parts{fmt::format("{} sources", layers.sources.size())};
  if (layers.suns) parts.emplace_back("suns");
  if (layers.ghosts) parts.push_back(fmt::format("ghosts by {} ways", layers.report.followed));
  if (layers.stars) parts.emplace_back("stars");
  if (layers.scatter) parts.emplace_back("scatter");
  return fmt::format("<Flare: {}>", fmt::join(parts, ", "));
}

}  // namespace

void bind_flare(nb::module_& module) {
  const Sun usual;
  nb::class_<Sun>(module, "Sun", nb::type_slots(explained_constructor),
                  "A disc of light at infinity that the scene does not hold.")
      .def(nb::new_([](double right_deg, double up_deg, double illuminance_lx, double diameter_deg,
                       const std::string& light) {
             return Sun{right_deg, up_deg, illuminance_lx, diameter_deg, light};
           }),
           nb::arg("right_deg"), nb::arg("up_deg"), nb::kw_only(),
           nb::arg("illuminance_lx") = usual.illuminance_lx, nb::arg("diameter_deg") = usual.diameter_deg,
           nb::arg("light") = usual.light,
           "`right_deg`, `up_deg`: where it stands from the middle of the picture, for the photographer. "
           "`illuminance_lx`: at the lens, across its light. `diameter_deg` 0: a point. `light`: an "
           "illuminant.")
      .def_rw("right_deg", &Sun::right_deg)
      .def_rw("up_deg", &Sun::up_deg)
      .def_rw("illuminance_lx", &Sun::illuminance_lx)
      .def_rw("diameter_deg", &Sun::diameter_deg)
      .def_rw("light", &Sun::light)
      .def("__repr__", [](const Sun& sun) {
        return fmt::format("Sun({}, {}, illuminance_lx={}, diameter_deg={}, light='{}')",
                           number_repr(sun.right_deg), number_repr(sun.up_deg),
                           number_repr(sun.illuminance_lx), number_repr(sun.diameter_deg), sun.light);
      });
  constexpr auto inside = nb::rv_policy::reference_internal;
  nb::class_<FlareLayers>(
      module, "Flare",
      "Light that goes astray, each layer by itself: SpectralImages of the picture's frame and bands, "
      "(row, column, wavelength) [W/(m2 nm)].")
      .def_prop_ro("suns", layer_of<&FlareLayers::suns>, inside, "Images of the suns; None without suns.")
      .def_prop_ro("ghosts", layer_of<&FlareLayers::ghosts>, inside,
                   "What two surfaces reflect; None unless asked for.")
      .def_prop_ro("stars", layer_of<&FlareLayers::stars>, inside,
                   "What the edges of the stop diffract, beyond the PSFs; it adds up to nothing. None unless "
                   "asked for.")
      .def_prop_ro(
          "scatter", layer_of<&FlareLayers::scatter>, inside,
          "What the surfaces of the lens turn aside, less what that takes from the picture; None unless "
          "asked for.")
      .def_prop_ro("sources", sources_of,
                   "Where the light comes from, suns first: dicts with `name`, `right_deg`, `up_deg` and "
                   "`radius_deg`.")
      .def_prop_ro("pairs", pairs_of,
                   "Ghosts by surfaces, the one with the most light first: dicts with `first` and `second`, "
                   "`flux_w_per_nm` on the plane of the sensor, `rays` and `seconds`.")
      .def_prop_ro(
          "ways", [](const FlareLayers& l) { return l.report.followed; },
          "Ghosts that were followed, each of one pair, source and wavelength.")
      .def_prop_ro("ways_neglected", [](const FlareLayers& l) { return l.report.neglected; })
      .def_prop_ro(
          "neglected_share", [](const FlareLayers& l) { return l.report.neglected_share; },
          "What these have at most of the light of all ghosts.")
      .def_prop_ro(
          "flux_w_per_nm", [](const FlareLayers& l) { return l.report.ghost_flux_w; },
          "Of all ghosts, bands added up.")
      .def_prop_ro(
          "frame_flux_w_per_nm", [](const FlareLayers& l) { return l.report.frame_flux_w; },
          "Of that, what falls into the frame.")
      .def(
          "add_to", [](const FlareLayers& layers, SpectralImage& light) { add_layers(layers, light); },
          nb::arg("light"), "Adds all layers to a picture of the same frame and bands, in place.")
      .def("__repr__", repr);
}

}  // namespace petzval::python
