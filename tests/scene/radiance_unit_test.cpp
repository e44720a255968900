// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/scene/radiance_unit.h>

#include <utility>

namespace petzval {
namespace {

TEST(RadianceUnit, SpellingsInUse) {
  const std::pair<const char*, double> units[] = {
      {"W.m^-2.sr^-1.nm^-1", 1},
      {"W.m^-2.sr^-1", 1},  // spectral OpenEXR, which means per nm
      {"W·m⁻²·sr⁻¹·nm⁻¹", 1},
      {"W m-2 sr-1 nm-1", 1},
      {"W/m^2/sr/nm", 1},
      {"W/(m^2 sr nm)", 1},
      {"W/(m2*sr*nm)", 1},
      {"W*m**-2*sr**-1*nm**-1", 1},
      {"W.m^{-2}.sr^{-1}.nm^{-1}", 1},
      {"[W/m2/sr/nm]", 1},
      {"Watts/(m^2 sr micron)", 1e-3},
      {"W/m2/sr/um", 1e-3},
      {"W m-2 sr-1 µm-1", 1e-3},
      {"mW/cm2/sr/um", 1e-2},  // 1e-3 W, 1e4 per m², 1e-3 per nm
      {"uW/cm2/sr/nm", 1e-2},  // 1e-6 W, 1e4 per m²
      {"μW/(cm² sr nm)", 1e-2},
      {"W.sr^-1.m^-3", 1e-9},
      {"kW m-2 sr-1 nm-1", 1e3},
      {"mW.m^-2.sr^-1.nm^-1", 1e-3},
  };
  for (const auto& [unit, factor] : units) EXPECT_NEAR(radiance_scale(unit) / factor, 1, 1e-12) << unit;
}

TEST(RadianceUnit, OtherQuantitiesAreRefused) {
  for (const char* unit :
       {"", "W", "W.m^-2", "W.m^-2.nm^-1", "cd.m^-2", "lx", "W.m^2.sr^-1.nm^-1", "W.m^-2.sr.nm^-1",
        "photons/s/m2/sr/nm", "W.m^-2.sr^-1.Hz^-1", "DN", "W^99 m", "/////", "((((", "W.m^-2.sr^-2"})
    EXPECT_THROW(radiance_scale(unit), InputError) << unit;
  try {
    radiance_scale("W.m^-2.nm^-1");
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("irradiance"), std::string::npos);
  }
}

}  // namespace
}  // namespace petzval
