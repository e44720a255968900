// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/wavelength.h>
#include <petzval/lens/lens_fault.h>
#include <petzval/lens/ray_transfer.h>
#include <petzval/lens/surface_kind.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace petzval {

namespace {

using Fault = std::optional<LensFault>;

bool positive(double value) {
  return std::isfinite(value) && value > 0;
}

Fault scatter_fault(const Scatter& scatter, const std::string& path) {
  try {
    scatter.validate();
  } catch (const InputError& error) {
    return LensFault{path, fmt::format("cannot be: {}", error.what())};
  }
  return {};
}

Fault coating_fault(const Lens& lens, std::size_t i) {
  const Surface& surface = lens.surfaces[i];
  const std::string path = fmt::format("surfaces[{}].coating", i);
  try {
    surface.coating->validate();
  } catch (const InputError& error) {
    return LensFault{path, fmt::format("cannot be: {}", error.what())};
  }
  const bool from_air = lens.medium_before(i).is_air();
  if (surface.coating->has_films() && (surface.mirror || from_air == surface.material.is_air()))
    return LensFault{path, "has films, which lie between air and glass; a reflectance would be right here"};
  return {};
}

Fault shape_fault(const Surface& surface, const std::string& path) {
  const AddedShape& shape = *surface.shape;
  const SurfaceKind* kind = find_surface_kind(shape.kind);
  if (!kind) return LensFault{path + ".kind", "is not a kind of surface; these are: " + surface_kind_names()};
  if (!surface.asphere.empty())
    return LensFault{path,
                     fmt::format("\"{}\" stands in place of powers of r; leave out asphere", kind->name)};
  for (const auto& [name, numbers] : shape.parameters)
    if (std::none_of(kind->parameters.begin(), kind->parameters.end(),
                     [&name = name](const ShapeParameter& parameter) { return name == parameter.name; }))
      return LensFault{path + "." + name, fmt::format("is not a parameter of \"{}\"", kind->name)};
  for (const ShapeParameter& parameter : kind->parameters) {
    const std::vector<double> numbers = shape_numbers(surface, parameter.name);
    const std::string at = path + "." + parameter.name;
    if (parameter.positive && !(numbers.size() == 1 && positive(numbers[0])))
      return LensFault{at, fmt::format("must be {}, and positive", parameter.meaning)};
    if (numbers.size() > parameter.most)
      return LensFault{at,
                       fmt::format("has {} numbers; at most {} are right", numbers.size(), parameter.most)};
    for (std::size_t i = 0; i < numbers.size(); ++i)
      if (!std::isfinite(numbers[i]))
        return LensFault{at, fmt::format("must be {}, finite", parameter.meaning)};
  }
  return {};
}

/// The largest tilt: beyond it a surface no longer faces the light.
constexpr double most_tilt_deg = 60;

/// A group turns what the groups behind it in the list have turned: from one largest tilt to the other.
constexpr double most_group_tilt_deg = 2 * most_tilt_deg;

/// Mirrors fold: what comes behind them may stand at any angle.
constexpr double most_folded_tilt_deg = 180;

Fault pose_fault(const Pose& pose, const std::string& path, double most_deg) {
  for (const PoseNumber& number : pose_numbers) {
    const double value = pose.*number.value;
    const std::string at = fmt::format("{}.{}", path, number.name);
    if (!std::isfinite(value))
      return LensFault{at, fmt::format("must be a finite number of {}", number.is_length ? "mm" : "degrees")};
    if (!number.is_length && number.value != &Pose::tilt_z_deg && std::abs(value) > most_deg)
      return LensFault{at, fmt::format("must lie within {:g} degrees", most_deg)};
  }
  return {};
}

Fault group_fault(const Lens& lens, std::size_t index) {
  const SurfaceGroup& group = lens.groups[index];
  const std::string path = fmt::format("groups[{}]", index);
  if (group.first > group.last || group.first >= lens.surfaces.size() || group.last > lens.surfaces.size())
    return LensFault{
        path + ".surfaces",
        fmt::format("must be the first and the last surface of {}, 0 to {}, or {} for the sensor",
                    lens.surfaces.size(), lens.surfaces.size() - 1, lens.surfaces.size())};
  if (!std::isfinite(group.pivot_mm))
    return LensFault{path + ".pivot_mm", "must be a finite distance in mm behind the group's first vertex"};
  return pose_fault(group.pose, path + ".pose",
                    lens.has_mirrors() ? most_folded_tilt_deg : most_group_tilt_deg);
}

Fault poses_fault(const Lens& lens) {
  const double most_deg = lens.has_mirrors() ? most_folded_tilt_deg : most_tilt_deg;
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
    if (Fault fault = pose_fault(lens.surfaces[i].pose, fmt::format("surfaces[{}].pose", i), most_deg))
      return fault;
  for (std::size_t i = 0; i < lens.groups.size(); ++i)
    if (Fault fault = group_fault(lens, i)) return fault;
  return pose_fault(lens.sensor_pose, "sensor_pose", most_deg);
}

Fault tolerances_fault(const Lens& lens) {
  for (std::size_t i = 0; i < lens.tolerances.size(); ++i) {
    try {
      check(lens, lens.tolerances[i]);
    } catch (const InputError& error) {
      return LensFault{fmt::format("tolerances[{}]", i), error.what()};
    }
  }
  return {};
}

/// As far as it can be told without setting the lens to them.
Fault states_fault(const LensStates& states) {
  if (states.empty() && !states.rows.empty())
    return LensFault{"states.names", "is empty; a name for each state would be right"};
  if (states.size() > LensStates::most)
    return LensFault{"states.names",
                     fmt::format("has {} states; at most {} are right", states.size(), LensStates::most)};
  std::set<std::string> known;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const std::string at = fmt::format("states.names[{}]", i);
    if (states.names[i].empty() || parse_number(states.names[i]))
      return LensFault{at, "must be a name that is no number, such as \"wide\""};
    if (!known.insert(states.names[i]).second)
      return LensFault{
          at, fmt::format("\"{}\" stands there twice; each state has a name of its own", states.names[i])};
  }
  for (const StateRow& row : states.rows) {
    if (row.values.size() == states.size()) continue;
    const std::string at = "states.values." + row.path;
    if (row.values.size() > states.size())
      return LensFault{at, fmt::format("has {} values for {} states", row.values.size(), states.size())};
    return LensFault{at, fmt::format("misses the value of state \"{}\": {} values for {} states",
                                     states.names[row.values.size()], row.values.size(), states.size())};
  }
  return {};
}

Fault surface_fault(const Surface& surface, const std::string& path) {
  const auto at = [&](const char* key) { return path + "." + key; };
  const double c = surface.curvature_per_mm;
  if (!std::isfinite(c) || (c != 0 && !std::isfinite(1 / c)))
    return LensFault{at("radius_mm"), "must be a finite radius in mm, or null for a flat surface"};
  if (!std::isfinite(surface.thickness_mm))
    return LensFault{at("thickness_mm"), "must be a finite number in mm"};
  if (surface.semi_diameter_mm && !positive(*surface.semi_diameter_mm))
    return LensFault{at("semi_diameter_mm"),
                     "must be positive, in mm; leave it out for an unbounded surface"};
  for (std::size_t i = 0; i < surface.apertures.size(); ++i)
    if (const std::string wrong = aperture_figure_fault(surface.apertures[i]); !wrong.empty())
      return LensFault{fmt::format("{}.apertures[{}]", path, i), wrong};
  if (surface.mirror && !surface.material.is_air())
    return LensFault{at("glass"), "must be left out: behind a mirror is what is in front of it"};
  if (!std::isfinite(surface.conic)) return LensFault{at("conic"), "must be a finite number"};
  const StopBlades& blades = surface.blades;
  if (blades.count != 0 && !surface.stop)
    return LensFault{at("blades"), "must stand at the stop; other apertures are round"};
  if (blades.count != 0 && (blades.count < 3 || blades.count > StopBlades::most))
    return LensFault{at("blades.count"),
                     fmt::format("must be 3 to {}, or 0 for a round stop", StopBlades::most)};
  if (blades.count != 0 && surface.shape)
    if (const SurfaceKind* kind = find_surface_kind(surface.shape->kind); kind && !kind->is_round)
      return LensFault{at("blades"), "must stand at a surface that is round itself"};
  if (surface.scatter)
    if (Fault fault = scatter_fault(*surface.scatter, at("scatter"))) return fault;
  if (!std::isfinite(blades.rotation_deg))
    return LensFault{at("blades.rotation_deg"), "must be a finite number of degrees"};
  for (const auto& [power, coefficient] : surface.asphere) {
    if (power < lowest_asphere_power || power > highest_asphere_power)
      return LensFault{fmt::format("{}.asphere.{}", path, power),
                       fmt::format("is not a power of r that a surface can have; {} to {} are",
                                   lowest_asphere_power, highest_asphere_power)};
    if (!std::isfinite(coefficient))
      return LensFault{fmt::format("{}.asphere.{}", path, power),
                       "must be a finite coefficient in mm^(1-power)"};
  }
  return surface.shape ? shape_fault(surface, at("shape")) : Fault();
}

/// Gratings are ruled on what rays meet in closed form; an ideal lens is a plane.
Fault bend_fault(const Surface& surface, const std::string& path) {
  if (surface.grating) {
    const Grating& grating = *surface.grating;
    const std::string at = path + ".grating";
    if (!std::isfinite(grating.lines_per_mm) || !std::isfinite(grating.order) ||
        !std::isfinite(grating.rotation_deg))
      return LensFault{at, "must have finite lines per mm, order and rotation"};
    if (grating.order != std::floor(grating.order))
      return LensFault{at + ".order", "must be a whole number, negative on the other side"};
    if (surface.shape || !surface.asphere.empty())
      return LensFault{at, "must be ruled on a plane, a sphere or a conic"};
    if (surface.blades.count != 0)
      return LensFault{path + ".blades", "must stand at a surface that is round itself"};
  }
  if (!surface.ideal_lens) return {};
  const double f = surface.ideal_lens->focal_length_mm;
  if (!std::isfinite(f) || f == 0 || !std::isfinite(1 / f))
    return LensFault{path + ".ideal_lens.focal_length_mm", "must be a finite focal length in mm, not 0"};
  if (surface.grating || surface.mirror || surface.curvature_per_mm != 0 || surface.shape ||
      !surface.asphere.empty())
    return LensFault{path + ".ideal_lens", "must be a plane with nothing besides, and no mirror"};
  return {};
}

/// What the object is immersed in, and what that asks for.
Fault immersion_fault(const Lens& lens) {
  if (lens.object_material.is_air()) return {};
  constexpr double farthest_mm = 1e5;
  if (lens.object_distance_mm && *lens.object_distance_mm >= farthest_mm)
    return LensFault{"object_glass", "must reach from an object nearer than 100 m, or from infinity"};
  if (lens.surfaces.front().transfer)
    return LensFault{"object_glass", "must be air in front of a ray transfer"};
  return {};
}

/// A ray transfer stands at the first surface, and the next one is its rear plane.
Fault transfer_fault(const Lens& lens, std::size_t index) {
  const Surface& surface = lens.surfaces[index];
  if (!surface.transfer) return {};
  const std::string path = fmt::format("surfaces[{}]", index);
  if (index != 0 || lens.surfaces.size() < 2)
    return LensFault{path + ".transfer", "must stand at surfaces[0], with its rear plane as surfaces[1]"};
  if (!surface.stop) return LensFault{path + ".stop", "must be true: the stop is inside the ray transfer"};
  for (std::size_t i = 0; i < 2; ++i) {
    const Surface& plane = lens.surfaces[i];
    if (plane.curvature_per_mm != 0 || plane.shape || !plane.asphere.empty() || !plane.material.is_air() ||
        !plane.pose.is_none())
      return LensFault{fmt::format("surfaces[{}]", i),
                       "must be a plane in air in its place: a ray transfer goes from plane to plane"};
  }
  for (std::size_t i = 0; i < 2; ++i)
    if (lens.surfaces[i].mirror || !lens.surfaces[i].apertures.empty())
      return LensFault{fmt::format("surfaces[{}]", i),
                       "must be a plane in air in its place: a ray transfer goes from plane to plane"};
  for (std::size_t i = 0; i < lens.groups.size(); ++i)
    if ((lens.groups[i].first == 0) != (lens.groups[i].first <= 1 && lens.groups[i].last >= 1) ||
        (lens.groups[i].first == 0 && lens.groups[i].last == 0))
      return LensFault{fmt::format("groups[{}].surfaces", i),
                       "must hold both planes of the ray transfer, 0 and 1, or neither"};
  if (!(std::abs(surface.thickness_mm - surface.transfer->length_mm) <= 1e-9 * surface.transfer->length_mm))
    return LensFault{
        path + ".thickness_mm",
        fmt::format("must be {:.15g}, from plane to plane of the ray transfer", surface.transfer->length_mm)};
  return {};
}

Fault surfaces_fault(const Lens& lens) {
  if (lens.surfaces.empty()) return LensFault{"surfaces", "is empty; a lens has at least its stop surface"};
  if (lens.surfaces.size() > most_surfaces)
    return LensFault{"surfaces", fmt::format("has {} entries; at most {} can be traced", lens.surfaces.size(),
                                             most_surfaces)};
  std::optional<std::size_t> stop;
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
    if (Fault fault = surface_fault(lens.surfaces[i], fmt::format("surfaces[{}]", i))) return fault;
    if (Fault fault = transfer_fault(lens, i)) return fault;
    if (Fault fault = bend_fault(lens.surfaces[i], fmt::format("surfaces[{}]", i))) return fault;
    if (lens.surfaces[i].coating)
      if (Fault fault = coating_fault(lens, i)) return fault;
    if (!lens.surfaces[i].stop) continue;
    if (stop)
      return LensFault{
          fmt::format("surfaces[{}].stop", i),
          fmt::format("is a second stop beside surfaces[{}]; exactly one surface is the stop", *stop)};
    stop = i;
  }
  if (!stop) return LensFault{"surfaces", "has no stop; mark one surface with \"stop\": true"};
  return {};
}

Fault aperture_fault(const Lens& lens) {
  const char* path = "aperture";
  if (!positive(lens.aperture.value)) return LensFault{path, "must be a positive number"};
  if (lens.aperture.kind != Aperture::Kind::object_na) return {};
  if (!lens.object_distance_mm)
    return LensFault{path, "object_na needs an object at a finite distance; set object_distance_mm"};
  const double index = lens.object_material.index(lens.reference_wavelength_nm);
  if (lens.aperture.value >= index)
    return LensFault{
        path, fmt::format("object_na must be below {:g}, the index of what the object stands in", index)};
  return {};
}

Fault fields_fault(const Lens& lens) {
  const Fields& fields = lens.fields;
  if (fields.values.empty())
    return LensFault{"fields.values", "is empty; give at least one field, [0] for the axis"};
  if (fields.kind == Fields::Kind::object_height_mm && !lens.object_distance_mm)
    return LensFault{
        "fields.type",
        "object_height_mm needs an object at a finite distance; use angle_deg or set object_distance_mm"};
  // Beyond 90 degrees a fisheye still sees an object at infinity, but nothing that stands on a plane.
  const double widest_deg = lens.object_distance_mm ? 90 : 180;
  for (std::size_t i = 0; i < fields.values.size(); ++i) {
    const std::string path = fmt::format("fields.values[{}]", i);
    if (!std::isfinite(fields.values[i])) return LensFault{path, "must be a finite number"};
    if (fields.kind == Fields::Kind::angle_deg && !(std::abs(fields.values[i]) < widest_deg))
      return LensFault{path, fmt::format("must be an angle below {} degrees", widest_deg)};
  }
  return {};
}

Fault wavelengths_fault(const Lens& lens) {
  if (lens.wavelengths_nm.empty())
    return LensFault{"wavelengths_nm", "is empty; give at least one wavelength"};
  const auto fault_of = [](const std::string& path, double nm) -> Fault {
    if (!positive(nm)) return LensFault{path, "must be a positive wavelength in nm"};
    const std::string wrong = wavelength_fault(nm);
    return wrong.empty() ? Fault() : LensFault{path, fmt::format("is {:g}: {}", nm, wrong)};
  };
  for (std::size_t i = 0; i < lens.wavelengths_nm.size(); ++i)
    if (Fault fault = fault_of(fmt::format("wavelengths_nm[{}]", i), lens.wavelengths_nm[i])) return fault;
  return fault_of("reference_wavelength_nm", lens.reference_wavelength_nm);
}

}  // namespace

std::optional<LensFault> find_fault(const Lens& lens) {
  if (Fault fault = surfaces_fault(lens)) return fault;
  if (lens.scatter)
    if (Fault fault = scatter_fault(*lens.scatter, "scatter")) return fault;
  if (Fault fault = poses_fault(lens)) return fault;
  if (Fault fault = tolerances_fault(lens)) return fault;
  if (Fault fault = states_fault(lens.states)) return fault;
  if (lens.object_distance_mm && !positive(*lens.object_distance_mm))
    return LensFault{"object_distance_mm",
                     "must be positive, in mm from the object to vertex 1, or null for infinity"};
  if (Fault fault = fields_fault(lens)) return fault;
  if (Fault fault = wavelengths_fault(lens)) return fault;
  if (Fault fault = immersion_fault(lens)) return fault;
  return aperture_fault(lens);
}

}  // namespace petzval
