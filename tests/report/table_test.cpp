// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/report/table.h>

#include <cmath>

namespace petzval {
namespace {

TEST(Csv, HasUnitsAndEveryDigit) {
  const double third = 1.0 / 3;
  const Table table{{{"field", "deg", 1}, {"g_sensor", "sr", 4}, {"note", ""}},
                    {{0.0, third, std::string("axis")}, {14.0, std::nan(""), std::string("a, \"b\"")}}};
  const std::string csv = to_csv(table);
  EXPECT_EQ(csv, "field [deg],g_sensor [sr],note\n0,0.3333333333333333,axis\n14,,\"a, \"\"b\"\"\"\n");
  EXPECT_EQ(std::stod("0.3333333333333333"), third);
}

TEST(Csv, LeavesOutWhatIsForPrograms) {
  const Table table{{{"a"}, {"", "", 0, "lit"}, {"b"}}, {{1.0, true, false}}};
  EXPECT_EQ(to_csv(table), "a,b\n1,no\n");
}

TEST(Text, HasHeadingsAndNumbersToTheRight) {
  const Table table{{{"field", "deg", 1}, {"", "", 0, "lit"}, {"W", "µm", 2}},
                    {{0.0, true, -0.001}, {14.0, false, std::nan("")}}};
  EXPECT_EQ(to_text(table),
            "  field [deg]  W [µm]\n"
            "          0.0    0.00\n"
            "         14.0       -\n");
}

TEST(Text, FollowsTheColumnsOwnWishes) {
  Table table{{{"field", "deg", 1, "field", {"", "g", 12}},
               {"hue", "", 1, "hue", {.gap = "all"}},
               {"RMS radius", "µm", 1, "rms", {"RMS [um]", ".3f", 9}},
               {"x", "", 1, "x", {.hidden = true}},
               {"y"}},
              {{0.5, std::nan(""), -1.5, 2.0, 3.0}, {7.0, 1.0, 1.0, 1.0, 1.0}}};
  table.remarks[1] = "dark";
  EXPECT_EQ(to_text(table),
            " field [deg]  hue RMS [um]      y\n"
            "         0.5  all   -1.500  3.000\n"
            "           7  1.0     dark\n");
}

TEST(Csv, RefusesRaggedTables) {
  const Table table{{{"a", ""}, {"b", ""}}, {{1.0, 2.0}, {1.0}}};
  EXPECT_THROW(to_csv(table), InputError);
}

TEST(CellText, IsWhatPeopleRead) {
  EXPECT_EQ(cell_text(-10.674, 2),
            "\xE2\x88\x92"
            "10.67");
  EXPECT_EQ(cell_text(6.0, 3), "6.000");
  EXPECT_EQ(cell_text(-1e-9, 3), "0.000");
  EXPECT_EQ(cell_text(INFINITY, 3), "–");
  EXPECT_EQ(cell_text(std::string("text"), 3), "text");
}

}  // namespace
}  // namespace petzval
