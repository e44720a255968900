// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/image/picture.h>
#include <petzval/image/picture_inset.h>

namespace petzval {
namespace {

using PixelKind = InsetSheet::Source::Kind;

TEST(PictureInset, IsReadFromText) {
  const PictureInset here = PictureInset::parse("310,20");
  EXPECT_EQ(here.column, 310);
  EXPECT_EQ(here.row, 20);
  EXPECT_EQ(here.factor, 4);
  EXPECT_FALSE(here.of_frame);
  const PictureInset corner = PictureInset::parse("top-right,8");
  EXPECT_EQ(corner.column, 1);
  EXPECT_EQ(corner.row, 0);
  EXPECT_EQ(corner.factor, 8);
  EXPECT_TRUE(corner.of_frame);
  for (const char* wrong : {"", "3", "3,4,1", "3,4,65", "3,4,2.5", "3,4,5,6", "up", "top,4,4", "3,x"})
    EXPECT_THROW(PictureInset::parse(wrong), InputError) << wrong;
}

/// Every pixel of what an inset shows stands in the sheet as a square of factor × factor, and nothing else
/// does.
TEST(PictureInset, EnlargesEachPixelBesideThePicture) {
  constexpr int columns = 300, rows = 200;
  const std::vector<PictureInset> insets{{0, 0, 5, false}, {1, 1, 3, true}, {150.2, 99.7, 7, false}};
  const InsetSheet sheet(columns, rows, insets);
  for (std::size_t i = 0; i < insets.size(); ++i) {
    const InsetSheet::Square square = sheet.square(i);
    EXPECT_GE(square.left, 0);
    EXPECT_GE(square.top, 0);
    EXPECT_LE(square.left + square.side, columns);
    EXPECT_LE(square.top + square.side, rows);
  }
  EXPECT_EQ(sheet.square(0).left, 0);
  EXPECT_EQ(sheet.square(1).left + sheet.square(1).side, columns);
  EXPECT_EQ(sheet.square(1).top + sheet.square(1).side, rows);
  EXPECT_NEAR(sheet.square(2).left + sheet.square(2).side / 2.0, 150.2, 1);

  std::vector<int> shown(columns * rows, 0);
  int of_picture = 0, in_frames = 0;
  for (int row = 0; row < sheet.rows(); ++row)
    for (int column = 0; column < sheet.columns(); ++column) {
      const InsetSheet::Source source = sheet.at(column, row);
      const bool within = column < columns && row < rows;
      if (source.kind == PixelKind::picture && within) {
        EXPECT_EQ(source.column, column);
        EXPECT_EQ(source.row, row);
        ++of_picture;
      } else if (source.kind == PixelKind::picture) {
        ++shown[static_cast<std::size_t>(source.row * columns + source.column)];
      } else if (within) {
        EXPECT_EQ(source.kind, PixelKind::frame);
        ++in_frames;
      }
    }
  EXPECT_EQ(of_picture + in_frames, columns * rows);
  std::vector<int> expected(columns * rows, 0);
  for (std::size_t i = 0; i < insets.size(); ++i) {
    const InsetSheet::Square square = sheet.square(i);
    for (int row = square.top; row < square.top + square.side; ++row)
      for (int column = square.left; column < square.left + square.side; ++column)
        expected[static_cast<std::size_t>(row * columns + column)] += insets[i].factor * insets[i].factor;
  }
  EXPECT_EQ(shown, expected);
}

TEST(PictureInset, RefusesWhatIsNotInThePicture) {
  const std::vector<PictureInset> beyond{{301, 20, 4, false}}, flat{{1, 1, 1, false}},
      many(17, PictureInset{1, 1, 4, false}), none;
  EXPECT_THROW(InsetSheet(300, 200, beyond), InputError);
  EXPECT_THROW(InsetSheet(300, 200, flat), InputError);
  EXPECT_THROW(InsetSheet(300, 200, many), InputError);
  const InsetSheet sheet(300, 200, none);
  EXPECT_EQ(sheet.columns(), 300);
  EXPECT_EQ(sheet.rows(), 200);
}

/// The picture with an inset holds the picture's own values, and the inset's pixels are those of the picture.
TEST(PictureInset, HoldsTheValuesOfThePicture) {
  SpectralImage light(40, 30, {550}, 5);
  for (std::size_t i = 0; i < light.band_size(); ++i) light.band(0)[i] = static_cast<float>(i % 97) * 1e-4F;
  PictureOptions options;
  const PngImage plain = srgb_picture(light, options);
  options.insets = {PictureInset::parse("20,15,4")};
  const PngImage sheet = srgb_picture(light, options);
  const InsetSheet places(40, 30, options.insets);
  ASSERT_EQ(sheet.columns, places.columns());
  ASSERT_EQ(sheet.rows, places.rows());
  for (int row = 0; row < sheet.rows; ++row)
    for (int column = 0; column < sheet.columns; ++column) {
      const InsetSheet::Source source = places.at(column, row);
      const std::size_t to = static_cast<std::size_t>(row * sheet.columns + column) * 3;
      if (source.kind == PixelKind::picture)
        EXPECT_EQ(sheet.samples[to],
                  plain.samples[static_cast<std::size_t>(source.row * 40 + source.column) * 3]);
      else
        EXPECT_EQ(sheet.samples[to], 255) << "white paper, and yellow has all the red";
    }
}

}  // namespace
}  // namespace petzval
