// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/bladed_overlap.h>
#include <petzval/analysis/pupil_mask.h>
#include <petzval/analysis/pupil_overlap.h>
#include <petzval/base/units.h>
#include <petzval/numeric/root.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

/// Nodes along and across the chords: what a smooth overlap needs, and what the waves across it take, half as
/// many nodes as radians; beyond the largest numbers nodes and waves beat. A fit takes as many as 250 periods
/// of the pattern in the spot need, where a defocused circle has 1e-4 left; aimed rays cost more. In steps,
/// so that frequencies share their rules.
constexpr int fewest_nodes = 24, most_nodes_of_fit = 1024, most_nodes_of_rays = 160, node_step = 8;
/// Where a pupil is dark inside, the waves end at edges that no rule knows: by so many nodes both ways an OTF
/// is good to some 1e-4.
constexpr int nodes_of_dark_edges = 400;

int nodes_for(double cycles, int most) {
  const double steps = std::ceil((fewest_nodes + 4 * cycles) / node_step);
  return std::clamp(node_step * static_cast<int>(std::min(steps, 1e6)), fewest_nodes, most);
}

/// ∫ f over [low, high], with nodes crowded towards both ends as cos θ: a chord ends there like a square
/// root.
template <class F>
void over_chords(double low, double high, int count, F&& f) {
  const QuadratureRule rule = gauss_legendre(count, -0.5 * pi, 0.5 * pi);
  const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
  for (std::size_t i = 0; i < rule.nodes.size(); ++i)
    f(middle + half * std::sin(rule.nodes[i]), half * std::cos(rule.nodes[i]) * rule.weights[i]);
}

OverlapAlong along_lines(const ExitPupilFit& fit) {
  return [&fit](MtfDirection direction, const ChordOverlap& chord, const QuadratureRule& along) {
    const WaveLine line =
        direction == MtfDirection::tangential ? fit.at_alpha(chord.across) : fit.at_beta(chord.across);
    return line_overlap(line, chord.low, chord.length, chord.shift, along);
  };
}

template <class Wave>
OverlapAlong place_by_place(Wave wave) {
  return [wave](MtfDirection direction, const ChordOverlap& chord, const QuadratureRule& along) {
    const auto at = [&](double here) {
      return direction == MtfDirection::tangential ? wave(chord.across, here) : wave(here, chord.across);
    };
    std::complex<double> sum = 0;
    for (std::size_t i = 0; i < along.nodes.size(); ++i) {
      const double here = chord.low + chord.length * along.nodes[i];
      sum += along.weights[i] * at(here) * std::conj(at(here - chord.shift));
    }
    return sum * chord.length;
  };
}

}  // namespace

PupilOverlap::PupilOverlap(const FieldTracer& tracer, const ExitPupil& pupil, const ExitPupilFit& fit)
    : PupilOverlap(
          tracer, pupil, fit.transverse_mm(),
          [&fit](double alpha, double beta) { return fit.wave(alpha, beta); }, along_lines(fit)) {}

PupilOverlap::PupilOverlap(const FieldTracer& tracer, const ExitPupil& pupil, const PupilModel& model)
    : PupilOverlap(tracer, pupil, pupil.transverse_mm(),
                   [&pupil, model](double alpha, double beta) {
                     return pupil.wave(pupil.mirrored() ? std::abs(alpha) : alpha, beta, model);
                   },
                   {}) {}

PupilOverlap::PupilOverlap(const FieldTracer& tracer, const ExitPupil& pupil, double transverse_mm,
                           const Wave& wave, OverlapAlong along)
    : pupil_(pupil),
      lambda_mm_(tracer.tracer().wavelength_nm() * mm_per_nm / tracer.tracer().image_index()),
      transverse_mm_(transverse_mm),
      most_nodes_(along ? most_nodes_of_fit : most_nodes_of_rays),
      along_(along ? std::move(along) : place_by_place(wave)) {
  if (std::optional<PupilMask> mask = PupilMask::of(tracer, pupil.chief())) {
    dark_inside_ = true;
    along_ = place_by_place([mask = std::move(*mask), wave](double alpha, double beta) {
      return mask.is_dark(alpha, beta) ? std::complex<double>(0) : wave(alpha, beta);
    });
  }
  constexpr int steps = 64;
  const auto [low, high] = pupil_.beta_range();
  for (int i = 1; i < steps; ++i) {
    const double beta = low + (high - low) * i / steps, here = pupil_.along_alpha(beta).length();
    if (here > width_) widest_beta_ = beta, width_ = here;
  }
}

std::complex<double> PupilOverlap::otf(MtfDirection direction, double frequency_cpmm) {
  const int whole_nodes = dark_inside_ ? nodes_of_dark_edges : fewest_nodes;
  const int nodes =
      dark_inside_ ? nodes_of_dark_edges : nodes_for(2 * frequency_cpmm * transverse_mm_, most_nodes_);
  // The whole pupil by chords of the same direction: where it has corners, the two differ by 1e-5.
  std::optional<double>& whole = whole_[direction == MtfDirection::tangential ? 0 : 1];
  if (!whole) whole = unscaled(direction, 0, whole_nodes).real();
  return unscaled(direction, lambda_mm_ * frequency_cpmm, nodes) / *whole;
}

std::complex<double> PupilOverlap::unscaled(MtfDirection direction, double shift, int nodes) const {
  if (!pupil_.whole_outline().empty())
    return bladed_overlap(pupil_.whole_outline(), along_, direction, shift, gauss_legendre(nodes),
                          pupil_.detail().overlap_panels);
  return direction == MtfDirection::tangential ? round_tangential(shift, nodes)
                                               : round_sagittal(shift, nodes);
}

/// Chords along β, pupil against itself shifted in β.
std::complex<double> PupilOverlap::round_tangential(double shift, int nodes) const {
  const auto spare = [&](double alpha) { return pupil_.along_beta(alpha).length() - shift; };
  if (!(spare(0) > 0)) return 0;
  const double edge = last_above_zero(0, pupil_.alpha_max(), spare);
  const QuadratureRule along = gauss_legendre(nodes);
  std::complex<double> sum = 0;
  over_chords(-edge, edge, 2 * nodes, [&](double alpha, double weight) {
    if (alpha < 0) return;  // the mirror image
    const ExitPupil::Chord chord = pupil_.along_beta(alpha);
    const double length = chord.length() - shift;
    if (length > 0)
      sum += 2 * weight * along_(MtfDirection::tangential, {alpha, chord.low + shift, length, shift}, along);
  });
  return sum;
}

/// Chords along α, shifted in α; the two halves of the overlap are conjugates.
std::complex<double> PupilOverlap::round_sagittal(double shift, int nodes) const {
  if (!(width_ > shift)) return 0;
  const auto spare = [&](double beta) { return pupil_.along_alpha(beta).length() - shift; };
  const auto [low, high] = pupil_.beta_range();
  const double from = last_above_zero(widest_beta_, low, spare);
  const double to = last_above_zero(widest_beta_, high, spare);
  const QuadratureRule along = gauss_legendre(nodes);
  double sum = 0;
  over_chords(from, to, nodes, [&](double beta, double weight) {
    const double half_length = 0.5 * (pupil_.along_alpha(beta).length() - shift);
    if (half_length > 0)
      sum +=
          2 * weight * along_(MtfDirection::sagittal, {beta, 0.5 * shift, half_length, shift}, along).real();
  });
  return sum;
}

}  // namespace petzval
