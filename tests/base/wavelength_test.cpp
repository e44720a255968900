// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/wavelength.h>

#include <cmath>

namespace petzval {
namespace {

TEST(Wavelength, LightFromTheVacuumUltravioletToHeatIsRight) {
  for (const double nm : {100.0, 121.6, 380.0, 587.5618, 1064.0, 14000.0, 100000.0})
    EXPECT_EQ(wavelength_fault(nm), "") << nm;
  EXPECT_NO_THROW(require_wavelength(550, "here"));
}

TEST(Wavelength, OtherUnitsAreToldByTheirSize) {
  const std::pair<double, const char*> wrong[] = {
      {0.55, "wavelengths are in nm; 550 would be right for 0.55"},
      {0.5875618, "wavelengths are in nm; 587.5618 would be right for 0.587562"},
      {10.6, "wavelengths are in nm; 10600 would be right for 10.6"},
      {550e-9, "wavelengths are in nm; 550 would be right for 5.5e-07"},
      {1e-3, "wavelengths are in nm; 0.001 is none of light, which begins at 100"}};
  for (const auto& [number, said] : wrong) EXPECT_EQ(wavelength_fault(number), said);
}

TEST(Wavelength, OtherNumbersAreNone) {
  for (const double number : {0.0, -550.0, std::nan(""), double{INFINITY}})
    EXPECT_NE(wavelength_fault(number).find("is no wavelength"), std::string::npos) << number;
  try {
    require_wavelength(0.55, "`wavelengths_nm` 0.55");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              "`wavelengths_nm` 0.55: wavelengths are in nm; 550 would be right for 0.55");
  }
}

}  // namespace
}  // namespace petzval
