// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/wave/line_overlap.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/wave/line_overlap.cpp"
// clang-format off
#include <hwy/foreach_target.h>
#include <petzval/numeric/turn-inl.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, 4>;
using V = hn::Vec<D>;
/// Vectors of nodes in flight together, each with the wave at two places.
constexpr std::size_t together = 2;

/// The series of a line at several places each way, by Clenshaw's recurrence.
HWY_ATTR HWY_INLINE void sum_series(const ChebyshevSurface::Line& line, const V (&at)[2 * together],
                                    V (&sums)[2 * together]) {
  const D d;
  const auto one = hn::Set(d, 1.0), middle = hn::Set(d, line.middle), scale = hn::Set(d, 1 / line.scale);
  V t[2 * together], later[2 * together];
  for (std::size_t k = 0; k < 2 * together; ++k) {
    t[k] = hn::Mul(hn::Sub(at[k], middle), scale);
    if (line.folded) t[k] = hn::MulSub(hn::Add(t[k], t[k]), t[k], one);
    later[k] = sums[k] = hn::Zero(d);
  }
  for (std::size_t n = line.count - 1; n > 0; --n) {
    const auto term = hn::Set(d, line.terms[n]);
    for (std::size_t k = 0; k < 2 * together; ++k) {
      const auto next = hn::Add(hn::MulSub(hn::Add(t[k], t[k]), sums[k], later[k]), term);
      later[k] = sums[k];
      sums[k] = next;
    }
  }
  const auto first = hn::Set(d, line.terms[0]);
  for (std::size_t k = 0; k < 2 * together; ++k)
    sums[k] = hn::Add(hn::MulSub(t[k], sums[k], later[k]), first);
}

/// \param nodes, weights  in whole groups.
HWY_ATTR void sum_overlap(const WaveLine& wave, double low, double length, double shift, const double* nodes,
                          const double* weights, std::size_t count, double* result) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  auto real = hn::Zero(d), imaginary = hn::Zero(d);
  for (std::size_t i = 0; i < count; i += together * lanes) {
    V at[2 * together], phase[2 * together], amplitude[2 * together];
    for (std::size_t k = 0; k < together; ++k) {
      at[k] = hn::MulAdd(hn::Set(d, length), hn::LoadU(d, nodes + i + k * lanes), hn::Set(d, low));
      at[together + k] = hn::Sub(at[k], hn::Set(d, shift));
    }
    sum_series(wave.phase_waves, at, phase);
    if (wave.amplitude) sum_series(*wave.amplitude, at, amplitude);
    for (std::size_t k = 0; k < together; ++k) {
      auto weight = hn::LoadU(d, weights + i + k * lanes);
      if (wave.amplitude)
        weight = hn::Mul(weight, hn::Mul(hn::Max(amplitude[k], hn::Zero(d)),
                                         hn::Max(amplitude[together + k], hn::Zero(d))));
      V cosine, sine;
      turn_by(d, hn::Sub(phase[k], phase[together + k]), cosine, sine);
      real = hn::MulAdd(weight, cosine, real);
      imaginary = hn::MulAdd(weight, sine, imaginary);
    }
  }
  result[0] = hn::GetLane(hn::SumOfLanes(d, real));
  result[1] = hn::GetLane(hn::SumOfLanes(d, imaginary));
}

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(sum_overlap);

std::complex<double> WaveLine::operator()(double along) const {
  return std::polar(amplitude ? std::max((*amplitude)(along), 0.0) : 1.0, 2 * pi * phase_waves(along));
}

std::complex<double> line_overlap(const WaveLine& wave, double low, double length, double shift,
                                  const QuadratureRule& rule) {
  // Whole groups of the widest vectors; nodes of weight 0 fill the last.
  constexpr std::size_t group = 8, at_once = 32 * group;
  alignas(64) double nodes[at_once], weights[at_once];
  std::complex<double> sum = 0;
  for (std::size_t from = 0; from < rule.nodes.size(); from += at_once) {
    const std::size_t count = std::min(at_once, rule.nodes.size() - from);
    const std::size_t filled = (count + group - 1) / group * group;
    std::copy_n(&rule.nodes[from], count, nodes);
    std::copy_n(&rule.weights[from], count, weights);
    std::fill(nodes + count, nodes + filled, rule.nodes[from]);
    std::fill(weights + count, weights + filled, 0.0);
    double part[2];
    HWY_DYNAMIC_DISPATCH(sum_overlap)(wave, low, length, shift, nodes, weights, filled, part);
    sum += std::complex<double>(part[0], part[1]);
  }
  return sum * length;
}

}  // namespace petzval
#endif
