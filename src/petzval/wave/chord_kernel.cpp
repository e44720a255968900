// SPDX-License-Identifier: BSD-3-Clause
#include <hwy/aligned_allocator.h>
#include <petzval/wave/chord_kernel.h>

#include <algorithm>
#include <cstddef>
#include <memory>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/wave/chord_kernel.cpp"
// clang-format off
#include <hwy/foreach_target.h>
#include <petzval/numeric/turn-inl.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, ChordSum::chords_together>;
using Doubles = hn::Repartition<double, Floats>;
using HalfFloats = hn::Rebind<float, Doubles>;
using Double = hn::Vec<Doubles>;
using Float = hn::Vec<Floats>;

/// Pairs of columns about a middle that share the nodes' waves there; a power of two, at least four.
constexpr std::size_t pairs = 8;
/// Nodes of each chord that are summed together: what is kept of them fits the first-level cache.
constexpr std::size_t block_nodes = 24;
constexpr std::size_t block_values = block_nodes * ChordSum::chords_together;

/// Clenshaw's sum of one Chebyshev series a lane at u; terms are `stride` apart.
template <class D, class V = hn::Vec<D>>
HWY_ATTR HWY_INLINE V chebyshev_sum(D d, const hn::TFromD<D>* series, std::size_t terms, std::size_t stride,
                                    V u) {
  const auto twice = hn::Add(u, u);
  auto later = hn::Zero(d), latest = hn::Zero(d);
  for (std::size_t m = terms - 1; m > 0; --m) {
    const auto next = hn::Add(hn::MulSub(twice, latest, later), hn::LoadU(d, series + m * stride));
    later = latest;
    latest = next;
  }
  return hn::Add(hn::MulSub(u, latest, later), hn::LoadU(d, series));
}

/// Nodes of as many chords as there are lanes, node after node. Columns come in groups of 2·pairs about a
/// middle: kα(middle ± (p + ½) step).
struct Nodes {
  std::size_t count = 0;                                                  ///< of nodes a chord
  alignas(64) double cosine[block_values], sine[block_values];            ///< at the group's middle
  alignas(64) double turn_cosine[block_values], turn_sine[block_values];  ///< from one middle to the next
  alignas(64) float re[block_values], im[block_values];                   ///< 2g
  alignas(64) float pair_cosine[pairs][block_values], pair_sine[pairs][block_values];  ///< of kα(p + ½) step
  alignas(64) float re_c[block_values], im_c[block_values];  ///< 2g times cosine and sine of the group
  alignas(64) float re_s[block_values], im_s[block_values];
};

/// What nodes need in double, a vector of doubles of chords. The turns that single precision can make of it
/// wait as cycles [−½, ½], those of the phases in `re`, of the middles in `im`, of half a step in `re_c`;
/// the series' argument in `im_c`.
HWY_ATTR void place_nodes(const ChordSum& sum, std::size_t chord, std::size_t lane, std::size_t first,
                          Nodes& nodes) {
  const Doubles d;
  const HalfFloats f;
  const std::size_t lanes = hn::Lanes(Floats()), chords = sum.beta.size(), own = chord + lane;
  const QuadratureRule& rule = sum.along[chord / ChordSum::chords_together];
  const double middle_mm = sum.first_column_mm + (static_cast<double>(pairs) - 0.5) * sum.column_step_mm;
  const double middle_row_mm = sum.first_row_mm + 0.5 * (sum.rows - 1) * sum.row_step_mm;
  const auto half = hn::LoadU(d, &sum.half_chord[own]);
  const auto row_waves = hn::Mul(hn::LoadU(d, &sum.beta[own]), hn::Set(d, sum.waves_per_mm * middle_row_mm));
  const auto put_cycles = [&](Double cycles, float* at) HWY_ATTR {
    hn::StoreU(hn::DemoteTo(f, hn::Sub(cycles, hn::Round(cycles))), f, at);
  };
  for (std::size_t j = 0; j < nodes.count; ++j) {
    const std::size_t at = j * lanes + lane;
    const auto alpha = hn::Mul(half, hn::Set(d, rule.nodes[first + j]));
    const auto ratio = hn::Mul(alpha, hn::Set(d, 1 / sum.alpha_scale));
    const auto u = hn::MulSub(hn::Add(ratio, ratio), ratio, hn::Set(d, 1.0));
    put_cycles(hn::Add(chebyshev_sum(d, &sum.phase[own], sum.terms, chords, u), row_waves), &nodes.re[at]);
    hn::StoreU(hn::DemoteTo(f, u), f, &nodes.im_c[at]);
    const auto waves_per_mm = hn::Mul(alpha, hn::Set(d, sum.waves_per_mm));
    put_cycles(hn::Mul(waves_per_mm, hn::Set(d, middle_mm)), &nodes.im[at]);
    put_cycles(hn::Mul(waves_per_mm, hn::Set(d, 0.5 * sum.column_step_mm)), &nodes.re_c[at]);
    Double c, s;
    turn_by(d, hn::Mul(waves_per_mm, hn::Set(d, 2.0 * pairs * sum.column_step_mm)), c, s);
    hn::StoreU(c, d, &nodes.turn_cosine[at]);
    hn::StoreU(s, d, &nodes.turn_sine[at]);
  }
}

/// The nodes from `first` on of the chords from `chord` on.
HWY_ATTR void start_nodes(const ChordSum& sum, std::size_t chord, std::size_t first, Nodes& nodes) {
  const Floats d;
  const Doubles wide;
  const HalfFloats f;
  const std::size_t lanes = hn::Lanes(d), chords = sum.beta.size();
  for (std::size_t lane = 0; lane < lanes; lane += hn::Lanes(wide))
    place_nodes(sum, chord, lane, first, nodes);
  const QuadratureRule& rule = sum.along[chord / ChordSum::chords_together];
  const auto half = hn::LoadU(d, &sum.strength[chord]);
  for (std::size_t j = 0; j < nodes.count; ++j) {
    const std::size_t at = j * lanes;
    const auto u = hn::LoadU(d, &nodes.im_c[at]);
    const auto strength = hn::Mul(hn::Mul(half, hn::Set(d, static_cast<float>(rule.weights[first + j]))),
                                  chebyshev_sum(d, &sum.amplitude[chord], sum.terms, chords, u));
    Float c, s;
    turn_by(d, hn::LoadU(d, &nodes.im[at]), c, s);
    hn::StoreU(c, d, &nodes.re_s[at]);
    hn::StoreU(s, d, &nodes.im_s[at]);
    for (std::size_t lane = 0; lane < lanes; lane += hn::Lanes(wide)) {
      hn::StoreU(hn::PromoteTo(wide, hn::LoadU(f, &nodes.re_s[at + lane])), wide, &nodes.cosine[at + lane]);
      hn::StoreU(hn::PromoteTo(wide, hn::LoadU(f, &nodes.im_s[at + lane])), wide, &nodes.sine[at + lane]);
    }
    turn_by(d, hn::LoadU(d, &nodes.re[at]), c, s);
    hn::StoreU(hn::Mul(strength, c), d, &nodes.re[at]);
    hn::StoreU(hn::Mul(strength, s), d, &nodes.im[at]);
    turn_by(d, hn::LoadU(d, &nodes.re_c[at]), c, s);
    const auto step_c = hn::MulSub(c, c, hn::Mul(s, s)), step_s = hn::Mul(hn::Add(c, c), s);
    for (std::size_t p = 0; p < pairs; ++p) {
      hn::StoreU(c, d, &nodes.pair_cosine[p][at]);
      hn::StoreU(s, d, &nodes.pair_sine[p][at]);
      const auto next = hn::MulSub(c, step_c, hn::Mul(s, step_s));
      s = hn::MulAdd(s, step_c, hn::Mul(c, step_s));
      c = next;
    }
  }
}

/// The nodes' waves at the middle of the present group, and the turn to the next.
HWY_ATTR void next_group(Nodes& nodes) {
  const Doubles d;
  const HalfFloats f;
  for (std::size_t j = 0; j < nodes.count * hn::Lanes(Floats()); j += hn::Lanes(d)) {
    const auto c = hn::LoadU(d, &nodes.cosine[j]), s = hn::LoadU(d, &nodes.sine[j]);
    const auto tc = hn::LoadU(d, &nodes.turn_cosine[j]), ts = hn::LoadU(d, &nodes.turn_sine[j]);
    const auto re = hn::LoadU(f, &nodes.re[j]), im = hn::LoadU(f, &nodes.im[j]);
    const auto fc = hn::DemoteTo(f, c), fs = hn::DemoteTo(f, s);
    hn::StoreU(hn::Mul(re, fc), f, &nodes.re_c[j]);
    hn::StoreU(hn::Mul(im, fc), f, &nodes.im_c[j]);
    hn::StoreU(hn::Mul(re, fs), f, &nodes.re_s[j]);
    hn::StoreU(hn::Mul(im, fs), f, &nodes.im_s[j]);
    hn::StoreU(hn::MulSub(c, tc, hn::Mul(s, ts)), d, &nodes.cosine[j]);
    hn::StoreU(hn::MulAdd(s, tc, hn::Mul(c, ts)), d, &nodes.sine[j]);
  }
}

/// weight_i e^{ikβ_i t} F_i at every column and at the t of the middle row, padded to whole groups of
/// columns: [batch of chords][column][lane].
struct ChordFields {
  std::size_t lanes, batches, columns;
  hwy::AlignedFreeUniquePtr<float[]> re, im;

  ChordFields(std::size_t chords, std::size_t padded_columns)
      : lanes(hn::Lanes(Floats())),
        batches(chords / lanes),
        columns(padded_columns),
        re(hwy::AllocateAligned<float>(chords * columns)),
        im(hwy::AllocateAligned<float>(chords * columns)) {
    std::fill_n(re.get(), chords * columns, 0.0F);
    std::fill_n(im.get(), chords * columns, 0.0F);
  }
  std::size_t at(std::size_t batch, std::size_t column) const { return (batch * columns + column) * lanes; }
};

/// Σ 2g cos(middle) cos δ and Σ 2g sin(middle) sin δ of one pair of columns.
struct PairSum {
  Float re_c, im_c, re_s, im_s;

  HWY_ATTR PairSum() { re_c = im_c = re_s = im_s = hn::Zero(Floats()); }
  HWY_ATTR HWY_INLINE void add(Float rc, Float ic, Float rs, Float is, Float cosine, Float sine) {
    re_c = hn::MulAdd(rc, cosine, re_c);
    im_c = hn::MulAdd(ic, cosine, im_c);
    re_s = hn::MulAdd(rs, sine, re_s);
    im_s = hn::MulAdd(is, sine, im_s);
  }
  /// Σ 2g cos(middle ± δ) is the difference and the sum of the two.
  HWY_ATTR HWY_INLINE void put(std::size_t left, std::size_t right, ChordFields& fields) const {
    const Floats d;
    const auto increase = [&](float* at, Float by)
                              HWY_ATTR { hn::StoreU(hn::Add(hn::LoadU(d, at), by), d, at); };
    increase(&fields.re[right], hn::Sub(re_c, re_s));
    increase(&fields.im[right], hn::Sub(im_c, im_s));
    increase(&fields.re[left], hn::Add(re_c, re_s));
    increase(&fields.im[left], hn::Add(im_c, im_s));
  }
};

/// Four pairs of the group from `column` on.
HWY_ATTR HWY_INLINE void add_four_pairs(const Nodes& nodes, std::size_t pair, std::size_t batch,
                                        std::size_t column, ChordFields& fields) {
  const Floats d;
  PairSum first, second, third, fourth;
  for (std::size_t j = 0; j < nodes.count * hn::Lanes(d); j += hn::Lanes(d)) {
    const auto rc = hn::LoadU(d, nodes.re_c + j), ic = hn::LoadU(d, nodes.im_c + j);
    const auto rs = hn::LoadU(d, nodes.re_s + j), is = hn::LoadU(d, nodes.im_s + j);
    const auto cosine = [&](std::size_t p) HWY_ATTR { return hn::LoadU(d, nodes.pair_cosine[pair + p] + j); };
    const auto sine = [&](std::size_t p) HWY_ATTR { return hn::LoadU(d, nodes.pair_sine[pair + p] + j); };
    first.add(rc, ic, rs, is, cosine(0), sine(0));
    second.add(rc, ic, rs, is, cosine(1), sine(1));
    third.add(rc, ic, rs, is, cosine(2), sine(2));
    fourth.add(rc, ic, rs, is, cosine(3), sine(3));
  }
  const std::size_t right = column + pairs + pair, left = column + pairs - 1 - pair;
  first.put(fields.at(batch, left), fields.at(batch, right), fields);
  second.put(fields.at(batch, left - 1), fields.at(batch, right + 1), fields);
  third.put(fields.at(batch, left - 2), fields.at(batch, right + 2), fields);
  fourth.put(fields.at(batch, left - 3), fields.at(batch, right + 3), fields);
}

/// \param columns  a multiple of the groups.
HWY_ATTR ChordFields chord_fields(const ChordSum& sum, std::size_t columns) {
  const std::size_t lanes = hn::Lanes(Floats()), chords = sum.beta.size();
  ChordFields fields(chords, columns);
  const auto nodes = std::make_unique<Nodes>();
  for (std::size_t chord = 0; chord < chords; chord += lanes) {
    const std::size_t count = sum.along[chord / ChordSum::chords_together].nodes.size();
    for (std::size_t first = 0; first < count; first += block_nodes) {
      nodes->count = std::min(block_nodes, count - first);
      start_nodes(sum, chord, first, *nodes);
      for (std::size_t c = 0; c < columns; c += 2 * pairs) {
        next_group(*nodes);
        for (std::size_t p = 0; p < pairs; p += 4) add_four_pairs(*nodes, p, chord / lanes, c, fields);
      }
    }
  }
  return fields;
}

/// e^{ikβ_i δ} at distances δ from the middle row, one a lane.
struct RowWaves {
  std::vector<double> cosine, sine;            ///< chords × lanes
  std::vector<double> turn_cosine, turn_sine;  ///< chords: to the next vector of distances
  hwy::AlignedFreeUniquePtr<float[]> re, im;   ///< chords × lanes
};

/// \param first_mm  δ of lane 0; rows are a step apart.
HWY_ATTR RowWaves start_rows(const ChordSum& sum, double first_mm) {
  const Doubles d;
  const std::size_t lanes = hn::Lanes(Floats()), chords = sum.beta.size();
  RowWaves waves;
  waves.cosine.resize(chords * lanes), waves.sine.resize(chords * lanes);
  waves.re = hwy::AllocateAligned<float>(chords * lanes);
  waves.im = hwy::AllocateAligned<float>(chords * lanes);
  waves.turn_cosine.resize(chords), waves.turn_sine.resize(chords);
  Double c, s;
  for (std::size_t i = 0; i < chords; ++i)
    for (std::size_t lane = 0; lane < lanes; lane += hn::Lanes(d)) {
      const auto row = hn::Iota(d, static_cast<double>(lane));
      const auto mm = hn::MulAdd(row, hn::Set(d, sum.row_step_mm), hn::Set(d, first_mm));
      turn_by(Doubles(), hn::Mul(mm, hn::Set(d, sum.beta[i] * sum.waves_per_mm)), c, s);
      hn::StoreU(c, d, &waves.cosine[i * lanes + lane]);
      hn::StoreU(s, d, &waves.sine[i * lanes + lane]);
    }
  const double stride_waves = static_cast<double>(lanes) * sum.row_step_mm * sum.waves_per_mm;
  for (std::size_t i = 0; i < chords; i += hn::Lanes(d)) {  // whole vectors, as chords_together are
    turn_by(Doubles(), hn::Mul(hn::LoadU(d, &sum.beta[i]), hn::Set(d, stride_waves)), c, s);
    hn::StoreU(c, d, &waves.turn_cosine[i]);
    hn::StoreU(s, d, &waves.turn_sine[i]);
  }
  return waves;
}

/// Fills re and im for the next vector of distances.
HWY_ATTR void next_rows(RowWaves& waves) {
  const Doubles d;
  const HalfFloats f;
  const std::size_t lanes = hn::Lanes(Floats());
  for (std::size_t i = 0; i < waves.turn_cosine.size(); ++i) {
    const auto tc = hn::Set(d, waves.turn_cosine[i]), ts = hn::Set(d, waves.turn_sine[i]);
    for (std::size_t at = i * lanes; at < (i + 1) * lanes; at += hn::Lanes(d)) {
      const auto c = hn::LoadU(d, &waves.cosine[at]), s = hn::LoadU(d, &waves.sine[at]);
      hn::StoreU(hn::DemoteTo(f, c), f, &waves.re[at]);
      hn::StoreU(hn::DemoteTo(f, s), f, &waves.im[at]);
      hn::StoreU(hn::MulSub(c, tc, hn::Mul(s, ts)), d, &waves.cosine[at]);
      hn::StoreU(hn::MulAdd(s, tc, hn::Mul(c, ts)), d, &waves.sine[at]);
    }
  }
}

/// U in the rows of the waves at two columns: with C = Σ F cos and S = Σ F sin of kβδ, U(±δ) = C ± iS.
/// \param upper, lower  the entries of the first of these rows, and of the one that mirrors it.
HWY_ATTR HWY_INLINE void sum_two_columns(const RowWaves& waves, const ChordFields& fields, std::size_t column,
                                         std::size_t upper, std::size_t lower, WaveSamples& samples) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  auto c_re0 = hn::Zero(d), c_im0 = c_re0, s_re0 = c_re0, s_im0 = c_re0;
  auto c_re1 = c_re0, c_im1 = c_re0, s_re1 = c_re0, s_im1 = c_re0;
  const float *wave_re = waves.re.get(), *wave_im = waves.im.get();
  for (std::size_t batch = 0; batch < fields.batches; ++batch) {
    const float *re = &fields.re[fields.at(batch, column)], *im = &fields.im[fields.at(batch, column)];
    for (std::size_t i = 0; i < lanes; ++i, wave_re += lanes, wave_im += lanes) {
      const auto c = hn::LoadU(d, wave_re), s = hn::LoadU(d, wave_im);
      const auto r0 = hn::Set(d, re[i]), i0 = hn::Set(d, im[i]);
      const auto r1 = hn::Set(d, re[lanes + i]), i1 = hn::Set(d, im[lanes + i]);
      c_re0 = hn::MulAdd(r0, c, c_re0);
      c_im0 = hn::MulAdd(i0, c, c_im0);
      s_re0 = hn::MulAdd(r0, s, s_re0);
      s_im0 = hn::MulAdd(i0, s, s_im0);
      c_re1 = hn::MulAdd(r1, c, c_re1);
      c_im1 = hn::MulAdd(i1, c, c_im1);
      s_re1 = hn::MulAdd(r1, s, s_re1);
      s_im1 = hn::MulAdd(i1, s, s_im1);
    }
  }
  const auto put = [&](std::size_t to, const auto& c_re, const auto& c_im, const auto& s_re,
                       const auto& s_im) HWY_ATTR {
    hn::StoreU(hn::Sub(c_re, s_im), d, samples.re(to) + upper);
    hn::StoreU(hn::Add(c_im, s_re), d, samples.im(to) + upper);
    float *lower_re = samples.re(to) + lower - (lanes - 1), *lower_im = samples.im(to) + lower - (lanes - 1);
    hn::StoreU(hn::Reverse(d, hn::Add(c_re, s_im)), d, lower_re);
    hn::StoreU(hn::Reverse(d, hn::Sub(c_im, s_re)), d, lower_im);
  };
  put(column, c_re0, c_im0, s_re0, s_im0);
  put(column + 1, c_re1, c_im1, s_re1, s_im1);
}

/// Rows that mirror each other about the middle share their waves, so they are made in pairs, as many at a
/// time as a vector has lanes.
HWY_ATTR void sum_waves(const ChordSum& sum, WaveSamples& samples) {
  const std::size_t lanes = hn::Lanes(Floats());
  const auto columns = static_cast<std::size_t>(sum.columns), rows = static_cast<std::size_t>(sum.rows);
  const ChordFields fields = chord_fields(sum, (columns + 2 * pairs - 1) / (2 * pairs) * (2 * pairs));
  RowWaves waves = start_rows(sum, rows % 2 == 0 ? 0.5 * sum.row_step_mm : 0);
  const std::size_t half = (rows + 1) / 2;  // pairs, the middle row with itself when their number is odd
  for (std::size_t pair = 0; pair < half; pair += lanes) {
    next_rows(waves);
    const std::size_t upper = rows / 2 + pair;
    for (std::size_t c = 0; c < columns; c += 2)
      sum_two_columns(waves, fields, c, upper, rows - 1 - upper, samples);
  }
}

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(sum_waves);

WaveSamples::WaveSamples(int columns, int rows)
    : stride_((static_cast<std::size_t>(rows) + 3 * margin - 1) / margin * margin + margin),
      values_(2 * stride_ * (static_cast<std::size_t>(columns) + columns % 2), 0.0F) {}

WaveSamples sum_chord_waves(const ChordSum& sum) {
  WaveSamples samples(sum.columns, sum.rows);
  if (!sum.beta.empty()) HWY_DYNAMIC_DISPATCH(sum_waves)(sum, samples);
  return samples;
}

}  // namespace petzval
#endif
