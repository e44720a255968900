// SPDX-License-Identifier: BSD-3-Clause
// What a stop of blades does to light, against the exact transform and overlap of polygons and laws of
// symmetry.
#include <gtest/gtest.h>
#include <petzval/analysis/fft_point_spread.h>
#include <petzval/analysis/mtf.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/analysis/spots.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>

#include <array>
#include <cmath>
#include <complex>

#include "analysis/stigmatic_lens.h"

namespace petzval {
namespace {

constexpr double semi_mm = 0.5, focal_mm = 40, lambda_um = 0.55;
constexpr double lambda_n_um = lambda_um * focal_mm / (2 * semi_mm);

using Polygon = std::vector<std::array<double, 2>>;

/// Corners on the circle of radius 1, anticlockwise with x to the right and y up, as seen from the film.
Polygon corners(const StopBlades& blades) {
  Polygon result;
  for (int i = 0; i < blades.count; ++i) {
    const double turn = radians(90 + blades.rotation_deg + 360.0 * i / blades.count);
    result.push_back({std::cos(turn), std::sin(turn)});
  }
  return result;
}

/// ∬ exp(−i k·r) over a polygon, by Gauss' theorem along its edges.
std::complex<double> transform(const Polygon& polygon, double kx, double ky) {
  const double k_sq = kx * kx + ky * ky;
  std::complex<double> sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double dx = b[0] - a[0], dy = b[1] - a[1];
    const double half = 0.5 * (kx * dx + ky * dy);
    const double middle = 0.5 * (kx * (a[0] + b[0]) + ky * (a[1] + b[1]));
    const double sinc = std::abs(half) < 1e-9 ? 1 : std::sin(half) / half;
    sum += (kx * dy - ky * dx) * sinc * std::polar(1.0, -middle);
  }
  return std::complex<double>(0, 1) * sum / k_sq;
}

double area(const Polygon& polygon) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    sum += 0.5 * (a[0] * b[1] - a[1] * b[0]);
  }
  return sum;
}

/// What is left of a polygon on the inner side of each edge of another, both convex (Sutherland and Hodgman
/// 1974).
Polygon clipped(Polygon polygon, const Polygon& by) {
  for (std::size_t e = 0; e < by.size(); ++e) {
    const auto &a = by[e], &b = by[(e + 1) % by.size()];
    const auto inside = [&](const std::array<double, 2>& p) {
      return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    };
    Polygon left;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const auto &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
      const double at_p = inside(p), at_q = inside(q);
      if (at_p >= 0) left.push_back(p);
      if ((at_p >= 0) != (at_q >= 0)) {
        const double share = at_p / (at_p - at_q);
        left.push_back({p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1])});
      }
    }
    polygon = left;
  }
  return polygon;
}

Lens bladed(Lens lens, const StopBlades& blades) {
  lens.surfaces[lens.stop_index()].blades = blades;
  return lens;
}

Psf psf_of(const Lens& lens, double field, const PsfOptions& options) {
  FieldTracer tracer(lens, 1e3 * lambda_um);
  return *point_spread(tracer, *tracer.chief_ray(field), options);
}

TEST(BladedStop, PsfOfAPerfectLensIsTheTransformOfThePolygon) {
  for (const StopBlades& blades :
       {StopBlades{3, 10}, StopBlades{4, 45}, StopBlades{5, 0}, StopBlades{6, 17}, StopBlades{9, 3}}) {
    PsfOptions options;
    options.size = 81;
    options.spacing_um = 0.4 * lambda_n_um;
    const Psf psf = psf_of(bladed(stigmatic_lens(semi_mm), blades), 0, options);
    const Polygon polygon = corners(blades);
    const double peak = psf.at(40, 40), whole = area(polygon);
    double worst = 0;
    for (int i = 0; i < psf.size; ++i)
      for (int j = 0; j < psf.size; ++j) {
        // Light from (x, y) of the stop arrives with direction cosines −(x, y)/f; k·r over the unit circle.
        const double k = pi * psf.spacing_um / lambda_n_um, s = k * (j - 40), t = k * (i - 40);
        const double expected =
            i == 40 && j == 40 ? 1 : std::norm(transform(polygon, -s, -t)) / (whole * whole);
        worst = std::max(worst, std::abs(psf.at(i, j) / peak - expected));
      }
    // The lens does not meet the sine condition: 2 (semi/f)² = 3e-4 for the Airy disc
    // (point_spread_test.cpp).
    EXPECT_LT(worst, 2 * std::pow(semi_mm / focal_mm, 2)) << blades.count;
  }
}

/// How many rays a star has: maxima over azimuth of the light between two radii.
int rays_of_star(const Psf& psf) {
  constexpr int bins = 120;
  std::array<double, bins> light{};
  for (int i = 0; i < psf.size; ++i)
    for (int j = 0; j < psf.size; ++j) {
      const double t = i - psf.size / 2, s = j - psf.size / 2, r = std::hypot(s, t) * psf.spacing_um;
      if (r < 8 * lambda_n_um || r > 24 * lambda_n_um) continue;
      const double turn = (std::atan2(t, s) + 2 * pi) / (2 * pi) * bins;
      light[static_cast<std::size_t>(turn) % bins] += psf.at(i, j);
    }
  const double half = 0.3 * *std::max_element(light.begin(), light.end());
  int rays = 0;
  for (std::size_t i = 0; i < bins; ++i) rays += light[i] > half && light[(i + bins - 1) % bins] <= half;
  return rays;
}

TEST(BladedStop, OddNumbersMakeTwiceAsManyRays) {
  PsfOptions options;
  options.size = 121;
  options.spacing_um = 0.45 * lambda_n_um;
  for (const auto& [blades, rays] : {std::pair{5, 10}, {6, 6}, {7, 14}, {8, 8}})
    EXPECT_EQ(rays_of_star(psf_of(bladed(stigmatic_lens(semi_mm), {blades, 4}), 0, options)), rays) << blades;
}

TEST(BladedStop, MtfOfAPerfectLensIsTheOverlapOfThePolygon) {
  for (const StopBlades& blades : {StopBlades{3, 10}, StopBlades{5, 40}, StopBlades{6, 0}}) {
    FieldTracer tracer(bladed(stigmatic_lens(semi_mm), blades), 1e3 * lambda_um);
    const ExitPupil pupil = *ExitPupil::of(tracer, *tracer.chief_ray(0));
    const Polygon polygon = corners(blades);
    for (const double share : {0.1, 0.3, 0.5, 0.7}) {
      const double cpmm = share / lambda_n_um * um_per_mm;
      for (const MtfDirection direction : {MtfDirection::tangential, MtfDirection::sagittal}) {
        Polygon moved = polygon;
        for (auto& corner : moved) corner[direction == MtfDirection::tangential ? 1 : 0] += 2 * share;
        const double expected = area(clipped(polygon, moved)) / area(polygon);
        const std::complex<double> otf = diffraction_otf(
            tracer, pupil, direction, cpmm, {PupilModel::Amplitude::light, PupilModel::Phase::plane_waves});
        // The outline is a polygon of 512 corners, 2.5e-5; the sine condition tilts amplitudes by (semi/f)².
        EXPECT_NEAR(std::abs(otf), expected, 3e-4) << blades.count << " " << share;
      }
    }
  }
}

/// A real lens off its axis, with aberrations and vignetting: the MTF is the transform of the PSF.
TEST(BladedStop, MtfAndPsfBelongTogether) {
  Lens lens = bladed(read_lens("double-gauss").lens, {5, 20});
  lens.aperture = {Aperture::Kind::f_number, 8};
  FieldTracer tracer(lens, 550);
  const ChiefRay chief = *tracer.chief_ray(7);
  PsfOptions options;
  options.size = 257;
  options.spacing_um = 1.5;
  const Psf psf = *point_spread(tracer, chief, options);
  const ExitPupil pupil = *ExitPupil::of(tracer, chief);
  for (const double cpmm : {30.0, 60.0, 100.0}) {
    std::complex<double> along_t = 0, along_s = 0;
    for (int i = 0; i < psf.size; ++i)
      for (int j = 0; j < psf.size; ++j) {
        const double phase = 2 * pi * cpmm * psf.spacing_um * mm_per_um;
        along_t += static_cast<double>(psf.at(i, j)) * std::polar(1.0, -phase * (i - psf.size / 2));
        along_s += static_cast<double>(psf.at(i, j)) * std::polar(1.0, -phase * (j - psf.size / 2));
      }
    const PupilModel model{PupilModel::Amplitude::light, PupilModel::Phase::plane_waves};
    const std::complex<double> t = diffraction_otf(tracer, pupil, MtfDirection::tangential, cpmm, model);
    const std::complex<double> s = diffraction_otf(tracer, pupil, MtfDirection::sagittal, cpmm, model);
    // What the window leaves out, times what it holds: less than one per cent of the light.
    const double out = 1 - psf.captured;
    ASSERT_LT(out, 0.02);
    EXPECT_LT(std::abs(psf.captured * along_t - t), out + 2e-3) << cpmm;
    EXPECT_LT(std::abs(psf.captured * along_s - s), out + 2e-3) << cpmm;
  }
}

TEST(BladedStop, TakesItsShareOfTheLight) {
  Lens lens = read_lens("dgauss-50mm").lens;
  lens.aperture = {Aperture::Kind::f_number, 8};
  FieldTracer round(lens, 550);
  for (const StopBlades& blades : {StopBlades{3, 10}, StopBlades{5, 0}, StopBlades{8, 33}}) {
    FieldTracer tracer(bladed(lens, blades), 550);
    const ChiefRay axis = *tracer.chief_ray(0), off = *tracer.chief_ray(10);
    // In the exit cone areas are those of the stop to the lens's own pupil aberrations; at f/8, NA² = 4e-3.
    EXPECT_NEAR(tracer.g_sensor_sr(axis) / round.g_sensor_sr(axis), blades.area_share(), 1e-3)
        << blades.count;
    EXPECT_NEAR(tracer.object_flux(axis) / round.object_flux(axis), blades.area_share(), 1e-3);
    EXPECT_NEAR(tracer.object_flux(off) / round.object_flux(off), blades.area_share(), 1e-2);
  }
}

/// Turning the blades by their own symmetry changes nothing; a mirror image mirrors.
TEST(BladedStop, TurnsAndMirrorsAsPolygonsDo) {
  const Lens lens = read_lens("double-gauss").lens;
  PsfOptions options;
  options.size = 65;
  options.spacing_um = 1;
  const Psf one = psf_of(bladed(lens, {5, 20}), 7, options),
            turned = psf_of(bladed(lens, {5, 20 + 72}), 7, options),
            mirrored = psf_of(bladed(lens, {5, -20}), 7, options);
  double peak = 0, apart = 0, mirror = 0, same = 0;
  for (int i = 0; i < 65; ++i)
    for (int j = 0; j < 65; ++j) {
      peak = std::max<double>(peak, one.at(i, j));
      apart = std::max<double>(apart, std::abs(one.at(i, j) - turned.at(i, j)));
      mirror = std::max<double>(mirror, std::abs(one.at(i, j) - mirrored.at(i, 64 - j)));
      same = std::max<double>(same, std::abs(one.at(i, j) - mirrored.at(i, j)));
    }
  // Corners of vignetted edges lie between nodes of the quadrature: 1/azimuths².
  EXPECT_LT(apart, 2e-3 * peak);
  EXPECT_LT(mirror, 2e-3 * peak);
  EXPECT_GT(same, 0.05 * peak) << "the sense of rotation shows";
}

TEST(BladedStop, IsRefusedWhereOnlyRoundStopsAreKnown) {
  const Lens lens = bladed(stigmatic_lens(semi_mm), {6, 0});
  FieldTracer tracer(lens, 550);
  EXPECT_THROW(fft_point_spread(tracer, *tracer.chief_ray(0), {32, 1}, 64), InputError);
}

}  // namespace
}  // namespace petzval
