// SPDX-License-Identifier: BSD-3-Clause
#include "catalogue_bytes.h"

#include <gtest/gtest.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/glass/byte_reader.h>
#include <petzval/glass/packed_catalogue.h>

#include <cmath>
#include <random>

namespace petzval {
namespace {

using namespace testing;

/// Opens and decodes everything, and asks each glass for indices: what a reader of the file can do at all.
/// \return whether the file was taken; anything but InputError fails the test.
bool survives(const std::string& bytes) {
  try {
    const PackedCatalogue catalogue(bytes, "fixture.pgc");
    for (std::size_t i = 0; i < catalogue.glass_count(); ++i) {
      const Glass glass = catalogue.glass(i);
      EXPECT_TRUE(std::isfinite(glass.index(0.5 * (glass.shortest_nm + glass.longest_nm))));
      EXPECT_TRUE(std::isfinite(glass.extinction(500)));
    }
    return true;
  } catch (const InputError&) {
    return false;
  }
}

TEST(PackedCatalogue, ReadsAFileWrittenAfterItsDescription) {
  const PackedCatalogue catalogue(small_catalogue(), "fixture.pgc");
  ASSERT_EQ(catalogue.glass_count(), 5u);
  ASSERT_EQ(catalogue.names().size(), 6u);
  EXPECT_EQ(catalogue.names()[0].full, "ONE:Alias");
  EXPECT_FALSE(catalogue.names()[0].proper);
  EXPECT_TRUE(catalogue.names()[1].proper);
  const Glass crown = catalogue.glass(0);
  EXPECT_EQ(crown.full_name(), "ONE:Crown");
  EXPECT_EQ(crown.formula, 2);
  EXPECT_EQ(crown.status, "preferred");
  EXPECT_EQ(crown.stated_nd, 1.5);
  EXPECT_EQ(crown.stated_vd, 64.0);
  EXPECT_EQ(crown.coefficients, (std::vector<double>{0, 1.25, 0.01}));
  EXPECT_EQ(crown.shortest_nm, 400);
  EXPECT_EQ(crown.longest_nm, 700);
  EXPECT_EQ(crown.k_table, (Material::Table{{400, 3e-8}, {500, 1e-8}, {700, 2e-8}}));
  EXPECT_NEAR(crown.index(500), std::sqrt(1 + 1.25 * 0.25 / 0.24), 1e-15);
  const Glass table = catalogue.glass(1);
  EXPECT_EQ(table.index(500), 1.55);
  EXPECT_FALSE(table.stated_nd);
  EXPECT_EQ(catalogue.glass(2).index(500), 1.5);
  EXPECT_DOUBLE_EQ(catalogue.glass(3).index(500), 1.52);
}

TEST(PackedCatalogue, ChecksumIsThatOfZlib) {
  EXPECT_EQ(crc32("123456789"), 0xCBF43926u);  // the check value in the catalogue of CRC parameters
}

// With one power of ten, mantissas below 2⁵³ and |exponent| ≤ 22, division is exact to the last bit; strtod
// agrees.
TEST(PackedCatalogue, NumbersAreTheNearestDoubles) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 2000; ++i) {
    const auto mantissa = static_cast<long long>(random() >> (11 + random() % 40));
    const int exponent = static_cast<int>(random() % 45) - 22;
    GlassBytes glass;
    glass.coefficients = {{mantissa, exponent}};
    const PackedCatalogue catalogue(catalogue_bytes({{"A:B", 0}}, {glass}), "fixture.pgc");
    EXPECT_EQ(catalogue.glass(0).coefficients[0],
              std::strtod((std::to_string(mantissa) + "e" + std::to_string(exponent)).c_str(), nullptr));
  }
}

TEST(PackedCatalogue, EveryTruncationIsAnError) {
  const std::string whole = small_catalogue();
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_FALSE(survives(whole.substr(0, length))) << length;
    if (length < 12) continue;  // no room for a checksum
    EXPECT_FALSE(survives(with_checksum(whole.substr(0, length)))) << length;
  }
  EXPECT_FALSE(survives(whole + '\0'));
  EXPECT_FALSE(survives(with_checksum(whole + '\0')));
}

TEST(PackedCatalogue, EveryFlippedBitIsAnError) {
  const std::string whole = small_catalogue();
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string flipped = whole;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ 1 << bit % 8);
    EXPECT_FALSE(survives(flipped)) << bit;
  }
}

// A liar mends the checksum. Then a flipped bit may make another valid catalogue, but never anything worse
// than an InputError.
TEST(PackedCatalogue, LiesWithAGoodChecksumDoNoHarm) {
  const std::string whole = small_catalogue();
  int refused = 0;
  for (std::size_t bit = 8 * 12; bit < 8 * whole.size(); ++bit) {
    std::string flipped = whole;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ 1 << bit % 8);
    refused += !survives(with_checksum(flipped));
  }
  EXPECT_GT(refused, 100);
  std::mt19937_64 random(11);
  for (int i = 0; i < 20000; ++i) {
    std::string garbled = whole;
    for (std::uint64_t changes = 1 + random() % 8; changes > 0; --changes)
      garbled[12 + random() % (whole.size() - 12)] = static_cast<char>(random());
    survives(with_checksum(garbled));
  }
}

TEST(PackedCatalogue, BundledFileDamagedAnywhereIsAnError) {
  const std::string whole = read_whole_file(data_directory() + "/glass/catalogue.pgc");
  ASSERT_TRUE(survives(whole));
  std::mt19937_64 random(13);
  for (int i = 0; i < 200; ++i) {
    EXPECT_FALSE(survives(whole.substr(0, random() % whole.size())));
    std::string flipped = whole;
    const std::uint64_t bit = random() % (8 * whole.size());
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ 1 << bit % 8);
    EXPECT_FALSE(survives(flipped)) << bit;
  }
}

// Counts that a reader might allocate by.
TEST(PackedCatalogue, AbsurdCountsAreRefusedBeforeAllocation) {
  constexpr std::uint32_t many = 0xFFFFFFFFu;
  constexpr std::uint64_t huge = std::uint64_t{1} << 60;
  const std::string name = text_bytes("A:B") + varint_bytes(0);
  EXPECT_FALSE(survives(framed(many, 0, "")));
  EXPECT_FALSE(survives(framed(0, many, "")));
  EXPECT_FALSE(survives(framed(1, 1, varint_bytes(huge))));
  EXPECT_FALSE(survives(framed(1, 1, text_bytes("A:B") + varint_bytes(huge))));
  EXPECT_FALSE(survives(framed(1, 1, name + varint_bytes(huge))));
  const std::string up_to_counts = record_bytes(GlassBytes{}).substr(0, 3 + 4 * 2);
  EXPECT_FALSE(survives(framed(1, 1, name + text_bytes(up_to_counts + varint_bytes(huge)))));
  EXPECT_FALSE(
      survives(framed(1, 1, name + text_bytes(up_to_counts + varint_bytes(0) + varint_bytes(huge)))));
  EXPECT_FALSE(survives(framed(1, 1, name + text_bytes(std::string(40, '\xFF')))))
      << "a number without an end";
}

TEST(PackedCatalogue, RefusesGlassesThatMakeNoSense) {
  GlassBytes good;
  good.coefficients = {{0, 0}, {125, -2}, {1, -2}};
  good.k_table = {{1, {40, 50}}, {-8, {1, 2}}};
  const auto taken = [](const GlassBytes& glass) { return survives(catalogue_bytes({{"A:B", 0}}, {glass})); };
  ASSERT_TRUE(taken(good));
  const auto with = [&](auto change) {
    GlassBytes glass = good;
    change(glass);
    return taken(glass);
  };
  EXPECT_FALSE(with([](GlassBytes& g) { g.formula = 10; }));
  EXPECT_FALSE(with([](GlassBytes& g) { g.formula = 0; })) << "a table without a table";
  EXPECT_FALSE(with([](GlassBytes& g) { g.status = 4; }));
  EXPECT_FALSE(with([](GlassBytes& g) { g.coefficients.pop_back(); }));
  EXPECT_FALSE(with([](GlassBytes& g) { g.coefficients[1] = {1LL << 53, 0}; }));
  EXPECT_FALSE(with([](GlassBytes& g) { g.coefficients[1].exponent = 23; }));
  EXPECT_FALSE(with([](GlassBytes& g) { g.coefficients[1].exponent = -128; }));
  EXPECT_FALSE(with([](GlassBytes& g) { g.longest_nm = {3, 2}; })) << "ends before it begins";
  EXPECT_FALSE(with([](GlassBytes& g) { g.shortest_nm = {0, 0}; }));
  EXPECT_FALSE(with([](GlassBytes& g) { g.k_table.first.mantissas = {50, 40}; }));
  EXPECT_FALSE(with([](GlassBytes& g) { g.k_table.first.mantissas = {-40, 50}; }));
  EXPECT_FALSE(with([](GlassBytes& g) { g.k_table.second.mantissas = {1, -2}; })) << "light out of nothing";
  EXPECT_FALSE(with([](GlassBytes& g) { g.k_table.second.mantissas = {1LL << 53, 0}; }));
  EXPECT_FALSE(with([](GlassBytes& g) { g.name = 1; }));
}

TEST(PackedCatalogue, RefusesNamesThatMakeNoSense) {
  GlassBytes glass;
  glass.coefficients = {{0, 0}, {125, -2}, {1, -2}};
  const auto taken = [&](const std::vector<std::pair<std::string, std::uint64_t>>& names) {
    return survives(catalogue_bytes(names, {glass}));
  };
  ASSERT_TRUE(taken({{"A:B", 0}, {"A:C", 0}}));
  EXPECT_FALSE(taken({{"A:B", 0}, {"A:b", 0}})) << "the same name twice";
  EXPECT_FALSE(taken({{"A:C", 0}, {"A:B", 0}})) << "out of order";
  EXPECT_FALSE(taken({{"A:B", 1}}));
  for (const char* name : {"AB", ":B", "A:", ":", "", "A:B C", "A:\n", "A:\xC3\xA4"})
    EXPECT_FALSE(taken({{name, 0}})) << name;
}

TEST(PackedCatalogue, SaysWhatTheFileIsNot) {
  try {
    PackedCatalogue("GIF89a, say", "lens.gif");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "lens.gif: not a packed glass catalogue of this version (it would begin with PZGLASS1)");
  }
}

}  // namespace
}  // namespace petzval
