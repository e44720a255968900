// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/colour/spectrum_text.h>

namespace petzval {
namespace {

TEST(SpectrumText, ComesBackExactly) {
  const Spectrum spectrum({400, 410.5, 1e3}, {0.1, -2.5e-300, 1.0 / 3});
  const Spectrum back = parse_spectrum_text(spectrum_text(spectrum));
  EXPECT_EQ(back.wavelengths_nm(), spectrum.wavelengths_nm());
  EXPECT_EQ(back.values(), spectrum.values());
  EXPECT_EQ(spectrum_text(Spectrum({400, 410}, {0.12, 0.13})), "400:0.12 410:0.13");
}

TEST(SpectrumText, OtherTextsAreRefused) {
  for (const char* text :
       {"", "400", "400:", "400:1,410:2", "410:1 400:2", "x:1", "400:1 410", "400:nan", ":1"})
    EXPECT_THROW(parse_spectrum_text(text), InputError) << text;
}

}  // namespace
}  // namespace petzval
