// SPDX-License-Identifier: BSD-3-Clause
// What vignetting takes from the light it must take from the contrast.
//
// Without aberration the MTF is the share of the pupil that is left when it is shifted against itself by s =
// λν/n', so that MTF(ν) · g_sensor/n'² is an area. Aberrations vanish where waves are long: at 5 mm those of
// these lenses, whose indices are constants, are a thousandth of a wave. The left side comes of rays from the
// object point and the autocorrelation of their exit directions; the right side is the overlap of the rim
// that rays traced back from the image point find.
#include <gtest/gtest.h>
#include <petzval/analysis/mtf.h>
#include <petzval/lens/lens_file.h>

#include <algorithm>
#include <cmath>

namespace petzval {
namespace {

constexpr double beam_nm = 5e6, lambda_mm = 5;

/// The rim of a pupil, and how long its chords are.
struct Rim {
  std::vector<double> alpha, beta;

  Rim(const FieldTracer& tracer, const ChiefRay& chief) {
    const PupilBoundary pupil = *tracer.image_pupil(chief, 2048);
    for (std::size_t i = 0; i < pupil.radius.size(); ++i) {
      alpha.push_back(pupil.radius[i] * std::sin(pupil.azimuth(i)));
      beta.push_back(pupil.centre_v + pupil.radius[i] * std::cos(pupil.azimuth(i)));
    }
  }
  /// Of the points with x = `at`, the extent in y.
  static double chord(const std::vector<double>& x, const std::vector<double>& y, double at) {
    double low = 2, high = -2;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const std::size_t next = (i + 1) % x.size();
      if ((x[i] < at) == (x[next] < at)) continue;
      const double crossing = y[i] + (at - x[i]) / (x[next] - x[i]) * (y[next] - y[i]);
      low = std::min(low, crossing);
      high = std::max(high, crossing);
    }
    return std::max(high - low, 0.0);
  }
  /// The area that is left of the pupil shifted by s along y.
  static double overlap(const std::vector<double>& x, const std::vector<double>& y, double s) {
    const auto [low, high] = std::minmax_element(x.begin(), x.end());
    constexpr int steps = 1000;
    double area = 0;
    for (int i = 0; i < steps; ++i)
      area +=
          std::max(chord(x, y, *low + (i + 0.5) / steps * (*high - *low)) - s, 0.0) * (*high - *low) / steps;
    return area;
  }
  double tangential(double s) const { return overlap(alpha, beta, s); }
  double sagittal(double s) const { return overlap(beta, alpha, s); }
};

TEST(VignettingLaw, LightAndContrastGoTogether) {
  Lens lens = read_lens("dgauss-50mm").lens;
  lens.aperture = {Aperture::Kind::f_number, 4};
  lens.reference_wavelength_nm = beam_nm;
  lens.wavelengths_nm = {beam_nm};
  MtfOptions options;
  options.frequencies_cpmm = {0.005, 0.01, 0.02, 0.03, 0.04};  // the limit is 0.05 on the axis
  double dimmest = 1;
  for (const double field : {0.0, 10.0, 20.0, 22.0})
    for (const auto clip : {Tracer::Clip::apertures, Tracer::Clip::stop_only}) {
      FieldTracer tracer(lens, beam_nm, clip), open(lens, beam_nm, Tracer::Clip::stop_only);
      const ChiefRay chief = *tracer.chief_ray(field);
      const Rim rim(tracer, chief);
      const double tolerance = field == 0 ? 1e-3 : 6e-3;
      const double g_sr = tracer.g_sensor_sr(chief);
      for (const MtfRow& row :
           mtf_table(lens, {Fields::Kind::angle_deg, {field}, {beam_nm}, clip, {}}, options)) {
        const double s = lambda_mm * row.frequency_cpmm;
        // Rays from the object point and rays to the image point differ by what aberrations do to the pupil:
        // the law holds to 1e-3 on the axis, to 6e-3 at 22°, where vignetting has taken 18 %.
        EXPECT_NEAR(row.tangential * g_sr, rim.tangential(s), tolerance * g_sr)
            << field << " " << row.frequency_cpmm;
        EXPECT_NEAR(row.sagittal * g_sr, rim.sagittal(s), tolerance * g_sr)
            << field << " " << row.frequency_cpmm;
      }
      dimmest = std::min(dimmest, g_sr / open.g_sensor_sr(chief));
    }
  EXPECT_LT(dimmest, 0.9) << "a lens that vignettes";
}

}  // namespace
}  // namespace petzval
