// SPDX-License-Identifier: BSD-3-Clause
// Ghosts against real rays that are reflected, traced close to the axis by a tracer of this test's own,
// against a plate's closed form, and their irradiance against counted rays.
#include <gtest/gtest.h>
#include <petzval/analysis/ghosts.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>
#include <petzval/trace/tracer.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <vector>

namespace petzval {
namespace {

using GhostReal = long double;

/// A ray in the plane x = 0 through spheres and planes, by vectors: no paraxial formula, nothing unfolded.
class ReflectedRays {
 public:
  ReflectedRays(const Lens& lens, double wavelength_nm) : lens_(lens) {
    GhostReal z = 0;
    indices_.push_back(1);
    for (const Surface& surface : lens.surfaces) {
      vertices_.push_back(z);
      z += surface.thickness_mm;
      indices_.push_back(surface.material.index(wavelength_nm));
    }
    vertices_.push_back(z);
  }

  struct Result {
    GhostReal height = 0, slope = 0, at_stop = 0;
    GhostReal smallest_clearance = std::numeric_limits<GhostReal>::infinity();  ///< clear height over height
    GhostReal transmittance = 1;
  };

  /// \param first, second  as in Ghost; both the number of surfaces: nothing is reflected but by nobody.
  /// \param third, fourth  as in Ghost, if there are any.
  Result trace(GhostReal y, GhostReal slope, std::size_t first, std::size_t second,
               std::optional<std::size_t> third = {}, std::optional<std::size_t> fourth = {}) {
    const std::size_t sensor = lens_.surfaces.size();
    Result result;
    y_ = y;
    z_ = 0;
    const GhostReal length = std::sqrt(1 + slope * slope);
    dy_ = slope / length;
    dz_ = 1 / length;
    bool stop_seen = false;
    const auto meet = [&](std::size_t i) {
      go_to(i);
      if (i == sensor) return;
      const Surface& surface = lens_.surfaces[i];
      GhostReal clear = std::numeric_limits<GhostReal>::infinity();
      if (surface.semi_diameter_mm) clear = *surface.semi_diameter_mm;
      if (surface.stop) clear = std::min<GhostReal>(clear, stop_radius_mm(lens_));
      result.smallest_clearance = std::min(result.smallest_clearance, clear / std::abs(y_));
      if (surface.stop && !stop_seen) result.at_stop = y_, stop_seen = true;
    };
    const auto pass = [&](std::size_t i) { result.transmittance *= 1 - reflectance(i), refract(i); };
    const auto turn = [&](std::size_t i) { result.transmittance *= reflectance(i), reflect(i); };
    if (second == sensor) {
      for (std::size_t i = 0; i < sensor; ++i) meet(i), pass(i);
    } else {
      for (std::size_t i = 0; i < first; ++i) meet(i), pass(i);
      meet(first), turn(first);
      for (std::size_t i = first - 1; i > second; --i) meet(i), pass(i);
      meet(second), turn(second);
      std::size_t next = second + 1;
      if (third) {
        for (; next < *third; ++next) meet(next), pass(next);
        meet(*third), turn(*third);
        for (std::size_t i = *third - 1; i > *fourth; --i) meet(i), pass(i);
        meet(*fourth), turn(*fourth);
        next = *fourth + 1;
      }
      for (; next < sensor; ++next) meet(next), pass(next);
    }
    meet(sensor);
    result.height = y_;
    result.slope = dy_ / dz_;
    return result;
  }

 private:
  GhostReal reflectance(std::size_t i) const {
    if (i == lens_.surfaces.size()) return sensor_reflectance;
    const GhostReal r = (indices_[i] - indices_[i + 1]) / (indices_[i] + indices_[i + 1]);
    return r * r;
  }
  void go_to(std::size_t i) {
    const GhostReal c = i < lens_.surfaces.size() ? lens_.surfaces[i].curvature_per_mm : 0;
    // To the vertex plane, then to the sphere c (y² + z²) = 2 z.
    const GhostReal to_plane = (vertices_[i] - z_) / dz_;
    y_ += to_plane * dy_;
    z_ = vertices_[i];
    if (c != 0) {
      const GhostReal half_b = dz_ - c * y_ * dy_, q = c * y_ * y_;
      const GhostReal root = std::sqrt(half_b * half_b - c * q);
      const GhostReal t = q / (half_b + std::copysign(root, half_b));
      y_ += t * dy_;
      z_ += t * dz_;
    }
    normal_y_ = -c * y_;
    normal_z_ = 1 - c * (z_ - vertices_[i]);
    const GhostReal length = std::hypot(normal_y_, normal_z_);
    normal_y_ /= length;
    normal_z_ /= length;
  }
  void refract(std::size_t i) {
    const bool onwards = dz_ > 0;
    const GhostReal ratio = onwards ? indices_[i] / indices_[i + 1] : indices_[i + 1] / indices_[i];
    const GhostReal cosine = dy_ * normal_y_ + dz_ * normal_z_;
    const GhostReal after = std::copysign(std::sqrt(1 - ratio * ratio * (1 - cosine * cosine)), cosine);
    dy_ = ratio * dy_ + (after - ratio * cosine) * normal_y_;
    dz_ = ratio * dz_ + (after - ratio * cosine) * normal_z_;
  }
  void reflect(std::size_t) {
    const GhostReal cosine = dy_ * normal_y_ + dz_ * normal_z_;
    dy_ -= 2 * cosine * normal_y_;
    dz_ -= 2 * cosine * normal_z_;
  }

 public:
  GhostReal sensor_reflectance = 0;

 private:
  const Lens& lens_;
  std::vector<GhostReal> vertices_, indices_;
  GhostReal y_ = 0, z_ = 0, dy_ = 0, dz_ = 1, normal_y_ = 0, normal_z_ = 1;
};

constexpr GhostReal tiny = 1e-8L;

TEST(Ghosts, AreWhereReflectedRaysGo) {
  for (const char* name : {"cooke-triplet", "double-gauss", "petzval-lens", "tessar"}) {
    const Lens lens = read_lens(name).lens;
    GhostOptions options;
    options.sensor_reflectance = 0.05;
    options.reflections = 4;
    const std::vector<Ghost> all = ghosts(lens, options);
    const std::size_t sensor = lens.surfaces.size();
    const auto of_four = [](const Ghost& ghost) { return ghost.third.has_value(); };
    ASSERT_GE(std::ranges::count_if(all, std::not_fn(of_four)),
              static_cast<std::ptrdiff_t>(sensor * (sensor - 1) / 4))
        << name;
    ASSERT_GE(std::ranges::count_if(all, of_four), 5) << name;
    ReflectedRays rays(lens, lens.reference_wavelength_nm);
    rays.sensor_reflectance = options.sensor_reflectance;
    const GhostReal stop_by_height = rays.trace(tiny, 0, sensor, sensor).at_stop,
                    stop_by_slope = rays.trace(0, tiny, sensor, sensor).at_stop;
    const auto chief = [&](std::size_t first, std::size_t second, std::optional<std::size_t> third,
                           std::optional<std::size_t> fourth) {
      return rays.trace(-tiny * stop_by_slope / stop_by_height, tiny, first, second, third, fourth).height;
    };
    const GhostReal image = chief(sensor, sensor, {}, {});
    for (const Ghost& ghost : all) {
      const auto traced = rays.trace(tiny, 0, ghost.first, ghost.second, ghost.third, ghost.fourth);
      const std::string where =
          std::string(name) + " " + std::to_string(ghost.first) + " " + std::to_string(ghost.second);
      EXPECT_NEAR(ghost.focus_mm / static_cast<double>(-traced.height / traced.slope), 1, 1e-9) << where;
      EXPECT_NEAR(
          ghost.diameter_mm / static_cast<double>(2 * std::abs(traced.height) * traced.smallest_clearance), 1,
          1e-9)
          << where;
      EXPECT_NEAR(
          ghost.magnification /
              static_cast<double>(chief(ghost.first, ghost.second, ghost.third, ghost.fourth) / image),
          1, 1e-9)
          << where;
      EXPECT_NEAR(ghost.transmittance / static_cast<double>(traced.transmittance), 1, 1e-12) << where;
    }
  }
}

// Light that a plate reflects twice leaves it as it came: r² of what passes, twice the plate farther.
TEST(Ghosts, OfAPlateIsItsReflectanceSquared) {
  Lens lens;
  const Material glass(Material::Constant{1.5});
  lens.surfaces = {Surface::sphere(INFINITY, 10, glass), Surface::sphere(INFINITY, 20)};
  lens.surfaces[0].stop = true;
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 3};
  const std::vector<Ghost> all = ghosts(lens);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_NEAR(all[0].relative_irradiance, 0.04 * 0.04, 1e-15);
  EXPECT_NEAR(all[0].irradiance, 0.96 * 0.96 * 0.04 * 0.04, 1e-15);
  EXPECT_NEAR(all[0].diameter_mm, 6, 1e-12);
  EXPECT_TRUE(std::isinf(all[0].focus_mm));
  EXPECT_NEAR(all[0].magnification, (20 + 3 * 10 / 1.5) / (20 + 10 / 1.5), 1e-12);

  GhostOptions coated;
  coated.losses.air_glass = Coating::constant(0.01);
  EXPECT_NEAR(ghosts(lens, coated)[0].relative_irradiance, 1e-4, 1e-17);
}

// Points of the entrance and of the source at random; the density of their rays in the middle of the ghost.
TEST(Ghosts, HaveTheIrradianceOfCountedRays) {
  const Lens lens = read_lens("cooke-triplet").lens;
  const std::vector<Ghost> all = ghosts(lens);
  ReflectedRays rays(lens, lens.reference_wavelength_nm);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> even(-1, 1);
  const auto in_disc = [&](double radius) {
    while (true)
      if (const double x = even(random), y = even(random); x * x + y * y <= 1)
        return std::pair(radius * x, radius * y);
  };
  for (const std::size_t which : {std::size_t{0}, all.size() / 2, all.size() - 1}) {
    const Ghost& ghost = all[which];
    const auto by_height = rays.trace(tiny, 0, ghost.first, ghost.second),
               by_slope = rays.trace(0, tiny, ghost.first, ghost.second);
    const auto a = static_cast<double>(by_height.height / tiny),
               b = static_cast<double>(by_slope.height / tiny);
    const auto entrance_mm = static_cast<double>(by_height.smallest_clearance * tiny);
    const double slope = std::tan(radians(0.53) / 2);
    const double point_mm = std::abs(a) * entrance_mm, source_mm = std::abs(b) * slope;
    const double middle_mm = 0.5 * std::abs(point_mm - source_mm);
    constexpr int count = 400000;
    int hits = 0;
    for (int i = 0; i < count; ++i) {
      const auto [x, y] = in_disc(entrance_mm);
      const auto [u, v] = in_disc(slope);
      if (std::hypot(a * x + b * u, a * y + b * v) < middle_mm) ++hits;
    }
    ASSERT_GT(hits, 1000);
    const double density = double(hits) / count * std::pow(entrance_mm / middle_mm, 2);
    EXPECT_NEAR(ghost.irradiance / (ghost.transmittance * density), 1, 3 / std::sqrt(double(hits))) << which;
  }
}

TEST(Ghosts, RefuseWhatNoSurfaceReflects) {
  const Lens lens = read_lens("cooke-triplet").lens;
  GhostOptions options;
  options.sensor_reflectance = 1.5;
  EXPECT_THROW(ghosts(lens, options), InputError);
  options.sensor_reflectance = 0;
  options.source_diameter_deg = 0;
  EXPECT_THROW(ghosts(lens, options), InputError);
  options.source_diameter_deg = 1;
  options.reflections = 3;
  EXPECT_THROW(ghosts(lens, options), InputError);
}

}  // namespace
}  // namespace petzval
