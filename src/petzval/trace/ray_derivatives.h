// SPDX-License-Identifier: BSD-3-Clause
// How a ray moves on the image surface when a number of the lens changes.
#pragma once

#include <petzval/lens/lens.h>
#include <petzval/trace/tracer.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace petzval {

/// One number of a lens.
struct LensNumber {
  enum class Kind {
    curvature_per_mm,
    thickness_mm,  ///< all that lies behind the surface moves along
    conic,
    power,         ///< the coefficient of r^power
    surface_pose,  ///< one of pose_numbers, [mm] or [degrees]
    group_pose,    ///< the same of a group of surfaces
    sensor_pose    ///< and of the sensor
  };
  Kind kind = Kind::curvature_per_mm;
  std::size_t surface = 0;  ///< of a group its place among the groups
  int power = 0;            ///< of poses the place in pose_numbers

  bool is_pose() const { return kind >= Kind::surface_pose; }
  friend bool operator==(const LensNumber&, const LensNumber&) = default;
};

double value_of(const Lens& lens, const LensNumber& number);
/// \throws InputError for a surface, a group or a power that there is not.
Lens with_value(Lens lens, const LensNumber& number, double value);

/// A ray at the image surface, with its derivatives by numbers of the lens.
struct DerivedRay {
  Ray ray;
  /// By one number, in units of it.
  struct Slope {
    double x_mm, y_mm;   ///< place on the image surface
    double alpha, beta;  ///< direction cosines
    double opl_mm;       ///< optical path
  };
  std::vector<Slope> by;  ///< in the order of the numbers
};

/// Traces rays that are launched where they are whatever the lens, and are not clipped, with derivatives.
/// These are exact: the surfaces' own formulas and those of poses in dual numbers (forward automatic
/// differentiation), the intersection by the theorem of implicit functions, so that Newton's steps leave no
/// trace in them. Cost grows with the number of derivatives.
class DerivedTracer {
 public:
  /// \throws InputError as Tracer, and for a lens with gratings, ideal lenses or ray transfers.
  DerivedTracer(const Lens& lens, double wavelength_nm, std::vector<LensNumber> numbers);
  DerivedTracer(DerivedTracer&&) noexcept;
  ~DerivedTracer();

  const Tracer& tracer() const { return tracer_; }
  /// Nothing where the ray misses a surface or is totally reflected.
  std::optional<DerivedRay> trace(const Ray& ray) const;

 private:
  struct Part;  ///< of the lens, for as many numbers as are carried at once

  Tracer tracer_;
  std::vector<LensNumber> numbers_;
  std::vector<std::unique_ptr<const Part>> parts_;
};

}  // namespace petzval
