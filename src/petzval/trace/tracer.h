// SPDX-License-Identifier: BSD-3-Clause
// Sequential ray trace through a lens at one wavelength.
#pragma once

#include <petzval/lens/bend_data.h>
#include <petzval/lens/lens.h>
#include <petzval/lens/shapes/shape_data.h>
#include <petzval/lens/stop_blades.h>
#include <petzval/lens/transfer_data.h>
#include <petzval/trace/ray_batch.h>

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace petzval {

/// One ray, for code that walks a single ray. Direction is a unit vector.
struct Ray {
  std::array<double, 3> point_mm{};
  std::array<double, 3> direction{0, 0, 1};
  double opl_mm = 0;
  RayStatus status = RayStatus::ok;
  int failed_at = -1;
};

/// Where a ray met a surface, in lens space.
struct Intersection {
  std::array<double, 3> point_mm{};
  std::array<double, 3> direction_after{};
  std::array<double, 3> normal{};  ///< unit, on the +z side at the vertex
};

/// A lens made ready for tracing at one wavelength. Immutable; cheap to build.
///
/// Forward: a ray from anywhere in object space is refracted at all surfaces in turn and carried to the image
/// surface (a plane). Backward: a ray from image space is refracted at all surfaces in reverse order and left
/// just in front of surface 0. Rays in image space are in the axes of the sensor, which stands at
/// image_z_mm() and differs from lens space only if the sensor has a pose; where a ray crosses the stop is in
/// the stop's. Behind an odd number of mirrors image space is seen in a mirror, z → −z about the image
/// surface, so that its light runs towards +z like any other. Optical path is signed, so surfaces that cross
/// beyond their rims are no harm. Method: closed form for spheres and conics, Newton to 1e-12 mm for other
/// shapes; refraction by vector Snell (docs/CONVENTIONS.md; Welford, Aberrations of Optical Systems, 1986,
/// ch. 4).
class Tracer {
 public:
  enum class Clip { apertures, stop_only, none };

  /// Clips at the lens's own stop radius, stop_radius_mm(lens), and at the blades of its stop.
  /// \throws InputError if an index is not known at the wavelength, or as stop_radius_mm.
  Tracer(const Lens& lens, double wavelength_nm);
  /// Clips at a stop radius that the caller gives (infinity: the stop is no aperture, whatever its blades).
  Tracer(const Lens& lens, double wavelength_nm, double stop_radius_mm);

  /// The same with other blades at the stop, or a round one: light that would pass the round stop and not the
  /// polygon is vignetted. \throws InputError as StopBlades::validate(), and for blades of a stop without a
  /// radius.
  Tracer with_blades(const StopBlades& blades) const;
  const StopBlades& stop_blades() const { return blades_; }
  /// The same lens turned by an angle [rad] about its axis, from +x towards +y, the sensor's axes kept: what
  /// a field sees at that azimuth from +y towards +x.
  Tracer turned(double angle) const;
  /// Its mirror image x → −x.
  Tracer mirrored() const;
  /// Whether the lens is round about its axis, but for its blades.
  bool is_centred() const { return centred_; }

  double wavelength_nm() const { return wavelength_nm_; }
  std::size_t surface_count() const { return surfaces_.size(); }
  std::size_t stop_index() const { return stop_index_; }
  double object_index() const { return surfaces_.front().index_before; }
  double image_index() const { return surfaces_.back().index_after; }
  double image_z_mm() const { return image_z_mm_; }
  double vertex_z_mm(std::size_t surface) const { return surfaces_[surface].vertex_z_mm; }
  /// Radius that the stop clips at [mm].
  double stop_radius_mm() const { return stop_radius_mm_; }
  /// Rays that are launched at a rim exactly are not to be lost to rounding: what clips is this share of r²
  /// wider.
  static constexpr double rim_tolerance = 1e-9;
  /// The square of the radius that clips at a surface, a rounding wider than the clear aperture, so that rays
  /// launched at a rim exactly are not lost; infinity where nothing clips.
  double clip_radius_sq(std::size_t surface, Clip clip) const;

  /// Traces a batch in place, from object space to the image surface.
  void trace(RayBatch& rays, Clip clip = Clip::apertures) const;
  void trace_backward(RayBatch& rays, Clip clip = Clip::apertures) const;

  /// One ray; `path`, if given, receives an Intersection for each surface passed (and the image point last,
  /// forward only).
  Ray trace(Ray ray, Clip clip = Clip::apertures, std::vector<Intersection>* path = nullptr) const;
  Ray trace_backward(Ray ray, Clip clip = Clip::apertures, std::vector<Intersection>* path = nullptr) const;

  /// A ray of image space, as trace_backward() takes it, in the axes of lens space.
  Ray from_image(Ray ray) const;

  /// (r/r_clear)² at a surface, of the worst of its limits; clips where above 1. \param with_obscurations
  /// whether what is closed inside counts, or the outer edges alone.
  double clip_share_sq(std::size_t surface, double x_mm, double y_mm, Clip clip,
                       bool with_obscurations = true) const;

  /// As trace(), never clipped, and says by how much the ray clears the outer edges of the apertures (what
  /// is closed inside them does not count): the largest over all clipping surfaces of (r/r_clear)² − 1:
  /// negative inside, positive outside, +infinity if the ray was missed or totally reflected; and where it
  /// crossed the stop surface.
  struct Clearance {
    double worst = 0;
    int surface = -1;  ///< which one clips first
    double stop_x_mm = 0, stop_y_mm = 0;
    bool reached_stop = false;
    Ray ray;
  };
  Clearance clearance(const Ray& ray, bool backward, Clip clip = Clip::apertures) const;

  /// What one surface needs to be traced; public for surface_step.h.
  struct PreparedSurface {
    ShapeData<double> shape;
    double vertex_z_mm, index_before, index_after;
    double clear_radius_sq;   ///< infinity when unbounded
    Frame frame;              ///< against the vertex at vertex_z_mm on the axis
    bool posed = false;       ///< whether the frame is any
    bool axes_count = false;  ///< its shape is not round: own axes are not to be chosen
    bool mirror = false;      ///< throws light back; both indices are that of the medium in front
    double sense = 1;         ///< −1 where light comes to it from behind, thrown back by mirrors
    std::vector<ApertureFigure> apertures = {};
    std::shared_ptr<const TransferData<double>> transfer = {};  ///< carries rays to the next surface
    std::shared_ptr<const BendData<double>> bend = {};          ///< a grating or an ideal lens
  };
  const std::vector<PreparedSurface>& surfaces() const { return surfaces_; }
  const Frame& sensor_frame() const { return sensor_frame_; }
  /// −1 where light reaches the sensor running towards −z, thrown back by an odd number of mirrors.
  double image_sense() const { return image_sense_; }
  bool sensor_posed() const { return sensor_posed_; }

 private:
  double wavelength_nm_ = 0;
  std::vector<PreparedSurface> surfaces_;
  std::size_t stop_index_ = 0;
  double image_z_mm_ = 0, stop_radius_mm_ = 0, image_sense_ = 1;
  Frame sensor_frame_;
  bool sensor_posed_ = false, centred_ = true;
  StopBlades blades_;
  std::vector<std::array<double, 2>> blade_normals_;
};

/// The radius of the aperture stop [mm]: `aperture.value` when the file gives it (stop_semi_diameter_mm),
/// else the height at the stop surface of the real on-axis ray at the reference wavelength that is launched
/// at the edge of the paraxial entrance pupil; never more than the stop surface's own clear radius, which
/// counts alone when that ray does not reach the stop. Poses do not count: the stop is as large as designed.
/// \throws InputError if neither gives a radius, saying which surface ends the ray.
double stop_radius_mm(const Lens& lens);

}  // namespace petzval
