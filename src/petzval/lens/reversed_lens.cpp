// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_states.h>
#include <petzval/lens/ray_transfer.h>
#include <petzval/lens/reversed_lens.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

/// Seen after a half turn about the y axis.
Pose turned_round(Pose pose) {
  for (double Pose::*number : {&Pose::decentre_x_mm, &Pose::shift_z_mm, &Pose::tilt_x_deg, &Pose::tilt_z_deg})
    if (pose.*number != 0) pose.*number = -(pose.*number);
  return pose;
}

void turn_poses(const Lens& lens, Lens& turned) {
  const std::size_t last = lens.surfaces.size() - 1;
  if (!lens.sensor_pose.is_none())
    throw InputError(
        fmt::format("{}: the sensor is off its place, and a lens that is turned round has another; "
                    "set sensor_pose=null",
                    lens.name));
  for (Surface& surface : turned.surfaces) surface.pose = turned_round(surface.pose);
  for (std::size_t i = 0; i < lens.groups.size(); ++i) {
    const SurfaceGroup& group = lens.groups[i];
    if (group.last > last)
      throw InputError(
          fmt::format("{}: groups[{}] holds the sensor, which a lens that is turned round has "
                      "elsewhere; groups of surfaces alone can be turned round",
                      lens.name, i));
    double length_mm = 0;
    for (std::size_t k = group.first; k < group.last; ++k) length_mm += lens.surfaces[k].thickness_mm;
    turned.groups[i] = {last - group.last, last - group.first, turned_round(group.pose),
                        length_mm - group.pivot_mm};
  }
}

}  // namespace

Lens reversed_lens(const Lens& lens) {
  if (!lens.states.empty()) return in_every_state(lens, reversed_lens);
  lens.validate();
  require_glass(lens, "turning it round needs");
  require_no_bends(lens, "turning it round needs");
  require_no_mirrors(lens, "lenses without one can be turned round");
  if (!lens.surfaces.back().material.is_air() || !lens.object_material.is_air())
    throw InputError(
        fmt::format("{}: glass reaches up to the sensor or the object; a lens with air on both sides can be "
                    "turned round",
                    lens.name));
  Lens turned = lens;
  turned.aperture = {Aperture::Kind::stop_semi_diameter_mm, first_order(lens).stop_semi_diameter_mm};
  std::ranges::reverse(turned.surfaces);
  turn_poses(lens, turned);
  const std::size_t last = lens.surfaces.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    Surface& surface = turned.surfaces[i];
    if (!surface.apertures.empty())
      throw InputError(
          fmt::format("{}: surfaces[{}] has apertures that are not round; others can be turned round",
                      lens.name, last - i));
    if (surface.shape)
      throw InputError(fmt::format("{}: surfaces[{}] is a {}; conics and aspheres can be turned round",
                                   lens.name, last - i, surface.shape->kind));
    surface.curvature_per_mm = -surface.curvature_per_mm;
    for (auto& [power, coefficient] : surface.asphere) coefficient = -coefficient;
    surface.blades.rotation_deg = -surface.blades.rotation_deg;
    surface.thickness_mm = i < last ? lens.surfaces[last - 1 - i].thickness_mm : 1;
    surface.material = i < last ? lens.surfaces[last - 1 - i].material : Material();
  }
  const double image_mm = first_order(turned).paraxial_image_mm;
  if (!(image_mm > 0 && std::isfinite(image_mm)))
    throw InputError(
        fmt::format("{} forms no real image behind its last surface when it is turned round", lens.name));
  turned.surfaces.back().thickness_mm = image_mm;
  turned.name += ", turned round";
  return turned;
}

}  // namespace petzval
