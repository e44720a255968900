// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/lens/lens_file.h>
#include <petzval/simulate/psf_stack.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace petzval {
namespace {

FieldTableRequest psf_request(const std::vector<double>& fields, const std::vector<double>& wavelengths_nm) {
  return {Fields::Kind::angle_deg, fields, wavelengths_nm};
}

/// The image of a small stop on the axis is Airy's: ∬ PSF² is ∬ MTF² (Parseval), (λN)⁻² times a number.
TEST(PsfStack, OfASmallStopIsAirys) {
  Lens lens = read_lens("double-gauss").lens;
  lens.aperture = {Aperture::Kind::f_number, 32};
  const PsfStack stack = psf_stack(lens, psf_request({0}, {480, 640}), {.size = 256, .spacing_um = 4});
  const auto sharpness = [&](std::size_t wavelength) {
    double sum = 0;
    for (std::size_t i = 0; i < stack.psf_cells(); ++i)
      sum += std::pow(stack.values[wavelength * stack.psf_cells() + i], 2);
    return sum / std::pow(stack.spacing_um * 1e-3, 2) *
           std::pow(stack.wavelengths_nm[wavelength] * 1e-6 * 32, 2);
  };
  // ∫₀¹ 2πν T(ν)² dν of the round pupil's T, by Simpson's rule.
  const auto mtf = [](double v) { return 2 / std::numbers::pi * (std::acos(v) - v * std::sqrt(1 - v * v)); };
  double integral = 0;
  constexpr int steps = 1000;
  for (int i = 0; i <= steps; ++i) {
    const double v = static_cast<double>(i) / steps, weight = i == 0 || i == steps ? 1 : i % 2 ? 4 : 2;
    integral += weight * 2 * std::numbers::pi * v * mtf(v) * mtf(v) / (3 * steps);
  }
  EXPECT_NEAR(sharpness(0), integral, 0.02 * integral);
  EXPECT_NEAR(sharpness(1), integral, 0.02 * integral);
}

TEST(PsfStack, AGridThatIsChosenHoldsAll) {
  const Lens lens = read_lens("cooke-triplet").lens;
  const PsfStack stack = psf_stack(lens, psf_request({0, 14, 20}, {480, 640}));
  EXPECT_EQ(stack.values.size(), 6 * stack.psf_cells());
  EXPECT_LE(stack.size, PsfOptions().largest_size);
  for (const double share : stack.captured) EXPECT_GT(share, 0.98);
  for (std::size_t i = 0; i < 6; ++i) {
    double sum = 0;
    for (std::size_t c = 0; c < stack.psf_cells(); ++c) sum += stack.values[i * stack.psf_cells() + c];
    EXPECT_NEAR(sum, 1, 1e-5);
  }
  // The same grid asked for gives the same PSFs.
  const PsfStack again =
      psf_stack(lens, psf_request({14}, {640}), {.size = stack.size, .spacing_um = stack.spacing_um});
  const auto cells = static_cast<std::ptrdiff_t>(stack.psf_cells());
  EXPECT_TRUE(std::equal(again.values.begin(), again.values.end(), stack.values.begin() + 3 * cells));
}

// Without symmetry, cells wider than half of λN hold the light of several samples: as many cells as were
// asked for, the middle one about the chief ray. Against cells of a fifth, added up; the two midpoint rules
// differ by (1.33² − 0.8²)/24 · f″ with f″ below (2π · 0.11/µm)² f: 3 % of the largest.
TEST(PsfStack, WideCellsOfALensWithoutSymmetryHoldTheLightOfNarrowOnes) {
  Lens lens = with_setting(read_lens("double-gauss").lens, "surfaces[1].pose.decentre_y_mm=0.05");
  lens.aperture = {Aperture::Kind::f_number, 8};
  const FieldTableRequest at = psf_request({5}, {550});
  const PsfStack wide = psf_stack(lens, at, {.size = 32, .spacing_um = 4});
  const PsfStack narrow = psf_stack(lens, at, {.size = 165, .spacing_um = 0.8});
  ASSERT_EQ(wide.size, 32);
  ASSERT_EQ(wide.values.size(), 32u * 32);
  double sum = 0, worst = 0, largest = 0;
  for (int i = 0; i < 32; ++i)
    for (int j = 0; j < 32; ++j) {
      double fine = 0;
      for (int a = 0; a < 5; ++a)
        for (int b = 0; b < 5; ++b)
          fine += static_cast<double>(narrow.values[static_cast<std::size_t>((5 * i + a) * 165 + 5 * j + b)]);
      const double coarse =
          static_cast<double>(wide.values[static_cast<std::size_t>(32 * i + j)]) * wide.captured[0];
      worst = std::max(worst, std::abs(coarse - fine * narrow.captured[0]));
      largest = std::max(largest, coarse), sum += coarse;
    }
  EXPECT_NEAR(sum, wide.captured[0], 1e-5);
  EXPECT_LT(worst, 0.03 * largest);
}

TEST(PsfStack, SaysWhereNoRayPasses) {
  const Lens lens = read_lens("double-gauss").lens;
  try {
    psf_stack(lens, psf_request({0, 60}, {550}));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("60"), std::string::npos) << error.what();
  }
}

TEST(PsfStack, Stops) {
  Context context;
  context.progress = [](double, const std::string&) { return false; };
  EXPECT_THROW(psf_stack(read_lens("double-gauss").lens, {}, {}, context), Cancelled);
}

}  // namespace
}  // namespace petzval
