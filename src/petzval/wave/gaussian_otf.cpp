// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/wave/gaussian_otf.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

class EllipticalGaussian : public Otf {
 public:
  EllipticalGaussian(double sigma_x_um, double sigma_y_um)
      : x_mm_(sigma_x_um * mm_per_um), y_mm_(sigma_y_um * mm_per_um) {}

  // exp(−2π²σ²f²) falls to 1e-13 at f = 1.231/σ.
  double cutoff_cpmm() const override {
    return std::sqrt(std::log(1e13) / 2) / (pi * std::min(x_mm_, y_mm_));
  }
  void evaluate(double fx_cpmm, std::span<const double> fy_cpmm,
                std::span<std::complex<double>> values) const override {
    const double x = pi * x_mm_ * fx_cpmm;
    for (std::size_t i = 0; i < fy_cpmm.size(); ++i) {
      const double y = pi * y_mm_ * fy_cpmm[i];
      values[i] = std::exp(-2 * (x * x + y * y));
    }
  }
  double reach_um() const override { return 8 * std::max(x_mm_, y_mm_) / mm_per_um; }

 private:
  double x_mm_, y_mm_;
};

}  // namespace

std::unique_ptr<Otf> elliptical_gaussian_otf(double sigma_x_um, double sigma_y_um) {
  for (const double sigma : {sigma_x_um, sigma_y_um})
    if (!(sigma > 0) || !std::isfinite(sigma))
      throw InputError(fmt::format("a standard deviation of {:g}: a positive number is right", sigma));
  return std::make_unique<EllipticalGaussian>(sigma_x_um, sigma_y_um);
}

}  // namespace petzval
