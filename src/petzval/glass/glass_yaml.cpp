// SPDX-License-Identifier: BSD-3-Clause
// Glasses of refractiveindex.info.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/glass/glass_file.h>
#include <petzval/glass/yaml_document.h>

#include <algorithm>

namespace petzval {

namespace {

constexpr int nm_per_um_power = 3;

class GlassYamlReader {
 public:
  GlassYamlReader(const std::string& file, Glass& glass) : file_(file), glass_(glass) {}

  void read(const YamlNode& root) {
    const YamlNode* data = root.find("DATA");
    if (!data || data->kind != YamlNode::Kind::list || data->items.empty())
      throw InputError(file_, "has no list DATA; a file of refractiveindex.info has one");
    for (const YamlNode& item : data->items) read_item(item);
    if (glass_.formula == 0 && glass_.n_table.empty())
      throw InputError(file_, data->line,
                       "gives no index; \"formula …\", \"tabulated n\" or \"tabulated nk\" would");
    read_properties(root);
    check_formula(*data);
  }

 private:
  [[noreturn]] void fail(const YamlNode& node, const std::string& message) const {
    throw InputError(file_, node.line, message);
  }
  const YamlNode& member(const YamlNode& node, const char* key) const {
    const YamlNode* found = node.find(key);
    if (!found || found->kind != YamlNode::Kind::scalar) fail(node, fmt::format("has no {}", key));
    return *found;
  }
  /// Numbers parted by blanks.
  std::vector<double> numbers(const YamlNode& node, const char* what) const {
    std::vector<double> values;
    for (const std::string& word : split_words(node.text)) {
      const auto value = parse_number(word);
      if (!value) fail(node, fmt::format("{} must be numbers, not \"{}\"", what, quotable(word)));
      values.push_back(*value);
    }
    return values;
  }
  double nanometres(const YamlNode& node, const std::string& word) const {
    const auto value = parse_scaled_number(word, nm_per_um_power);
    constexpr double shortest_nm = 1e-3, longest_nm = 1e9;
    if (!value || !(*value >= shortest_nm && *value <= longest_nm))
      fail(node, fmt::format("\"{}\" is not a wavelength in um", quotable(word)));
    return *value;
  }

  void read_item(const YamlNode& item) {
    const std::string type = trimmed(member(item, "type").text);
    if (type == "tabulated n" || type == "tabulated k" || type == "tabulated nk")
      return read_table(item, type);
    const std::string prefix = "formula ";
    const auto formula = type.compare(0, prefix.size(), prefix) == 0
                             ? parse_integer(type.substr(prefix.size()))
                             : std::nullopt;
    if (!formula || *formula < 1 || *formula > 9)
      fail(item, fmt::format("type \"{}\" is not known; formula 1 to 9 and tabulated n, k and nk are",
                             quotable(type)));
    if (glass_.formula != 0 || !glass_.n_table.empty()) fail(item, "gives the index a second time");
    glass_.formula = *formula;
    glass_.coefficients = numbers(member(item, "coefficients"), "coefficients");
    const YamlNode* range = item.find("wavelength_range");
    if (!range) range = item.find("range");
    if (!range) fail(item, "has no wavelength_range");
    const auto ends = split_words(range->text);
    if (ends.size() != 2) fail(*range, "wavelength_range must be two wavelengths in um");
    glass_.shortest_nm = nanometres(*range, ends[0]);
    glass_.longest_nm = nanometres(*range, ends[1]);
    if (!(glass_.shortest_nm < glass_.longest_nm))
      fail(*range, "wavelength_range must have its shorter end first");
  }

  void read_table(const YamlNode& item, const std::string& type) {
    const YamlNode& data = member(item, "data");
    const bool has_n = type != "tabulated k", has_k = type != "tabulated n";
    if (has_n && (glass_.formula != 0 || !glass_.n_table.empty()))
      fail(item, "gives the index a second time");
    const std::size_t columns = 1 + has_n + has_k;
    int line = data.line;  // a literal block begins on the line after its mark
    std::vector<std::pair<double, double>> n, k;
    for (const TextLine& row : text_lines(data.text)) {
      ++line;
      if (row.words.empty()) continue;
      std::vector<double> values;
      for (std::size_t i = 1; i < std::min(row.words.size(), columns); ++i)
        if (const auto value = parse_number(row.words[i])) values.push_back(*value);
      if (row.words.size() < columns || values.size() + 1 != columns)
        throw InputError(file_, line, fmt::format("a row of \"{}\" has {} numbers", type, columns));
      const double wavelength_nm = nanometres(data, row.words[0]);
      if (has_n) n.emplace_back(wavelength_nm, values[0]);
      if (has_k) k.emplace_back(wavelength_nm, values.back());
    }
    if (has_n) glass_.n_table = increasing(item, std::move(n), 1e-3);
    if (has_k) glass_.k_table = increasing(item, std::move(k), 0);
    if (!has_n) return;
    glass_.shortest_nm = glass_.n_table.front().first;
    glass_.longest_nm = glass_.n_table.back().first;
  }
  std::vector<std::pair<double, double>> increasing(const YamlNode& item,
                                                    std::vector<std::pair<double, double>> table,
                                                    double least) const {
    if (table.empty()) fail(item, "an empty table");
    std::stable_sort(table.begin(), table.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    table.erase(std::unique(table.begin(), table.end(),
                            [](const auto& a, const auto& b) { return a.first == b.first; }),
                table.end());
    constexpr double largest = 100;
    for (const auto& [wavelength_nm, value] : table)
      if (!(value >= least && value <= largest))
        fail(item, fmt::format("a table with the value {} at {} nm", value, wavelength_nm));
    return table;
  }

  void read_properties(const YamlNode& root) {
    for (const char* section : {"PROPERTIES", "SPECS", "CONDITIONS"}) {
      const YamlNode* node = root.find(section);
      if (!node) continue;
      const auto stated = [&](const char* key, std::optional<double>& value) {
        const YamlNode* entry = node->find(key);
        if (entry && parse_number(trimmed(entry->text))) value = parse_number(trimmed(entry->text));
      };
      stated("nd", glass_.stated_nd);
      stated("Vd", glass_.stated_vd);
      const auto truth = [&](const char* key, bool& value) {
        if (const YamlNode* entry = node->find(key)) value = trimmed(entry->text) == "true";
      };
      truth("n_is_absolute", glass_.absolute);
      truth("wavelength_is_vacuum", glass_.vacuum_wavelengths);
      if (const YamlNode* status = node->find("glass_status"))
        glass_.status = quotable(trimmed(status->text));
    }
  }

  /// The formula says so itself when its coefficients cannot be.
  void check_formula(const YamlNode& data) const {
    if (glass_.formula == 0) return;
    try {
      check_dispersion_formula(glass_.formula, glass_.coefficients);
    } catch (const InputError& error) {
      throw InputError(file_, data.line, error.what());
    }
  }

  const std::string& file_;
  Glass& glass_;
};

}  // namespace

GlassFile read_glass_yaml(std::string_view bytes, const std::string& file, const std::string& catalogue,
                          const std::string& name) {
  Glass glass;
  glass.catalogue = catalogue;
  glass.name = name;
  GlassYamlReader(file, glass).read(parse_yaml(decoded_text(bytes), file));
  return {{std::move(glass)}, {}};
}

}  // namespace petzval
