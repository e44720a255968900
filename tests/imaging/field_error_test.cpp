// SPDX-License-Identifier: BSD-3-Clause
// What a table says of its own gaps against a table with twice as many fields.
#include <gtest/gtest.h>
#include <petzval/imaging/field_error.h>
#include <petzval/lens/lens_file.h>
#include <petzval/optics/build.h>

#include <cmath>
#include <string>
#include <vector>

namespace petzval {
namespace {

constexpr std::array<double, 2> gaps_half_frame{2.4, 1.8};
constexpr SpreadWanted gaps_wanted{.cell_um = 1.875, .tolerance = 1e-3, .tail_um = 60};

LensDataTable table_of_fields(const std::string& lens, int count) {
  TableOptions options;
  options.wavelengths_nm = {550};
  options.max_image_height_mm = std::hypot(gaps_half_frame[0], gaps_half_frame[1]);
  options.field_count = count;
  return build_lens_data_table(read_lens(lens).lens, options);
}

class GapsOfTables : public ::testing::TestWithParam<const char*> {};

// A table of 2n − 1 fields has a PSF in every gap of one of n. By half or by twice as much again an estimate
// is of use.
TEST_P(GapsOfTables, IsThatOfThePsfsThatLieThere) {
  const LensDataTable few = table_of_fields(GetParam(), 17), more = table_of_fields(GetParam(), 33);
  const FrameRings frame(gaps_half_frame);
  double sum = 0;
  for (std::size_t odd = 1; odd < more.fields.size(); odd += 2) {
    std::vector<std::size_t> about;
    for (const int step : {-3, -1, 1, 3})
      if (const int field = int(odd) + step; field >= 0 && field < int(more.fields.size()))
        about.push_back(std::size_t(field));
    const double error = field_misfit(more, 0, about, odd, gaps_wanted).error();
    sum +=
        frame.share(more.real_image_height_mm[odd - 1], more.real_image_height_mm[odd + 1]) * error * error;
  }
  const double measured = over_interval * std::sqrt(sum),
               said = error_between_fields(few, gaps_half_frame, gaps_wanted);
  EXPECT_GT(said, 0.5 * measured);
  EXPECT_LT(said, 3 * measured);
}

INSTANTIATE_TEST_SUITE_P(Lenses, GapsOfTables,
                         ::testing::Values("m12-4.5mm", "edmund-54852", "tessar", "dgauss-50mm"));

TEST(ErrorBetweenFields, IsNotSaidOfFewFields) {
  EXPECT_EQ(error_between_fields(table_of_fields("edmund-54852", 5), gaps_half_frame, gaps_wanted), 0);
}

}  // namespace
}  // namespace petzval
