// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/lens/lens_file.h>
#include <petzval/trace/exit_pupil_region.h>
#include <petzval/trace/passing_region.h>
#include <petzval/trace/pupil.h>

#include <cmath>
#include <random>

#include "trace/sample_lenses.h"

namespace petzval {
namespace {

Ray backward_ray(const Tracer& tracer, double x, double y, double alpha, double beta) {
  return {{x, y, tracer.image_z_mm()}, {-alpha, -beta, -std::sqrt(1 - alpha * alpha - beta * beta)}};
}

struct Case {
  const char* lens;
  double film_radius_mm;
};
void PrintTo(const Case& each, std::ostream* out) {
  *out << each.lens;
}

class ExitPupil : public testing::TestWithParam<Case> {};

TEST_P(ExitPupil, RegionHoldsAllTheLightAndLittleElse) {
  const Lens lens = read_lens(GetParam().lens).lens;
  const Tracer tracers[] = {Tracer(lens, 450), Tracer(lens, 650)};
  const ExitPupilRegions regions(tracers, GetParam().film_radius_mm);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  double smallest_share = 1, lost = 0, points = 0;
  for (int point = 0; point < 60; ++point) {
    const double radius = GetParam().film_radius_mm * unit(random), angle = 2 * M_PI * unit(random);
    const double x = radius * std::cos(angle), y = radius * std::sin(angle);
    // Directions of a box twice as wide: all that pass must lie inside.
    const double half = 2 * std::sqrt(regions.area_sr(x, y) / M_PI);
    const auto centre = regions.sample(x, y, 0.5, 0.0);
    if (!centre) continue;
    int passed = 0, passed_outside = 0;
    for (int i = 0; i < 4000; ++i) {
      const double alpha = centre->alpha + half * (2 * unit(random) - 1);
      const double beta = centre->beta + half * (2 * unit(random) - 1);
      if (alpha * alpha + beta * beta >= 1) continue;
      const Tracer& tracer = tracers[i % 2];
      if (tracer.trace_backward(backward_ray(tracer, x, y, alpha, beta)).status != RayStatus::ok) continue;
      ++passed;
      const double density = regions.density_per_sr(x, y, alpha, beta);
      passed_outside += density == 0;
      if (density != 0) {
        EXPECT_DOUBLE_EQ(density * regions.area_sr(x, y), 1);
      }
    }
    lost += passed_outside;
    points += passed;
    // Directions drawn from the region: how many pass at either wavelength.
    int useful = 0;
    const int drawn = 500;
    for (int i = 0; i < drawn; ++i) {
      const auto sample = regions.sample(x, y, unit(random), unit(random));
      ASSERT_TRUE(sample);
      EXPECT_GT(regions.density_per_sr(x, y, sample->alpha * (1 - 1e-12), sample->beta * (1 - 1e-12)), 0);
      bool passes = false;
      for (const Tracer& tracer : tracers)
        passes |= tracer.trace_backward(backward_ray(tracer, x, y, sample->alpha, sample->beta)).status ==
                  RayStatus::ok;
      useful += passes;
    }
    smallest_share = std::min(smallest_share, static_cast<double>(useful) / drawn);
  }
  EXPECT_GT(points, 1000);
  EXPECT_EQ(lost, 0) << "of " << points;
  EXPECT_GT(smallest_share, 0.6) << "a box would hold a disc to π/4, a vignetted pupil worse";
}

/// χ² of drawn directions over a grid about the pupil, against the integral of the density.
TEST_P(ExitPupil, DirectionsFollowTheirDensity) {
  const Lens lens = read_lens(GetParam().lens).lens;
  const Tracer tracer(lens, 550);
  const ExitPupilRegions regions(std::span(&tracer, 1), GetParam().film_radius_mm);
  constexpr int cells = 12, fine = 40, samples = 100000;
  for (const double share : {0.0, 0.55, 0.9}) {
    const double x = 0.6 * share * GetParam().film_radius_mm, y = 0.8 * share * GetParam().film_radius_mm;
    const auto centre = regions.sample(x, y, 0.5, 0.0);
    ASSERT_TRUE(centre);
    const double half = 2.5 * std::sqrt(regions.area_sr(x, y) / M_PI);
    const auto cell_of = [&](double cosine, double middle) {
      return static_cast<int>(std::floor((cosine - middle + half) / (2 * half) * cells));
    };
    std::vector<double> found(cells * cells), expected(cells * cells);
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < samples; ++i) {
      const auto sample = regions.sample(x, y, unit(random), unit(random));
      const int a = cell_of(sample->alpha, centre->alpha), b = cell_of(sample->beta, centre->beta);
      ASSERT_TRUE(a >= 0 && a < cells && b >= 0 && b < cells);
      found[static_cast<std::size_t>(a * cells + b)] += 1;
    }
    const double step = 2 * half / (cells * fine);
    for (int i = 0; i < cells * fine; ++i)
      for (int j = 0; j < cells * fine; ++j)
        expected[static_cast<std::size_t>(i / fine * cells + j / fine)] +=
            samples * step * step *
            regions.density_per_sr(x, y, centre->alpha - half + (i + 0.5) * step,
                                   centre->beta - half + (j + 0.5) * step);
    double chi2 = 0, counted = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (expected[i] < 20) continue;
      // The region's edge through a cell of 40² points: half a point along 40 of them, over the cell's share.
      const double rule =
          samples * step * step * regions.density_per_sr(x, y, centre->alpha, centre->beta) * 10;
      chi2 += (found[i] - expected[i]) * (found[i] - expected[i]) / (expected[i] + rule * rule);
      counted += 1;
    }
    // Mean `counted`, variance 2·counted; five deviations.
    EXPECT_GT(counted, 10);
    EXPECT_LT(chi2, counted + 5 * std::sqrt(2 * counted)) << "at " << share;
  }
}

/// The lanes round to floats: only directions within a few roundings of the rim may fall on its other side.
TEST_P(ExitPupil, LanesGiveTheScalarDensity) {
  const Lens lens = read_lens(GetParam().lens).lens;
  const Tracer tracer(lens, 550);
  const ExitPupilRegions regions(std::span(&tracer, 1), GetParam().film_radius_mm);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<float> x, y, alpha, beta;
  constexpr int count = 20011;  // fills no number of vectors
  for (int i = 0; i < count; ++i) {
    // A little beyond the last film radius, and every 50th point on the axis.
    const double radius = i % 50 ? 1.05 * GetParam().film_radius_mm * unit(random) : 0;
    const double angle = 2 * M_PI * unit(random);
    x.push_back(static_cast<float>(radius * std::cos(angle)));
    y.push_back(static_cast<float>(radius * std::sin(angle)));
    const double half = 1.5 * std::sqrt(regions.area_sr(x.back(), y.back()) / M_PI);
    const auto centre = regions.sample(x.back(), y.back(), 0.5, 0.0);
    alpha.push_back(static_cast<float>((centre ? centre->alpha : 0) + half * (2 * unit(random) - 1)));
    beta.push_back(static_cast<float>((centre ? centre->beta : 0) + half * (2 * unit(random) - 1)));
  }
  std::vector<float> lanes(count);
  regions.densities_per_sr({x.data(), y.data(), alpha.data(), beta.data(), count}, lanes.data());
  int inside = 0, at_an_edge = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double scalar = regions.density_per_sr(x[i], y[i], alpha[i], beta[i]);
    inside += scalar > 0;
    // 1e-6: some 16 roundings of a float.
    if (std::abs(static_cast<double>(lanes[i]) - scalar) > 1e-6 * scalar) ++at_an_edge;
  }
  EXPECT_GT(inside, count / 5);
  // Rims and borders between zones and sectors are as wide as a rounding, 1e-6 of the region or less: one
  // direction in a thousand would be a hundred times what chance gives.
  EXPECT_LT(at_an_edge, count / 1000);
}

INSTANTIATE_TEST_SUITE_P(Lenses, ExitPupil,
                         testing::Values(Case{"dgauss-50mm", 15}, Case{"edmund-54852", 3},
                                         Case{"wide-22mm", 12}, Case{"telephoto-250mm", 15},
                                         Case{"fisheye-10mm", 13.2}));

TEST(ExitPupilRegions, AreaIsThatOfThePupil) {
  // On axis the pupil is a disc, π sin²U'; the region is larger by the cells around it, two in a hundred.
  const Lens lens = read_lens("dgauss-50mm").lens;
  const Tracer tracer(lens, 587.5618);
  const ExitPupilRegions regions(std::span(&tracer, 1), 10);
  const Pencil pencil = Pencil::from_image(tracer, 0);
  const double exact = find_pupil(tracer, pencil, 0, 64)->area();
  EXPECT_GT(regions.area_sr(0, 0), exact);
  EXPECT_LT(regions.area_sr(0, 0), 1.1 * exact);
}

TEST(ExitPupilRegions, RefusesNonsense) {
  const Tracer tracer(sample::triplet_like(), 550);
  EXPECT_THROW(ExitPupilRegions({}, 1), InputError);
  EXPECT_THROW(ExitPupilRegions(std::span(&tracer, 1), 0), InputError);
  EXPECT_THROW(ExitPupilRegions(std::span(&tracer, 1), 1, 1), InputError);
}

TEST(PassingRegion, AgreesWithTheBoundaryByRoots) {
  for (const char* name : {"dgauss-50mm", "wide-22mm", "edmund-54852"}) {
    const Lens lens = read_lens(name).lens;
    const Tracer tracer(lens, 587.5618);
    for (const double angle : {0.0, 10.0, 18.0}) {
      const Pencil pencil = Pencil::from_object(lens, lens.object_distance_mm ? 0 : angle);
      const auto region = find_passing_region(tracer, pencil);
      ASSERT_TRUE(region);
      EXPECT_EQ(region->parts(), 1);
      EXPECT_FALSE(region->has_hole());
      const auto chief = aim_chief_ray(tracer, pencil, 0);
      const double exact = find_pupil(tracer, pencil, *chief, 256)->area();
      // Cells on the rim, some 500 of 25,000, are in or out by chance.
      EXPECT_NEAR(region->area / exact, 1, 5e-3) << name << " " << angle;
    }
  }
}

TEST(PassingRegion, SeesTheRingThatFindPupilDoesNot) {
  // A plano-convex singlet, flat side first, is so aberrated that through a pinhole near its focus a disc
  // about the axis passes, then nothing, then a ring: the height at the stop is about 0.1 r − 0.0018 r³.
  Lens lens;
  lens.name = "aberrated singlet";
  lens.surfaces = {sample::surface(0, 3, 1.5), sample::surface(-25, 45, 1), sample::surface(0, 10, 1)};
  lens.surfaces[0].semi_diameter_mm = 12;
  lens.surfaces[2].stop = true;
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 0.15};
  const Tracer tracer(lens, 550);
  const Pencil pencil = Pencil::from_object(lens, 0);
  const auto region = find_passing_region(tracer, pencil);
  ASSERT_TRUE(region);
  EXPECT_EQ(region->parts(), 2);
  EXPECT_TRUE(region->has_hole());
  // Along the meridian the light is what scalar rays say.
  double area = 0;
  const double step = 0.001;
  for (double r = step / 2; r < 12; r += step)
    if (tracer.trace(Ray{{0, r, 0}, {0, 0, 1}}).status == RayStatus::ok) area += 2 * M_PI * r * step;
  EXPECT_NEAR(region->area / area, 1, 0.02);
  EXPECT_LT(find_pupil(tracer, pencil, 0, 16)->area(), 0.3 * area);
}

/// A region drawn with characters, half of it, the axis on the left.
PassingRegion drawn(const std::vector<std::string>& rows) {
  PassingRegion region{{}, 1, 1, {}, 0, static_cast<int>(rows[0].size()), static_cast<int>(rows.size()), {}};
  for (const std::string& row : rows)
    for (const char cell : row) region.passes.push_back(cell == '#');
  return region;
}

TEST(PassingRegion, CountsPiecesAndHolesOfBothHalves) {
  const PassingRegion disc = drawn({"......", "##....", "###...", "##....", "......"});
  EXPECT_EQ(disc.parts(), 1);
  EXPECT_FALSE(disc.has_hole());
  const PassingRegion ring = drawn({"......", "####..", "..##..", "..##..", "####..", "......"});
  EXPECT_EQ(ring.parts(), 1);
  EXPECT_TRUE(ring.has_hole());
  const PassingRegion above_and_below = drawn({"......", "###...", "###...", "......", "###...", "......"});
  EXPECT_EQ(above_and_below.parts(), 1) << "three cells are raggedness";
  const PassingRegion beside = drawn({"......", "..##..", "..##..", "......"});
  EXPECT_EQ(beside.parts(), 2) << "a part off the axis has a mirror image";
  const PassingRegion corner = drawn({"......", "##....", "##....", "..##..", "..##..", "......"});
  EXPECT_EQ(corner.parts(), 1);
}

}  // namespace
}  // namespace petzval
