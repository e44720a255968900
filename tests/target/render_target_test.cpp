// SPDX-License-Identifier: BSD-3-Clause
// Exact pictures against closed forms, an independent quadrature, and the laws that they must obey.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/target/render_target.h>

#include <cmath>

#include "edge_spread.h"

namespace petzval {
namespace {

TargetScene one(const Contour& contour, double level = 0, double ground = 1) {
  TargetScene scene;
  scene.ground = ground;
  scene.polygons.push_back({{contour}, level, 0});
  return scene;
}

TargetOptions frame(int columns, int rows) {
  TargetOptions options;
  options.columns = columns;
  options.rows = rows;
  options.pitch_um = 4.73;
  return options;
}

struct EdgeCase {
  double angle_deg, f_number, w020;
  Photosite::Shape shape;
};

TEST(RenderTarget, HalfPlaneIsTheClosedFormTo1e6) {
  const double wavelength = 550;
  for (const EdgeCase& c :
       {EdgeCase{5, 8, 0, Photosite::Shape::rectangle}, EdgeCase{30, 4, 0, Photosite::Shape::none},
        EdgeCase{93, 16, 0, Photosite::Shape::rectangle}, EdgeCase{0, 8, 1, Photosite::Shape::rectangle},
        EdgeCase{-140, 16, 2, Photosite::Shape::rectangle},
        EdgeCase{45, 4, 10, Photosite::Shape::rectangle}}) {
    TargetOptions options = frame(96, 64);
    options.photosite.shape = c.shape;
    const auto otf = radial_pupil_otf({{c.w020}, 0}, wavelength, c.f_number);
    const TargetImage image = render_target(one(half_plane({48.3, 31.9}, c.angle_deg), 0, 1), *otf, options);
    const double cutoff = options.pitch_um / (wavelength * 1e-3 * c.f_number);
    const double cosine = std::cos(c.angle_deg * pi / 180), sine = std::sin(c.angle_deg * pi / 180);
    const auto along = [&](double nu) {
      const double site =
          c.shape == Photosite::Shape::none ? 1 : test::sinc_of(nu * cosine) * test::sinc_of(nu * sine);
      return site * test::defocus_otf(nu / cutoff, c.w020);
    };
    double worst = 0;
    for (int row = 0; row < 64; row += 13)
      for (int column = 0; column < 96; column += 11) {
        const double d = (column + 0.5 - 48.3) * cosine + (row + 0.5 - 31.9) * sine;
        worst = std::max(worst, std::abs(image.at(column, row) - (1 - test::edge_spread(along, cutoff, d))));
      }
    EXPECT_LT(worst, 1e-6) << c.angle_deg << " deg, f/" << c.f_number << ", W020 " << c.w020;
    std::printf("worst %g\n", worst);
  }
}

}  // namespace
}  // namespace petzval
