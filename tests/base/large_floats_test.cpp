// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/large_floats.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <string>

using petzval::LargeFloats;

namespace {

constexpr std::size_t count = std::size_t{4} << 20;  // 16 MiB

/// Of this process, pages of files included [bytes].
std::size_t resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  std::size_t size = 0, resident = 0;
  statm >> size >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace

TEST(LargeFloats, BeginAtZeroAndStayInMemoryWhenFew) {
  const LargeFloats few(1000);
  EXPECT_FALSE(few.in_file());
  EXPECT_EQ(few.size(), 1000U);
  EXPECT_TRUE(std::all_of(few.all().begin(), few.all().end(), [](float value) { return value == 0; }));
}

TEST(LargeFloats, KeepTheirValuesWhenTheirMemoryIsGivenBack) {
  LargeFloats many(count, 1000);
  ASSERT_TRUE(many.in_file());
  EXPECT_EQ(std::accumulate(many.all().begin(), many.all().end(), 0.0F), 0.0F);
  std::iota(many.all().begin(), many.all().end(), 0.0F);  // exact up to 2^24
  const std::size_t before = resident_bytes();
  many.release_memory();
  EXPECT_LT(resident_bytes() + count * sizeof(float) / 2, before);
  EXPECT_EQ(many.all()[count - 1], static_cast<float>(count - 1));
  EXPECT_EQ(many.all()[12345], 12345.0F);
}

TEST(LargeFloats, GiveUpSomeValuesAndKeepTheOthers) {
  LargeFloats many(count, 1000), few(count);
  for (LargeFloats* floats : {&many, &few}) {
    std::iota(floats->all().begin(), floats->all().end(), 1.0F);
    floats->give_up(1001, 500000);  // begins and ends within a page
    EXPECT_EQ(floats->all()[1000], 1001.0F);
    EXPECT_EQ(floats->all()[501001], 501002.0F);
    EXPECT_EQ(floats->all()[count - 1], static_cast<float>(count));
  }
  EXPECT_EQ(few.all()[1001], 1002.0F);
  EXPECT_EQ(std::count(many.all().begin() + 1001, many.all().begin() + 501001, 0.0F), 500000);
}

TEST(LargeFloats, AreCopiedAndMoved) {
  LargeFloats many(5000, 1000);
  many.all()[4999] = 7;
  LargeFloats copy = many;
  copy.all()[0] = 1;
  EXPECT_EQ(many.all()[0], 0.0F);
  EXPECT_EQ(copy.all()[4999], 7.0F);
  const LargeFloats moved = std::move(copy);
  EXPECT_EQ(moved.all()[4999], 7.0F);
  many = moved;
  EXPECT_EQ(many.all()[0], 1.0F);
}

TEST(LargeFloats, StayInMemoryWhereNoFileCanBeMade) {
  const char* before = std::getenv("TMPDIR");
  const std::string kept = before != nullptr ? before : "";
  setenv("TMPDIR", "/nonexistent", 1);
  const LargeFloats many(5000, 1000);
  if (before != nullptr)
    setenv("TMPDIR", kept.c_str(), 1);
  else
    unsetenv("TMPDIR");
  EXPECT_FALSE(many.in_file());
  EXPECT_EQ(many.size(), 5000U);
}
