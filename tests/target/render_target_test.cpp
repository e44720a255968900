// SPDX-License-Identifier: BSD-3-Clause
// Exact pictures against closed forms, an independent quadrature, and the laws that they must obey.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/target/render_target.h>
#include <petzval/wave/pupil_otf.h>

#include <boost/math/special_functions/bessel.hpp>
#include <cmath>

#include "../wave/clipped_blades.h"
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

double worst_difference(const TargetImage& a, const TargetImage& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i)
    worst = std::max(worst, std::abs(a.values()[i] - b.values()[i]));
  return worst;
}

struct EdgeCase {
  double angle_deg, f_number, w020;
  Photosite::Shape shape;
};

TEST(RenderTarget, HalfPlaneIsTheClosedFormTo1e6) {
  const double wavelength = 550;
  using Shape = Photosite::Shape;
  for (const EdgeCase& c : {EdgeCase{5, 8, 0, Shape::rectangle},
                            {30, 4, 0, Shape::none},
                            {93, 16, 0, Shape::rectangle},
                            {0, 8, 1, Shape::rectangle},
                            {-140, 16, 2, Shape::rectangle},
                            {45, 4, 10, Shape::rectangle}}) {
    TargetOptions options = frame(96, 64);
    options.photosite.shape = c.shape;
    const auto otf = radial_pupil_otf({{c.w020}, 0}, wavelength, c.f_number);
    const TargetImage image = render_target(one(half_plane({48.3, 31.9}, c.angle_deg)), *otf, options);
    const double cutoff = options.pitch_um / (wavelength * 1e-3 * c.f_number);
    const double cosine = std::cos(c.angle_deg * pi / 180), sine = std::sin(c.angle_deg * pi / 180);
    const auto along = [&](double nu) {
      const double site = c.shape == Shape::none ? 1 : test::sinc_of(nu * cosine) * test::sinc_of(nu * sine);
      return site * test::defocus_otf(nu / cutoff, c.w020);
    };
    for (int row = 0; row < 64; row += 21)
      for (int column = 0; column < 96; column += 11) {
        const double d = (column + 0.5 - 48.3) * cosine + (row + 0.5 - 31.9) * sine;
        EXPECT_NEAR(image.at(row, column), 1 - test::edge_spread(along, cutoff, d), 1e-6)
            << c.angle_deg << " deg, f/" << c.f_number << ", W020 " << c.w020 << ", d " << d;
      }
  }
}

TEST(RenderTarget, HalfPlaneThroughBladesIsTheClosedFormToo) {
  // The transfer function of straight blades from clipped polygons; edges along a spike, across it, and
  // between.
  const double wavelength = 550, f_number = 8;
  for (const auto& [count, edge_deg] : {std::pair{6, 10.0}, {5, 93.0}}) {
    const int blades = count;
    const double angle_deg = edge_deg;
    GeneralPupil pupil;
    pupil.shape = {blades, 10 * pi / 180, 0, 0};
    const TargetOptions options = frame(64, 64);
    const auto otf = general_pupil_otf(pupil, wavelength, f_number);
    const TargetImage image = render_target(one(half_plane({32.3, 31.9}, angle_deg)), *otf, options);
    const double cutoff = options.pitch_um / (wavelength * 1e-3 * f_number);
    const double cosine = std::cos(angle_deg * pi / 180), sine = std::sin(angle_deg * pi / 180);
    const auto along = [&](double nu) {
      // The picture's x runs against the pupil's.
      return test::sinc_of(nu * cosine) * test::sinc_of(nu * sine) *
             test::blade_otf(blades, 10, nu / cutoff, 180 - angle_deg);
    };
    double worst = 0;
    for (int row = 0; row < 64; row += 21)
      for (int column = 0; column < 64; column += 7) {
        const double d = (column + 0.5 - 32.3) * cosine + (row + 0.5 - 31.9) * sine;
        worst = std::max(worst, std::abs(image.at(row, column) - 1 + test::edge_spread(along, cutoff, d)));
      }
    EXPECT_LT(worst, 5e-6) << blades << " blades, " << angle_deg << " deg";
  }
}

/// 1 − ∬ Airy pattern over a polygon about a point, in polar coordinates about it: ∫ dθ of the encircled
/// energy 1 − J0² − J1² up to the boundary, by Gauss-Legendre on every edge. No photosite.
double airy_over_polygon(const Contour& contour, Vertex at, double lambda_n_px) {
  static const QuadratureRule rule = gauss_legendre(1200);
  double sum = 0;
  for (std::size_t i = 0; i < contour.size(); ++i) {
    const Vertex &a = contour[i], &b = contour[(i + 1) % contour.size()];
    for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
      const double x = a.x + rule.nodes[j] * (b.x - a.x) - at.x, y = a.y + rule.nodes[j] * (b.y - a.y) - at.y;
      const double r2 = x * x + y * y, v = pi * std::sqrt(r2) / lambda_n_px;
      const double j0 = boost::math::cyl_bessel_j(0, v), j1 = boost::math::cyl_bessel_j(1, v);
      sum += rule.weights[j] * (x * (b.y - a.y) - y * (b.x - a.x)) / r2 * (1 - j0 * j0 - j1 * j1) / (2 * pi);
    }
  }
  return std::abs(sum);
}

TEST(RenderTarget, SmallPolygonsAgreeWithQuadratureTo1e6) {
  TargetOptions options = frame(48, 40);
  options.photosite.shape = Photosite::Shape::none;
  const double wavelength = 550, f_number = 8, unit = wavelength * 1e-3 * f_number / options.pitch_um;
  const auto otf = radial_pupil_otf({}, wavelength, f_number);
  const Contour concave{{11.2, 9.1}, {33.7, 12.9}, {22.4, 19.3}, {30.1, 31.8}, {9.9, 27.2}, {16.3, 18.8}};
  for (const Contour& contour :
       {concave, rectangle({24.3, 20.1}, 0.8, 0.6, 20), rectangle({20.2, 14.4}, 25, 12, 31)}) {
    const TargetImage image = render_target(one(contour), *otf, options);
    for (const auto& [column, row] : {std::pair{0, 0}, {24, 20}, {20, 12}, {33, 13}, {10, 27}, {47, 39}})
      EXPECT_NEAR(image.at(row, column), 1 - airy_over_polygon(contour, {column + 0.5, row + 0.5}, unit),
                  1e-6)
          << column << "," << row;
  }
}

TEST(RenderTarget, PhotositeIsAnAverageOverItsArea) {
  // Points on a 16 × 16 Gauss grid within each pixel make the square photosite's value: two independent uses
  // of the code.
  const auto otf = radial_pupil_otf({}, 550, 8);
  const Contour contour = rectangle({10.3, 9.8}, 9, 7, 25);
  TargetOptions square = frame(20, 20), point = square;
  point.photosite.shape = Photosite::Shape::none;
  const TargetImage expected = render_target(one(contour), *otf, square);
  const QuadratureRule rule = gauss_legendre(8, -0.5, 0.5);
  std::vector<double> sum(400);
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t j = 0; j < 8; ++j) {
      Contour shifted = contour;
      for (Vertex& v : shifted) v = {v.x - rule.nodes[i], v.y - rule.nodes[j]};
      const TargetImage image = render_target(one(shifted), *otf, point);
      for (std::size_t k = 0; k < 400; ++k) sum[k] += rule.weights[i] * rule.weights[j] * image.values()[k];
    }
  for (std::size_t k = 0; k < 400; ++k) EXPECT_NEAR(sum[k], expected.values()[k], 1e-8);
}

TEST(RenderTarget, ShiftsByWholePixelsAndTurnsByRightAngles) {
  const auto otf = radial_pupil_otf({{0.5, 0.5}, 0}, 550, 5.6);
  const Contour contour{{31.2, 29.1}, {73.7, 32.9}, {52.4, 49.3}, {60.1, 71.8}, {29.9, 67.2}};
  const TargetImage image = render_target(one(contour), *otf, frame(100, 100));
  Contour moved = contour, turned = contour;
  for (Vertex& v : moved) v = {v.x + 7, v.y - 3};
  for (Vertex& v : turned) v = {100 - v.y, v.x};
  const TargetImage shifted = render_target(one(moved), *otf, frame(100, 100));
  const TargetImage rotated = render_target(one(turned), *otf, frame(100, 100));
  for (int row = 10; row < 90; ++row)
    for (int column = 10; column < 90; ++column) {
      // What the period still wraps of the tail, below 1e-7, depends on the place in it.
      EXPECT_NEAR(shifted.at(row - 3, column + 7), image.at(row, column), 1e-7);
      EXPECT_NEAR(rotated.at(column, 99 - row), image.at(row, column), 1e-7);
    }
}

TEST(RenderTarget, ConservesLightOfACompactPsf) {
  // A Gaussian loses nothing to tails: the deficit of the picture is the area of the polygon.
  const auto otf = gaussian_otf(4);
  const TargetImage image = render_target(one(rectangle({50, 40}, 30, 20, 12), 0.25), *otf, frame(100, 80));
  double deficit = 0;
  for (const double value : image.values()) deficit += 1 - value;
  EXPECT_NEAR(deficit, 0.75 * 600, 1e-7);
}

TEST(RenderTarget, ManyPolygonsAddNoErrorFloor) {
  // A checkerboard of 1024 touching squares that fills one big square is that square.
  const auto otf = radial_pupil_otf({}, 550, 8);
  TargetScene many;
  for (int i = 0; i < 32; ++i)
    for (int j = 0; j < 32; ++j)
      many.polygons.push_back({{rectangle({20.25 + 2.5 * i, 20.25 + 2.5 * j}, 2.5, 2.5, 0)}, 0, 0});
  const TargetImage parts = render_target(many, *otf, frame(120, 120));
  const TargetImage whole = render_target(one(rectangle({59, 59}, 80, 80, 0)), *otf, frame(120, 120));
  EXPECT_LT(worst_difference(parts, whole), 2e-7);
}

TEST(RenderTarget, LaterPolygonsCoverEarlierOnesAndHolesShowWhatIsBelow) {
  const auto otf = gaussian_otf(2);
  const Contour outer = rectangle({30, 30}, 40, 40, 0), inner = rectangle({30, 30}, 16, 16, 0);
  TargetScene hole = one(outer);
  hole.polygons[0].contours.push_back(inner);
  TargetScene covered = one(outer);
  covered.polygons.push_back({{inner}, 1, 0});
  TargetScene four;
  for (const auto& [x, y, w, h] : {std::array{16.0, 30.0, 12.0, 40.0},
                                   {44.0, 30.0, 12.0, 40.0},
                                   {30.0, 16.0, 16.0, 12.0},
                                   {30.0, 44.0, 16.0, 12.0}})
    four.polygons.push_back({{rectangle({x, y}, w, h, 0)}, 0, 0});
  const TargetImage a = render_target(hole, *otf, frame(60, 60)),
                    b = render_target(covered, *otf, frame(60, 60)),
                    c = render_target(four, *otf, frame(60, 60));
  EXPECT_LT(worst_difference(a, b), 1e-7) << "corners are rounded to 2^-24 px where polygons overlap";
  EXPECT_LT(worst_difference(a, c), 1e-9);
  // Order matters: the earlier grey square vanishes under a black one, the later one shows.
  TargetScene under = one(inner, 0.5), over = one(outer);
  under.polygons.push_back({{outer}, 0, 0});
  over.polygons.push_back({{inner}, 0.5, 0});
  EXPECT_NEAR(render_target(under, *otf, frame(60, 60)).at(30, 30), 0, 1e-7);
  EXPECT_NEAR(render_target(over, *otf, frame(60, 60)).at(30, 30), 0.5, 1e-6);
}

TEST(RenderTarget, PolygonsThatLeaveTheFrameGoOnBeyondIt) {
  // A window of a large picture is the picture of the window.
  const auto otf = radial_pupil_otf({{1}, 0}, 550, 8);
  const Contour big{{-300, 40}, {90, -200}, {420, 160}, {150, 500}, {-80, 260}};
  Contour moved = big;
  for (Vertex& v : moved) v = {v.x + 150, v.y + 150};
  const TargetImage window = render_target(one(big), *otf, frame(100, 100));
  const TargetImage large = render_target(one(moved), *otf, frame(400, 400));
  for (int row = 0; row < 100; ++row)
    for (int column = 0; column < 100; ++column)
      EXPECT_NEAR(window.at(row, column), large.at(row + 150, column + 150), 3e-7);
}

TEST(RenderTarget, BytesDoNotDependOnThreadsOrMemory) {
  const auto otf = radial_pupil_otf({}, 550, 8);
  const TargetScene scene = one(rectangle({40.2, 40.9}, 33, 21, 17));
  TargetOptions options = frame(80, 80);
  const TargetImage many = render_target(scene, *otf, options);
  options.working_bytes = 100000;
  EXPECT_EQ(render_target(scene, *otf, options).values(), many.values());
  const ThreadLimit one_thread(1);
  EXPECT_EQ(render_target(scene, *otf, options).values(), many.values());
}

TEST(RenderTarget, RefusesInPlainWords) {
  const auto otf = radial_pupil_otf({}, 550, 8);
  const auto message = [&](const TargetScene& scene,
                           const TargetOptions& options = frame(32, 32)) -> std::string {
    try {
      render_target(scene, *otf, options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message(one({{0, 0}, {10, 10}, {10, 0}, {0, 10}})).find("crosses"), std::string::npos);
  EXPECT_NE(message(one({{0, 0}, {10, 0}, {5, 0}, {5, 5}})).find("crosses or touches"), std::string::npos);
  EXPECT_NE(message(one({{0, 0}, {10, 0}})).find("at least three"), std::string::npos);
  EXPECT_NE(message(one({{0, 0}, {10, 10}, {20, 20}})).find("no area"), std::string::npos);
  EXPECT_NE(message(one({{0, 0}, {NAN, 10}, {20, 0}})).find("not a number"), std::string::npos);
  EXPECT_NE(message(one({{0, 0}, {1e9, 10}, {20, 0}})).find("within"), std::string::npos);
  EXPECT_NE(message(one(rectangle({5, 5}, 3, 3, 0), INFINITY)).find("level"), std::string::npos);
  EXPECT_NE(message(one(rectangle({5, 5}, 3, 3, 0)), frame(0, 5)).find("1 x 1"), std::string::npos);
  EXPECT_NE(message(one(rectangle({5, 5}, 3, 3, 0)), frame(1 << 20, 1 << 20)).find("2^28"),
            std::string::npos);
  TargetOptions coarse = frame(32, 32);
  coarse.pitch_um = 1e6;
  EXPECT_NE(message(one(rectangle({5, 5}, 3, 3, 0)), coarse).find("cycles/pixel"), std::string::npos);
  EXPECT_THROW(rectangle({0, 0}, -1, 3, 0), InputError);
  EXPECT_THROW(regular_polygon({0, 0}, 3, 2, 0), InputError);
}

}  // namespace
}  // namespace petzval
