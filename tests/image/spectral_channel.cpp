// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/image/formats/spectral_channel.h>

#include <random>

namespace petzval {
namespace {

using Kind = SpectralChannel::Kind;

TEST(SpectralChannel, NamesAreThoseOfTheLayout) {
  EXPECT_EQ(spectral_channel_name({Kind::emissive, 0, 550}), "S0.550,0nm");
  EXPECT_EQ(spectral_channel_name({Kind::emissive, 3, 587.56}), "S3.587,56nm");
  EXPECT_EQ(spectral_channel_name({Kind::reflective, 0, 1064.5}), "T.1064,5nm");
}

TEST(SpectralChannel, NamesReadBackToTheSameNumber) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> wavelength(200, 2500);
  for (int i = 0; i < 1000; ++i) {
    const double nm = wavelength(random);
    const auto parsed = parse_spectral_channel(spectral_channel_name({Kind::reflective, 0, nm}));
    ASSERT_TRUE(parsed);
    EXPECT_EQ(parsed->wavelength_nm, nm);
    EXPECT_EQ(parsed->kind, Kind::reflective);
  }
}

TEST(SpectralChannel, AllUnitsOfLengthAndFrequencyAreRead) {
  for (const char* name : {"S0.550,0nm", "S0.550nm", "S0.0,55um", "S0.5,5e-7m", "S0.550000,000000pm",
                           "S0.0,00055mm", "S0.5,5E2nm", "S0.550.0nm", "S0.0,000055cm"}) {
    const auto channel = parse_spectral_channel(name);
    ASSERT_TRUE(channel) << name;
    EXPECT_NEAR(channel->wavelength_nm, 550, 1e-12 * 550) << name;
  }
  // c = 299 792 458 m/s: 500 THz is 599.584916 nm.
  for (const char* name : {"T.500,0THz", "T.0,5PHz", "T.500000GHz", "T.5e14Hz"}) {
    const auto channel = parse_spectral_channel(name);
    ASSERT_TRUE(channel) << name;
    EXPECT_NEAR(channel->wavelength_nm, 599.584916, 1e-9) << name;
  }
}

TEST(SpectralChannel, OtherNamesAreNone) {
  for (const char* name : {"",
                           "R",
                           "S",
                           "S0",
                           "S0.",
                           "S4.550,0nm",
                           "S0.nm",
                           "S0.550",
                           "S0.550,0",
                           "S0.550,0xm",
                           "S0.-550nm",
                           "S0.0nm",
                           "S0.0Hz",
                           "S0.5,5,0nm",
                           "S0.1e999nm",
                           "S0.1e-999Hz",
                           "T.",
                           "T",
                           "M00.550,0nm",
                           "depth.Z",
                           "T.550,0nm.600,0nm",
                           "S0. 550nm",
                           "S0.infnm",
                           "S0.nanm",
                           "S0.550nmm",
                           "X.550nm"})
    EXPECT_FALSE(parse_spectral_channel(name)) << name;
}

}  // namespace
}  // namespace petzval
