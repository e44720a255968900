// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_values.h>
#include <petzval/analysis/seidel.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/ray_transfer.h>
#include <petzval/lens/surface_shape.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Height and slope at vertex 1, in front of it.
struct Launch {
  double height, slope;

  Launch operator*(double factor) const { return {height * factor, slope * factor}; }
  Launch operator+(const Launch& other) const { return {height + other.height, slope + other.slope}; }
};

/// A paraxial ray traced through a lens, with its slope in front of each surface.
struct TracedRay {
  ParaxialRay ray;
  double first_slope;

  double height(std::size_t i) const { return ray.height_mm[i]; }
  double slope_before(std::size_t i) const { return i == 0 ? first_slope : ray.slope[i - 1]; }
};

class ParaxialLens {
 public:
  explicit ParaxialLens(const Lens& lens) : lens_(lens), field_(largest_field(lens)) {}

  double field() const { return field_; }

  TracedRay marginal() const {
    const Launch unit = unit_marginal();
    const double size = first_order(lens_).stop_semi_diameter_mm / std::abs(stop_height(unit));
    return trace(unit * size);
  }
  /// The ray of the object point at the field's edge that has height zero at the stop.
  TracedRay chief() const {
    const Launch unit = unit_marginal();
    const Launch through =
        lens_.object_distance_mm ? Launch{-field_, 0} : Launch{0, std::tan(radians(field_))};
    return trace(through + unit * (-stop_height(through) / stop_height(unit)));
  }

 private:
  static double largest_field(const Lens& lens) {
    double largest = 0;
    for (const double field : lens.fields.values)
      largest = std::max(largest, std::abs(object_field(lens, lens.fields.kind, field)));
    if (!lens.object_distance_mm && largest >= 90)
      throw InputError(
          fmt::format("{}: Seidel sums need a largest field below 90°, not {:g}°", lens.name, largest));
    return largest;
  }
  /// A ray of the axial object point.
  Launch unit_marginal() const {
    return lens_.object_distance_mm ? Launch{*lens_.object_distance_mm, 1} : Launch{1, 0};
  }
  TracedRay trace(const Launch& launch) const {
    return {trace_paraxial(lens_, launch.height, launch.slope, lens_.reference_wavelength_nm), launch.slope};
  }
  double stop_height(const Launch& launch) const { return trace(launch).height(lens_.stop_index()); }

  const Lens& lens_;
  double field_;
};

/// c₃ of the sag c r²/2 + (c³ + c₃) r⁴/8 + …: what a surface departs by from the sphere of its vertex
/// curvature.
double fourth_order_departure(const Surface& surface) {
  const auto [vertex, fourth] = vertex_series(surface);
  return fourth - vertex * vertex * vertex;
}

/// Refractive indices on the two sides of a surface: at the reference wavelength, and dispersion (first minus
/// last wavelength).
struct Media {
  double before, after, dispersion_before, dispersion_after;
};

/// \param y, ybar  heights of marginal and chief ray; a, abar  their refraction invariants n(u + y c).
SeidelTerms surface_terms(const Surface& surface, const Media& media, double y, double ybar, double a,
                          double abar, double lagrange) {
  const double c = vertex_curvature_per_mm(surface);
  const double inverse_step = 1 / media.after - 1 / media.before;  // Δ(1/n)
  const double square_step = 1 / (media.after * media.after) - 1 / (media.before * media.before);
  const double slope_step = a * square_step - c * y * inverse_step;  // Δ(u/n)
  const double colour_step = media.dispersion_after / media.after - media.dispersion_before / media.before;
  SeidelTerms terms;
  terms.s1 = -a * a * y * slope_step;
  terms.s2 = -a * abar * y * slope_step;
  terms.s3 = -abar * abar * y * slope_step;
  terms.s4 = -lagrange * lagrange * c * inverse_step;
  // (Ā/A)(S3 + S4) with H = Āy − Aȳ put in, which cancels A.
  terms.s5 = abar * (c * ybar * (abar * y + lagrange) * inverse_step - abar * abar * y * square_step);
  terms.cl = a * y * colour_step;
  terms.ct = abar * y * colour_step;
  const double asphere = fourth_order_departure(surface) * (media.after - media.before) * y;
  terms.s1 += asphere * y * y * y;
  terms.s2 += asphere * y * y * ybar;
  terms.s3 += asphere * y * ybar * ybar;
  terms.s5 += asphere * ybar * ybar * ybar;
  return terms;
}

}  // namespace

SeidelTerms& SeidelTerms::operator+=(const SeidelTerms& other) {
  s1 += other.s1;
  s2 += other.s2;
  s3 += other.s3;
  s4 += other.s4;
  s5 += other.s5;
  cl += other.cl;
  ct += other.ct;
  return *this;
}

SeidelSums seidel_sums(const Lens& lens) {
  require_glass(lens, "Seidel sums need");
  require_no_bends(lens, "Seidel sums need");
  require_centred(
      lens,
      "Seidel sums belong to centred lenses (Zernike terms, fans and field curvature are there for all)");
  const ParaxialLens paraxial(lens);
  const TracedRay marginal = paraxial.marginal(), chief = paraxial.chief();
  SeidelSums sums;
  sums.wavelength_nm = lens.reference_wavelength_nm;
  sums.largest_field = paraxial.field();
  sums.lagrange_invariant_mm =
      chief.first_slope * marginal.height(0) - marginal.first_slope * chief.height(0);
  // Behind a mirror, indices and slopes change their signs, as thicknesses do (Welford, Aberrations of
  // Optical Systems, 1986, ch. 3).
  double sense = 1;
  Media media{1, 1, 0, 0};
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
    const Surface& surface = lens.surfaces[i];
    const double before = sense;
    if (surface.mirror) sense = -sense;
    const Material& behind = lens.medium_behind(i);
    media.after = sense * behind.index(lens.reference_wavelength_nm);
    media.dispersion_after =
        sense * (behind.index(lens.wavelengths_nm.front()) - behind.index(lens.wavelengths_nm.back()));
    const double c = vertex_curvature_per_mm(surface);
    const auto invariant = [&](const TracedRay& ray) {
      return media.before * (before * ray.slope_before(i) + ray.height(i) * c);
    };
    sums.surfaces.push_back(surface_terms(surface, media, marginal.height(i), chief.height(i),
                                          invariant(marginal), invariant(chief), sums.lagrange_invariant_mm));
    sums.sum += sums.surfaces.back();
    media = {media.after, 1, media.dispersion_after, 0};
  }
  return sums;
}

}  // namespace petzval
