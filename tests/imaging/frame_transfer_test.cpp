// SPDX-License-Identifier: BSD-3-Clause
// What becomes of waves on cells, against waves followed number by number.
#include "imaging/synthetic_table.h"

#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/imaging/cell_choice.h>
#include <petzval/imaging/frame_transfer.h>

#include <cmath>
#include <complex>
#include <functional>

namespace petzval {
namespace {

using namespace testing;

constexpr double followed_pixel_um = 4;
const SensorGeometry followed_frame{64, 48, followed_pixel_um};

/// A head and a tail, so that the transform is not real; all fields alike.
LensDataTable head_and_tail_table() {
  TableRecipe recipe;
  recipe.psf = [](double, double) {
    return psf_of_spots({{0, 0, 0.6, 0.6, 1}, {0.5, 2.5, 0.9, 1.2, 0.6}}, 81, 0.25);
  };
  return make_table(recipe);
}

/// The light that a wave sends to a pixel, of cells one by one: each takes what the source filter leaves of
/// it and spreads it by the PSF, through a Gaussian window. \return what came out wrong of it.
double wrong_of_a_wave(const std::vector<double>& light, double spacing_pixels, double f_cpp, int cells,
                       const LightPath& path, const PixelTaps& taps, const Photosite& site) {
  double sum = 0, centroid = 0;
  for (std::size_t i = 0; i < light.size(); ++i) {
    sum += light[i];
    centroid += light[i] * double(i) * spacing_pixels;
  }
  centroid /= sum;
  const auto wave = [&](double x) { return std::polar(1.0, 2 * pi * f_cpp * x); };
  const double sigma = 0.65 / cells;  // of the window [pixels]
  const auto spread = [&](double x) {
    double value = 0;
    for (std::size_t i = 0; i < light.size(); ++i) {
      const double beside = (x - (double(i) * spacing_pixels - centroid)) / sigma;
      value += light[i] / sum * std::exp(-beside * beside / 2) / std::sqrt(2 * pi) / sigma / cells;
    }
    return value;
  };
  constexpr int reach_pixels = 8;
  std::complex<double> pixel = 0;
  for (std::size_t tap = 0; tap < taps.terms[0].across.size(); ++tap) {
    const double at = (double(tap) + 0.5 - double(taps.size()) / 2) / cells;
    for (int source = -reach_pixels * cells; source <= reach_pixels * cells; ++source) {
      const double away = double(source) / cells;
      pixel +=
          taps.terms[0].across[tap] * spread(away) * path.source.transform(f_cpp / cells) * wave(at - away);
    }
  }
  std::complex<double> wanted = 0;
  for (std::size_t i = 0; i < light.size(); ++i)
    wanted += light[i] / sum * std::conj(wave(double(i) * spacing_pixels - centroid));
  return std::norm(pixel - site.transform(f_cpp, 0).real() * wanted);
}

TEST(FrameTransfer, IsWhatBecomesOfAWaveOnCells) {
  const LensDataTable table = head_and_tail_table();
  const Psf& psf = table.psf[0];
  std::vector<double> down(std::size_t(psf.size)), across(std::size_t(psf.size));
  for (std::size_t i = 0; i < down.size(); ++i)
    for (std::size_t j = 0; j < down.size(); ++j) {
      down[i] += double(psf.values[i * down.size() + j]);
      across[j] += double(psf.values[i * down.size() + j]);
    }
  const FrameTransfer lens(table, 550, followed_frame);
  const Photosite site;
  const LightPath path{SourceFilter(2), true};
  for (const int cells : {1, 2, 3}) {
    const PixelTaps taps = pixel_taps(site, cells, path);
    const std::vector<PassedWaves> along = lens.passed(FrameZones::along_radius(2), cells),
                                   aside = lens.passed(FrameZones::across_radius(1), cells);
    for (const std::size_t band : {3, 8, 12, 17, 25, 31, 44}) {
      const double f = DetailBands::middle_cpp(band),
                   of_cells = taps.transform(f, 0) * path.source.transform(f / cells);
      const double wanted = site.transform(f, 0).real(), step = psf.spacing_um / followed_pixel_um;
      // Straight lines between the frequencies of a transform: 1 in 1000 of what the lens passes.
      const auto bound = [&](double exact, const PassedWaves& waves) {
        return 4e-3 * std::sqrt(exact * waves.by_lens) + 1e-7;
      };
      const double of_rows = wrong_of_a_wave(down, step, f, cells, path, taps, site),
                   of_columns = wrong_of_a_wave(across, step, f, cells, path, taps, site);
      EXPECT_NEAR(along[band].error(of_cells, wanted), of_rows, bound(of_rows, along[band]))
          << cells << ", " << f;
      EXPECT_NEAR(aside[band].error(of_cells, wanted), of_columns, bound(of_columns, aside[band]))
          << cells << ", " << f;
    }
  }
}

// Fields crowd at the rim, where PSFs are wide: what they stand for is the area about them, not their number.
TEST(FrameTransfer, FieldsCountByTheAreaAboutThem) {
  const auto table = [](std::vector<double> fields) {
    TableRecipe recipe;
    recipe.fields = std::move(fields);
    recipe.height_mm = [](double field, double) { return 0.01 * field; };
    recipe.psf = [](double field, double) { return psf_of_spots({{0, 0, 1 + field / 10, 1, 1}}, 65, 0.5); };
    return make_table(recipe);
  };
  std::vector<double> even, crowded;
  for (int i = 0; i <= 32; ++i) even.push_back(0.5 * i);
  for (int i = 0; i <= 32; ++i) crowded.push_back(16 * std::sqrt(i / 32.0));
  const FrameTransfer a(table(even), 550, followed_frame), b(table(crowded), 550, followed_frame);
  for (std::size_t ring = 0; ring < FrameZones::rings; ++ring) {
    const std::size_t zone = FrameZones::across_radius(ring);
    EXPECT_NEAR(a.passed(zone, 2)[8].by_lens / b.passed(zone, 2)[8].by_lens, 1, 0.02) << ring;
  }
}

// More cells, less error; and none where there is no detail.
TEST(FrameTransfer, MoreCellsHoldMoreDetail) {
  SceneDetail detail;
  detail.mean = 1;
  detail.power.fill(std::vector<double>(DetailBands::count));
  const FrameTransfer lens(head_and_tail_table(), 550, followed_frame);
  const Photosite site;
  EXPECT_EQ(SamplingErrors(detail, lens, site, 2).with(SourceFilter(2)), 0);
  detail.power[0][15] = 0.1;
  double before = 1;
  for (const int cells : {1, 2, 3, 4}) {
    const double error = SamplingErrors(detail, lens, site, cells).with(SourceFilter(2));
    EXPECT_LT(error, before / 2) << cells;
    before = error;
  }
}

}  // namespace
}  // namespace petzval
