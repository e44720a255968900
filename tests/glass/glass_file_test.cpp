// SPDX-License-Identifier: BSD-3-Clause
// Glass files of the user's own. Right answers: the same glass in another form (the bundled catalogue), and
// each formula written out here by hand from its definition.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/glass/catalogue.h>
#include <petzval/glass/glass_file.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "scratch.h"

namespace petzval {
namespace {

// Two glasses with the makers' published constants.
constexpr const char* agf =
    "CC a small catalogue\n"
    "NM N-BK7 2 517642.251 1.5168 64.17 0 1 1\n"
    "ED 7.1 8.3 2.51 -0.0009 0\n"
    "CD 1.03961212E+00 6.00069867E-03 2.31792344E-01 2.00179144E-02 1.01046945E+00 1.03560653E+02\n"
    "TD 1.86E-06 1.31E-08 -1.37E-11 4.34E-07 6.27E-10 1.7E-01 2.0E+01\n"
    "OD 1.0 2.0 0.0 1.0 2.3 2.3\n"
    "LD 3.0E-01 2.5E+00\n"
    "IT 0.400 0.997 10.0\n"
    "IT 0.350 0.96724 25.0\n"
    "IT 0.300 0 10.0\n"
    "NM F2 2 620364.360 1.62004 36.37 0 0 4\n"
    "CD 1.34533359E+00 9.97743871E-03 2.09073176E-01 4.70450767E-02 9.37357162E-01 1.11886764E+02 0 0\n"
    "LD 0.32 2.5\n";

const GlassCatalogue& bundled_glasses() {
  return GlassCatalogue::bundled();
}

GlassFile read(const std::string& text) {
  return read_agf(text, "own.agf", "OWN");
}

std::string changed(const std::string& before, const std::string& after) {
  std::string text = agf;
  const std::size_t at = text.find(before);
  EXPECT_NE(at, text.npos) << before;
  return at == text.npos ? text : text.replace(at, before.size(), after);
}

std::string error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no InputError";
  return "";
}

void expect_mentions(const std::string& text, std::initializer_list<const char*> words) {
  for (const char* word : words) EXPECT_NE(text.find(word), text.npos) << word << " is not in: " << text;
}

TEST(AgfReader, ReadsGlassesAsTheBundledCatalogueHasThem) {
  const GlassFile file = read(agf);
  ASSERT_EQ(file.glasses.size(), 2u);
  EXPECT_TRUE(file.notes.empty());
  for (const Glass& glass : file.glasses) {
    const auto known = bundled_glasses().find("SCHOTT:" + glass.name);
    for (const double nm : {365.0, 486.1327, 587.5618, 1014.0, 2325.0})
      EXPECT_NEAR(glass.index(nm), known->index(nm), 1e-15)
          << glass.name;  // the same constants, one rounding
  }
  const Glass& crown = file.glasses[0];
  EXPECT_EQ(crown.full_name(), "OWN:N-BK7");
  EXPECT_EQ(crown.shortest_nm, 300);
  EXPECT_EQ(crown.longest_nm, 2500);
  EXPECT_EQ(crown.stated_nd, 1.5168);
  EXPECT_EQ(crown.status, "preferred");
  EXPECT_THROW(crown.index(299), InputError);
}

TEST(AgfReader, TransmittanceIsThatOfTheThicknessGiven) {
  const Glass crown = read(agf).glasses[0];
  EXPECT_NEAR(crown.transmittance_10mm(400), 0.997, 1e-14);
  EXPECT_NEAR(crown.transmittance_10mm(350), std::pow(0.96724, 10.0 / 25.0), 1e-14);
  EXPECT_NEAR(crown.transmittance_10mm(300), 1e-10, 1e-22);  // 0 is not printed any smaller
}

/// Formulas as Zemax numbers them, written out; λ in µm.
using Formula = std::function<double(const std::vector<double>&, double)>;

double sellmeier(const std::vector<double>& c, double l, int terms) {
  double sum = 1;
  for (int i = 0; i < terms; ++i) sum += c[2 * i] * l * l / (l * l - c[2 * i + 1]);
  return std::sqrt(sum);
}

const std::vector<Formula> formulas{
    [](const auto& c, double l) {
      return std::sqrt(c[0] + c[1] * l * l + c[2] / std::pow(l, 2) + c[3] / std::pow(l, 4) +
                       c[4] / std::pow(l, 6) + c[5] / std::pow(l, 8));
    },
    [](const auto& c, double l) { return sellmeier(c, l, 3); },
    [](const auto& c, double l) {
      const double f = 1 / (l * l - 0.028);
      return c[0] + c[1] * f + c[2] * f * f + c[3] * l * l + c[4] * std::pow(l, 4) + c[5] * std::pow(l, 6);
    },
    [](const auto& c, double l) {
      return std::sqrt(1 + c[0] + c[1] * l * l / (l * l - c[2] * c[2]) + c[3] / (l * l - c[4] * c[4]));
    },
    [](const auto& c, double l) { return c[0] + c[1] / l + c[2] / std::pow(l, 3.5); },
    [](const auto& c, double l) { return sellmeier(c, l, 4); },
    [](const auto& c, double l) { return std::sqrt(c[0] + c[1] / (l * l - c[2]) - c[3] * l * l); },
    [](const auto& c, double l) { return std::sqrt(c[0] + c[1] * l * l / (l * l - c[2]) - c[3] * l * l); },
    [](const auto& c, double l) {
      return std::sqrt(c[0] + c[1] * l * l / (l * l - c[2]) + c[3] * l * l / (l * l - c[4]));
    },
    [](const auto& c, double l) {
      double sum = c[0] + c[1] * l * l;
      for (int i = 2; i < 8; ++i) sum += c[i] * std::pow(l, -2 * (i - 1));
      return std::sqrt(sum);
    },
    [](const auto& c, double l) { return sellmeier(c, l, 5); },
    [](const auto& c, double l) {
      double sum = c[0] + c[1] * l * l;
      for (int i = 2; i < 6; ++i) sum += c[i] * std::pow(l, -2 * (i - 1));
      return std::sqrt(sum + c[6] * std::pow(l, 4) + c[7] * std::pow(l, 6));
    },
    [](const auto& c, double l) {
      double sum = c[0] + c[1] * l * l + c[2] * std::pow(l, 4);
      for (int i = 3; i < 9; ++i) sum += c[i] * std::pow(l, -2 * (i - 2));
      return std::sqrt(sum);
    }};

TEST(AgfReader, AllThirteenFormulas) {
  // Numbers that differ in every place, so that no two coefficients can be exchanged unnoticed.
  const std::vector<double> c{1.9, 0.021, 0.013, 0.0171, 0.0093, 0.0057, 0.0031, 0.0023, 0.0011, 0.0007};
  for (std::size_t number = 1; number <= formulas.size(); ++number) {
    std::string text = fmt::format("NM X {} 0 1.5 60 0 1\nCD", number);
    for (const double value : c) text += fmt::format(" {}", value);
    const Glass glass = read(text + "\nLD 0.4 2.0\n").glasses.at(0);
    for (const double l : {0.45, 0.7, 1.9})
      EXPECT_NEAR(glass.index(1000 * l), formulas[number - 1](c, l), 1e-14) << "formula " << number;
  }
}

TEST(AgfReader, NamesTheLine) {
  expect_mentions(error_of([] { read(changed("CD 1.03961212E+00", "CD 1.0x")); }), {"own.agf:4: ", "1.0x"});
  expect_mentions(error_of([] { read(changed("LD 3.0E-01 2.5E+00", "LD 3.0 2.5")); }), {"own.agf:7: LD"});
  expect_mentions(error_of([] { read(changed("LD 3.0E-01 2.5E+00\n", "")); }),
                  {"own.agf:2: N-BK7 has no range"});
  expect_mentions(error_of([] { read(changed("NM N-BK7 2", "NM N-BK7 two")); }), {"own.agf:2: "});
  expect_mentions(error_of([] { read("CC nothing\n"); }), {"own.agf: holds no glass"});
  const GlassFile left_out = read(changed("NM N-BK7 2", "NM N-BK7 17"));
  EXPECT_EQ(left_out.glasses.size(), 1u);
  ASSERT_EQ(left_out.notes.size(), 1u);
  expect_mentions(left_out.notes[0], {"own.agf:2: N-BK7"});
}

TEST(AgfReader, ReadsUtf16) {
  std::string utf16 = "\xFF\xFE";
  for (const char c : std::string(agf)) {
    utf16 += c;
    utf16 += '\0';
  }
  EXPECT_EQ(read(utf16).glasses.size(), 2u);
}

// --- refractiveindex.info

constexpr const char* yaml =
    "# a comment\n"
    "REFERENCES: |\n"
    "    somebody\n"
    "DATA:\n"
    "  - type: formula 2\n"
    "    wavelength_range: 0.3 2.5\n"
    "    coefficients: 0 1.03961212 0.00600069867 0.231792344 0.0200179144 1.01046945 103.560653\n"
    "  - type: tabulated k\n"
    "    data: |\n"
    "        0.4 1.0e-8\n"
    "        0.5 2.0e-8\n"
    "PROPERTIES:\n"
    "  nd: 1.5168\n"
    "  Vd: 64.17\n";

Glass read_yaml(std::string text) {
  return read_glass_yaml(text, "x.yml", "USER", "X").glasses.at(0);
}

std::string with_data(const std::string& data) {
  return fmt::format("DATA:\n{}", data);
}

TEST(GlassYaml, ReadsTheFileOfAGlass) {
  const Glass glass = read_yaml(yaml);
  const auto known = bundled_glasses().find("SCHOTT:N-BK7");
  for (const double nm : {300.0, 587.5618, 2500.0}) EXPECT_EQ(glass.index(nm), known->index(nm));
  EXPECT_DOUBLE_EQ(glass.extinction(450), 1.5e-8);
  EXPECT_EQ(glass.stated_vd, 64.17);
  EXPECT_EQ(glass.full_name(), "USER:X");
}

TEST(GlassYaml, AllNineFormulas) {
  const double l = 0.8, c[] = {1.9, 0.021, 0.013, 0.0171, 0.9, 0.0057, 1.1, 0.23, 1.3, 0.0007, -1.5};
  const auto index = [&](int formula, std::size_t count) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i) text += fmt::format(" {}", c[i]);
    return read_yaml(with_data(fmt::format(
                         "  - type: formula {}\n    wavelength_range: 0.5 1\n    coefficients:{}\n", formula,
                         text)))
        .index(1000 * l);
  };
  const double s = l * l, h = 1 / (s - 0.028);
  const double tolerance = 1e-14;  // a few roundings
  EXPECT_NEAR(index(1, 3), std::sqrt(1 + c[0] + c[1] * s / (s - c[2] * c[2])), tolerance);
  EXPECT_NEAR(index(2, 3), std::sqrt(1 + c[0] + c[1] * s / (s - c[2])), tolerance);
  EXPECT_NEAR(index(3, 3), std::sqrt(c[0] + c[1] * std::pow(l, c[2])), tolerance);
  EXPECT_NEAR(index(4, 11),
              std::sqrt(c[0] + c[1] * std::pow(l, c[2]) / (s - std::pow(c[3], c[4])) +
                        c[5] * std::pow(l, c[6]) / (s - std::pow(c[7], c[8])) + c[9] * std::pow(l, c[10])),
              tolerance);
  EXPECT_NEAR(index(5, 3), c[0] + c[1] * std::pow(l, c[2]), tolerance);
  EXPECT_NEAR(index(6, 3), 1 + c[0] + c[1] / (c[2] - 1 / s), tolerance);
  EXPECT_NEAR(index(7, 6), c[0] + c[1] * h + c[2] * h * h + c[3] * s + c[4] * s * s + c[5] * s * s * s,
              tolerance);
  EXPECT_NEAR(index(9, 6),
              std::sqrt(c[0] + c[1] / (s - c[2]) + c[3] * (l - c[4]) / (std::pow(l - c[4], 2) + c[5])),
              tolerance);
  // Formula 8 turned back: its right side from the index found.
  const double retro[] = {0.2, 0.021, 0.013, 0.01};
  const double n =
      read_yaml(with_data("  - type: formula 8\n    wavelength_range: 0.5 1\n    coefficients: 0.2 0.021 "
                          "0.013 0.01\n"))
          .index(1000 * l);
  EXPECT_NEAR((n * n - 1) / (n * n + 2), retro[0] + retro[1] * s / (s - retro[2]) + retro[3] * s, tolerance);
}

TEST(GlassYaml, Tables) {
  const Glass glass =
      read_yaml(with_data("  - type: tabulated nk\n    data: |\n        0.4 1.53 1e-7\n"
                          "        0.5 1.52 2e-7\n        0.7 1.51 3e-7\n"));
  EXPECT_EQ(glass.index(500), 1.52);
  EXPECT_EQ(glass.extinction(500), 2e-7);
  EXPECT_EQ(glass.longest_nm, 700);
  EXPECT_THROW(glass.index(701), InputError);
  const Glass n = read_yaml(with_data("  - type: tabulated n\n    data: \"0.4 1.53\\n0.5 1.52\"\n"));
  EXPECT_EQ(n.index(400), 1.53);
}

TEST(GlassYaml, AbsoluteIndicesBecomeRelativeToAir) {
  // B. Edlén's formula of 1966 for standard air at 15 °C, brought to 20 °C by the gas law; the two differ by
  // 2e-8.
  const double sigma_sq = 1 / (0.633 * 0.633);
  const double edlen = 1e-8 * (8342.54 + 2406147 / (130 - sigma_sq) + 15998 / (38.9 - sigma_sq));
  EXPECT_NEAR(air_index(633), 1 + edlen * 288.15 / 293.15, 5e-8);
  const std::string text =
      std::string(yaml) + "CONDITIONS:\n  n_is_absolute: true\n  wavelength_is_vacuum: true\n";
  const Glass glass = read_yaml(text), plain = read_yaml(yaml);
  const double air = air_index(600);
  EXPECT_NEAR(glass.index(600), plain.index(600 * air) / air, 1e-15);
  EXPECT_LT(glass.index(600), plain.index(600) - 4e-4);
}

TEST(GlassYaml, NamesTheLine) {
  const auto complaint = [](const std::string& text) { return error_of([&] { read_yaml(text); }); };
  expect_mentions(complaint("DATA: 3\n"), {"x.yml: has no list DATA"});
  expect_mentions(complaint(""), {"x.yml: "});
  expect_mentions(complaint(with_data("  - type: formula 12\n")), {"x.yml:2: ", "formula 12"});
  expect_mentions(complaint(with_data("  - type: formula 2\n    coefficients: 0 1 2\n")),
                  {"x.yml:2: has no wavelength"});
  expect_mentions(
      complaint(with_data("  - type: formula 2\n    wavelength_range: 1 2\n    coefficients: 0 1\n")),
      {"x.yml:2: dispersion formula 2 with 2"});
  expect_mentions(
      complaint(with_data("  - type: tabulated n\n    data: |\n        0.4 1.5\n        0.5 x\n")),
      {"x.yml:5: "});
  expect_mentions(complaint("DATA: [1, 2\n"), {"x.yml:", "is not YAML"});
  expect_mentions(complaint("a: &x [1]\nDATA: *x\n"), {"x.yml:2: ", "alias"});
  expect_mentions(complaint(with_data("  - type: tabulated k\n    data: |\n        0.4 1.5\n")),
                  {"gives no index"});
}

// --- searching them

TEST(OwnGlasses, AreFoundBeforeTheBundledOnes) {
  Glass mine;
  mine.catalogue = "SCHOTT";
  mine.name = "N-BK7";
  mine.formula = 5;
  mine.coefficients = {1.7};
  mine.shortest_nm = 300;
  mine.longest_nm = 900;
  Glass other = mine;
  other.catalogue = "OWN";
  other.name = "BRAND-NEW";
  const GlassCatalogue both = bundled_glasses().with({mine, other});
  EXPECT_EQ(both.find("SCHOTT:N-BK7")->index(500), 1.7);
  EXPECT_EQ(both.find("n-bk7", {"SCHOTT"})->index(500), 1.7);
  EXPECT_EQ(both.find("BRAND-NEW")->full_name(), "OWN:BRAND-NEW");
  EXPECT_EQ(both.find("SCHOTT:F2")->index(500), bundled_glasses().find("SCHOTT:F2")->index(500));
  EXPECT_NE(bundled_glasses().find("SCHOTT:N-BK7")->index(500), 1.7);  // the shared catalogue is as it was
  EXPECT_EQ(both.size(), bundled_glasses().size() + 1);                // one hides another
  EXPECT_TRUE(both.contains("OWN:brand-new"));
  EXPECT_EQ(both.names_spelled("BRANDNEW"), std::vector<std::string>{"OWN:BRAND-NEW"});
  EXPECT_EQ(both.names_spelled("NBK7").size(), bundled_glasses().names_spelled("NBK7").size());
  expect_mentions(error_of([&] { both.find("BRAND-NEWER"); }), {"OWN:BRAND-NEW"});
}

TEST(OwnGlasses, FilesAndFolders) {
  const test::Scratch scratch;
  const std::filesystem::path folder = scratch.folder() / "petzval-own-glasses";
  std::filesystem::create_directory(folder);
  std::ofstream(folder / "mine.agf") << agf;
  std::ofstream(folder / "X 1.yml") << yaml;
  std::ofstream(folder / "notes.txt") << "nothing";
  const GlassFile all = read_glass_files(folder.string());
  ASSERT_EQ(all.glasses.size(), 3u);
  EXPECT_EQ(all.glasses[0].full_name(), "PETZVAL-OWN-GLASSES:X_1");
  EXPECT_EQ(all.glasses[1].full_name(), "MINE:N-BK7");
  EXPECT_EQ(read_glass_files((folder / "X 1.yml").string()).glasses[0].full_name(), "USER:X_1");
  expect_mentions(error_of([&] { read_glass_files((folder / "notes.txt").string()); }),
                  {"notes.txt", ".agf"});
  expect_mentions(error_of([] { read_glass_files("/no/such/file.agf"); }), {"/no/such/file.agf"});
}

}  // namespace
}  // namespace petzval
