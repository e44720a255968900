// SPDX-License-Identifier: BSD-3-Clause
// Transforms along lines of complex elements whose lanes are rows or columns of a tile (tile_blur.h), once
// per instruction set.
#if defined(PETZVAL_IMAGING_TILE_FFT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PETZVAL_IMAGING_TILE_FFT_INL_H_
#undef PETZVAL_IMAGING_TILE_FFT_INL_H_
#else
#define PETZVAL_IMAGING_TILE_FFT_INL_H_
#endif

#include <hwy/highway.h>
#include <petzval/imaging/tile_blur.h>

#include <algorithm>
#include <array>
#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, 16>;
using Vector = hn::Vec<Lanes>;

/// Floats of an element: one vector of real parts, one of imaginary parts.
HWY_ATTR HWY_INLINE std::size_t element_floats() {
  return 2 * hn::Lanes(Lanes());
}

struct Complex {
  Vector re, im;
};

HWY_ATTR HWY_INLINE Complex load(const float* at) {
  const Lanes d;
  return {hn::Load(d, at), hn::Load(d, at + hn::Lanes(d))};
}
HWY_ATTR HWY_INLINE void store(const Complex& value, float* at) {
  const Lanes d;
  hn::Store(value.re, d, at);
  hn::Store(value.im, d, at + hn::Lanes(d));
}
HWY_ATTR HWY_INLINE Complex add(const Complex& a, const Complex& b) {
  return {hn::Add(a.re, b.re), hn::Add(a.im, b.im)};
}
HWY_ATTR HWY_INLINE Complex subtract(const Complex& a, const Complex& b) {
  return {hn::Sub(a.re, b.re), hn::Sub(a.im, b.im)};
}
/// (a − b)·i.
HWY_ATTR HWY_INLINE Complex turned_difference(const Complex& a, const Complex& b) {
  return {hn::Sub(b.im, a.im), hn::Sub(a.re, b.re)};
}
HWY_ATTR HWY_INLINE Complex multiply(const Complex& a, const Complex& b) {
  return {hn::NegMulAdd(a.im, b.im, hn::Mul(a.re, b.re)), hn::MulAdd(a.re, b.im, hn::Mul(a.im, b.re))};
}
/// a times the conjugate of b.
HWY_ATTR HWY_INLINE Complex multiply_conjugate(const Complex& a, const Complex& b) {
  return {hn::MulAdd(a.im, b.im, hn::Mul(a.re, b.re)), hn::NegMulAdd(a.re, b.im, hn::Mul(a.im, b.re))};
}
HWY_ATTR HWY_INLINE Complex broadcast(const float* twiddle) {
  const Lanes d;
  return {hn::Set(d, twiddle[0]), hn::Set(d, twiddle[1])};
}

/// Decimation in frequency. \param x  of a stage whose blocks fall into four. \param out  four elements that
/// far apart. \param w  twiddles {re, im} of the last three; null: all 1.
HWY_ATTR HWY_INLINE void butterfly_forward(const Complex& x0, const Complex& x1, const Complex& x2,
                                           const Complex& x3, const float* w, float* out,
                                           std::size_t quarter) {
  const Complex t0 = add(x0, x2), t1 = subtract(x0, x2), t2 = add(x1, x3), t3 = turned_difference(x1, x3);
  const Complex y1 = subtract(t1, t3), y2 = subtract(t0, t2), y3 = add(t1, t3);
  store(add(t0, t2), out);
  store(w != nullptr ? multiply(y1, broadcast(w)) : y1, out + quarter);
  store(w != nullptr ? multiply(y2, broadcast(w + 2)) : y2, out + 2 * quarter);
  store(w != nullptr ? multiply(y3, broadcast(w + 4)) : y3, out + 3 * quarter);
}

/// Its inverse, times four.
HWY_ATTR HWY_INLINE void butterfly_inverse(float* at, std::size_t quarter, const float* w) {
  const Complex y0 = load(at);
  Complex y1 = load(at + quarter), y2 = load(at + 2 * quarter), y3 = load(at + 3 * quarter);
  if (w != nullptr) {
    y1 = multiply_conjugate(y1, broadcast(w));
    y2 = multiply_conjugate(y2, broadcast(w + 2));
    y3 = multiply_conjugate(y3, broadcast(w + 4));
  }
  const Complex t0 = add(y0, y2), t1 = subtract(y0, y2), t2 = add(y1, y3), t3 = turned_difference(y1, y3);
  store(add(t0, t2), at);
  store(add(t1, t3), at + quarter);
  store(subtract(t0, t2), at + 2 * quarter);
  store(subtract(t1, t3), at + 3 * quarter);
}

template <bool forward>
HWY_ATTR HWY_INLINE void stage(float* data, int size, int length, const float* twiddles) {
  const std::size_t element = element_floats();
  const auto quarter = static_cast<std::size_t>(length / 4) * element,
             block = static_cast<std::size_t>(length) * element,
             end = static_cast<std::size_t>(size) * element;
  const auto butterfly = [&](float* at, const float* w) HWY_ATTR {
    if constexpr (forward)
      butterfly_forward(load(at), load(at + quarter), load(at + 2 * quarter), load(at + 3 * quarter), w, at,
                        quarter);
    else
      butterfly_inverse(at, quarter, w);
  };
  for (std::size_t at = 0; at < end; at += block) butterfly(data + at, nullptr);
  for (int j = 1; j < length / 4; ++j)
    for (std::size_t at = static_cast<std::size_t>(j) * element; at < end; at += block)
      butterfly(data + at, twiddles + static_cast<std::size_t>(j) * 6);
}

/// Transforms of the shortest blocks, in place: two, three, four or six elements, in order.
template <bool forward>
HWY_ATTR HWY_INLINE void short_transform(std::array<Complex, 2>& x) {
  x = {add(x[0], x[1]), subtract(x[0], x[1])};
}
template <bool forward>
HWY_ATTR HWY_INLINE void short_transform(std::array<Complex, 3>& x) {
  const Vector half = hn::Set(Lanes(), 0.5F), sine = hn::Set(Lanes(), 0.866025403784438647F);
  const Complex sum = add(x[1], x[2]), difference = subtract(x[1], x[2]);
  const Complex middle{hn::NegMulAdd(half, sum.re, x[0].re), hn::NegMulAdd(half, sum.im, x[0].im)};
  // −i·√3/2·difference.
  const Complex turned{hn::Mul(sine, difference.im), hn::Neg(hn::Mul(sine, difference.re))};
  const Complex with = add(middle, turned), against = subtract(middle, turned);
  x = {add(x[0], sum), forward ? with : against, forward ? against : with};
}
template <bool forward>
HWY_ATTR HWY_INLINE void short_transform(std::array<Complex, 4>& x) {
  const Complex t0 = add(x[0], x[2]), t1 = subtract(x[0], x[2]), t2 = add(x[1], x[3]),
                t3 = turned_difference(x[1], x[3]);
  const Complex with = add(t1, t3), against = subtract(t1, t3);
  x = {add(t0, t2), forward ? against : with, subtract(t0, t2), forward ? with : against};
}
template <bool forward>
HWY_ATTR HWY_INLINE void short_transform(std::array<Complex, 6>& x) {
  // By prime factors: element 3a + 2b (mod 6), frequency ≡ c (mod 2), ≡ d (mod 3); no twiddles.
  std::array<Complex, 3> even{add(x[0], x[3]), add(x[2], x[5]), add(x[4], x[1])},
      odd{subtract(x[0], x[3]), subtract(x[2], x[5]), subtract(x[4], x[1])};
  short_transform<forward>(even);
  short_transform<forward>(odd);
  x = {even[0], odd[1], even[2], odd[0], even[1], odd[2]};
}

/// The shortest blocks of a line. \param use  (place, element) of what comes out.
template <bool forward, std::size_t length, typename Use>
HWY_ATTR HWY_INLINE void short_blocks(const float* data, int size, const Use& use) {
  const std::size_t element = element_floats();
  for (std::size_t at = 0; at < static_cast<std::size_t>(size); at += length) {
    std::array<Complex, length> x;
    HWY_UNROLL(6)
    for (std::size_t i = 0; i < length; ++i) x[i] = load(data + (at + i) * element);
    short_transform<forward>(x);
    HWY_UNROLL(6)
    for (std::size_t i = 0; i < length; ++i) use(at + i, x[i]);
  }
}
template <bool forward, typename Use>
HWY_ATTR HWY_INLINE void short_blocks(const float* data, int size, const Use& use) {
  switch (shortest_block(size)) {
    case 2:
      return short_blocks<forward, 2>(data, size, use);
    case 3:
      return short_blocks<forward, 3>(data, size, use);
    case 4:
      return short_blocks<forward, 4>(data, size, use);
    default:
      return short_blocks<forward, 6>(data, size, use);
  }
}

HWY_ATTR inline void inverse(float* data, int size, const float* twiddles) {
  const std::size_t element = element_floats();
  std::array<const float*, 8> at{};
  int stages = 0;
  for (int length = size; length > shortest_block(size); length /= 4) {
    at[static_cast<std::size_t>(stages++)] = twiddles;
    twiddles += static_cast<std::size_t>(length / 4) * 6;
  }
  short_blocks<false>(data, size,
                      [&](std::size_t i, const Complex& x) HWY_ATTR { store(x, data + i * element); });
  for (int length = 4 * shortest_block(size); stages > 0; length *= 4)
    stage<false>(data, size, length, at[static_cast<std::size_t>(--stages)]);
}

/// Elements of a line whose places behind `count` are zero.
struct PaddedLine {
  const float* elements;
  const float* weights;  ///< of each; null: all 1
  int count;
};

/// The first stage, of elements [from, to) of each quarter, of which `quarters` are not zero.
template <int quarters, bool weighted>
HWY_ATTR HWY_INLINE void first_stage(const PaddedLine& line, int from, int to, int quarter,
                                     const float* twiddles, float* data) {
  const Lanes d;
  const std::size_t element = element_floats(), step = static_cast<std::size_t>(quarter) * element;
  const Complex none{hn::Zero(d), hn::Zero(d)};
  const auto at = [&](int i) HWY_ATTR {
    const Complex value = load(line.elements + static_cast<std::size_t>(i) * element);
    if (!weighted) return value;
    const Vector weight = hn::Set(d, line.weights[i]);
    return Complex{hn::Mul(weight, value.re), hn::Mul(weight, value.im)};
  };
  for (int j = from; j < to; ++j)
    butterfly_forward(at(j), quarters > 1 ? at(j + quarter) : none, quarters > 2 ? at(j + 2 * quarter) : none,
                      quarters > 3 ? at(j + 3 * quarter) : none, twiddles + static_cast<std::size_t>(j) * 6,
                      data + static_cast<std::size_t>(j) * element, step);
}
template <bool weighted>
HWY_ATTR inline void first_stage(const PaddedLine& line, int quarter, const float* twiddles, float* data) {
  const int full = std::min(line.count / quarter, 4), rest = full < 4 ? line.count - full * quarter : 0;
  const auto run = [&](int quarters, int from, int to) HWY_ATTR {
    switch (quarters) {
      case 0: {
        const Complex none{hn::Zero(Lanes()), hn::Zero(Lanes())};
        for (int j = from; j < to; ++j)
          for (int k = 0; k < 4; ++k)
            store(none, data + static_cast<std::size_t>(j + k * quarter) * element_floats());
        return;
      }
      case 1:
        return first_stage<1, weighted>(line, from, to, quarter, twiddles, data);
      case 2:
        return first_stage<2, weighted>(line, from, to, quarter, twiddles, data);
      case 3:
        return first_stage<3, weighted>(line, from, to, quarter, twiddles, data);
      default:
        return first_stage<4, weighted>(line, from, to, quarter, twiddles, data);
    }
  };
  run(full + 1, 0, rest);
  run(full, rest, quarter);
}

/// The transform of a padded line. \param data  room for `size` elements. \param use  (place, element) of
/// what comes out, once for each place.
template <typename Use>
HWY_ATTR HWY_INLINE void forward(const PaddedLine& line, int size, const float* twiddles, float* data,
                                 const Use& use) {
  if (line.weights != nullptr)
    first_stage<true>(line, size / 4, twiddles, data);
  else
    first_stage<false>(line, size / 4, twiddles, data);
  for (int length = size / 4; length > shortest_block(size); length /= 4) {
    twiddles += static_cast<std::size_t>(length) * 6;
    stage<true>(data, size, length, twiddles);
  }
  short_blocks<true>(data, size, use);
}

/// The same where all of what comes out stays in `data`.
HWY_ATTR inline void forward(const PaddedLine& line, int size, const float* twiddles, float* data) {
  const std::size_t element = element_floats();
  forward(line, size, twiddles, data,
          [&](std::size_t i, const Complex& x) HWY_ATTR { store(x, data + i * element); });
}

/// A square of floats, as many as a vector has: vector i of what comes out holds what the vectors that go in
/// hold in lane i. \param from  (i) ↦ where vector i is. \param to  (i) ↦ where vector i goes.
template <typename From, typename To>
HWY_ATTR HWY_INLINE void transpose(const From& from, const To& to) {
  const Lanes d;
  constexpr std::size_t lanes = hn::MaxLanes(Lanes());
  std::array<Vector, lanes> in;
  HWY_UNROLL(16)
  for (std::size_t i = 0; i < lanes; ++i) in[i] = hn::Load(d, from(i));
#if HWY_TARGET != HWY_SCALAR
  std::array<Vector, lanes> out;
  // Number of vector and number of lane, written one behind the other in binary, turn by a digit each time.
  HWY_UNROLL(4)
  for (std::size_t digit = 1; digit < lanes; digit *= 2) {
    HWY_UNROLL(8)
    for (std::size_t i = 0; i < lanes / 2; ++i) {
      out[i] = hn::ConcatEven(d, in[2 * i + 1], in[2 * i]);
      out[lanes / 2 + i] = hn::ConcatOdd(d, in[2 * i + 1], in[2 * i]);
    }
    in = out;
  }
#endif
  HWY_UNROLL(16)
  for (std::size_t i = 0; i < lanes; ++i) hn::Store(in[i], d, to(i));
}

/// What is laid out in whole vectors.
HWY_ATTR HWY_INLINE std::size_t whole_vectors(int count) {
  const std::size_t lanes = hn::Lanes(Lanes());
  return (static_cast<std::size_t>(count) + lanes - 1) / lanes;
}

/// Rows of a tile that become columns of frequencies, lane by lane.
struct RowPass {
  std::size_t width;        ///< floats of a row of whole vectors
  float *real, *imaginary;  ///< [lane][column]
  float *elements, *line;   ///< [column]{re, im}[lane], and transformed
  static std::size_t floats(int count, int size) {
    const std::size_t lanes = hn::Lanes(Lanes()), width = whole_vectors(count) * lanes;
    return 4 * lanes * width + static_cast<std::size_t>(size) * 2 * lanes;
  }
  RowPass(int count, float* memory) : width(whole_vectors(count) * hn::Lanes(Lanes())) {
    const std::size_t plane = hn::Lanes(Lanes()) * width;
    real = memory;
    imaginary = real + plane;
    elements = imaginary + plane;
    line = elements + 2 * plane;
  }
};

/// From rows to elements.
HWY_ATTR HWY_INLINE void rows_to_elements(const RowPass& pass) {
  const std::size_t lanes = hn::Lanes(Lanes()), element = 2 * lanes;
  for (std::size_t column = 0; column < pass.width; column += lanes) {
    float* out = pass.elements + column * element;
    transpose([&](std::size_t i) HWY_ATTR { return pass.real + i * pass.width + column; },
              [&](std::size_t i) HWY_ATTR { return out + i * element; });
    transpose([&](std::size_t i) HWY_ATTR { return pass.imaginary + i * pass.width + column; },
              [&](std::size_t i) HWY_ATTR { return out + lanes + i * element; });
  }
}

/// From places of a line, whose lanes are rows, to elements that follow each other, whose lanes are those
/// places.
HWY_ATTR HWY_INLINE void turn_columns(const float* line, const int* places, float* out) {
  const std::size_t lanes = hn::Lanes(Lanes()), element = 2 * lanes;
  for (const std::size_t part : {std::size_t{0}, lanes})
    transpose([&](std::size_t i)
                  HWY_ATTR { return line + static_cast<std::size_t>(places[i]) * element + part; },
              [&](std::size_t i) HWY_ATTR { return out + i * element + part; });
}

/// And back.
HWY_ATTR HWY_INLINE void turn_back(const float* elements, const int* places, float* line) {
  const std::size_t lanes = hn::Lanes(Lanes()), element = 2 * lanes;
  for (const std::size_t part : {std::size_t{0}, lanes})
    transpose([&](std::size_t i) HWY_ATTR { return elements + i * element + part; },
              [&](std::size_t i)
                  HWY_ATTR { return line + static_cast<std::size_t>(places[i]) * element + part; });
}

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
