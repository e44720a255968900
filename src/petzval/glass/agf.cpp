// SPDX-License-Identifier: BSD-3-Clause
// Zemax glass catalogues.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/units.h>
#include <petzval/glass/glass_file.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// No glass is known at a picometre, nor at a millimetre.
constexpr double shortest_wavelength_nm = 1e-3, longest_wavelength_nm = 1e6;

/// A glass as its lines come in.
struct AgfGlass {
  int line = 0;  ///< of NM
  int formula = 0;
  std::vector<double> coefficients;
  bool has_range = false;
  Glass glass;
};

class AgfReader {
 public:
  AgfReader(const std::string& file, const std::string& catalogue) : file_(file), catalogue_(catalogue) {}

  void read(const TextLine& line) {
    const std::string& keyword = line.words.front();
    if (keyword == "NM") return begin(line);
    if (!current_) return;  // comments (CC) in front of the first glass
    if (keyword == "CD") take_coefficients(line);
    if (keyword == "LD") take_range(line);
    if (keyword == "IT") take_transmittance(line);
  }
  GlassFile finish() {
    end();
    if (result_.glasses.empty())
      throw InputError(file_, "holds no glass; a glass catalogue has lines NM, CD and LD for each");
    return std::move(result_);
  }

 private:
  double number(const TextLine& line, std::size_t i) const {
    const auto value = i < line.words.size() ? parse_number(line.words[i]) : std::nullopt;
    if (!value)
      throw InputError(file_, line.number,
                       fmt::format("value {} of {} must be a number, not \"{}\"", i, line.words[0],
                                   quotable(i < line.words.size() ? line.words[i] : "")));
    return *value;
  }
  void begin(const TextLine& line) {
    end();
    AgfGlass next;
    next.line = line.number;
    if (line.words.size() < 3) throw InputError(file_, line.number, "NM must have a name and a formula");
    next.glass.catalogue = catalogue_;
    next.glass.name = line.words[1];
    if (quotable(next.glass.name) != next.glass.name || next.glass.name.find(':') != std::string::npos)
      throw InputError(file_, line.number,
                       fmt::format("\"{}\" is not the name of a glass", quotable(next.glass.name)));
    const double formula = number(line, 2);
    next.formula = formula == std::floor(formula) && std::abs(formula) < 100 ? static_cast<int>(formula) : 0;
    const auto stated = [&](std::size_t i) {
      const auto value = i < line.words.size() ? parse_number(line.words[i]) : std::nullopt;
      return value && *value > 0 ? value : std::nullopt;
    };
    next.glass.stated_nd = stated(4);
    next.glass.stated_vd = stated(5);
    constexpr const char* statuses[] = {"standard", "preferred", "obsolete", "special", "melt"};
    const auto status = line.words.size() > 7 ? parse_integer(line.words[7]) : std::nullopt;
    if (status && *status >= 0 && *status < 5) next.glass.status = statuses[*status];
    current_ = std::move(next);
  }
  void take_coefficients(const TextLine& line) {
    constexpr std::size_t most_coefficients = 12;
    current_->coefficients.clear();
    for (std::size_t i = 1; i < std::min(line.words.size(), most_coefficients + 1); ++i)
      current_->coefficients.push_back(number(line, i));
    current_->coefficients.resize(most_coefficients, 0);
  }
  void take_range(const TextLine& line) {
    current_->glass.shortest_nm = parse_scaled(line, 1);
    current_->glass.longest_nm = parse_scaled(line, 2);
    if (!(current_->glass.shortest_nm >= shortest_wavelength_nm &&
          current_->glass.shortest_nm < current_->glass.longest_nm &&
          current_->glass.longest_nm < longest_wavelength_nm))
      throw InputError(file_, line.number, "LD must be two wavelengths in um, the shorter one first");
    current_->has_range = true;
  }
  double parse_scaled(const TextLine& line, std::size_t i) const {
    number(line, i);  // complains if it is not a number
    constexpr int nm_per_um_power = 3;
    return parse_scaled_number(line.words[i], nm_per_um_power).value_or(0);
  }
  /// Wavelength, internal transmittance, thickness in mm, from which k follows: T = exp(−4πk d/λ).
  void take_transmittance(const TextLine& line) {
    constexpr double least_transmittance = 1e-10;
    const double wavelength_nm = parse_scaled(line, 1), transmittance = number(line, 2);
    const double thickness_mm = number(line, 3);
    if (wavelength_nm == 0 || thickness_mm == 0) return;  // makers fill up with zeros
    constexpr double thinnest_mm = 1e-3, thickest_mm = 1e5;
    if (!(wavelength_nm >= shortest_wavelength_nm && wavelength_nm < longest_wavelength_nm) ||
        !(thickness_mm >= thinnest_mm && thickness_mm <= thickest_mm))
      throw InputError(file_, line.number,
                       "IT must be a wavelength in um, a transmittance and a thickness in mm");
    const double t = std::clamp(transmittance, least_transmittance, 1.0);
    const double k = -std::log(t) * wavelength_nm * mm_per_nm / (4 * pi * thickness_mm);
    current_->glass.k_table.emplace_back(wavelength_nm, k);
  }
  void end() {
    if (!current_) return;
    AgfGlass done = std::move(*current_);
    current_.reset();
    if (done.formula < 1 || done.formula > 13) {
      result_.notes.push_back(
          fmt::format("{}:{}: {} is left out: its dispersion formula is not one of 1 to 13", file_, done.line,
                      done.glass.name));
      return;
    }
    const auto lacks = [&](const char* keyword) {
      throw InputError(file_, done.line, fmt::format("{} has no {}", done.glass.name, keyword));
    };
    if (done.coefficients.empty()) lacks("coefficients (CD)");
    if (!done.has_range) lacks("range of wavelengths (LD)");
    translate(done);
    auto& table = done.glass.k_table;
    std::stable_sort(table.begin(), table.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    table.erase(std::unique(table.begin(), table.end(),
                            [](const auto& a, const auto& b) { return a.first == b.first; }),
                table.end());
    result_.glasses.push_back(std::move(done.glass));
  }
  void translate(AgfGlass& done) const;

  const std::string& file_;
  const std::string& catalogue_;
  std::optional<AgfGlass> current_;
  GlassFile result_;
};

/// Each of the 13 formulas is one of refractiveindex.info with its coefficients in another order (Zemax
/// OpticStudio, "Glass dispersion formulas"; λ in µm throughout).
void AgfReader::translate(AgfGlass& done) const {
  const std::vector<double>& c = done.coefficients;
  Glass& glass = done.glass;
  const auto powers = [&](std::initializer_list<int> exponents) {
    glass.formula = 3;
    glass.coefficients = {c[0]};
    std::size_t i = 1;
    for (const int exponent : exponents) {
      glass.coefficients.push_back(c[i++]);
      glass.coefficients.push_back(exponent);
    }
  };
  const auto sellmeier = [&](std::size_t terms) {
    glass.formula = 2;
    glass.coefficients.assign(1, 0.0);
    glass.coefficients.insert(glass.coefficients.end(), c.begin(),
                              c.begin() + static_cast<std::ptrdiff_t>(2 * terms));
  };
  const auto rational = [&](std::vector<double> coefficients) {
    glass.formula = 4;
    glass.coefficients = std::move(coefficients);
  };
  switch (done.formula) {
    case 1:  // Schott: n² = a₀ + a₁λ² + a₂λ⁻² + a₃λ⁻⁴ + a₄λ⁻⁶ + a₅λ⁻⁸
      return powers({2, -2, -4, -6, -8});
    case 2:  // Sellmeier 1
      return sellmeier(3);
    case 3:  // Herzberger: n = A + BL + CL² + Dλ² + Eλ⁴ + Fλ⁶, L = 1/(λ² − 0.028)
      glass.formula = 7;
      glass.coefficients.assign(c.begin(), c.begin() + 6);
      return;
    case 4:  // Sellmeier 2: n² − 1 = A + B₁λ²/(λ² − λ₁²) + B₂/(λ² − λ₂²)
      return rational({1 + c[0], c[1], 2, c[2], 2, c[3], 0, c[4], 2});
    case 5:  // Conrady: n = n₀ + A/λ + B/λ^3.5
      glass.formula = 5;
      glass.coefficients = {c[0], c[1], -1, c[2], -3.5};
      return;
    case 6:  // Sellmeier 3
      return sellmeier(4);
    case 7:  // Handbook of Optics 1: n² = A + B/(λ² − C) − Dλ²
      return rational({c[0], c[1], 0, c[2], 1, 0, 0, 0, 1, -c[3], 2});
    case 8:  // Handbook of Optics 2: n² = A + Bλ²/(λ² − C) − Dλ²
      return rational({c[0], c[1], 2, c[2], 1, 0, 0, 0, 1, -c[3], 2});
    case 9:  // Sellmeier 4: n² = A + Bλ²/(λ² − C) + Dλ²/(λ² − E)
      return rational({c[0], c[1], 2, c[2], 1, c[3], 2, c[4], 1});
    case 10:  // Extended
      return powers({2, -2, -4, -6, -8, -10, -12});
    case 11:  // Sellmeier 5
      return sellmeier(5);
    case 12:  // Extended 2
      return powers({2, -2, -4, -6, -8, 4, 6});
    default:  // Extended 3
      return powers({2, 4, -2, -4, -6, -8, -10, -12});
  }
}

}  // namespace

GlassFile read_agf(std::string_view bytes, const std::string& file, const std::string& catalogue) {
  AgfReader reader(file, catalogue);
  for (const TextLine& line : text_lines(decoded_text(bytes)))
    if (!line.words.empty()) reader.read(line);
  return reader.finish();
}

}  // namespace petzval
