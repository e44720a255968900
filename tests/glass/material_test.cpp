// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/glass/material.h>

#include <cmath>
#include <limits>

namespace petzval {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::shared_ptr<const Glass> flat_glass() {
  Glass glass;
  glass.catalogue = "MAKER";
  glass.name = "Flat-1";
  glass.formula = 5;
  glass.coefficients = {1.625};
  glass.shortest_nm = 400;
  glass.longest_nm = 700;
  glass.k_table = {{400, 4e-8}, {500, 2e-8}, {600, 3e-8}};
  return std::make_shared<const Glass>(glass);
}

std::string refusal_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Material, OfEachKindHasItsIndexAndItsDescription) {
  EXPECT_EQ(Material().index(550), 1);
  EXPECT_EQ(Material().description(), "air");
  EXPECT_TRUE(Material().is_air());
  const Material glass(flat_glass());
  EXPECT_EQ(glass.index(550), 1.625);
  EXPECT_EQ(glass.description(), "MAKER:Flat-1");
  EXPECT_FALSE(glass.is_air());
  const Material constant(Material::Constant{1.67});
  EXPECT_EQ(constant.index(550), 1.67);
  EXPECT_EQ(constant.description(), "n 1.67");
  const Material model(Material::Model{1.6, 60});
  EXPECT_EQ(model.index(587.5618), 1.6);
  EXPECT_EQ(model.description(), "nd 1.6 Vd 60");
  const Material table(Material::Table{{500, 1.6}, {600, 1.5}});
  EXPECT_EQ(table.index(600), 1.5);
  EXPECT_EQ(table.description(), "table");
}

TEST(Material, RefusesNumbersThatNoMaterialHas) {
  for (const double n : {0.99, 0.0, -1.5, std::nan(""), infinity}) {
    EXPECT_THROW(Material(Material::Constant{n}), InputError) << n;
    EXPECT_THROW(Material(Material::Model{n, 60}), InputError) << n;
    EXPECT_THROW(Material(Material::Table{{500, n}}), InputError) << n;
  }
  for (const double vd : {0.0, -40.0, std::nan(""), infinity})
    EXPECT_THROW(Material(Material::Model{1.5, vd}), InputError) << vd;
  EXPECT_THROW(Material(Material::Table{}), InputError);
  EXPECT_THROW(Material(Material::Table{{500, 1.5}, {500, 1.5}}), InputError);
  EXPECT_THROW(Material(Material::Table{{500, 1.5}, {400, 1.5}}), InputError);
  EXPECT_THROW(Material(Material::Table{{0, 1.5}}), InputError);
  EXPECT_THROW(Material(Material::Table{{std::nan(""), 1.5}}), InputError);
  EXPECT_THROW(Material(std::shared_ptr<const Glass>()), InputError);
}

TEST(Material, RefusesWavelengthsThatAreNone) {
  for (const double nm : {0.0, -550.0, std::nan(""), infinity}) {
    EXPECT_THROW(Material().index(nm), InputError) << nm;
    EXPECT_THROW(Material(Material::Constant{1.5}).index(nm), InputError) << nm;
    EXPECT_THROW(Material(flat_glass()).index(nm), InputError) << nm;
  }
}

TEST(Glass, SaysWhereItsIndexIsValid) {
  const auto glass = flat_glass();
  EXPECT_EQ(glass->index(400), 1.625);
  EXPECT_EQ(glass->index(700), 1.625);
  EXPECT_EQ(refusal_of([&] { glass->index(365.01); }),
            "the index of MAKER:Flat-1 is not known at 365.01 nm; it is valid from 400 to 700 nm");
  EXPECT_THROW(glass->index(700.001), InputError);
}

TEST(Glass, WithoutFormulaOrTableIsAnErrorWhenAsked) {
  Glass glass;
  glass.longest_nm = 1000;
  EXPECT_THROW(glass.index(500), InputError);
}

TEST(Glass, ExtinctionIsLinearInTheTableAndHeldAtItsEnds) {
  const auto glass = flat_glass();
  EXPECT_EQ(glass->extinction(400), 4e-8);
  EXPECT_EQ(glass->extinction(500), 2e-8);
  EXPECT_DOUBLE_EQ(glass->extinction(425), 3.5e-8);
  EXPECT_DOUBLE_EQ(glass->extinction(550), 2.5e-8);
  EXPECT_EQ(glass->extinction(100), 4e-8);
  EXPECT_EQ(glass->extinction(2000), 3e-8);
  EXPECT_EQ(Glass().extinction(500), 0);
}

TEST(Glass, TransmittanceIsBeerLambert) {
  // 4π · 2e-8 · 10 mm / 500e-6 mm = 5.0265e-3
  EXPECT_NEAR(flat_glass()->transmittance_10mm(500), std::exp(-5.026548245743669e-3), 1e-15);
  EXPECT_EQ(Glass().transmittance_10mm(500), 1);
}

TEST(Glass, HasAbbeNumbersOnlyWhereTheLinesAreValid) {
  ASSERT_TRUE(flat_glass()->abbe());
  EXPECT_EQ(flat_glass()->abbe()->nd, 1.625);
  Glass narrow = *flat_glass();
  narrow.shortest_nm = 490;
  EXPECT_FALSE(narrow.abbe());
  narrow.shortest_nm = 400;
  narrow.longest_nm = 650;
  EXPECT_FALSE(narrow.abbe());
}

}  // namespace
}  // namespace petzval
