// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/measure/picture_comparison.h>

#include <cmath>
#include <string>

namespace petzval {
namespace {

ComparablePicture picture_of(int columns, int rows, std::size_t bands, std::vector<float> values) {
  ComparablePicture picture;
  picture.name = "test";
  picture.columns = columns;
  picture.rows = rows;
  picture.bands = bands;
  picture.values = LargeFloats(std::move(values));
  return picture;
}

// By hand: differences 0, 1, −2, 0 against 3, 4, 0, −12. √5/13; 2/12; 20 log₁₀(12/√(5/4)).
TEST(PictureComparison, MeasuresWhatItsFormulasSay) {
  const ComparablePicture reference = picture_of(2, 1, 2, {3, 4, 0, -12});
  const ComparablePicture picture = picture_of(2, 1, 2, {3, 5, -2, -12});
  const PictureComparison comparison = compare_pictures(picture, reference);
  EXPECT_DOUBLE_EQ(comparison.all.relative_l2, std::sqrt(5.0) / 13);
  EXPECT_DOUBLE_EQ(comparison.all.max_error_over_peak, 2.0 / 12);
  EXPECT_DOUBLE_EQ(comparison.all.psnr_db, 20 * std::log10(12 / std::sqrt(5.0 / 4)));
  ASSERT_EQ(comparison.bands.size(), 2U);
  EXPECT_DOUBLE_EQ(comparison.bands[0].relative_l2, 1.0 / 5);
  EXPECT_DOUBLE_EQ(comparison.bands[1].relative_l2, 2.0 / 12);
}

TEST(PictureComparison, DoesNotCareHowValuesAreLaidOut) {
  const ComparablePicture planar = picture_of(2, 1, 2, {3, 4, 0, -12});
  ComparablePicture interleaved = planar;
  interleaved.interleaved = true;
  interleaved.values = std::vector<double>{3, 0, 4, -12};
  const PictureComparison comparison = compare_pictures(interleaved, planar);
  EXPECT_EQ(comparison.all.relative_l2, 0);
  EXPECT_EQ(comparison.all.max_error_over_peak, 0);
  EXPECT_TRUE(std::isinf(comparison.all.psnr_db));
}

TEST(PictureComparison, BlackReferencesAreNoReasonForNan) {
  const ComparablePicture black = picture_of(2, 1, 1, {0, 0});
  EXPECT_EQ(compare_pictures(black, black).all.relative_l2, 0);
  const PictureDifference grey = compare_pictures(picture_of(2, 1, 1, {0, 1}), black).all;
  EXPECT_TRUE(std::isinf(grey.relative_l2));
  EXPECT_TRUE(std::isinf(grey.max_error_over_peak));
}

TEST(PictureComparison, RefusesWhatIsNotAlikeAndSaysWhy) {
  const ComparablePicture one = picture_of(2, 1, 1, {1, 2});
  const auto refusal = [&](ComparablePicture first, ComparablePicture second) -> std::string {
    try {
      compare_pictures(first, second);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing";
  };
  EXPECT_NE(refusal(one, picture_of(1, 2, 1, {1, 2})).find("2 × 1 pixels and 1 × 2"), std::string::npos);
  EXPECT_NE(refusal(one, picture_of(2, 1, 2, {1, 2, 3, 4})).find("1 bands and 2"), std::string::npos);
  ComparablePicture a = one, b = one;
  a.units = "W.m^-2.nm^-1";
  EXPECT_EQ(refusal(a, b), "nothing") << "one file says nothing about units";
  b.units = "W.m^-2.sr^-1.nm^-1";
  EXPECT_NE(refusal(a, b).find("units"), std::string::npos);
  b = a = one;
  a.wavelengths_nm = {550};
  b.wavelengths_nm = {551};
  EXPECT_NE(refusal(a, b).find("551"), std::string::npos);
  b = a = one;
  a.pitch_um = 5;
  b.pitch_um = 6;
  EXPECT_NE(refusal(a, b).find("pitch"), std::string::npos);
  b = a = one;
  b.display = true;
  EXPECT_NE(refusal(a, b).find("display"), std::string::npos);
}

}  // namespace
}  // namespace petzval
