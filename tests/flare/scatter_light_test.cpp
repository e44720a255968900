// SPDX-License-Identifier: BSD-3-Clause
// The scatter of pictures, and veiling glare, against sums of their own.
#include <gtest/gtest.h>
#include <petzval/analysis/field_tables.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/flare/scatter_light.h>
#include <petzval/flare/scatter_spread.h>
#include <petzval/flare/veiling_glare.h>
#include <petzval/lens/lens_file.h>

#include <algorithm>
#include <cmath>

namespace petzval {
namespace {

constexpr double green_nm = 550;

Lens scattering_triplet() {
  Lens lens = with_scatter(read_lens("cooke-triplet").lens, parse_scatter("roughness=4,l=0.02"));
  lens.reference_wavelength_nm = green_nm;
  return lens;
}

/// One pixel of light.
SpectralImage star_at(const SensorGeometry& frame, int column, int row, float value) {
  SpectralImage light(frame.columns, frame.rows, {green_nm}, frame.pitch_um);
  light.at(0, row, column) = value;
  return light;
}

// The layer about a lit pixel is the scatter point-spread function of its field, mean over pixels, which are
// cells here.
TEST(ScatterLayer, IsTheSpreadOfEachPoint) {
  const Lens lens = scattering_triplet();
  const SensorGeometry frame{72, 48, 500};
  const ScatterTracer tracer(lens, green_nm, {});
  const double pixel_mm = 0.5;
  for (const auto& [column, row] : {std::pair{36, 24}, std::pair{54, 35}, std::pair{10, 24}}) {
    const SpectralImage layer =
        scatter_light(lens, star_at(frame, column, row, 1), {}, {.cells = 128, .nodes = 9});
    const BrightSource source =
        source_imaged_at(lens, tracer, frame.x_mm(column + 0.5), frame.y_mm(row + 0.5));
    std::vector<std::array<double, 2>> places;
    std::vector<double> seen;
    for (const auto& [dc, dr] : {std::pair{5, 0}, std::pair{-7, 6}, std::pair{0, -12}, std::pair{14, 3}}) {
      const int c = std::clamp(column + dc, 0, frame.columns - 1),
                r = std::clamp(row + dr, 0, frame.rows - 1);
      places.push_back({frame.x_mm(c + 0.5), frame.y_mm(r + 0.5)});
      seen.push_back(static_cast<double>(layer.at(0, r, c)));
    }
    const ScatterSpread spread = scatter_spread(tracer, source, places, {.across = 64});
    // Apertures cut between points of coarse grids: a twentieth is what the documents say.
    for (std::size_t i = 0; i < places.size(); ++i)
      EXPECT_NEAR(seen[i] / (spread.per_light(i) * pixel_mm * pixel_mm), 1, 0.05) << column << " " << i;
    // What scatter takes from the pixel, less what it gives back to it.
    EXPECT_LT(layer.at(0, row, column), 0);
    // The share is linear between nodes.
    EXPECT_GT(layer.at(0, row, column), -1.01 * spread.image.scattered_share());
  }
}

// Rows of light from every place of a frame: the same in sum, whichever cells it is taken in.
TEST(ScatterLayer, DoesNotDependOnCells) {
  const Lens lens = scattering_triplet();
  const SensorGeometry frame{144, 96, 250};
  SpectralImage light(frame.columns, frame.rows, {green_nm}, frame.pitch_um);
  for (int row = 30; row < 60; ++row)
    for (int column = 40; column < 80; ++column) light.at(0, row, column) = 1;
  const SpectralImage fine = scatter_light(lens, light, {}, {.cells = 144, .nodes = 3, .across = 8}),
                      coarse = scatter_light(lens, light, {}, {.cells = 48, .nodes = 3, .across = 8});
  for (const auto& [column, row] :
       {std::pair{10, 10}, std::pair{120, 80}, std::pair{60, 80}, std::pair{60, 45}})
    EXPECT_NEAR(coarse.at(0, row, column) / fine.at(0, row, column), 1, 0.03) << column << " " << row;
}

// A surround as bright as the frame and half a frame wide is an even picture of twice the size: the same
// light but for the scatter of places beyond the frame, which is taken to be that of its edge (a twentieth,
// as of single points).
TEST(ScatterLayer, OfAMeanSurroundIsThatOfALargerPicture) {
  const Lens lens = scattering_triplet();
  const auto even = [&](int scale, ScatterLightOptions::Surround surround) {
    SpectralImage light(24 * scale, 16 * scale, {green_nm}, 500);
    for (float& value : light.band(0)) value = 1;
    return scatter_light(lens, light, {},
                         {.surround = surround, .cells = 24 * scale, .nodes = 3, .across = 16});
  };
  using Surround = ScatterLightOptions::Surround;
  const SpectralImage mean = even(1, Surround::mean), dark = even(1, Surround::dark),
                      larger = even(2, Surround::dark);
  for (const auto& [column, row] : {std::pair{12, 8}, std::pair{1, 1}, std::pair{22, 8}, std::pair{6, 14}}) {
    // What is taken is the same in all of them, and larger than what comes back: compare what comes.
    const double more = mean.at(0, row, column) - dark.at(0, row, column),
                 expected = larger.at(0, row + 8, column + 12) - dark.at(0, row, column);
    EXPECT_GT(expected, 0);
    EXPECT_NEAR(more / expected, 1, 0.05) << column << " " << row;
  }
}

TEST(ScatterLayer, KeepsLightAndBytes) {
  const Lens lens = scattering_triplet();
  const SensorGeometry frame{60, 40, 600};
  const SpectralImage light = star_at(frame, 30, 20, 1);
  ScatterLightReport report;
  const auto with = [&](int threads) {
    const ThreadLimit limit(threads);
    return scatter_light(lens, light, {}, {.nodes = 3, .across = 8}, {}, &report);
  };
  const SpectralImage one = with(1), two = with(2);
  EXPECT_TRUE(std::ranges::equal(one.values(), two.values()));
  double sum = 0;
  for (const float value : one.values()) sum += value;
  EXPECT_NEAR(sum, report.returned_share - report.scattered_share, 1e-6);
  // Six surfaces of 4 nm: the closed form at normal incidence, which rays at an angle exceed by little.
  double kept = 1;
  double before = 1;
  for (const Surface& surface : lens.surfaces) {
    const double after = surface.material.index(green_nm);
    kept *= std::exp(-std::pow(2 * pi * 4 * (after - before) / green_nm, 2));
    before = after;
  }
  EXPECT_NEAR(report.scattered_share / (1 - kept), 1, 0.1);
}

// A source that the frame does not hold: what its rays scatter, and no core.
TEST(ScatterLayer, HasWhatSourcesBeyondTheFrameScatter) {
  const Lens lens = scattering_triplet();
  const SensorGeometry frame{36, 24, 600};
  BrightSource sun;
  sun.right = std::tan(radians(30));
  sun.irradiance = {2};
  ScatterLightReport report;
  const SpectralImage dark(frame.columns, frame.rows, {green_nm}, frame.pitch_um);
  const SpectralImage layer = scatter_light(lens, dark, {{sun}}, {.nodes = 2, .across = 32}, {}, &report);
  std::vector<std::array<double, 2>> places;
  for (const int column : {6, 18, 30}) places.push_back({frame.x_mm(column + 0.5), frame.y_mm(12.5)});
  const ScatterSpread spread = scatter_spread(ScatterTracer(lens, green_nm, {}), sun, places, {.across = 64});
  std::size_t i = 0;
  for (const int column : {6, 18, 30}) {
    EXPECT_GT(spread.at(i), 0);
    EXPECT_NEAR(layer.at(0, 12, column) / (2 * spread.at(i)), 1, 0.05) << column;
    ++i;
  }
}

// The surround in even steps of the tangents of its angles, a quadrature that knows nothing of the hole's
// polar rings.
TEST(VeilingGlare, IsTheScatterOfAllPointsOfTheSurround) {
  const Lens lens = scattering_triplet();
  const ScatterTracer tracer(lens, green_nm, {});
  FieldTableRequest at = FieldTableRequest::of(lens);
  at.field_kind = Fields::Kind::angle_deg;
  at.fields = {0, 12};
  at.wavelengths_nm = {green_nm};
  GlareOptions options;
  options.hole_mm = 4;
  options.surround_deg = 35;
  for (const IlluminationRow& row : illumination_table(lens, at)) {
    const VeilingGlare glare =
        veiling_glare(lens, tracer, {0, row.real_image_height_mm}, row.g_sensor_sr, options);
    const BrightSource middle = source_imaged_at(lens, tracer, 0, row.real_image_height_mm);
    const std::array<std::array<double, 2>, 1> place{{{0, row.real_image_height_mm}}};
    const auto angle_of = [](double right, double up, double right_2, double up_2) {
      const double a = std::sqrt(right * right + up * up + 1),
                   b = std::sqrt(right_2 * right_2 + up_2 * up_2 + 1);
      return std::acos(std::min(1.0, (right * right_2 + up * up_2 + 1) / (a * b)));
    };
    // Half the hole, by the images of its upper and its lower end.
    const double upper = source_imaged_at(lens, tracer, 0, row.real_image_height_mm + 2).up,
                 lower = source_imaged_at(lens, tracer, 0, row.real_image_height_mm - 2).up;
    const double hole_rad = std::abs(std::atan(upper) - std::atan(lower)) / 2;
    constexpr int steps = 57;
    const double widest = std::tan(radians(35)), step = 2 * widest / steps;
    double sum = 0;
    std::vector<BrightSource> sources;
    std::vector<double> solid;
    for (int j = 0; j < steps; ++j)
      for (int i = 0; i <= steps / 2; ++i) {
        BrightSource source;
        source.right = -widest + (i + 0.5) * step, source.up = -widest + (j + 0.5) * step;
        if (angle_of(source.right, source.up, 0, 0) > radians(35) ||
            angle_of(source.right, source.up, middle.right, middle.up) < hole_rad)
          continue;
        const double both = i < steps / 2 ? 2 : 1;  // its mirror image as well
        solid.push_back(both * step * step /
                        std::pow(source.right * source.right + source.up * source.up + 1, 1.5));
        sources.push_back(source);
      }
    for (std::size_t k = 0; k < sources.size(); ++k)
      sum += solid[k] * scatter_spread(tracer, sources[k], place, {.across = 10}).at(0);
    // The edge of the hole cuts cells: within a twentieth.
    EXPECT_NEAR(glare.scatter_sr / sum, 1, 0.05) << row.field;
    EXPECT_GT(glare.index(), 0);
    EXPECT_LT(glare.index(), glare.scattered_share);
    EXPECT_NEAR(glare.white_sr / row.g_sensor_sr, 1, glare.scattered_share);
  }
}

// Ghosts of rings against sources all around the axis.
TEST(GhostVeil, IsThatOfSourcesAllAround) {
  const Lens lens = read_lens("cooke-triplet").lens;
  GlareOptions options;
  options.hole_mm = 3;
  options.surround_deg = 20;
  const std::array<std::array<double, 2>, 2> places{{{0, 0}, {0, 9}}};
  const std::vector<double> veil = ghost_veil(lens, green_nm, places, options);
  const SensorGeometry frame{9, 9, 3000};
  std::vector<BrightSource> sources;
  constexpr int steps = 14;
  const double widest = std::tan(radians(20)), step = 2 * widest / steps;
  for (int j = 0; j < steps; ++j)
    for (int i = 0; i < steps; ++i) {
      BrightSource source;
      source.right = -widest + (i + 0.5) * step, source.up = -widest + (j + 0.5) * step;
      const double square = source.right * source.right + source.up * source.up;
      if (square > widest * widest) continue;
      source.irradiance = {step * step / std::pow(square + 1, 1.5)};
      sources.push_back(source);
    }
  const SpectralImage light = ghost_light(lens, frame, {green_nm}, sources);
  EXPECT_NEAR(veil[0] / light.at(0, 4, 4), 1, 0.1);
  EXPECT_NEAR(veil[1] / ((light.at(0, 4, 7) + light.at(0, 4, 1) + light.at(0, 1, 4) + light.at(0, 7, 4)) / 4),
              1, 0.1);
}

TEST(ScatterLayerInput, IsRefusedWithAWordOfWhatWouldBeRight) {
  const Lens lens = read_lens("cooke-triplet").lens;
  const SensorGeometry frame{8, 8, 1000};
  const SpectralImage light = star_at(frame, 4, 4, 1);
  EXPECT_THROW(scatter_light(lens, light, {}), InputError);
  const Lens scattering = scattering_triplet();
  EXPECT_THROW(scatter_light(scattering, light, {}, {.cells = 1}), InputError);
  EXPECT_THROW(scatter_light(scattering, light, {}, {.nodes = 1}), InputError);
  GlareOptions options;
  EXPECT_THROW(options.validate(), InputError);
  options.hole_mm = 1;
  options.surround_deg = 90;
  EXPECT_THROW(options.validate(), InputError);
}

}  // namespace
}  // namespace petzval
