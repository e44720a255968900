// SPDX-License-Identifier: BSD-3-Clause
// The ruler on edges of exactly known sharpness.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/measure/sfr/measure_edge.h>
#include <petzval/target/render_target.h>

#include <cmath>

namespace petzval {
namespace {

struct Case {
  double angle_deg, f_number, w020, w040;
  int width = 100, height = 100;
};

double worst_error(const Case& c, double* mtf50_error) {
  TargetScene scene;
  scene.polygons.push_back({{half_plane({c.width / 2 + 0.3, c.height / 2 + 0.1}, c.angle_deg)}, 0, 0});
  const auto otf = radial_pupil_otf({{c.w020, c.w040}, 0}, 550, c.f_number);
  TargetOptions options;
  options.columns = c.width, options.rows = c.height, options.pitch_um = 4.73;
  const TargetImage image = render_target(scene, *otf, options);
  const Plane plane{image.columns, image.rows, image.values};
  const EdgeMeasurement m = measure_edge(samples_in(plane, {0, 0, c.width, c.height}), 1, {});
  const double cosine = std::cos(c.angle_deg * M_PI / 180), sine = std::sin(c.angle_deg * M_PI / 180);
  const auto truth = [&](double f) { return std::abs(transfer(*otf, options, f * cosine, f * sine)); };
  double worst = 0;
  for (std::size_t i = 0; i < m.sfr.size(); ++i)
    if (m.frequencies_cpp[i] >= 0.02 && m.frequencies_cpp[i] <= 0.5)
      worst = std::max(worst, std::abs(m.sfr[i] - truth(m.frequencies_cpp[i])));
  double low = 0, high = 0.001;
  while (truth(high) > 0.5) high += 0.0005;
  low = high - 0.0005;
  for (int i = 0; i < 50; ++i) (truth(0.5 * (low + high)) > 0.5 ? low : high) = 0.5 * (low + high);
  *mtf50_error = m.mtf50().frequency_cpp / low - 1;
  std::printf("angle %5.1f f/%-4g W %4g %4g  worst %.2e  mtf50 %.5f err %.2e  tail %.4f (%.4f) angle %.6f rise %.2f noise %.1e\n",
              c.angle_deg, c.f_number, c.w020, c.w040, worst, low, *mtf50_error, m.tail_px,
              2 * otf->tail().k3_um / 4.73, m.line.angle_deg(), m.rise_px, m.noise_dark);
  return worst;
}

TEST(MeasureEdge, ExactEdges) {
  for (const double f_number : {4.0, 8.0, 16.0})
    for (const double angle : {0.5, 5.0, 43.0})
      for (const auto& [w020, w040] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {0.0, 0.75}, {2.0, -2.0}, {0.0, 2.0}, {2.0, 0.0}}) {
        double mtf50 = 0;
        const double worst = worst_error({angle, f_number, w020, w040, 100, angle < 1 ? 130 : 100}, &mtf50);
        EXPECT_LT(worst, 1e-3);
        EXPECT_LT(std::abs(mtf50), 1e-3);
      }
}

}  // namespace
}  // namespace petzval
