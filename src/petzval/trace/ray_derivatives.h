// SPDX-License-Identifier: BSD-3-Clause
// How a ray moves on the image surface when a number of the lens changes.
#pragma once

#include <petzval/lens/lens.h>
#include <petzval/trace/tracer.h>

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace petzval {

/// One number of a lens.
struct LensNumber {
  enum class Kind {
    curvature_per_mm,
    thickness_mm,  ///< all that lies behind the surface moves along
    conic,
    power  ///< the coefficient of r^power
  };
  Kind kind = Kind::curvature_per_mm;
  std::size_t surface = 0;
  int power = 0;
};

double value_of(const Lens& lens, const LensNumber& number);
/// \throws InputError for a surface or a power that there is not.
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

/// Traces a ray that is launched where it is whatever the lens, and is not clipped. Derivatives are exact:
/// the surfaces' own formulas in dual numbers (forward automatic differentiation), the intersection by the
/// theorem of implicit functions, so that Newton's steps leave no trace in them. Cost grows with the number
/// of derivatives. Nothing where the ray misses a surface or is totally reflected.
/// \param tracer  of `lens`. \throws InputError for a lens with poses.
std::optional<DerivedRay> trace_derived(const Tracer& tracer, const Ray& ray,
                                        std::span<const LensNumber> numbers);

}  // namespace petzval
