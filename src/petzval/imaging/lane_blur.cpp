// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/lane_blur.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/imaging/lane_blur.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

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

HWY_ATTR void forward(float* data, int size, const float* twiddles) {
  int length = size;
  for (; length >= 4; length /= 4) {
    stage<true>(data, size, length, twiddles);
    twiddles += static_cast<std::size_t>(length / 4) * 6;
  }
  if (length == 2) pairs(data, size);
}

HWY_ATTR void inverse(float* data, int size, const float* twiddles) {
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

HWY_ATTR void transform_kernels(const LaneTransform& transform, const float* kernels, int size, float* otfs,
                                std::size_t stride, std::size_t imaginary) {
  const Lanes d;
  const std::size_t lanes = hn::Lanes(d), element = 2 * lanes;
  const int n = transform.size();
  const auto side = static_cast<std::size_t>(n), rows = static_cast<std::size_t>(size);
  AlignedVector<float> line(side * element), turned(side * rows * element);  // [frequency along x][row]
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < rows; ++column)
      store({hn::Load(d, kernels + (row * rows + column) * lanes), hn::Zero(d)}, &line[column * element]);
    pad(line.data(), size, n);
    forward(line.data(), n, transform.twiddles());
    for (std::size_t k = 0; k < side; ++k)
      store(load(&line[k * element]), &turned[(k * rows + row) * element]);
  }
  for (std::size_t k = 0; k < side; ++k) {
    std::copy_n(&turned[k * rows * element], rows * element, line.data());
    pad(line.data(), size, n);
    forward(line.data(), n, transform.twiddles());
    for (std::size_t l = 0; l < side; ++l) {
      const Complex value = load(&line[l * element]);
      float* at = otfs + (k * side + l) * stride;
      hn::StoreU(value.re, d, at);
      hn::StoreU(value.im, d, at + imaginary);
    }
  }
}

/// sums += otf · spectrum, or sums = otf · spectrum.
HWY_ATTR HWY_INLINE void filter(const float* spectrum, const float* otf, const LaneTiles& tiles, int size,
                                bool first, float* sums) {
  const Lanes d;
  const std::size_t element = element_floats();
  for (int k = 0; k < size; ++k, spectrum += element, sums += element, otf += tiles.otf_stride) {
    const Complex h{hn::LoadU(d, otf), hn::LoadU(d, otf + tiles.otf_imaginary)};
    const Complex product = multiply(load(spectrum), h);
    store(first ? product : add(load(sums), product), sums);
  }
}

HWY_ATTR HWY_INLINE void weigh(const float* elements, const float* weights, int count, float* out) {
  const Lanes d;
  const std::size_t element = element_floats();
  for (int i = 0; i < count; ++i, elements += element, out += element) {
    const Vector weight = hn::Set(d, weights[i]);
    const Complex value = load(elements);
    store({hn::Mul(weight, value.re), hn::Mul(weight, value.im)}, out);
  }
}

HWY_ATTR void blur_tiles(const LaneTransform& transform, const LaneTiles& tiles, LaneTileIo& io,
                         AlignedVector<float>& workspace) {
  const std::size_t element = element_floats();
  const int n = transform.size();
  const auto side = static_cast<std::size_t>(n), tile = static_cast<std::size_t>(tiles.tile),
             extent = static_cast<std::size_t>(tiles.extent), nodes = static_cast<std::size_t>(tiles.nodes);
  // One element more than a row: strides of a power of two would all meet in the same few cache sets.
  const std::size_t turned_row = (tile + 1) * element, row_floats = (side + 1) * element;
  const std::size_t turned_floats = nodes * side * turned_row;
  workspace.resize(turned_floats + extent * row_floats + 2 * side * element + tile * element);
  float* turned = workspace.data();  // [node along x][frequency along x][row]
  float* result = turned + turned_floats;
  float *line = result + extent * row_floats, *sums = line + side * element, *raw = sums + side * element;

  for (std::size_t row = 0; row < tile; ++row) {
    io.load_row(static_cast<int>(row), raw);
    for (std::size_t a = 0; a < nodes; ++a) {
      weigh(raw, tiles.weights + a * tile, tiles.tile, line);
      pad(line, tiles.tile, n);
      forward(line, n, transform.twiddles());
      for (std::size_t k = 0; k < side; ++k)
        store(load(line + k * element), turned + (a * side + k) * turned_row + row * element);
    }
  }
  for (std::size_t k = 0; k < side; ++k) {
    for (std::size_t a = 0; a < nodes; ++a)
      for (std::size_t b = 0; b < nodes; ++b) {
        weigh(turned + (a * side + k) * turned_row, tiles.weights + b * tile, tiles.tile, line);
        pad(line, tiles.tile, n);
        forward(line, n, transform.twiddles());
        filter(line, tiles.otfs[b * nodes + a] + k * side * tiles.otf_stride, tiles, n, a + b == 0, sums);
      }
    inverse(sums, n, transform.twiddles());
    for (std::size_t row = 0; row < extent; ++row)
      store(load(sums + row * element), result + row * row_floats + k * element);
  }
  for (std::size_t row = 0; row < extent; ++row) {
    float* elements = result + row * row_floats;
    inverse(elements, n, transform.twiddles());
    io.store_row(static_cast<int>(row), elements);
  }
}

HWY_ATTR std::size_t width() {
  return hn::Lanes(Lanes());
}

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(width);
HWY_EXPORT(transform_kernels);
HWY_EXPORT(blur_tiles);

std::size_t lane_count() {
  return HWY_DYNAMIC_DISPATCH(width)();
}

LaneTransform::LaneTransform(int size) : size_(size) {
  for (int length = size; length >= 4; length /= 4)
    for (int j = 0; j < length / 4; ++j)
      for (int power = 1; power <= 3; ++power) {
        const double angle = -2 * std::numbers::pi * power * j / length;
        twiddles_.push_back(static_cast<float>(std::cos(angle)));
        twiddles_.push_back(static_cast<float>(std::sin(angle)));
      }
}

void transform_lane_kernels(const LaneTransform& transform, const float* kernels, int size, float* otfs,
                            std::size_t stride, std::size_t imaginary) {
  HWY_DYNAMIC_DISPATCH(transform_kernels)(transform, kernels, size, otfs, stride, imaginary);
}

void blur_lane_tiles(const LaneTransform& transform, const LaneTiles& tiles, LaneTileIo& io,
                     AlignedVector<float>& workspace) {
  HWY_DYNAMIC_DISPATCH(blur_tiles)(transform, tiles, io, workspace);
}

}  // namespace petzval
#endif
