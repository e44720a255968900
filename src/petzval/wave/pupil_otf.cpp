// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/wave/pupil_otf.h>
#include <petzval/wave/pupil_strips.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace petzval {

namespace {

using Complex = std::complex<double>;

constexpr int highest_degree = 20;

bool all_zero(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return v == 0; });
}

int degree_of(const GeneralPupil& pupil) {
  int degree = 0;
  for (std::size_t j = 0; j < pupil.w_waves.size(); ++j)
    if (pupil.w_waves[j] != 0) degree = std::max(degree, 2 * (static_cast<int>(j) + 1));
  for (std::size_t j = 0; j < pupil.zernike_waves.size(); ++j)
    if (pupil.zernike_waves[j] != 0)
      degree = std::max(degree, zernike_term(pupil.order, static_cast<int>(j) + 1).n);
  return degree;
}

/// Slopes and curvatures of W over the unit disc, by differences on a grid: enough to count nodes by.
struct Steepness {
  double slope = 0, bend = 0;
};

Steepness steepness(const GeneralPupil& pupil) {
  Steepness found;
  if (degree_of(pupil) == 0) return found;
  constexpr int samples = 24;
  constexpr double h = 1e-3;
  for (int i = -samples; i <= samples; ++i)
    for (int j = -samples; j <= samples; ++j) {
      const double x = (1 - h) * i / samples, y = (1 - h) * j / samples;
      if (x * x + y * y > 1.05) continue;
      const double here = pupil.aberration(x, y);
      const double right = pupil.aberration(x + h, y), left = pupil.aberration(x - h, y),
                   above = pupil.aberration(x, y + h), below = pupil.aberration(x, y - h);
      found.slope = std::max(found.slope, std::hypot(right - left, above - below) / (2 * h));
      const double xx = (right - 2 * here + left) / (h * h), yy = (above - 2 * here + below) / (h * h);
      const double xy = (pupil.aberration(x + h, y + h) - pupil.aberration(x - h, y + h) -
                         pupil.aberration(x + h, y - h) + pupil.aberration(x - h, y - h)) /
                        (4 * h * h);
      found.bend = std::max(found.bend, std::sqrt(xx * xx + yy * yy + 2 * xy * xy));
    }
  return found;
}

PupilStrips strips_along(const GeneralPupil& pupil, double angle, const Steepness& steep) {
  PupilPolynomial w;
  const double c = std::cos(angle), s = std::sin(angle);
  if (const int degree = degree_of(pupil); degree > 0)
    w = PupilPolynomial(degree,
                        [&](double x, double y) { return pupil.aberration(x * c - y * s, x * s + y * c); });
  return PupilStrips(pupil.shape, angle, std::move(w), steep.slope, steep.bend);
}

constexpr int stencil = 6;

/// The weights of the polynomial through six equally spaced values, `at` counted in their spacing, and the
/// first of them.
int lagrange(double at, int count, std::array<double, stencil>& weights) {
  const int first = std::clamp(static_cast<int>(at) - stencil / 2 + 1, 0, count - stencil);
  const double u = at - first;
  // Products of the distances from the left and from the right, over the fixed products of the nodes' own.
  constexpr std::array<double, stencil> scale{-1.0 / 120, 1.0 / 24,  -1.0 / 12,
                                              1.0 / 12,   -1.0 / 24, 1.0 / 120};
  std::array<double, stencil> left, right;
  left[0] = 1, right[stencil - 1] = 1;
  for (std::size_t i = 1; i < stencil; ++i) left[i] = left[i - 1] * (u - static_cast<double>(i) + 1);
  for (std::size_t i = stencil - 1; i-- > 0;) right[i] = right[i + 1] * (u - static_cast<double>(i) - 1);
  for (std::size_t i = 0; i < stencil; ++i) weights[i] = scale[i] * left[i] * right[i];
  return first;
}

class PupilOtf : public Otf {
 public:
  PupilOtf(const GeneralPupil& pupil, double wavelength_nm, double f_number)
      : unit_um_(wavelength_nm * 1e-3 * f_number), steep_(steepness(pupil)) {
    // Sixth order: a wavefront of slope G turns the phase by up to 4πG over the cut-off. Without a wavefront
    // strips are lengths, and a table fine enough for the kinks where rims and corners pass each other costs
    // little.
    const bool is_flat = degree_of(pupil) == 0;
    const int steps =
        is_flat ? 480 : (pupil.shape.is_round() ? 96 : 192) + static_cast<int>(12 * steep_.slope);
    sectors_ = pupil.shape.is_round() ? 1 : pupil.shape.blades;
    const double half = pupil.shape.is_round() ? 0 : pi / pupil.shape.blades;
    first_angle_ = pupil.shape.rotation_rad + (pupil.shape.blades % 2 == 0 ? 0 : half / 2);
    directions_ = std::max(9, steps / sectors_ + 1);
    radii_ = is_flat ? 385 : 129 + static_cast<int>(32 * steep_.slope);
    fill(pupil);
    const double share = pupil.shape.perimeter() / 2 / pupil.shape.area();  // a clear circle has 1
    tail_.k3_um = share / (pi * pi * pi) * unit_um_;
    // Straight edges throw spikes, which are not the same in all directions; curved wavefronts leave terms in
    // 1/r⁵.
    tail_.settled_um = (pupil.shape.is_round() ? 240 : 1000) * unit_um_;
  }

  double cutoff_cpmm() const override { return 1e3 / unit_um_; }
  PsfTail tail() const override { return tail_; }
  double reach_um() const override { return (2 * steep_.slope + 2) * unit_um_; }
  void evaluate(double fx_cpmm, std::span<const double> fy_cpmm, std::span<Complex> values) const override {
    const double scale = unit_um_ * 1e-3;
    for (std::size_t i = 0; i < fy_cpmm.size(); ++i)
      // The picture's x runs against x'.
      values[i] = within(-fx_cpmm * scale, fy_cpmm[i] * scale);
  }

 private:
  void fill(const GeneralPupil& pupil) {
    const auto lines = static_cast<std::size_t>(sectors_) * static_cast<std::size_t>(directions_);
    const auto count = static_cast<std::size_t>(radii_);
    table_.assign(lines * count, 0);
    reach_.assign(lines, 0);
    const double area = pupil.shape.area();
    parallel_for(lines, [&](std::size_t line) {
      const auto sector = static_cast<int>(line / static_cast<std::size_t>(directions_));
      const auto step = static_cast<int>(line % static_cast<std::size_t>(directions_));
      const double angle =
          first_angle_ + (sector + static_cast<double>(step) / (directions_ - 1)) * pi / sectors_;
      const PupilStrips strips = strips_along(pupil, angle, steep_);
      RuleShelf rules;
      reach_[line] = strips.largest_shift();
      table_[line * count] = 1;
      for (std::size_t i = 1; i + 1 < count; ++i) {
        // At the cut-off the OTF goes as the 3/2 power of the distance: analytic in u.
        const double u = 1 - static_cast<double>(i) / static_cast<double>(count - 1);
        table_[line * count + i] = strips.overlap(reach_[line] * (1 - u * u), rules) / area;
      }
    });
  }

  /// At a frequency in units of the cut-off.
  Complex within(double fx, double fy) const {
    const double s = std::sqrt(fx * fx + fy * fy);
    if (s >= 1) return 0;
    if (s == 0) return 1;
    double turn = (std::atan2(fy, fx) - first_angle_) / pi;
    const double halves = std::floor(turn);
    const bool opposite = std::fmod(halves, 2) != 0;
    turn -= halves;
    const int sector = std::min(sectors_ - 1, static_cast<int>(turn * sectors_));
    std::array<double, stencil> across, along;
    const int line =
        lagrange((turn * sectors_ - sector) * (directions_ - 1), directions_, across) + sector * directions_;
    double reach = 0;
    for (std::size_t i = 0; i < stencil; ++i) reach += across[i] * reach_[static_cast<std::size_t>(line) + i];
    if (s >= reach) return 0;
    const int at = lagrange((1 - std::sqrt(1 - s / reach)) * (radii_ - 1), radii_, along);
    Complex sum = 0;
    for (std::size_t i = 0; i < stencil; ++i) {
      const Complex* row = table_.data() +
                           (static_cast<std::size_t>(line) + i) * static_cast<std::size_t>(radii_) +
                           static_cast<std::size_t>(at);
      Complex one = 0;
      for (std::size_t j = 0; j < stencil; ++j) one += along[j] * row[j];
      sum += across[i] * one;
    }
    return opposite ? std::conj(sum) : sum;
  }

  double unit_um_;  ///< λN
  Steepness steep_;
  int sectors_ = 1, directions_ = 0, radii_ = 0;
  double first_angle_ = 0;
  PsfTail tail_;
  std::vector<Complex> table_;  ///< [sector][direction][s = reach (1 − (1 − u)²)]
  std::vector<double> reach_;   ///< the cut-off in each direction
};

}  // namespace

bool GeneralPupil::is_radial() const {
  if (!shape.is_round()) return false;
  for (std::size_t j = 0; j < zernike_waves.size(); ++j)
    if (zernike_waves[j] != 0) return false;
  return true;
}

RadialPupil GeneralPupil::radial() const {
  if (!is_radial()) throw InputError("a pupil with blades or Zernike terms is not rotationally symmetric");
  return {w_waves, shape.obstruction};
}

double GeneralPupil::aberration(double x, double y) const {
  const double radial = RadialPupil{w_waves, 0}.aberration(x * x + y * y);
  return all_zero(zernike_waves) ? radial : radial + zernike_sum(order, zernike_waves, x, y);
}

double GeneralPupil::steepest() const {
  return steepness(*this).slope;
}

void GeneralPupil::validate() const {
  shape.validate();
  RadialPupil{w_waves, 0}.validate();
  for (std::size_t j = 0; j < zernike_waves.size(); ++j) {
    const int index = static_cast<int>(j) + 1;
    if (zernike_waves[j] == 0) continue;
    if (!std::isfinite(zernike_waves[j]))
      throw InputError(fmt::format("Zernike coefficient {} is not a finite number", index));
    if (zernike_term(order, index).n > highest_degree)
      throw InputError(fmt::format("Zernike term {} is of order {}; up to order {} is right", index,
                                   zernike_term(order, index).n, highest_degree));
  }
  constexpr double steepest_allowed = 100;
  if (const double slope = steepest(); !(slope <= steepest_allowed))
    throw InputError(
        fmt::format("a wavefront that slopes by {:.4g} waves over the pupil's radius; up to {} are right",
                    slope, steepest_allowed));
}

Complex pupil_otf_at(const GeneralPupil& pupil, double s, double theta) {
  pupil.validate();
  RuleShelf rules;
  return strips_along(pupil, theta, steepness(pupil)).overlap(s, rules) / pupil.shape.area();
}

Complex pupil_amplitude_at(const GeneralPupil& pupil, double x, double y) {
  pupil.validate();
  RuleShelf rules;
  const PupilStrips strips = strips_along(pupil, std::atan2(y, x), steepness(pupil));
  return strips.amplitude(std::hypot(x, y), rules) / pupil.shape.area();
}

std::unique_ptr<Otf> general_pupil_otf(const GeneralPupil& pupil, double wavelength_nm, double f_number) {
  pupil.validate();
  if (pupil.is_radial()) return radial_pupil_otf(pupil.radial(), wavelength_nm, f_number);
  for (const auto& [value, what] : {std::pair{wavelength_nm, "a wavelength"}, {f_number, "an f-number"}})
    if (!(value > 0) || !std::isfinite(value))
      throw InputError(fmt::format("{} of {}: a positive number is right", what, value));
  return std::make_unique<PupilOtf>(pupil, wavelength_nm, f_number);
}

}  // namespace petzval
