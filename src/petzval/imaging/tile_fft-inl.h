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

/// Decimation in frequency: four elements a quarter of a block apart, and the twiddles behind them.
template <bool twiddled>
HWY_ATTR HWY_INLINE void butterfly_forward(float* at, std::size_t quarter, const Complex& w1,
                                           const Complex& w2, const Complex& w3) {
  const Complex x0 = load(at), x1 = load(at + quarter), x2 = load(at + 2 * quarter),
                x3 = load(at + 3 * quarter);
  const Complex t0 = add(x0, x2), t1 = subtract(x0, x2), t2 = add(x1, x3), t3 = turned_difference(x1, x3);
  const Complex y1 = subtract(t1, t3), y2 = subtract(t0, t2), y3 = add(t1, t3);
  store(add(t0, t2), at);
  store(twiddled ? multiply(y1, w1) : y1, at + quarter);
  store(twiddled ? multiply(y2, w2) : y2, at + 2 * quarter);
  store(twiddled ? multiply(y3, w3) : y3, at + 3 * quarter);
}

/// Its inverse, times four.
template <bool twiddled>
HWY_ATTR HWY_INLINE void butterfly_inverse(float* at, std::size_t quarter, const Complex& w1,
                                           const Complex& w2, const Complex& w3) {
  const Complex y0 = load(at);
  Complex y1 = load(at + quarter), y2 = load(at + 2 * quarter), y3 = load(at + 3 * quarter);
  if (twiddled) {
    y1 = multiply_conjugate(y1, w1);
    y2 = multiply_conjugate(y2, w2);
    y3 = multiply_conjugate(y3, w3);
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
  const Complex one{hn::Zero(Lanes()), hn::Zero(Lanes())};
  for (std::size_t at = 0; at < end; at += block)
    if constexpr (forward)
      butterfly_forward<false>(data + at, quarter, one, one, one);
    else
      butterfly_inverse<false>(data + at, quarter, one, one, one);
  for (int j = 1; j < length / 4; ++j) {
    const float* w = twiddles + static_cast<std::size_t>(j) * 6;
    const Complex w1 = broadcast(w), w2 = broadcast(w + 2), w3 = broadcast(w + 4);
    for (std::size_t at = static_cast<std::size_t>(j) * element; at < end; at += block)
      if constexpr (forward)
        butterfly_forward<true>(data + at, quarter, w1, w2, w3);
      else
        butterfly_inverse<true>(data + at, quarter, w1, w2, w3);
  }
}

HWY_ATTR HWY_INLINE void pairs(float* data, int size) {
  const std::size_t element = element_floats();
  for (int i = 0; i < size; i += 2, data += 2 * element) {
    const Complex a = load(data), b = load(data + element);
    store(add(a, b), data);
    store(subtract(a, b), data + element);
  }
}

/// The stages of a transform whose blocks have come down to `length`.
HWY_ATTR inline void forward_from(float* data, int size, int length, const float* twiddles) {
  for (; length >= 4; length /= 4) {
    stage<true>(data, size, length, twiddles);
    twiddles += static_cast<std::size_t>(length / 4) * 6;
  }
  if (length == 2) pairs(data, size);
}

HWY_ATTR inline void inverse(float* data, int size, const float* twiddles) {
  std::array<const float*, 8> at{};
  int stages = 0, length = size;
  for (; length >= 4; length /= 4) {
    at[static_cast<std::size_t>(stages++)] = twiddles;
    twiddles += static_cast<std::size_t>(length / 4) * 6;
  }
  if (length == 2) pairs(data, size);
  for (length = length == 2 ? 8 : 4; stages > 0; length *= 4)
    stage<false>(data, size, length, at[static_cast<std::size_t>(--stages)]);
}

/// Elements [from, size) become zero.
HWY_ATTR HWY_INLINE void pad(float* data, int from, int size) {
  const std::size_t element = element_floats();
  std::fill(data + static_cast<std::size_t>(from) * element, data + static_cast<std::size_t>(size) * element,
            0.0F);
}

/// The transform of `count` elements, each times its weight, and zeros behind them. \param weights  null:
/// all 1.
HWY_ATTR inline void forward_padded(const float* elements, const float* weights, int count, int size,
                                    const float* twiddles, float* data) {
  const Lanes d;
  const std::size_t element = element_floats();
  const auto at = [&](int i) HWY_ATTR {
    const Complex value = load(elements + static_cast<std::size_t>(i) * element);
    if (weights == nullptr) return value;
    const Vector weight = hn::Set(d, weights[i]);
    return Complex{hn::Mul(weight, value.re), hn::Mul(weight, value.im)};
  };
  const int quarter = size / 4;
  if (count > 2 * quarter) {
    for (int i = 0; i < count; ++i) store(at(i), data + static_cast<std::size_t>(i) * element);
    pad(data, count, size);
    return forward_from(data, size, size, twiddles);
  }
  // The first stage knows that at least half of what it takes is zero.
  const std::size_t step = static_cast<std::size_t>(quarter) * element;
  const float* w = twiddles;
  for (int j = 0; j < quarter; ++j, w += 6) {
    float* out = data + static_cast<std::size_t>(j) * element;
    const Complex none{hn::Zero(d), hn::Zero(d)};
    const Complex x0 = j < count ? at(j) : none, x1 = j + quarter < count ? at(j + quarter) : none;
    const Complex turned = turned_difference(x1, none);
    store(add(x0, x1), out);
    store(multiply(subtract(x0, turned), broadcast(w)), out + step);
    store(multiply(subtract(x0, x1), broadcast(w + 2)), out + 2 * step);
    store(multiply(add(x0, turned), broadcast(w + 4)), out + 3 * step);
  }
  forward_from(data, size, quarter, w);
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
