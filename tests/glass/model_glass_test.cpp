// SPDX-License-Identifier: BSD-3-Clause
// The model glass by its definition, and how well it stands for real glasses.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/glass/catalogue.h>
#include <petzval/glass/dispersion.h>

#include <cmath>

namespace petzval {
namespace {

using namespace spectral_line;

TEST(ModelGlass, HasItsNdVdAndNormalPartialDispersion) {
  for (const double nd : {1.45, 1.6, 1.9})
    for (const double vd : {20.0, 36.37, 60.0, 95.0}) {
      const auto n = [&](double nm) { return model_glass_index(nd, vd, nm); };
      EXPECT_EQ(n(d_nm), nd);
      // Differences of indices near 1.5 carry 2e-16 of rounding; against a dispersion of 0.005 that is 1e-13.
      EXPECT_NEAR((nd - 1) / (n(f_nm) - n(c_nm)), vd, 1e-11 * vd);
      EXPECT_NEAR((n(g_nm) - n(f_nm)) / (n(f_nm) - n(c_nm)), 0.6438 - 0.001682 * vd, 1e-11);
    }
}

// The line goes through K7 and F2, so for these two the model must give g as the data sheets print it, to one
// unit of the fifth decimal (P_gF of the line is rounded to four decimals, times 0.017 of dispersion).
TEST(ModelGlass, ReproducesTheTwoGlassesThatDefineItsLine) {
  for (const char* name : {"SCHOTT:K7", "SCHOTT:F2"}) {
    const auto glass = GlassCatalogue::bundled().find(name);
    const AbbeNumbers numbers = *glass->abbe();
    EXPECT_NEAR(model_glass_index(numbers.nd, numbers.vd, g_nm), glass->index(g_nm), 1e-5) << name;
    // Conrady's formula interpolates the visible to a few units of the fifth decimal.
    for (double nm = 420; nm <= 700; nm += 10)
      EXPECT_NEAR(model_glass_index(numbers.nd, numbers.vd, nm), glass->index(nm), 5e-5)
          << name << " at " << nm;
  }
}

// What the model is worth where real glasses are known. A glass within 0.005 of the normal line misses at g
// by no more than 0.005 of its dispersion (at most 0.036); Conrady's formula leaves a few units of the fifth
// decimal at e, F and C.
TEST(ModelGlass, StandsForNormalGlassesToTheFourthDecimal) {
  const GlassCatalogue& catalogue = GlassCatalogue::bundled();
  int normal_glasses = 0;
  for (const std::string& name : catalogue.full_names()) {
    const auto glass = catalogue.find(name);
    if (!glass->stated_nd || glass->shortest_nm > g_nm) continue;
    const AbbeNumbers numbers = *glass->abbe();
    const double dispersion = (numbers.nd - 1) / numbers.vd;
    const double partial = (glass->index(g_nm) - glass->index(f_nm)) / dispersion;
    const auto miss = [&](double nm) {
      return std::abs(model_glass_index(numbers.nd, numbers.vd, nm) - glass->index(nm));
    };
    if (std::abs(partial - (0.6438 - 0.001682 * numbers.vd)) < 0.005) {
      ++normal_glasses;
      for (const double nm : {f_nm, e_nm, c_nm}) EXPECT_LT(miss(nm), 5e-5) << name << " at " << nm;
      EXPECT_LT(miss(g_nm), 0.005 * 0.036 + 5e-5) << name;
    }
    // However far a glass is off the line, n_F − n_C fits: F and C share a small error.
    EXPECT_LT(miss(f_nm), 0.02 * dispersion) << name;
    EXPECT_NEAR(miss(f_nm), miss(c_nm), 1e-12) << name;
  }
  EXPECT_GT(normal_glasses, 700);
}

TEST(ModelGlass, LosesItsDispersionAsVdGrows) {
  for (const double nm : {400.0, 700.0, 1000.0})
    EXPECT_NEAR(model_glass_index(1.5, 1e12, nm), 1.5, 1e-11) << nm;
  EXPECT_EQ(model_glass_index(1, 50, 400), 1);
}

TEST(ModelGlass, DispersionIsNormal) {
  for (const double vd : {15.0, 40.0, 100.0, 500.0})
    for (double nm = 310; nm <= 2500; nm += 10)
      EXPECT_LT(model_glass_index(1.6, vd, nm), model_glass_index(1.6, vd, nm - 10)) << vd << " at " << nm;
}

TEST(ModelGlass, RefusesWhatItCannotStandFor) {
  EXPECT_THROW(model_glass_index(1.5, 0, 550), InputError);
  EXPECT_THROW(model_glass_index(1.5, -60, 550), InputError);
  EXPECT_THROW(model_glass_index(0.9, 60, 550), InputError);
  EXPECT_THROW(model_glass_index(std::nan(""), 60, 550), InputError);
  EXPECT_THROW(model_glass_index(1.5, 60, 299), InputError);
  EXPECT_THROW(model_glass_index(1.5, 60, 2501), InputError);
}

}  // namespace
}  // namespace petzval
