// SPDX-License-Identifier: BSD-3-Clause
// The bundled reflectances against the colours that the maker of the chart publishes.
#include <gtest/gtest.h>
#include <petzval/colour/display.h>
#include <petzval/colour/illuminants.h>
#include <petzval/colour/spectra_files.h>

#include <array>
#include <cmath>
#include <string>

namespace petzval {
namespace {

struct Patch {
  const char* name;
  std::array<int, 3> srgb;
};

// 8-bit sRGB of the ColorChecker (GretagMacbeth's data sheet), row by row.
constexpr Patch published[] = {
    {"dark skin", {115, 82, 68}},   {"light skin", {194, 150, 130}},  {"blue sky", {98, 122, 157}},
    {"foliage", {87, 108, 67}},     {"blue flower", {133, 128, 177}}, {"bluish green", {103, 189, 170}},
    {"orange", {214, 126, 44}},     {"purplish blue", {80, 91, 166}}, {"moderate red", {193, 90, 99}},
    {"purple", {94, 60, 108}},      {"yellow green", {157, 188, 64}}, {"orange yellow", {224, 163, 46}},
    {"blue", {56, 61, 150}},        {"green", {70, 148, 73}},         {"red", {175, 54, 60}},
    {"yellow", {231, 199, 31}},     {"magenta", {187, 86, 149}},      {"cyan", {8, 133, 161}},
    {"white", {243, 243, 242}},     {"neutral 8", {200, 200, 200}},   {"neutral 6.5", {160, 160, 160}},
    {"neutral 5", {122, 122, 121}}, {"neutral 3.5", {85, 85, 85}},    {"black", {52, 52, 52}}};

using Lab = std::array<double, 3>;

Lab lab_of(Xyz colour) {
  const Xyz white = display_white();
  const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; };
  const double x = f(colour.x / white.x), y = f(colour.y), z = f(colour.z / white.z);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

double delta_e(const Lab& a, const Lab& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

Lab published_lab(const Patch& patch) {
  const auto linear = [](int code) { return srgb_decoded(code / 255.0); };
  return lab_of(xyz_of(LinearRgb{linear(patch.srgb[0]), linear(patch.srgb[1]), linear(patch.srgb[2])}));
}

/// The colour of a reflectance under D65, on the observer's own 1 nm grid.
Lab measured_lab(const Spectrum& reflectance) {
  const Spectrum light = illuminant("D65");
  std::vector<double> grid, lit, unlit;
  for (double nm = 370; nm <= 730; nm += 1) {
    grid.push_back(nm);
    lit.push_back(light.at(nm) * reflectance.at_extended(nm));
    unlit.push_back(light.at(nm));
  }
  const double white_y = Observer::cie_1931().xyz(Spectrum(grid, unlit)).y;
  return lab_of((1 / white_y) * Observer::cie_1931().xyz(Spectrum(grid, lit)));
}

TEST(ColorChecker, PatchesAreInTheOrderOfTheChart) {
  const SpectrumSet chart = read_spectrum_set("colorchecker_reflectance");
  ASSERT_EQ(chart.spectra.size(), std::size(published));
  for (std::size_t i = 0; i < std::size(published); ++i) EXPECT_EQ(chart.spectra[i].name, published[i].name);
}

TEST(ColorChecker, EveryPatchIsNearestToThePublishedColourOfItsOwnName) {
  for (const NamedSpectrum& patch : read_spectrum_set("colorchecker_reflectance").spectra) {
    const Lab measured = measured_lab(patch.spectrum);
    const Patch* nearest = &published[0];
    for (const Patch& candidate : published)
      if (delta_e(measured, published_lab(candidate)) < delta_e(measured, published_lab(*nearest)))
        nearest = &candidate;
    EXPECT_EQ(patch.name, nearest->name);
  }
}

TEST(ColorChecker, ColoursAreThePublishedOnesAsFarAsOneOldChartIsTheAverageChart) {
  // Charts differ by ΔE*ab of 2 to 4 from lot to lot and yellow with age: the white of the measured one
  // reflects 81 %, 90 % is nominal, and less in the blue. Mean 4.4, median 3. Two pigments stand out,
  // purplish blue (12.9) and yellow green (10.5); no other order or scale of the data brings them nearer.
  double sum = 0;
  for (const Patch& patch : published) {
    const double difference = delta_e(
        measured_lab(read_spectrum_set("colorchecker_reflectance").find(patch.name)), published_lab(patch));
    EXPECT_LT(difference, 13) << patch.name;
    sum += difference;
  }
  EXPECT_LT(sum / std::size(published), 5);
  RecordProperty("mean_delta_e", std::to_string(sum / std::size(published)));
}

}  // namespace
}  // namespace petzval
