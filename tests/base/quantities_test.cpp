// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/quantities.h>

#include <cmath>

namespace petzval {
namespace {

std::string complaint(const auto& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing";
}

TEST(Lengths, AreMetresWhateverTheirUnit) {
  EXPECT_EQ(parse_length_m("1.2m"), 1.2);
  EXPECT_EQ(parse_length_m("250mm"), 0.25);
  EXPECT_DOUBLE_EQ(parse_length_m("30cm").value(), 0.3);
  EXPECT_EQ(parse_length_m("2 km"), 2000);
  EXPECT_DOUBLE_EQ(parse_length_m("12um").value(), 12e-6);
  EXPECT_EQ(parse_length_m("infinity"), INFINITY);
  EXPECT_EQ(parse_length_m("inf"), INFINITY);
  for (const char* wrong : {"", "1.2", "m", "mm", "1.2metre", "1,2m", "1.2m2", "nanm"})
    EXPECT_FALSE(parse_length_m(wrong)) << wrong;
}

TEST(Distances, NeedTheirUnit) {
  EXPECT_EQ(parse_distance_m("1.2m", "focus"), 1.2);
  EXPECT_NE(complaint([] { parse_distance_m("500", "focus"); }).find("500m or 500mm would be right"),
            std::string::npos);
  for (const char* wrong : {"0m", "-1m", "near", ""})
    EXPECT_NE(complaint([&] { parse_distance_m(wrong, "focus"); }).find("1.2m or 250mm"), std::string::npos)
        << wrong;
}

TEST(Distances, AreWrittenAsTheyAreRead) {
  for (const double metres : {0.0125, 0.25, 1.0, 1.2, 250.0, 12345.0})
    EXPECT_NEAR(parse_length_m(distance_text(metres)).value(), metres, 1e-6 * metres);
  EXPECT_EQ(distance_text(INFINITY), "infinity");
  EXPECT_EQ(distance_text(0.25), "250mm");
}

TEST(NumberList, TakesRangesFromStartByStepToStop) {
  EXPECT_EQ(parse_number_list("0,7,14", "fields"), (std::vector<double>{0, 7, 14}));
  EXPECT_EQ(parse_number_list("0:5:20", "fields"), (std::vector<double>{0, 5, 10, 15, 20}));
  EXPECT_EQ(parse_number_list("1,4:-2:0", "fields"), (std::vector<double>{1, 4, 2, 0}));
  EXPECT_EQ(parse_number_list("3:1:3", "fields"), std::vector<double>{3});
  EXPECT_EQ(parse_number_list("0:0.1:0.3", "fields").size(), 4U);
}

TEST(NumberList, RefusesTheOtherOrderWithTheRightOne) {
  EXPECT_NE(
      complaint([] { parse_number_list("400:700:10", "wavelengths"); }).find("as 400:10:700, would be right"),
      std::string::npos);
  EXPECT_NE(
      complaint([] { parse_number_list("0.4:0.6:0.05", "vary"); }).find("as 0.4:0.05:0.6, would be right"),
      std::string::npos);
  // Nothing says which order this is, but one number is no range.
  EXPECT_NE(complaint([] { parse_number_list("1:4:2", "fields"); }).find("is no range"), std::string::npos);
  for (const char* wrong : {"", "1,", "a", "1:2", "1:0:2", "1:2:3:4", "0:1e-9:1"})
    EXPECT_NE(complaint([&] { parse_number_list(wrong, "fields"); }).find("start:step:stop"),
              std::string::npos)
        << wrong;
}

TEST(PixelSizes, AreColumnsTimesRows) {
  EXPECT_EQ(parse_grid_size("768x576", "size").columns, 768);
  EXPECT_EQ(parse_grid_size("768x576", "size").rows, 576);
  for (const char* wrong : {"", "768", "768x", "x576", "0x5", "-1x5", "1.5x2", "7x7x7"})
    EXPECT_NE(complaint([&] { parse_grid_size(wrong, "size"); }).find("768x576"), std::string::npos) << wrong;
}

}  // namespace
}  // namespace petzval
