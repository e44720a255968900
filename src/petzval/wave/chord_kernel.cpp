// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/wave/chord_kernel.h>

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/wave/chord_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format off: after highway.h
#include <hwy/contrib/math/math-inl.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::ScalableTag<double>;
using Floats = hn::ScalableTag<float>;
using HalfFloats = hn::Rebind<float, Doubles>;
using Double = hn::Vec<Doubles>;

constexpr double two_pi = 6.283185307179586477;
/// Pairs of sample rows about the middle row that are summed together.
constexpr std::size_t row_pairs = 2;
/// Pairs of columns about a middle that share the nodes' waves there; a power of two.
constexpr std::size_t pairs = 8;

/// e^{2πi cycles}.
HWY_ATTR HWY_INLINE void turn_by(Double cycles, Double& cosine, Double& sine) {
  const Doubles d;
  const auto angle = hn::Mul(hn::Sub(cycles, hn::Round(cycles)), hn::Set(d, two_pi));
  cosine = hn::Cos(d, angle);
  sine = hn::Sin(d, angle);
}

/// Clenshaw's sum of a Chebyshev series at u.
HWY_ATTR HWY_INLINE Double chebyshev_sum(const double* series, std::size_t terms, Double u) {
  const Doubles d;
  const auto twice = hn::Add(u, u);
  auto later = hn::Zero(d), latest = hn::Zero(d);
  for (std::size_t m = terms - 1; m > 0; --m) {
    const auto next = hn::Add(hn::MulSub(twice, latest, later), hn::Set(d, series[m]));
    later = latest;
    latest = next;
  }
  return hn::Add(hn::MulSub(u, latest, later), hn::Set(d, series[0]));
}

/// The nodes of one chord. Columns come in groups of 2·pairs about a middle: kα(middle ± (p + ½) step).
struct Nodes {
  std::size_t count;  ///< padded to whole vectors of floats
  std::vector<double> cosine, sine, turn_cosine,
      turn_sine;                              ///< at the group's middle, and from one to the next
  std::vector<float> re, im;                  ///< 2g
  std::vector<float> pair_cosine, pair_sine;  ///< pairs × count, of kα(p + ½) step
  std::vector<float> group_re_c, group_im_c, group_re_s,
      group_im_s;  ///< 2g times cosine and sine of the group

  explicit Nodes(std::size_t padded) : count(padded) {
    for (std::vector<double>* column : {&cosine, &sine, &turn_cosine, &turn_sine}) column->resize(count);
    for (std::vector<float>* column : {&re, &im, &group_re_c, &group_im_c, &group_re_s, &group_im_s})
      column->resize(count);
    pair_cosine.resize(pairs * count);
    pair_sine.resize(pairs * count);
  }
};

/// (c + is)².
HWY_ATTR HWY_INLINE void square(Double& c, Double& s) {
  const auto real = hn::MulSub(c, c, hn::Mul(s, s));
  s = hn::Mul(hn::Add(c, c), s);
  c = real;
}

HWY_ATTR void start_chord(const ChordSum& sum, const std::vector<double>& node,
                          const std::vector<double>& node_weight, std::size_t chord, Nodes& nodes) {
  const Doubles d;
  const HalfFloats f;
  const double half = sum.half_chord[chord];
  const double* phase = &sum.phase[chord * sum.terms];
  const double* amplitude = &sum.amplitude[chord * sum.terms];
  const double middle_mm = sum.first_column_mm + (static_cast<double>(pairs) - 0.5) * sum.step_mm;
  const double middle_row_mm = sum.first_row_mm + 0.5 * (sum.rows - 1) * sum.step_mm;
  const double row_waves = sum.beta[chord] * sum.waves_per_mm * middle_row_mm;
  const double weight = 2 * half * sum.weight[chord];
  for (std::size_t j = 0; j < nodes.count; j += hn::Lanes(d)) {
    const auto alpha = hn::Mul(hn::Set(d, half), hn::LoadU(d, &node[j]));
    const auto ratio = hn::Mul(alpha, hn::Set(d, 1 / sum.alpha_scale));
    const auto u = hn::MulSub(hn::Add(ratio, ratio), ratio, hn::Set(d, 1.0));
    const auto strength = hn::Mul(hn::Mul(hn::Set(d, weight), hn::LoadU(d, &node_weight[j])),
                                  chebyshev_sum(amplitude, sum.terms, u));
    Double c, s;
    turn_by(hn::Add(chebyshev_sum(phase, sum.terms, u), hn::Set(d, row_waves)), c, s);
    hn::StoreU(hn::DemoteTo(f, hn::Mul(strength, c)), f, &nodes.re[j]);
    hn::StoreU(hn::DemoteTo(f, hn::Mul(strength, s)), f, &nodes.im[j]);
    const auto waves_per_mm = hn::Mul(alpha, hn::Set(d, sum.waves_per_mm));
    turn_by(hn::Mul(waves_per_mm, hn::Set(d, middle_mm)), c, s);
    hn::StoreU(c, d, &nodes.cosine[j]);
    hn::StoreU(s, d, &nodes.sine[j]);
    // Half a step, and by its square the steps from pair to pair and from group to group.
    turn_by(hn::Mul(waves_per_mm, hn::Set(d, 0.5 * sum.step_mm)), c, s);
    Double step_c = c, step_s = s;
    square(step_c, step_s);
    for (std::size_t p = 0; p < pairs; ++p) {
      hn::StoreU(hn::DemoteTo(f, c), f, &nodes.pair_cosine[p * nodes.count + j]);
      hn::StoreU(hn::DemoteTo(f, s), f, &nodes.pair_sine[p * nodes.count + j]);
      const auto next = hn::MulSub(c, step_c, hn::Mul(s, step_s));
      s = hn::MulAdd(s, step_c, hn::Mul(c, step_s));
      c = next;
    }
    for (std::size_t steps = 1; steps < 2 * pairs; steps *= 2) square(step_c, step_s);
    hn::StoreU(step_c, d, &nodes.turn_cosine[j]);
    hn::StoreU(step_s, d, &nodes.turn_sine[j]);
  }
}

/// The nodes' waves at the middle of the present group, and the turn to the next.
HWY_ATTR void next_group(Nodes& nodes) {
  const Doubles d;
  const HalfFloats f;
  for (std::size_t j = 0; j < nodes.count; j += hn::Lanes(d)) {
    const auto c = hn::LoadU(d, &nodes.cosine[j]), s = hn::LoadU(d, &nodes.sine[j]);
    const auto tc = hn::LoadU(d, &nodes.turn_cosine[j]), ts = hn::LoadU(d, &nodes.turn_sine[j]);
    const auto re = hn::LoadU(f, &nodes.re[j]), im = hn::LoadU(f, &nodes.im[j]);
    const auto fc = hn::DemoteTo(f, c), fs = hn::DemoteTo(f, s);
    hn::StoreU(hn::Mul(re, fc), f, &nodes.group_re_c[j]);
    hn::StoreU(hn::Mul(im, fc), f, &nodes.group_im_c[j]);
    hn::StoreU(hn::Mul(re, fs), f, &nodes.group_re_s[j]);
    hn::StoreU(hn::Mul(im, fs), f, &nodes.group_im_s[j]);
    hn::StoreU(hn::MulSub(c, tc, hn::Mul(s, ts)), d, &nodes.cosine[j]);
    hn::StoreU(hn::MulAdd(s, tc, hn::Mul(c, ts)), d, &nodes.sine[j]);
  }
}

/// Two pairs of a group: Σ 2g cos(middle ± δ) = Σ 2g cos(middle) cos δ ∓ Σ 2g sin(middle) sin δ.
HWY_ATTR HWY_INLINE void sum_two_pairs(const Nodes& nodes, std::size_t pair, float* group_re,
                                       float* group_im) {
  const Floats d;
  const float* cosine = &nodes.pair_cosine[pair * nodes.count];
  const float* sine = &nodes.pair_sine[pair * nodes.count];
  auto re_c0 = hn::Zero(d), im_c0 = re_c0, re_s0 = re_c0, im_s0 = re_c0;
  auto re_c1 = re_c0, im_c1 = re_c0, re_s1 = re_c0, im_s1 = re_c0;
  for (std::size_t j = 0; j < nodes.count; j += hn::Lanes(d)) {
    const auto rc = hn::LoadU(d, &nodes.group_re_c[j]), ic = hn::LoadU(d, &nodes.group_im_c[j]);
    const auto rs = hn::LoadU(d, &nodes.group_re_s[j]), is = hn::LoadU(d, &nodes.group_im_s[j]);
    const auto c0 = hn::LoadU(d, cosine + j), c1 = hn::LoadU(d, cosine + nodes.count + j);
    const auto s0 = hn::LoadU(d, sine + j), s1 = hn::LoadU(d, sine + nodes.count + j);
    re_c0 = hn::MulAdd(rc, c0, re_c0);
    im_c0 = hn::MulAdd(ic, c0, im_c0);
    re_s0 = hn::MulAdd(rs, s0, re_s0);
    im_s0 = hn::MulAdd(is, s0, im_s0);
    re_c1 = hn::MulAdd(rc, c1, re_c1);
    im_c1 = hn::MulAdd(ic, c1, im_c1);
    re_s1 = hn::MulAdd(rs, s1, re_s1);
    im_s1 = hn::MulAdd(is, s1, im_s1);
  }
  const auto put = [&](std::size_t p, const auto& c, const auto& s, float* group) HWY_ATTR {
    group[pairs + p] = hn::GetLane(hn::SumOfLanes(d, hn::Sub(c, s)));
    group[pairs - 1 - p] = hn::GetLane(hn::SumOfLanes(d, hn::Add(c, s)));
  };
  put(pair, re_c0, re_s0, group_re);
  put(pair, im_c0, im_s0, group_im);
  put(pair + 1, re_c1, re_s1, group_re);
  put(pair + 1, im_c1, im_s1, group_im);
}

/// weight_i e^{ikβ_i t} F_i at every column and at the t of the middle row, a vector of columns after
/// another: [column / lanes][chord][column mod lanes].
struct ChordFields {
  std::size_t chords, lanes;
  std::vector<float> re, im;

  ChordFields(std::size_t chord_count, std::size_t columns)
      : chords(chord_count), lanes(hn::Lanes(Floats())), re(chords * columns), im(chords * columns) {}
  std::size_t at(std::size_t column, std::size_t chord) const {
    return (column / lanes * chords + chord) * lanes + column % lanes;
  }
};

/// \param columns  a multiple of the lanes and of the groups.
HWY_ATTR ChordFields chord_fields(const ChordSum& sum, std::size_t columns) {
  const std::size_t lanes = hn::Lanes(Floats());
  Nodes nodes((sum.node.size() + lanes - 1) / lanes * lanes);
  std::vector<double> node = sum.node, node_weight = sum.node_weight;
  node.resize(nodes.count, 0.0);
  node_weight.resize(nodes.count, 0.0);
  ChordFields fields(sum.beta.size(), columns);
  float group_re[2 * pairs], group_im[2 * pairs];
  for (std::size_t i = 0; i < sum.beta.size(); ++i) {
    start_chord(sum, node, node_weight, i, nodes);
    for (std::size_t c = 0; c < columns; c += 2 * pairs) {
      next_group(nodes);
      for (std::size_t p = 0; p < pairs; p += 2) sum_two_pairs(nodes, p, group_re, group_im);
      for (std::size_t k = 0; k < 2 * pairs; ++k) {
        fields.re[fields.at(c + k, i)] = group_re[k];
        fields.im[fields.at(c + k, i)] = group_im[k];
      }
    }
  }
  return fields;
}

/// e^{ikβ_i δ} at the distances δ of a group of row pairs from the middle row, by turns from group to group.
struct RowWaves {
  std::vector<double> cosine, sine, turn_cosine, turn_sine;  ///< chords; the next distance
  std::vector<float> re, im;                                 ///< chords × row_pairs
};

HWY_ATTR RowWaves start_rows(const ChordSum& sum) {
  const Doubles d;
  const std::size_t lanes = hn::Lanes(d), padded = (sum.beta.size() + lanes - 1) / lanes * lanes;
  std::vector<double> beta = sum.beta;
  beta.resize(padded, 0.0);
  RowWaves waves;
  for (std::vector<double>* column : {&waves.cosine, &waves.sine, &waves.turn_cosine, &waves.turn_sine})
    column->resize(padded);
  waves.re.resize(padded * row_pairs);
  waves.im.resize(padded * row_pairs);
  const double first_mm = sum.rows % 2 == 0 ? 0.5 * sum.step_mm : 0;
  for (std::size_t i = 0; i < padded; i += lanes) {
    const auto waves_per_mm = hn::Mul(hn::LoadU(d, &beta[i]), hn::Set(d, sum.waves_per_mm));
    Double cosine, sine;
    turn_by(hn::Mul(waves_per_mm, hn::Set(d, first_mm)), cosine, sine);
    hn::StoreU(cosine, d, &waves.cosine[i]);
    hn::StoreU(sine, d, &waves.sine[i]);
    turn_by(hn::Mul(waves_per_mm, hn::Set(d, sum.step_mm)), cosine, sine);
    hn::StoreU(cosine, d, &waves.turn_cosine[i]);
    hn::StoreU(sine, d, &waves.turn_sine[i]);
  }
  return waves;
}

/// Fills re and im for the next distances.
HWY_ATTR void next_rows(RowWaves& waves) {
  for (std::size_t i = 0; i < waves.cosine.size(); ++i)
    for (std::size_t r = 0; r < row_pairs; ++r) {
      waves.re[i * row_pairs + r] = static_cast<float>(waves.cosine[i]);
      waves.im[i * row_pairs + r] = static_cast<float>(waves.sine[i]);
      const double c = waves.cosine[i], s = waves.sine[i];
      waves.cosine[i] = c * waves.turn_cosine[i] - s * waves.turn_sine[i];
      waves.sine[i] = s * waves.turn_cosine[i] + c * waves.turn_sine[i];
    }
}

/// |U|² of a group of row pairs at the vector of columns from `column` on: with C = Σ F cos and S = Σ F sin
/// of kβδ, U(±δ) = C ± iS. \param intensity  2 · row_pairs rows of `columns`, the upper row of each pair
/// first.
HWY_ATTR HWY_INLINE void sum_tile(const RowWaves& waves, const ChordFields& fields, std::size_t column,
                                  std::size_t columns, float* intensity) {
  const Floats d;
  auto c_re0 = hn::Zero(d), c_im0 = c_re0, s_re0 = c_re0, s_im0 = c_re0;
  auto c_re1 = c_re0, c_im1 = c_re0, s_re1 = c_re0, s_im1 = c_re0;
  const float* field_re = &fields.re[fields.at(column, 0)];
  const float* field_im = &fields.im[fields.at(column, 0)];
  for (std::size_t i = 0; i < fields.chords; ++i) {
    const auto re = hn::LoadU(d, field_re + i * fields.lanes), im = hn::LoadU(d, field_im + i * fields.lanes);
    const auto c0 = hn::Set(d, waves.re[i * row_pairs]), s0 = hn::Set(d, waves.im[i * row_pairs]);
    const auto c1 = hn::Set(d, waves.re[i * row_pairs + 1]), s1 = hn::Set(d, waves.im[i * row_pairs + 1]);
    c_re0 = hn::MulAdd(re, c0, c_re0);
    c_im0 = hn::MulAdd(im, c0, c_im0);
    s_re0 = hn::MulAdd(re, s0, s_re0);
    s_im0 = hn::MulAdd(im, s0, s_im0);
    c_re1 = hn::MulAdd(re, c1, c_re1);
    c_im1 = hn::MulAdd(im, c1, c_im1);
    s_re1 = hn::MulAdd(re, s1, s_re1);
    s_im1 = hn::MulAdd(im, s1, s_im1);
  }
  const auto put = [&](std::size_t row, const auto& re, const auto& im) HWY_ATTR {
    hn::StoreU(hn::MulAdd(re, re, hn::Mul(im, im)), d, intensity + row * columns + column);
  };
  put(0, hn::Sub(c_re0, s_im0), hn::Add(c_im0, s_re0));
  put(1, hn::Add(c_re0, s_im0), hn::Sub(c_im0, s_re0));
  put(2, hn::Sub(c_re1, s_im1), hn::Add(c_im1, s_re1));
  put(3, hn::Add(c_re1, s_im1), hn::Sub(c_im1, s_re1));
}

/// What a sample gives to the cell beside it, if it is the last of its own: its interval holds
/// f + (f₊ − 2f + f₋)/24, to fourth order in the spacing.
constexpr double to_neighbour = 1.0 / 24;

template <class Add>
void share_out(std::size_t sample, std::size_t samples, std::size_t cell, double value, const Add& add) {
  const std::size_t own = sample / cell;
  const std::size_t before = sample > 0 ? (sample - 1) / cell : own;
  const std::size_t after = sample + 1 < samples ? (sample + 1) / cell : own;
  if (cell == 1 || (before == own && after == own)) return add(own, value);
  add(own, (1 - 2 * to_neighbour) * value);
  add(before, to_neighbour * value);
  add(after, to_neighbour * value);
}

/// One row of samples in cells; cell 0 lies about s = 0, so that what is left of it mirrors its right.
void bin_columns(const float* intensity, std::size_t columns, std::size_t cell, std::vector<double>& cells) {
  std::fill(cells.begin(), cells.end(), 0.0);
  for (std::size_t j = 0; j < columns; ++j)
    share_out(j, columns, cell, static_cast<double>(intensity[j]),
              [&](std::size_t to, double value) { cells[to] += value; });
  if (cell > 1 && cell < columns)
    cells[0] += to_neighbour * (static_cast<double>(intensity[cell]) - static_cast<double>(intensity[0]));
}

HWY_ATTR void sum_cells(const ChordSum& sum, double* cells) {
  const std::size_t lanes = hn::Lanes(Floats()), unit = std::max(lanes, 2 * pairs);
  const auto columns = static_cast<std::size_t>(sum.columns), rows = static_cast<std::size_t>(sum.rows);
  const auto cell = static_cast<std::size_t>(sum.cell), cell_columns = columns / cell;
  const std::size_t padded = (columns + unit - 1) / unit * unit;
  const ChordFields fields = chord_fields(sum, padded);
  RowWaves waves = start_rows(sum);
  std::vector<float> intensity(2 * row_pairs * padded);
  std::vector<double> in_cells(cell_columns);
  const auto bin_row = [&](std::size_t row, const float* samples) {
    bin_columns(samples, columns, cell, in_cells);
    share_out(row, rows, cell, 1.0, [&](std::size_t to, double share) {
      for (std::size_t j = 0; j < cell_columns; ++j) cells[to * cell_columns + j] += share * in_cells[j];
    });
  };
  const std::size_t half = (rows + 1) / 2;  // pairs, the middle row with itself when their number is odd
  for (std::size_t pair = 0; pair < half; pair += row_pairs) {
    next_rows(waves);
    for (std::size_t c = 0; c < padded; c += lanes) sum_tile(waves, fields, c, padded, intensity.data());
    for (std::size_t r = 0; r < std::min(row_pairs, half - pair); ++r) {
      const std::size_t upper = rows / 2 + pair + r, lower = rows - 1 - upper;
      bin_row(upper, &intensity[2 * r * padded]);
      if (lower != upper) bin_row(lower, &intensity[(2 * r + 1) * padded]);
    }
  }
}

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(sum_cells);

void sum_chord_cells(const ChordSum& sum, std::vector<double>& cells) {
  const int cell_columns = sum.columns / sum.cell, cell_rows = sum.rows / sum.cell;
  cells.assign(static_cast<std::size_t>(cell_columns) * static_cast<std::size_t>(cell_rows), 0.0);
  if (!sum.beta.empty()) HWY_DYNAMIC_DISPATCH(sum_cells)(sum, cells.data());
}

}  // namespace petzval
#endif
