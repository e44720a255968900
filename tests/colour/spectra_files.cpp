// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/colour/spectra_files.h>

#include <string>

namespace petzval {
namespace {

std::string message_of(const std::string& text) {
  try {
    parse_spectrum_set(text, "f.csv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(SpectrumSet, IsReadWithItsHeader) {
  const SpectrumSet set = parse_spectrum_set(
      "# name: two filters\r\n# a remark\n# source: made by hand\n# unit: transmittance\n\n"
      "wavelength_nm, red ,green\n400,0.1,1e-3\n 500 , 0.2, -2\n",
      "f.csv");
  EXPECT_EQ(set.name, "two filters");
  EXPECT_EQ(set.source, "made by hand");
  EXPECT_EQ(set.unit, "transmittance");
  ASSERT_EQ(set.spectra.size(), 2u);
  EXPECT_EQ(set.spectra[0].name, "red");
  EXPECT_EQ(set.find("green").values(), (std::vector<double>{1e-3, -2}));
  EXPECT_EQ(set.find("green").wavelengths_nm(), (std::vector<double>{400, 500}));
}

TEST(SpectrumSet, SaysWhichColumnsThereAreWhenOneIsMissing) {
  const SpectrumSet set = parse_spectrum_set("wavelength_nm,red\n400,1\n", "f.csv");
  try {
    set.find("rod");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("red"), std::string::npos) << error.what();
  }
}

TEST(SpectrumSet, ErrorsNameFileAndLine) {
  EXPECT_EQ(message_of("nm,red\n400,1\n").find("f.csv:1: "), 0u);
  EXPECT_EQ(message_of("wavelength_nm,red\n400,1\n410,1,2\n").find("f.csv:3: "), 0u);
  EXPECT_EQ(message_of("wavelength_nm,red\n400,1\n390,1\n").find("f.csv:3: "), 0u);
  EXPECT_EQ(message_of("wavelength_nm,red\n400,one\n").find("f.csv:2: "), 0u);
  EXPECT_EQ(message_of("wavelength_nm,red\n400,nan\n").find("f.csv:2: "), 0u);
  EXPECT_EQ(message_of("wavelength_nm,red\n400,1e999\n").find("f.csv:2: "), 0u);
  EXPECT_EQ(message_of("wavelength_nm,red\n-4,1\n").find("f.csv:2: "), 0u);
  EXPECT_EQ(message_of("wavelength_nm,red,red\n").find("f.csv:1: "), 0u);
  EXPECT_EQ(message_of("").find("f.csv: "), 0u);
  EXPECT_EQ(message_of("wavelength_nm,red\n").find("f.csv: "), 0u);
}

TEST(BundledSpectra, AllOpenAndSayWhereTheyComeFrom) {
  const std::vector<std::string> names = bundled_names("spectra", ".csv");
  ASSERT_GE(names.size(), 10u);
  for (const std::string& name : names) {
    const SpectrumSet set = read_spectrum_set(name);
    EXPECT_FALSE(set.name.empty()) << name;
    EXPECT_FALSE(set.source.empty()) << name;
    EXPECT_FALSE(set.unit.empty()) << name;
  }
  EXPECT_EQ(read_spectrum_set("colorchecker_reflectance").spectra.size(), 24u);
}

TEST(BundledSpectra, FiltersAndSensorsPassTheirOwnColour) {
  for (const char* sensor : {"nikon_d100", "ar0132at"}) {
    const SpectrumSet set = read_spectrum_set(sensor);
    const Spectrum &red = set.find("red"), &green = set.find("green"), &blue = set.find("blue");
    EXPECT_GT(red.at(610), std::max(green.at(610), blue.at(610))) << sensor;
    EXPECT_GT(green.at(535), std::max(red.at(535), blue.at(535))) << sensor;
    EXPECT_GT(blue.at(455), std::max(red.at(455), green.at(455))) << sensor;
  }
  const Spectrum ir_cut = read_spectrum_set("ir_cut").find("transmittance");
  EXPECT_GT(ir_cut.at(550), 0.9);
  EXPECT_LT(ir_cut.at(800), 0.1);
}

TEST(BundledSpectra, AnUnknownNameLeadsToTheNearest) {
  try {
    read_spectrum_set("nikon_d10");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("nikon_d100"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace petzval
