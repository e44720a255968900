// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/glass/dispersion.h>
#include <petzval/numeric/interpolation.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr double um_per_nm = 1e-3;

double sellmeier_sum(std::span<const double> c, double lambda_um, bool squared) {
  const double lambda_sq = lambda_um * lambda_um;
  double sum = c[0];
  for (std::size_t i = 1; i + 1 < c.size(); i += 2) {
    const double resonance_sq = squared ? c[i + 1] * c[i + 1] : c[i + 1];
    sum += c[i] * lambda_sq / (lambda_sq - resonance_sq);
  }
  return sum;
}

double power_sum(std::span<const double> c, double lambda_um) {
  double sum = c[0];
  for (std::size_t i = 1; i + 1 < c.size(); i += 2) sum += c[i] * std::pow(lambda_um, c[i + 1]);
  return sum;
}

/// Coefficient i, 0 where the list has ended.
class Padded {
 public:
  explicit Padded(std::span<const double> coefficients) : c_(coefficients) {}
  double operator[](std::size_t i) const { return i < c_.size() ? c_[i] : 0; }

 private:
  std::span<const double> c_;
};

double rational_sum(std::span<const double> coefficients, double lambda_um) {
  const Padded c(coefficients);
  const double lambda_sq = lambda_um * lambda_um;
  double sum = c[0];
  for (const std::size_t i : {std::size_t{1}, std::size_t{5}})
    if (c[i] != 0) sum += c[i] * std::pow(lambda_um, c[i + 1]) / (lambda_sq - std::pow(c[i + 2], c[i + 3]));
  constexpr std::size_t first_power = 9;
  for (std::size_t i = first_power; i < coefficients.size(); i += 2)
    sum += c[i] * std::pow(lambda_um, c[i + 1]);
  return sum;
}

double gas_sum(std::span<const double> c, double lambda_um) {
  double sum = c[0];
  for (std::size_t i = 1; i + 1 < c.size(); i += 2) sum += c[i] / (c[i + 1] - 1 / (lambda_um * lambda_um));
  return sum;
}

double herzberger(const Padded& c, double lambda_um) {
  const double sq = lambda_um * lambda_um, l = 1 / (sq - 0.028);
  return c[0] + c[1] * l + c[2] * l * l + c[3] * sq + c[4] * sq * sq + c[5] * sq * sq * sq;
}

double retro(const Padded& c, double lambda_um) {
  const double sq = lambda_um * lambda_um;
  const double share = c[0] + c[1] * sq / (sq - c[2]) + c[3] * sq;
  return std::sqrt((1 + 2 * share) / (1 - share));
}

double exotic(const Padded& c, double lambda_um) {
  const double from = lambda_um - c[4];
  return std::sqrt(c[0] + c[1] / (lambda_um * lambda_um - c[2]) + c[3] * from / (from * from + c[5]));
}

double index_of(int formula, std::span<const double> c, double lambda_um) {
  switch (formula) {
    case 1:
      return std::sqrt(1 + sellmeier_sum(c, lambda_um, true));
    case 2:
      return std::sqrt(1 + sellmeier_sum(c, lambda_um, false));
    case 3:
      return std::sqrt(power_sum(c, lambda_um));
    case 4:
      return std::sqrt(rational_sum(c, lambda_um));
    case 5:
      return power_sum(c, lambda_um);
    case 6:
      return 1 + gas_sum(c, lambda_um);
    case 7:
      return herzberger(Padded(c), lambda_um);
    case 8:
      return retro(Padded(c), lambda_um);
    default:
      return exotic(Padded(c), lambda_um);
  }
}

/// P_gF of normal glasses.
double normal_partial_dispersion(double vd) {
  constexpr double largest_vd = 100;
  return 0.6438 - 0.001682 * std::min(vd, largest_vd);
}

/// A and the terms of Conrady's formula, differenced between two lines.
struct ConradyTerms {
  explicit ConradyTerms(double wavelength_nm) {
    const double lambda_um = wavelength_nm * um_per_nm;
    first = 1 / lambda_um;
    second = std::pow(lambda_um, -3.5);
  }
  double first, second;
};

}  // namespace

void check_dispersion_formula(int formula, std::span<const double> coefficients) {
  dispersion_formula_text(formula);  // refuses what is not known
  constexpr std::size_t pairs = 0, most_coefficients[] = {pairs, pairs, pairs, 17, pairs, pairs, 6, 4, 6};
  const std::size_t count = coefficients.size(), most = most_coefficients[formula - 1];
  if (most == pairs ? count % 2 == 0 : count == 0 || count > most)
    throw InputError(fmt::format("dispersion formula {} with {} coefficients; it takes {}", formula, count,
                                 most == pairs ? "one and then pairs" : fmt::format("up to {}", most)));
}

double dispersion_formula(int formula, std::span<const double> coefficients, double wavelength_nm) {
  check_dispersion_formula(formula, coefficients);
  if (!(wavelength_nm > 0) || !std::isfinite(wavelength_nm))
    throw InputError(fmt::format("a wavelength of {} nm; it must be positive", wavelength_nm));
  const double n = index_of(formula, coefficients, wavelength_nm * um_per_nm);
  if (!std::isfinite(n) || n <= 0)
    throw InputError(fmt::format("dispersion formula {} gives no index at {} nm", formula, wavelength_nm));
  return n;
}

double air_index(double wavelength_nm) {
  constexpr double shortest_nm = 200;
  if (!(wavelength_nm >= shortest_nm) || !std::isfinite(wavelength_nm))
    throw InputError(fmt::format("the index of air is not known at {} nm; it is from {} nm on", wavelength_nm,
                                 shortest_nm));
  const double sq = wavelength_nm * um_per_nm * wavelength_nm * um_per_nm;
  const double at_15_deg = 1e-8 * (6432.8 + 2949810 * sq / (146 * sq - 1) + 25540 * sq / (41 * sq - 1));
  constexpr double per_degree = 3.4785e-3, degrees_above_15 = 5;
  return 1 + at_15_deg / (1 + degrees_above_15 * per_degree);
}

const char* dispersion_formula_text(int formula) {
  switch (formula) {
    case 1:
      return "n² − 1 = c₀ + Σ cᵢ λ² / (λ² − cᵢ₊₁²), λ in µm (Sellmeier)";
    case 2:
      return "n² − 1 = c₀ + Σ cᵢ λ² / (λ² − cᵢ₊₁), λ in µm (Sellmeier)";
    case 3:
      return "n² = c₀ + Σ cᵢ λ^cᵢ₊₁, λ in µm (power series)";
    case 4:
      return "n² = c₀ + c₁ λ^c₂/(λ² − c₃^c₄) + c₅ λ^c₆/(λ² − c₇^c₈) + Σ cᵢ λ^cᵢ₊₁, λ in µm (rational)";
    case 5:
      return "n = c₀ + Σ cᵢ λ^cᵢ₊₁, λ in µm (Cauchy)";
    case 6:
      return "n − 1 = c₀ + Σ cᵢ / (cᵢ₊₁ − λ⁻²), λ in µm (gases)";
    case 7:
      return "n = c₀ + c₁ L + c₂ L² + c₃ λ² + c₄ λ⁴ + c₅ λ⁶, L = 1/(λ² − 0.028), λ in µm (Herzberger)";
    case 8:
      return "(n² − 1)/(n² + 2) = c₀ + c₁ λ²/(λ² − c₂) + c₃ λ², λ in µm (retro)";
    case 9:
      return "n² = c₀ + c₁/(λ² − c₂) + c₃ (λ − c₄)/((λ − c₄)² + c₅), λ in µm (exotic)";
    default:
      throw InputError(fmt::format("dispersion formula {} is not known; 1 to 9 are", formula));
  }
}

double model_glass_index(double nd, double vd, double wavelength_nm, double dpgf) {
  using namespace spectral_line;
  constexpr double shortest_nm = 300, longest_nm = 2500;
  if (!(nd >= 1) || !std::isfinite(nd) || !(vd > 0) || !std::isfinite(vd) || !std::isfinite(dpgf))
    throw InputError(
        fmt::format("a model glass of nd {} and Vd {}; nd must be at least 1 and Vd positive", nd, vd));
  if (!(wavelength_nm >= shortest_nm && wavelength_nm <= longest_nm))
    throw InputError(
        fmt::format("the model glass nd {} Vd {} has no index at {} nm; it is good from {} to {} nm", nd, vd,
                    wavelength_nm, shortest_nm, longest_nm));
  // n_F − n_C and n_g − n_F are linear in B and C: solve the two equations.
  const double dispersion = (nd - 1) / vd;
  const double g_minus_f = (normal_partial_dispersion(vd) + dpgf) * dispersion;
  const ConradyTerms g(g_nm), f(f_nm), d(d_nm), c(c_nm), here(wavelength_nm);
  const double b_fc = f.first - c.first, c_fc = f.second - c.second;
  const double b_gf = g.first - f.first, c_gf = g.second - f.second;
  const double determinant = b_fc * c_gf - b_gf * c_fc;
  const double conrady_b = (dispersion * c_gf - g_minus_f * c_fc) / determinant;
  const double conrady_c = (b_fc * g_minus_f - b_gf * dispersion) / determinant;
  return nd + conrady_b * (here.first - d.first) + conrady_c * (here.second - d.second);
}

double tabulated_index(std::span<const std::pair<double, double>> table, double wavelength_nm) {
  constexpr double tolerance_nm = 1e-6;
  const double shortest = table.front().first, longest = table.back().first;
  if (!(wavelength_nm >= shortest - tolerance_nm && wavelength_nm <= longest + tolerance_nm))
    throw InputError(fmt::format("a table of indices from {} to {} nm has none at {} nm", shortest, longest,
                                 wavelength_nm));
  // The curve in an interval depends on a few neighbours alone: of a long table these are enough.
  constexpr std::ptrdiff_t neighbours = 6;
  const auto above = std::upper_bound(table.begin(), table.end(), wavelength_nm,
                                      [](double nm, const auto& entry) { return nm < entry.first; });
  const auto first = above - std::min(neighbours, above - table.begin());
  const auto last = above + std::min(neighbours, table.end() - above);
  std::vector<double> wavelengths, indices;
  for (auto entry = first; entry != last; ++entry) {
    wavelengths.push_back(entry->first);
    indices.push_back(entry->second);
  }
  return MonotoneCubic(std::move(wavelengths), std::move(indices))(wavelength_nm);
}

AbbeNumbers abbe_numbers(const std::function<double(double)>& index) {
  const double nd = index(spectral_line::d_nm);
  return {nd, (nd - 1) / (index(spectral_line::f_nm) - index(spectral_line::c_nm))};
}

}  // namespace petzval
