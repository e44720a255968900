// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/units.h>
#include <petzval/base/wavelength.h>
#include <petzval/base/whole_file.h>
#include <petzval/lens/scatter.h>
#include <petzval/numeric/quadrature.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr double cc1246_slope = 0.926;
constexpr double cc1246_area_um2 = 1e11;
constexpr double lowest_level = 1, highest_level = 2000;
constexpr double most_dust_percent = 10, most_roughness_nm = 100, steepest_slope = -10;

/// π/4 ∫ d² dN over what N counts: discs of 1 µm to the level, in steps of log₁₀ d.
double covered_share(double level) {
  const double top = std::log10(level);
  if (!(top > 0)) return 0;
  constexpr int nodes = 64;
  const QuadratureRule rule = gauss_legendre(nodes, 0, top);
  const double ln10 = std::log(10.0);
  double sum = 0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double log_d = rule.nodes[i];
    const double larger = std::pow(10, cc1246_slope * (top * top - log_d * log_d));
    sum += rule.weights[i] * std::pow(10, 2 * log_d) * larger * 2 * cc1246_slope * log_d * ln10;
  }
  return pi / 4 * sum / cc1246_area_um2;
}

double number_of(const std::string& key, const std::string& value) {
  const std::optional<double> number = parse_number(value);
  if (!number)
    throw InputError(fmt::format("'{}' is no number; one would be right for {} (`scatter`)", quotable(value),
                                 quotable(key)));
  return *number;
}

void assign(Scatter& scatter, const std::string& key, const std::string& value) {
  if (key == "table")
    scatter.table = parse_scatter_table(read_whole_file(value, largest_text), value);
  else if (key == "roughness")
    scatter.roughness_nm = number_of(key, value);
  else if (key == "b0")
    scatter.b0_per_sr = number_of(key, value);
  else if (key == "l")
    scatter.l = number_of(key, value);
  else if (key == "s")
    scatter.s = number_of(key, value);
  else if (key == "wavelength")
    scatter.wavelength_nm = number_of(key, value);
  else if (key == "dust")
    scatter.dust_percent = number_of(key, value);
  else if (key == "level")
    scatter.cleanliness_level = number_of(key, value);
  else
    throw InputError(
        fmt::format("'{}' says nothing of scatter; roughness, b0, l, s, wavelength, table, dust and level do "
                    "(`scatter`)",
                    quotable(key)));
}

void validate_table(const std::vector<std::pair<double, double>>& table) {
  if (table.size() == 1) throw InputError("a table of one angle; two or more would be right");
  for (std::size_t i = 0; i < table.size(); ++i) {
    const auto& [angle_deg, bsdf] = table[i];
    if (!(angle_deg > 0 && angle_deg <= 90) || (i > 0 && !(angle_deg > table[i - 1].first)))
      throw InputError(fmt::format(
          "a table with an angle of {:g} degrees; increasing angles above 0 and up to 90 would be right",
          angle_deg));
    if (!(bsdf > 0 && std::isfinite(bsdf)))
      throw InputError(
          fmt::format("a BSDF of {:g} at {:g} degrees; more than 0 would be right", bsdf, angle_deg));
  }
}

}  // namespace

double Scatter::dust_share() const {
  constexpr double per_cent = 1e-2;
  return cleanliness_level ? covered_share(*cleanliness_level) : per_cent * dust_percent;
}

double Scatter::dust_level() const {
  if (cleanliness_level) return *cleanliness_level;
  const double share = dust_share();
  double low = lowest_level, high = highest_level;
  constexpr int halvings = 60;
  for (int i = 0; i < halvings; ++i) {
    const double middle = std::sqrt(low * high);
    (covered_share(middle) < share ? low : high) = middle;
  }
  return high;
}

void Scatter::validate() const {
  const int ways = (roughness_nm ? 1 : 0) + (b0_per_sr ? 1 : 0) + (table.empty() ? 0 : 1);
  if (ways > 1)
    throw InputError("a roughness, b0 and a table exclude each other; one of them would be right");
  if (!has_polish() && dust_percent == 0 && !cleanliness_level)
    throw InputError("nothing that scatters; a roughness, b0, a table or dust would be right");
  if (roughness_nm && !(*roughness_nm > 0 && *roughness_nm <= most_roughness_nm))
    throw InputError(fmt::format("a roughness of {:g} nm; more than 0 and up to {:g} would be right",
                                 *roughness_nm, most_roughness_nm));
  if (b0_per_sr && !(*b0_per_sr > 0 && std::isfinite(*b0_per_sr)))
    throw InputError(fmt::format("b0 of {:g} per sr; more than 0 would be right", *b0_per_sr));
  constexpr double least_l = 1e-5;
  if (!(l >= least_l && l <= 1))
    throw InputError(fmt::format("l of {:g}; {:g} to 1 would be right", l, least_l));
  if (!(s >= steepest_slope && s <= 0))
    throw InputError(fmt::format("s of {:g}; {:g} to 0 would be right", s, steepest_slope));
  if (const std::string wrong = wavelength_fault(wavelength_nm); !wrong.empty()) throw InputError(wrong);
  validate_table(table);
  if (!(dust_percent >= 0 && dust_percent <= most_dust_percent))
    throw InputError(fmt::format("dust on {:g} % of the surface; 0 to {:g} would be right", dust_percent,
                                 most_dust_percent));
  if (!cleanliness_level) return;
  if (dust_percent != 0) throw InputError("dust by its share and by a level; one of the two would be right");
  if (!(*cleanliness_level > lowest_level && *cleanliness_level <= highest_level))
    throw InputError(fmt::format("a cleanliness level of {:g}; more than {:g} and up to {:g} would be right",
                                 *cleanliness_level, lowest_level, highest_level));
}

Scatter parse_scatter(const std::string& text) {
  Scatter scatter;
  std::vector<std::string> seen;
  for (const std::string& part : split_at(text, ',')) {
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos)
      throw InputError(fmt::format(
          "'{}' says nothing of scatter; roughness=1.5 or roughness=1.5,dust=0.02 would be right (`scatter`)",
          quotable(part)));
    const std::string key = trimmed(part.substr(0, equals));
    if (std::ranges::find(seen, key) != seen.end())
      throw InputError(fmt::format("{} stands twice; once would be right (`scatter`)", quotable(key)));
    seen.push_back(key);
    assign(scatter, key, trimmed(part.substr(equals + 1)));
  }
  try {
    scatter.validate();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{} (`scatter`)", error.what()));
  }
  return scatter;
}

std::vector<std::pair<double, double>> parse_scatter_table(const std::string& text, const std::string& file) {
  std::vector<std::pair<double, double>> table;
  bool headed = false;
  for (const TextLine& line : text_lines(decoded_text(text))) {
    const std::string content = trimmed(line.text);
    if (content.empty() || content.front() == '#') continue;
    if (!headed && content != "angle_deg,bsdf_per_sr")
      throw InputError(file, line.number, "no table of scatter; its header must be angle_deg,bsdf_per_sr");
    if (!headed) {
      headed = true;
      continue;
    }
    const std::vector<std::string> cells = split_at(content, ',');
    const std::optional<double> angle = parse_number(trimmed(cells[0]));
    const std::optional<double> bsdf = cells.size() == 2 ? parse_number(trimmed(cells[1])) : std::nullopt;
    if (!angle || !bsdf)
      throw InputError(file, line.number, "an angle in degrees and a BSDF in 1/sr would be right");
    table.emplace_back(*angle, *bsdf);
  }
  try {
    validate_table(table);
  } catch (const InputError& error) {
    throw InputError(file, error.what());
  }
  if (table.empty()) throw InputError(file, "holds no BSDF; angle_deg,bsdf_per_sr and rows would be right");
  return table;
}

}  // namespace petzval
