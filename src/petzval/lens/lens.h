// SPDX-License-Identifier: BSD-3-Clause
// A lens prescription: surfaces front to back, and what the lens is used for.
#pragma once

#include <petzval/glass/material.h>
#include <petzval/lens/aperture_figure.h>
#include <petzval/lens/bend.h>
#include <petzval/lens/coating.h>
#include <petzval/lens/pose.h>
#include <petzval/lens/scatter.h>
#include <petzval/lens/stop_blades.h>
#include <petzval/lens/tolerance.h>

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace petzval {

struct RayTransfer;

/// A kind of surface beyond conics and powers of r (lens/surface_kind.h), by name, with its parameters by
/// name.
struct AddedShape {
  std::string kind;
  std::map<std::string, std::vector<double>> parameters;
};

/// One surface and the gap behind it. Sag z(r) = c r² / (1 + √(1 − (1 + k) c² r²)) + Σ a_p r^p, or that of
/// its `shape`, positive towards the image. lens/surface_shape.h answers what the shape is like.
struct Surface {
  double curvature_per_mm = 0;  ///< c = 1/radius, > 0 when the centre lies on the +z side; 0 = flat
  double thickness_mm = 0;      ///< to the next vertex; the last one reaches the image surface
  Material material = {};       ///< fills the gap behind the surface; a mirror has none of its own
  /// Throws the light back into the medium it came from: the senses of travel, and with them the signs of
  /// thicknesses, turn (docs/CONVENTIONS.md).
  bool mirror = false;
  bool stop = false;
  StopBlades blades = {};                       ///< of the stop, inside its radius; none: round
  std::optional<double> semi_diameter_mm = {};  ///< clear semi-aperture; absent = unbounded
  std::vector<ApertureFigure> apertures = {};   ///< that light must pass besides
  double conic = 0;                             ///< k
  std::map<int, double> asphere = {};           ///< power p of r → a_p [mm^(1−p)]
  std::optional<AddedShape> shape = {};         ///< takes c and k, and stands in place of powers of r
  std::optional<Grating> grating = {};          ///< ruled on it
  std::optional<IdealLens> ideal_lens = {};     ///< that this plane is
  Pose pose = {};                               ///< where it stands, if not on its place
  std::optional<Scatter> scatter = {};          ///< of its own, before that of the lens
  std::optional<Coating> coating = {};          ///< what it reflects counts wherever light passes
  /// Carries rays from this plane to the next surface, in place of refraction (lens/ray_transfer.h).
  std::shared_ptr<const RayTransfer> transfer = {};

  /// A sphere by its radius (infinite: a plane), the gap behind it, what fills that, and how wide it is
  /// clear.
  static Surface sphere(double radius_mm, double thickness_mm, const Material& behind = {},
                        std::optional<double> semi_diameter_mm = {});
};

/// How wide the lens is open.
struct Aperture {
  enum class Kind {
    f_number,          ///< paraxial, for an object at infinity
    working_f_number,  ///< paraxial, 1/(2 n' |u'|), at the object distance
    image_na,          ///< paraxial, n' |u'| at the object distance
    object_na,         ///< n sin U of the paraxial marginal ray from a finite object
    entrance_pupil_diameter_mm,
    stop_semi_diameter_mm  ///< real height at the stop
  };
  Kind kind = Kind::f_number;
  double value = 0;
};

/// The field points a designer cares about.
struct Fields {
  enum class Kind { angle_deg, object_height_mm, paraxial_image_height_mm, real_image_height_mm };
  Kind kind = Kind::angle_deg;
  std::vector<double> values{0.0};
};

/// An entry of the lens that differs from state to state.
struct StateRow {
  std::string path;                 ///< into the native form: "surfaces[4].thickness_mm"
  std::vector<std::string> values;  ///< a JSON value a state: "0.5", "null"
};

/// Positions of zoom and focus (lens/lens_states.h sets a lens to one of them).
struct LensStates {
  static constexpr std::size_t most = 200;
  std::vector<std::string> names;  ///< each once, and no numbers
  std::vector<StateRow> rows;

  bool empty() const { return names.empty(); }
  std::size_t size() const { return names.size(); }
};

/// A prescription. A value: alter it as you like, validate() says what is wrong with it.
///
///     Lens lens;
///     lens.surfaces = {Surface::sphere(51.5, 4, glass_material("SCHOTT:N-BK7"), 12.5),
///                      Surface::sphere(INFINITY, 97.3, Material(), 12.5)};
///     lens.surfaces[0].stop = true;
///     lens.aperture = {Aperture::Kind::f_number, 8};
///     lens.fields.values = {0, 3, 5};
struct Lens {
  std::string name = {};
  std::string source = {};
  std::optional<double> object_distance_mm = {};  ///< from the object to vertex 1; absent = infinity
  Material object_material = {};                  ///< what the object is immersed in
  Aperture aperture = {};
  Fields fields = {};
  std::vector<double> wavelengths_nm{587.5618};
  double reference_wavelength_nm = 587.5618;
  std::vector<Surface> surfaces = {};
  std::vector<SurfaceGroup> groups = {};   ///< later ones move what earlier ones have moved
  Pose sensor_pose = {};                   ///< of the image surface; image coordinates are the sensor's own
  std::vector<Tolerance> tolerances = {};  ///< that its maker keeps
  std::optional<Scatter> scatter = {};     ///< of every surface between two media that states none
  LensStates states = {};                  ///< the lens itself stands in one of them, or as it was altered

  /// Index of the stop surface. A valid lens has exactly one.
  std::size_t stop_index() const;
  /// Of the stop surface.
  const StopBlades& stop_blades() const { return surfaces[stop_index()].blades; }
  /// From vertex 1 to the image surface, along the light.
  double total_track_mm() const;
  /// What fills the gap in front of a surface, and behind it: behind a mirror, what is in front of it.
  const Material& medium_before(std::size_t surface) const {
    return surface == 0 ? object_material : medium_behind(surface - 1);
  }
  const Material& medium_behind(std::size_t surface) const;
  /// +1 where light runs towards +z in the gap behind a surface, −1 where it comes back: it turns at mirrors.
  double sense_behind(std::size_t surface) const;
  /// In the gap in front of the sensor.
  double last_sense() const { return sense_behind(surfaces.size() - 1); }
  /// From the last vertex to the sensor, along the light. And sets it.
  double image_distance_mm() const { return last_sense() * surfaces.back().thickness_mm; }
  void set_image_distance_mm(double distance_mm) {
    surfaces.back().thickness_mm = last_sense() * distance_mm;
  }
  bool has_mirrors() const;
  /// \throws InputError saying which entry is wrong and what would be right: no surfaces, no stop or two,
  /// non-finite numbers, asphere powers below 1, negative semi-diameters, non-positive aperture or
  /// wavelengths…
  void validate() const;
};

/// \throws InputError if the lens has a mirror, saying what cannot be done with it.
void require_no_mirrors(const Lens& lens, const char* what);

}  // namespace petzval
