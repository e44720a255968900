// SPDX-License-Identifier: BSD-3-Clause
// Rendered polygons against a quadrature that shares nothing with the renderer: light within a polygon by the
// encircled energy of the PSF in polar coordinates about a point, averaged over the photosite.
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/numeric/quadrature.h>
#include <petzval/target/render_target.h>

#include <boost/math/special_functions/bessel.hpp>
#include <cmath>
#include <complex>

namespace petzval {
namespace {

struct Optics {
  double w020, w040, obstruction, f_number;
};

/// The share of light within r [λN] of the middle, by a table of a hundredth with its slopes.
class EncircledEnergy {
 public:
  EncircledEnergy(const Optics& optics, double reach) {
    const QuadratureRule rule = gauss_legendre(60 + static_cast<int>(3 * reach), optics.obstruction, 1);
    std::vector<std::complex<double>> pupil;
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      const double t = rule.nodes[i] * rule.nodes[i];
      pupil.push_back(rule.weights[i] * rule.nodes[i] *
                      std::polar(1.0, 2 * pi * (optics.w020 * t + optics.w040 * t * t)));
    }
    const double area = 1 - optics.obstruction * optics.obstruction;
    const auto density = [&](double r) {
      std::complex<double> sum = 0;
      for (std::size_t i = 0; i < pupil.size(); ++i)
        sum += pupil[i] * boost::math::cyl_bessel_j(0, pi * r * rule.nodes[i]);
      return 2 * pi * r * std::norm(sum) * pi / area;
    };
    const auto count = static_cast<std::size_t>(reach / step) + 3;
    double before = 0, total = 0;
    energy_.push_back(0), slope_.push_back(0);
    for (std::size_t i = 1; i < count; ++i) {
      const double here = density(static_cast<double>(i) * step),
                   middle = density((static_cast<double>(i) - 0.5) * step);
      total += step / 6 * (before + 4 * middle + here);
      energy_.push_back(total), slope_.push_back(here);
      before = here;
    }
  }
  double operator()(double r) const {
    const auto i = static_cast<std::size_t>(r / step);
    const double t = r / step - static_cast<double>(i), u = 1 - t;
    return energy_[i] * u * u * (1 + 2 * t) + energy_[i + 1] * t * t * (1 + 2 * u) +
           step * t * u * (slope_[i] * u - slope_[i + 1] * t);
  }

 private:
  static constexpr double step = 0.02;
  std::vector<double> energy_, slope_;
};

/// Light that a polygon sends to a point: ∮ E(r) dθ/2π along its outline, edges in pieces of half a pixel.
double light_at(const Polygon& polygon, Vertex at, const EncircledEnergy& energy, double lambda_n_px) {
  static const QuadratureRule rule = gauss_legendre(8);
  double sum = 0;
  for (const Contour& contour : polygon.contours) {
    double one = 0;
    for (std::size_t i = 0; i < contour.size(); ++i) {
      const Vertex &a = contour[i], &b = contour[(i + 1) % contour.size()];
      const double ex = b.x - a.x, ey = b.y - a.y;
      const int pieces = 1 + static_cast<int>(2 * std::hypot(ex, ey));
      for (int p = 0; p < pieces; ++p)
        for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
          const double t = (p + rule.nodes[j]) / pieces, x = a.x + t * ex - at.x, y = a.y + t * ey - at.y;
          const double r = std::hypot(x, y);
          if (r > 0)
            one +=
                rule.weights[j] / pieces * (x * ey - y * ex) / (r * r) * energy(r / lambda_n_px) / (2 * pi);
        }
    }
    // The first contour holds light, the others are holes.
    sum += &contour == &polygon.contours[0] ? std::abs(one) : -std::abs(one);
  }
  return sum;
}

/// Places within the photosite and their weights.
struct SitePoint {
  double x, y, weight;
};

std::vector<SitePoint> points_of(const Photosite& site) {
  // The light varies by up to 2 cycles over a pixel at f/4.
  if (site.shape == Photosite::Shape::none) return {{0, 0, 1}};
  const QuadratureRule rule = gauss_legendre(10);
  std::vector<SitePoint> points;
  const auto add_triangle = [&](const std::pair<double, double>& a, const std::pair<double, double>& b,
                                const std::pair<double, double>& c) {
    const double area =
        0.5 * ((b.first - a.first) * (c.second - a.second) - (b.second - a.second) * (c.first - a.first));
    for (std::size_t i = 0; i < rule.nodes.size(); ++i)
      for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
        const double u = rule.nodes[i], v = u * rule.nodes[j];
        points.push_back({a.first + u * (b.first - a.first) + v * (c.first - b.first),
                          a.second + u * (b.second - a.second) + v * (c.second - b.second),
                          2 * area * u * rule.weights[i] * rule.weights[j]});
      }
  };
  if (site.shape == Photosite::Shape::polygon) {
    for (std::size_t i = 1; i + 1 < site.vertices.size(); ++i)
      add_triangle(site.vertices[0], site.vertices[i], site.vertices[i + 1]);
  } else if (site.shape == Photosite::Shape::rectangle) {
    for (std::size_t i = 0; i < rule.nodes.size(); ++i)
      for (std::size_t j = 0; j < rule.nodes.size(); ++j)
        points.push_back({site.width * (rule.nodes[i] - 0.5), site.height * (rule.nodes[j] - 0.5),
                          rule.weights[i] * rule.weights[j]});
  } else {
    constexpr int turns = 24;
    for (std::size_t i = 0; i < rule.nodes.size(); ++i)
      for (int j = 0; j < turns; ++j) {
        const double u = rule.nodes[i], angle = 2 * pi * j / turns;
        points.push_back({0.5 * site.width * u * std::cos(angle), 0.5 * site.height * u * std::sin(angle),
                          u * rule.weights[i] / turns});
      }
  }
  double total = 0;
  for (const SitePoint& point : points) total += point.weight;
  for (SitePoint& point : points) point.weight /= total;
  if (site.separation_x == 0 && site.separation_y == 0) return points;
  std::vector<SitePoint> dots;
  for (const SitePoint& point : points)
    for (const double dx : {-0.5, 0.5})
      for (const double dy : {-0.5, 0.5})
        dots.push_back(
            {point.x + dx * site.separation_x, point.y + dy * site.separation_y, point.weight / 4});
  return dots;
}

struct Case {
  const char* name;
  Optics optics;
  Photosite site;
  Polygon polygon;
};

std::vector<Case> cases() {
  const Contour star{{11.2, 9.1}, {33.7, 12.9}, {22.4, 19.3}, {30.1, 31.8}, {9.9, 27.2}, {16.3, 18.8}};
  const Contour slanted = rectangle({20.2, 19.4}, 24, 18, 31), slit = rectangle({19.8, 20.3}, 0.7, 20, 12);
  const Polygon ring{{slanted, rectangle({21, 20}, 9, 7, 50)}, 0, 0};
  const Polygon disc{
      {regular_polygon({20.1, 19.7}, 16, 2000, 3), regular_polygon({20.1, 19.7}, 9, 2000, 3)}, 0, 0};
  Photosite point, square, circle, corner, filtered, half = Photosite::square(0.5);
  point.shape = Photosite::Shape::none;
  circle.shape = Photosite::Shape::ellipse;
  circle.width = circle.height = 0.9;
  corner.shape = Photosite::Shape::polygon;  // concave about its first vertex, which sees all of it
  corner.vertices = {{0.1, 0.1}, {-0.4, 0.1}, {-0.4, -0.4}, {0.4, -0.4}, {0.4, 0.4}, {0.1, 0.4}};
  filtered.separation_x = 0.6, filtered.separation_y = 0.4;
  return {{"Airy, concave, square", {0, 0, 0, 8}, square, {{star}, 0, 0}},
          {"W020 2, W040 -2, ring, circle", {2, -2, 0, 4}, circle, ring},
          {"W020 -2, W040 2, slit, polygon photosite", {-2, 2, 0, 4}, corner, {{slit}, 0, 0}},
          {"W040 2, concave, half filled", {0, 2, 0, 5.6}, half, {{star}, 0, 0}},
          {"W020 -2, obstruction 0.4, ring, low-pass", {-2, 0, 0.4, 8}, filtered, ring},
          {"W040 -2, obstruction 0.3, slit, circle", {0, -2, 0.3, 8}, circle, {{slit}, 0, 0}},
          {"disc of 2000 corners, whose edges the far field joins", {0, 0, 0, 8}, point, disc},
          {"W020 2, concave, square, f/16", {2, 0, 0, 16}, square, {{star}, 0, 0}}};
}

// The renderer promises 1e-6. The largest difference seen is 9e-8, about what this quadrature itself is good
// to.
TEST(RenderQuadrature, PolygonsThroughAberratedOpticsAndPhotosites) {
  for (const Case& c : cases()) {
    TargetOptions options;
    options.columns = options.rows = 40;
    options.pitch_um = 4.73;
    options.photosite = c.site;
    const double wavelength = 550, unit = wavelength * 1e-3 * c.optics.f_number / options.pitch_um;
    TargetScene scene;
    scene.polygons.push_back(c.polygon);
    const TargetImage image =
        render_target(scene,
                      *radial_pupil_otf({{c.optics.w020, c.optics.w040}, c.optics.obstruction}, wavelength,
                                        c.optics.f_number),
                      options);
    const EncircledEnergy energy(c.optics, 60 / unit);
    const std::vector<SitePoint> site = points_of(c.site);
    for (const auto& [column, row] : {std::pair{0, 0}, {20, 20}, {30, 13}, {12, 26}, {39, 35}}) {
      double light = 0;
      for (const SitePoint& point : site)
        light +=
            point.weight * light_at(c.polygon, {column + 0.5 + point.x, row + 0.5 + point.y}, energy, unit);
      EXPECT_NEAR(image.at(row, column), 1 - light, 2e-7) << c.name << " at " << column << "," << row;
    }
  }
}

}  // namespace
}  // namespace petzval
