// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/date_time.h>
#include <petzval/base/error.h>

namespace petzval {
namespace {

TEST(DateTime, IsReadAndWritten) {
  for (const char* text :
       {"2026-11-26 10:07:09.25", "2026:11:26 10:07:09.250000", "2026-11-26T10:07:09.25"}) {
    const DateTime time = parse_date_time(text);
    EXPECT_EQ(exif_date_time(time), "2026:11:26 10:07:09") << text;
    EXPECT_EQ(exif_subseconds(time), "250000") << text;
    EXPECT_EQ(iso_date_time(time), "2026-11-26T10:07:09.25") << text;
  }
  EXPECT_EQ(exif_subseconds(parse_date_time("2026-11-26 10:07:09")), "");
  EXPECT_EQ(iso_date_time(parse_date_time("1969-12-31 23:59:59.000001")), "1969-12-31T23:59:59.000001");
}

TEST(DateTime, GoesOn) {
  // Over midnight, the end of a leap year's February, the end of a year.
  EXPECT_EQ(exif_date_time(later(parse_date_time("2028-02-28 23:59:59"), 1)), "2028:02:29 00:00:00");
  EXPECT_EQ(exif_date_time(later(parse_date_time("2028-12-31 23:59:59.9"), 0.1)), "2029:01:01 00:00:00");
  EXPECT_EQ(iso_date_time(later(parse_date_time("2026-11-26 10:00:00"), 1.0 / 24)),
            "2026-11-26T10:00:00.041667");
}

TEST(DateTime, WhatIsNoneIsRefused) {
  for (const char* text :
       {"", "now", "2026-11-26", "2026-11-31 10:00:00", "2026-02-29 10:00:00", "2026-13-01 10:00:00",
        "2026-11-26 24:00:00", "2026-11-26 10:60:00", "2026-11-26 10:00:60", "0000:00:00 00:00:00",
        "2026-11-26 10:00:00.1234567", "2026-11-26 10:00:00Z", " 2026-11-26 10:00:00"})
    EXPECT_THROW(parse_date_time(text), InputError) << text;
}

}  // namespace
}  // namespace petzval
