// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/numeric/normal_quantile_terms.h>
#include <petzval/numeric/random.h>

#include <cmath>
#include <cstddef>

namespace petzval {

namespace {

using namespace normal_quantile_terms;
using Words = std::array<std::uint32_t, 4>;

Words philox_round(const Words& c, std::uint32_t key0, std::uint32_t key1) {
  const std::uint64_t a = std::uint64_t{0xD2511F53} * c[0], b = std::uint64_t{0xCD9E8D57} * c[2];
  return {static_cast<std::uint32_t>(b >> 32) ^ c[1] ^ key0, static_cast<std::uint32_t>(b),
          static_cast<std::uint32_t>(a >> 32) ^ c[3] ^ key1, static_cast<std::uint32_t>(a)};
}

template <std::size_t N>
double polynomial(const double (&coefficients)[N], double x) {
  double sum = coefficients[N - 1];
  for (std::size_t i = N - 1; i-- > 0;) sum = sum * x + coefficients[i];
  return sum;
}

/// log k!, by table below 128 and by Stirling's series above (next term below 1e-17).
class LogFactorial {
 public:
  LogFactorial() {
    for (std::size_t k = 1; k < table_.size(); ++k)
      table_[k] = table_[k - 1] + std::log(static_cast<long double>(k));
  }
  double operator()(double k) const {
    if (k < static_cast<double>(table_.size()))
      return static_cast<double>(table_[static_cast<std::size_t>(k)]);
    constexpr double half_log_two_pi = 0.918938533204672741780329736406;
    const double n = k + 1, r = 1 / n, r2 = r * r;
    return (n - 0.5) * std::log(n) - n + half_log_two_pi +
           r * (1.0 / 12 - r2 * (1.0 / 360 - r2 * (1.0 / 1260 - r2 / 1680)));
  }

 private:
  std::array<long double, 128> table_{};
};

double log_factorial(double k) {
  static const LogFactorial value;
  return value(k);
}

}  // namespace

std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key) {
  constexpr int rounds = 10;
  for (int i = 0; i < rounds; ++i) {
    counter = philox_round(counter, key[0], key[1]);
    key[0] += 0x9E3779B9;  // Weyl sequences: the golden ratio and √3 − 1
    key[1] += 0xBB67AE85;
  }
  return counter;
}

std::uint64_t RandomStream::bits() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const auto words = philox4x32(counter_, key_);
  ++counter_[0];
  spare_ = std::uint64_t{words[3]} << 32 | words[2];
  has_spare_ = true;
  return std::uint64_t{words[1]} << 32 | words[0];
}

double RandomStream::uniform() {
  // 52 bits and a half: with 53 the greatest number would round to 1.
  return (static_cast<double>(bits() >> 12) + 0.5) * 0x1p-52;
}

double normal_quantile(double probability) {
  const double q = probability - 0.5;
  if (std::abs(q) <= middle_half_width) {
    const double r = middle_square - q * q;
    return q * polynomial(middle_over, r) / polynomial(middle_under, r);
  }
  const double r = std::sqrt(-std::log(q < 0 ? probability : 1 - probability));
  const double value =
      r <= tail_start ? polynomial(flank_over, r - flank_start) / polynomial(flank_under, r - flank_start)
                      : polynomial(tail_over, r - tail_start) / polynomial(tail_under, r - tail_start);
  return q < 0 ? -value : value;
}

double RandomStream::normal() {
  return normal_quantile(uniform());
}

double RandomStream::poisson(double mean) {
  constexpr double greatest = 1e15;  // above, whole numbers are no longer exact in the sums
  if (!(mean <= greatest)) throw InputError("the mean of a Poisson variable must be a number up to 1e15");
  if (mean <= 0) return 0;
  return mean < poisson_rejection_least_mean ? poisson_by_inversion(mean) : poisson_by_rejection(mean);
}

double RandomStream::poisson_by_inversion(double mean) {
  double left = uniform(), term = std::exp(-mean), k = 0;
  // Terms beyond the resolution of a uniform number end the search.
  while (left > term && (k < mean || term > 0x1p-60)) {
    left -= term;
    ++k;
    term *= mean / k;
  }
  return k;
}

double RandomStream::poisson_by_rejection(double mean) {
  const double root = std::sqrt(mean);
  const double b = 0.931 + 2.53 * root;
  const double a = -0.059 + 0.02483 * b;
  const double v_r = 0.9277 - 3.6224 / (b - 2);
  for (;;) {
    const double u = uniform() - 0.5, v = uniform();
    const double us = 0.5 - std::abs(u);
    const double k = std::floor((2 * a / us + b) * u + mean + 0.43);
    if (us >= 0.07 && v <= v_r) return k;
    if (k < 0 || (us < 0.013 && v > us)) continue;
    const double inverse_alpha = 1.1239 + 1.1328 / (b - 3.4);
    if (std::log(v * inverse_alpha / (a / (us * us) + b)) <= k * std::log(mean) - mean - log_factorial(k))
      return k;
  }
}

}  // namespace petzval
