// SPDX-License-Identifier: BSD-3-Clause
// The packed catalogue against the YAML files that it was made from, read a second time and in another way.
// The files are not part of the repository: they are looked for in ../shared/data/glass beside the checkout.
#include <gtest/gtest.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/whole_file.h>
#include <petzval/glass/catalogue.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>

namespace petzval {
namespace {

namespace fs = std::filesystem;

std::vector<double> numbers_in(const std::string& text) {
  std::istringstream words(text);
  std::vector<double> numbers;
  for (std::string word; words >> word;) {
    char* end = nullptr;
    numbers.push_back(std::strtod(word.c_str(), &end));
    if (*end != '\0') return {};
  }
  return numbers;
}

/// What one file says, keys in the order in which they come; rows of numbers follow the kind of their table.
struct Source {
  std::map<std::string, std::vector<double>> numbers;
  int formula = 0;
  std::vector<std::vector<double>> rows;
  bool has_n_rows = false, has_k_rows = false;
};

/// Line by line, by key; takes no notice of how the lines nest, except that data end where CONDITIONS begin.
Source read_source(const fs::path& path) {
  Source source;
  std::istringstream lines(read_whole_file(path.string()));
  bool in_data = false, formula_seen = false;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line[0] != ' ') in_data = line.starts_with("DATA");
    const std::size_t colon = line.find(": ");
    const std::size_t first = line.find_first_not_of(" -");
    const std::string key = colon == line.npos ? "" : line.substr(first, colon - first);
    const std::string value = colon == line.npos ? "" : line.substr(colon + 2);
    if (in_data && key == "type") {
      if (value.starts_with("formula")) source.formula = std::stoi(value.substr(8));
      source.has_n_rows = source.has_n_rows || value == "tabulated nk";
      source.has_k_rows = source.has_k_rows || value.starts_with("tabulated");
    } else if (key == "nd" || key == "Vd" || (in_data && key == "wavelength_range")) {
      source.numbers[key] = numbers_in(value);
    } else if (in_data && key == "coefficients" && !formula_seen) {
      source.numbers[key] = numbers_in(value);
      formula_seen = true;
    } else if (in_data && colon == line.npos) {
      if (auto row = numbers_in(line); row.size() >= 2) source.rows.push_back(std::move(row));
    }
  }
  return source;
}

/// Wavelengths come in µm: 1000 times the parsed number is within one rounding of the decimal.
void expect_table(const std::vector<std::pair<double, double>>& table, const Source& source,
                  std::size_t column) {
  auto rows = source.rows;
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());  // one row of one file is there twice
  ASSERT_EQ(table.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_DOUBLE_EQ(table[i].first, 1000 * rows[i][0]);
    EXPECT_EQ(table[i].second, rows[i][column]);
  }
}

void expect_same(const Glass& glass, const Source& source) {
  EXPECT_EQ(glass.formula, source.formula);
  const auto listed = [&](const char* key) {
    const auto found = source.numbers.find(key);
    return found == source.numbers.end() ? std::vector<double>{} : found->second;
  };
  EXPECT_EQ(glass.coefficients, listed("coefficients"));
  EXPECT_EQ(glass.stated_nd.value_or(0), listed("nd").empty() ? 0 : listed("nd")[0]);
  EXPECT_EQ(glass.stated_vd.value_or(0), listed("Vd").empty() ? 0 : listed("Vd")[0]);
  std::vector<double> range = listed("wavelength_range");
  if (source.has_n_rows) range = {source.rows.front()[0], source.rows.back()[0]};
  ASSERT_EQ(range.size(), 2u);
  EXPECT_DOUBLE_EQ(glass.shortest_nm, 1000 * range[0]);
  EXPECT_DOUBLE_EQ(glass.longest_nm, 1000 * range[1]);
  if (source.has_n_rows) expect_table(glass.n_table, source, 1);
  const std::size_t k_column = source.has_n_rows ? 2 : 1;
  const bool negative =
      std::any_of(source.rows.begin(), source.rows.end(), [&](const auto& row) { return row[k_column] < 0; });
  if (!source.has_k_rows || negative) {
    EXPECT_TRUE(glass.k_table.empty()) << "extinction below zero is left out";
  } else {
    expect_table(glass.k_table, source, k_column);
  }
}

TEST(Database, IsPackedToTheLastDigit) {
  const char* elsewhere = std::getenv("PETZVAL_SHARED");
  const fs::path tree =
      (elsewhere ? fs::path(elsewhere) : fs::path(data_directory()) / ".." / ".." / "shared") / "data" /
      "glass";
  if (!fs::is_directory(tree)) GTEST_SKIP() << "the refractiveindex.info files are not beside the checkout";
  int compared = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(tree)) {
    const fs::path& path = entry.path();
    if (path.extension() != ".yml" || path.stem().string().ends_with("__about")) continue;
    const std::string name = path.parent_path().filename().string() + ":" + path.stem().string();
    SCOPED_TRACE(name);
    expect_same(*GlassCatalogue::bundled().find(name), read_source(path));
    ++compared;
  }
  EXPECT_EQ(compared, 1627) << "1609 glasses of six makers and 18 polymers";
}

}  // namespace
}  // namespace petzval
