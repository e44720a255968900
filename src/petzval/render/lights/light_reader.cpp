// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/units.h>
#include <petzval/colour/observer.h>
#include <petzval/render/lights/alter_lights.h>
#include <petzval/render/lights/light_reader.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace petzval::render {

namespace {

/// Far above any light, far below what a float holds.
constexpr double strongest = 1e20;

/// ∫ ȳ dλ of a spectrum.
double luminous(const SceneSpectrum& spectrum) {
  std::vector<double> nm, values;
  for (double at = 360; at <= 830; at += 5) nm.push_back(at), values.push_back(spectrum.at(at));
  return Observer::cie_1931().xyz(Spectrum(nm, values)).y;
}

/// The spectrum of a light and the factor that makes it a radiance or intensity: pbrt-v4's "scale", and the
/// division by ∫ ȳ of its shape.
struct Strength {
  SceneSpectrum spectrum;
  double scale = 1;
  Location place;

  /// \throws InputError for light that is negative, or so strong that sums over it are lost.
  BandSpectrum at(const WavelengthGroups& groups, double factor = 1) const {
    return groups.sampled([&](double nm) {
      const double value = factor * scale * spectrum.at(nm);
      if (!(value >= 0 && value <= strongest))
        throw scene_error(
            place, fmt::format("a light of {:g} at {:g} nm; 0 to {:g} would be right", value, nm, strongest));
      return value;
    });
  }
};

Strength read_strength(const Parameters& parameters, const char* name, const LightOptions& options,
                       Unsupported& unsupported, const char* scale = "scale") {
  Strength strength;
  strength.place = parameters.location_of(name);
  strength.scale = options.scale * parameters.number(scale, 1);
  const auto given = spectrum_parameter(parameters, name, SpectrumRole::illuminant, unsupported);
  strength.spectrum = given ? *given : white_light();
  const Parameter* parameter = parameters.find(name);
  const bool as_it_stands = options.absolute_spectra && parameter &&
                            (parameter->type == "spectrum" || parameter->type == "blackbody");
  if (!as_it_stands) {
    if (!(strength.spectrum.photometric > 0))
      throw scene_error(parameters.location_of(name), "this light has no visible part to scale it by");
    strength.scale /= strength.spectrum.photometric;
  }
  if (const auto colour =
          spectrum_parameter(parameters, colour_of_light, SpectrumRole::illuminant, unsupported)) {
    strength.scale *= luminous(strength.spectrum) / luminous(*colour);
    strength.spectrum = *colour;
  }
  return strength;
}

/// "power" in the unit of ∫ Φ ȳ dλ, if given, replaces the strength (pbrt-v4).
double power_factor(const Parameters& parameters, double emitted_per_strength) {
  const double power = parameters.number("power", -1);
  return power > 0 ? power / emitted_per_strength : 1;
}

Vector3 triple(const Parameters& parameters, const char* name, Vector3 otherwise) {
  const auto value = parameters.triple(name);
  return value ? Vector3{(*value)[0], (*value)[1], (*value)[2]} : otherwise;
}

SmallLight read_point(const LightDescription& description, const WavelengthGroups& groups,
                      const LightOptions& options, Unsupported& unsupported) {
  const Parameters& parameters = description.entity.parameters;
  const Strength strength = read_strength(parameters, "I", options, unsupported);
  SmallLight light;
  light.position = description.world_from_light.point(triple(parameters, "from", {}));
  light.strength = strength.at(groups, power_factor(parameters, 4 * pi));
  return light;
}

/// The picture that a light shines by. \throws InputError with the place of its name.
PictureFile read_light_picture(const Parameters& parameters, const std::string& name) {
  PictureFile picture;
  try {
    picture = read_picture_file(resolved_path(parameters.location(), name));
  } catch (const InputError& error) {
    throw scene_error(parameters.location_of("filename"), error.what());
  }
  if (!std::ranges::all_of(picture.values, [](float value) { return std::isfinite(value); }))
    throw scene_error(parameters.location_of("filename"),
                      fmt::format("{} has pixels that are infinite or not a number", name));
  return picture;
}

void require_square(const PictureFile& picture, const Parameters& parameters, const std::string& name) {
  if (picture.width == picture.height) return;
  throw scene_error(
      parameters.location_of("filename"),
      fmt::format(
          "{} has {} x {} pixels; a square picture in the equal-area octahedral layout would be right", name,
          picture.width, picture.height));
}

SmallLight read_projection(const LightDescription& description, const WavelengthGroups& groups,
                           const LightOptions& options, Unsupported& unsupported) {
  const Parameters& parameters = description.entity.parameters;
  const std::string name = parameters.string("filename", "");
  if (name.empty())
    throw scene_error(parameters.location(), "a projection light needs \"string filename\", its slide");
  const double field_of_view = parameters.number("fov", 90);
  if (!(field_of_view > 0 && field_of_view < 180))
    throw scene_error(
        parameters.location_of("fov"),
        fmt::format("a slide {:g} degrees wide; above 0 and below 180 would be right", field_of_view));
  SmallLight light;
  light.position = description.world_from_light.point({});
  light.pattern = projected_pattern(read_light_picture(parameters, name), field_of_view, groups,
                                    description.world_from_light);
  const Strength strength = read_strength(parameters, "", options, unsupported);
  light.strength = strength.at(groups, power_factor(parameters, light.pattern->emitted_sr()));
  return light;
}

SmallLight read_goniometric(const LightDescription& description, const WavelengthGroups& groups,
                            const LightOptions& options, Unsupported& unsupported) {
  const Parameters& parameters = description.entity.parameters;
  const std::string name = parameters.string("filename", "");
  SmallLight light;
  light.position = description.world_from_light.point({});
  if (!name.empty()) {
    const PictureFile picture = read_light_picture(parameters, name);
    require_square(picture, parameters, name);
    light.pattern = goniometric_pattern(picture, description.world_from_light);
  }
  const Strength strength = read_strength(parameters, "I", options, unsupported);
  const double emitted = light.pattern ? light.pattern->emitted_sr() : 4 * pi;
  light.strength = strength.at(groups, power_factor(parameters, emitted));
  return light;
}

SmallLight read_spot(const LightDescription& description, const WavelengthGroups& groups,
                     const LightOptions& options, Unsupported& unsupported) {
  const Parameters& parameters = description.entity.parameters;
  const Strength strength = read_strength(parameters, "I", options, unsupported);
  SmallLight light;
  light.kind = SmallLight::Kind::spot;
  const Vector3 from = triple(parameters, "from", {}), to = triple(parameters, "to", {0, 0, 1});
  light.position = description.world_from_light.point(from);
  light.direction = normalised(description.world_from_light.direction(to - from));
  if (!(length(light.direction) > 0))
    throw scene_error(parameters.location(), "this light shines in no direction");
  const double cone = parameters.number("coneangle", 30), edge = parameters.number("conedeltaangle", 5);
  if (!(cone > 0 && cone <= 180 && edge >= 0))
    throw scene_error(parameters.location_of("coneangle"),
                      "a spot's cone angle lies above 0 and at most at 180 degrees");
  light.cos_end = std::cos(radians(cone));
  light.cos_begin = std::cos(radians(std::max(0.0, cone - edge)));
  const double solid_angle = 2 * pi * ((1 - light.cos_begin) + (light.cos_begin - light.cos_end) / 2);
  light.strength = strength.at(groups, power_factor(parameters, solid_angle));
  return light;
}

SmallLight read_distant(const LightDescription& description, const WavelengthGroups& groups,
                        const LightOptions& options, Unsupported& unsupported) {
  const Parameters& parameters = description.entity.parameters;
  const Strength strength = read_strength(parameters, "L", options, unsupported);
  SmallLight light;
  light.kind = SmallLight::Kind::distant;
  const Vector3 from = triple(parameters, "from", {}), to = triple(parameters, "to", {0, 0, 1});
  light.direction = normalised(description.world_from_light.direction(to - from));
  if (!(length(light.direction) > 0))
    throw scene_error(parameters.location(), "this light shines in no direction");
  const double illuminance = parameters.number("illuminance", -1);
  light.strength = strength.at(groups, illuminance > 0 ? illuminance : 1);
  return light;
}

/// Seen only through "portal", if there is one: four corners in the world, whatever the transformation.
Environment behind_portal(Environment light, const Parameters& parameters) {
  if (!parameters.find("portal")) return light;
  const std::vector<double> p = parameters.numbers("portal", {"point3"});
  if (p.size() != 12)
    throw scene_error(parameters.location_of("portal"),
                      fmt::format("{} numbers; four corners of three would be right", p.size()));
  const auto corner = [&](std::size_t i) { return Vector3{p[3 * i], p[3 * i + 1], p[3 * i + 2]}; };
  try {
    light.put_behind(Portal({corner(0), corner(1), corner(2), corner(3)}));
  } catch (const InputError& error) {
    throw scene_error(parameters.location_of("portal"), error.what());
  }
  return light;
}

Environment read_infinite(const LightDescription& description, const WavelengthGroups& groups,
                          const LightOptions& options, Unsupported& unsupported) {
  const Parameters& parameters = description.entity.parameters;
  Strength strength = read_strength(parameters, "L", options, unsupported);
  const double illuminance = parameters.number("illuminance", -1);
  const double factor = illuminance > 0 ? illuminance / pi : 1;
  const std::string name = parameters.string("filename", "");
  if (name.empty())
    return behind_portal({strength.at(groups, factor), description.world_from_light}, parameters);
  if (parameters.find("L"))
    throw scene_error(parameters.location_of("L"), "an infinite light has either \"L\" or a file");
  const auto picture = std::make_shared<const PictureFile>(read_light_picture(parameters, name));
  require_square(*picture, parameters, name);
  return behind_portal({picture, strength.at(groups, factor), groups, description.world_from_light},
                       parameters);
}

}  // namespace

void add_light(const LightDescription& description, const WavelengthGroups& groups,
               const LightOptions& options, Unsupported& unsupported, Lights& lights) {
  const std::string& type = description.entity.type;
  if (type == "point")
    lights.smalls.push_back(read_point(description, groups, options, unsupported));
  else if (type == "spot")
    lights.smalls.push_back(read_spot(description, groups, options, unsupported));
  else if (type == "projection")
    lights.smalls.push_back(read_projection(description, groups, options, unsupported));
  else if (type == "goniometric")
    lights.smalls.push_back(read_goniometric(description, groups, options, unsupported));
  else if (type == "distant")
    lights.smalls.push_back(read_distant(description, groups, options, unsupported));
  else if (type == "infinite")
    lights.environments.push_back(read_infinite(description, groups, options, unsupported));
  else
    return unsupported.report(description.entity.location(), fmt::format("LightSource \"{}\"", type));
  unsupported.report_unused(description.entity.parameters, fmt::format("LightSource \"{}\"", type));
}

BandSpectrum area_radiance(const Entity& entity, double area, const WavelengthGroups& groups,
                           const LightOptions& options, Unsupported& unsupported) {
  if (entity.type != "diffuse") {
    unsupported.report(entity.location(), fmt::format("AreaLightSource \"{}\"", entity.type));
    return groups.sampled([](double) { return 0; });
  }
  const Strength strength = read_strength(entity.parameters, "L", options, unsupported);
  const double sides = entity.parameters.boolean("twosided", false) ? 2 : 1;
  const double factor = power_factor(entity.parameters, sides * pi * area);
  unsupported.report_unused(entity.parameters, "AreaLightSource \"diffuse\"");
  return strength.at(groups, factor);
}

BandSpectrum medium_radiance(const Parameters& parameters, const WavelengthGroups& groups,
                             const LightOptions& options, Unsupported& unsupported) {
  const auto given = spectrum_parameter(parameters, "Le", SpectrumRole::illuminant, unsupported);
  BandSpectrum radiance = groups.sampled([&](double nm) { return given && given->at(nm) != 0 ? 1.0 : 0.0; });
  if (std::ranges::all_of(radiance, &Lanes::is_black)) return radiance;
  return read_strength(parameters, "Le", options, unsupported, strength_of_medium).at(groups);
}

}  // namespace petzval::render
