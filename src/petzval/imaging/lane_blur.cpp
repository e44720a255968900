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

/// Elements of a line, a stride apart.
HWY_ATTR HWY_INLINE void copy_line(const float* from, int count, float* line) {
  std::copy_n(from, static_cast<std::size_t>(count) * element_floats(), line);
}

/// Of two real kernels a and b, whose transforms come as those of a + ib at k and at −k.
HWY_ATTR HWY_INLINE void separate(const Complex& plus, const Complex& minus, Complex& a, Complex& b) {
  const Vector half = hn::Set(Lanes(), 0.5F);
  a = {hn::Mul(half, hn::Add(plus.re, minus.re)), hn::Mul(half, hn::Sub(plus.im, minus.im))};
  b = {hn::Mul(half, hn::Add(plus.im, minus.im)), hn::Mul(half, hn::Sub(minus.re, plus.re))};
}

HWY_ATTR void transform_kernels(const LaneTransform& transform, const std::array<const float*, 2>& kernels,
                                int size, const std::array<float*, 2>& otfs, std::size_t stride,
                                std::size_t imaginary) {
  const Lanes d;
  const std::size_t lanes = hn::Lanes(d), element = 2 * lanes;
  const int n = transform.size();
  const auto side = static_cast<std::size_t>(n), rows = static_cast<std::size_t>(size);
  const std::size_t turned_row = (rows + 1) * element;  // as in blur_tiles()
  AlignedVector<float> work(2 * side * element + side * turned_row);
  float *line = work.data(), *other = line + side * element;
  float* turned = other + side * element;  // [frequency along x][row]
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < rows; ++column) {
      const std::size_t at = (row * rows + column) * lanes;
      store({hn::Load(d, kernels[0] + at), hn::Load(d, kernels[1] + at)}, line + column * element);
    }
    pad(line, size, n);
    forward(line, n, transform.twiddles());
    for (std::size_t k = 0; k < side; ++k)
      store(load(line + k * element), turned + k * turned_row + row * element);
  }
  const auto column_of = [&](int k, float* out) {
    copy_line(turned + static_cast<std::size_t>(k) * turned_row, size, out);
    pad(out, size, n);
    forward(out, n, transform.twiddles());
  };
  std::size_t at = 0;
  for (const LaneTransform::ColumnPair& columns : transform.columns()) {
    column_of(columns.kept, line);
    if (columns.mirrored != columns.kept) column_of(columns.mirrored, other);
    const float* minus = columns.mirrored != columns.kept ? other : line;
    for (std::size_t k = 0; k < side; ++k, at += stride) {
      Complex a, b;
      separate(load(line + k * element),
               load(minus + static_cast<std::size_t>(transform.mirrored()[k]) * element), a, b);
      hn::StoreU(a.re, d, otfs[0] + at);
      hn::StoreU(a.im, d, otfs[0] + at + imaginary);
      if (otfs[1] == nullptr) continue;
      hn::StoreU(b.re, d, otfs[1] + at);
      hn::StoreU(b.im, d, otfs[1] + at + imaginary);
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

/// The same for the column that holds −k where the transfer functions kept are those at k.
HWY_ATTR HWY_INLINE void filter_mirrored(const float* spectrum, const float* otf, const LaneTiles& tiles,
                                         const std::vector<int>& mirrored, bool first, float* sums) {
  const Lanes d;
  const std::size_t element = element_floats();
  for (const int partner : mirrored) {
    const float* at = otf + static_cast<std::size_t>(partner) * tiles.otf_stride;
    const Complex h{hn::LoadU(d, at), hn::LoadU(d, at + tiles.otf_imaginary)};
    const Complex product = multiply_conjugate(load(spectrum), h);
    store(first ? product : add(load(sums), product), sums);
    spectrum += element;
    sums += element;
  }
}

/// What the tiles of one set become on the way.
struct Workspace {
  std::size_t turned_row, turned_node, result_row;  ///< floats from one to the next
  float* turned;                                    ///< [node along x][frequency along x][row]
  float* result;                                    ///< [row][frequency along x]
  float *line, *sums;
};

HWY_ATTR void transform_rows(const LaneTransform& transform, const LaneTiles& tiles, LaneTileIo& io,
                             std::size_t set, const Workspace& work) {
  const std::size_t element = element_floats();
  const int n = transform.size();
  for (int row = 0; row < tiles.tile; ++row) {
    io.load_row(set, row, work.sums);
    for (int a = 0; a < tiles.nodes; ++a) {
      weigh(work.sums, tiles.weights + a * tiles.tile, tiles.tile, work.line);
      pad(work.line, tiles.tile, n);
      forward(work.line, n, transform.twiddles());
      float* turned = work.turned + static_cast<std::size_t>(a) * work.turned_node +
                      static_cast<std::size_t>(row) * element;
      for (int k = 0; k < n; ++k, turned += work.turned_row)
        store(load(work.line + static_cast<std::size_t>(k) * element), turned);
    }
  }
}

HWY_ATTR void filter_column(const LaneTransform& transform, const LaneTiles& tiles, int column,
                            std::size_t kept, bool mirrored, const Workspace& work) {
  const std::size_t element = element_floats();
  const int n = transform.size();
  const auto k = static_cast<std::size_t>(column), nodes = static_cast<std::size_t>(tiles.nodes);
  for (std::size_t a = 0; a < nodes; ++a)
    for (std::size_t b = 0; b < nodes; ++b) {
      weigh(work.turned + a * work.turned_node + k * work.turned_row,
            tiles.weights + b * static_cast<std::size_t>(tiles.tile), tiles.tile, work.line);
      pad(work.line, tiles.tile, n);
      forward(work.line, n, transform.twiddles());
      const float* otf = tiles.otfs[b * nodes + a] + kept * static_cast<std::size_t>(n) * tiles.otf_stride;
      if (mirrored)
        filter_mirrored(work.line, otf, tiles, transform.mirrored(), a + b == 0, work.sums);
      else
        filter(work.line, otf, tiles, n, a + b == 0, work.sums);
    }
  inverse(work.sums, n, transform.twiddles());
  float* result = work.result + k * element;
  for (int row = 0; row < tiles.extent; ++row, result += work.result_row)
    store(load(work.sums + static_cast<std::size_t>(row) * element), result);
}

HWY_ATTR void blur_tiles(const LaneTransform& transform, const LaneTiles& tiles, LaneTileIo& io,
                         AlignedVector<float>& memory) {
  const std::size_t element = element_floats();
  const int n = transform.size();
  const auto side = static_cast<std::size_t>(n), extent = static_cast<std::size_t>(tiles.extent);
  // One element more than a row: strides of a power of two would all meet in the same few cache sets.
  Workspace work{};
  work.turned_row = (static_cast<std::size_t>(tiles.tile) + 1) * element;
  work.turned_node = side * work.turned_row;
  work.result_row = (side + 1) * element;
  const std::size_t turned_floats = static_cast<std::size_t>(tiles.nodes) * work.turned_node,
                    set_floats = turned_floats + extent * work.result_row;
  memory.resize(io.sets() * set_floats + 2 * side * element);
  work.line = memory.data() + io.sets() * set_floats;
  work.sums = work.line + side * element;
  const auto select = [&](std::size_t set) {
    work.turned = memory.data() + set * set_floats;
    work.result = work.turned + turned_floats;
  };
  for (std::size_t set = 0; set < io.sets(); ++set) {
    select(set);
    transform_rows(transform, tiles, io, set, work);
  }
  // Sets take turns at every column, while its transfer functions are at hand.
  for (std::size_t kept = 0; kept < transform.columns().size(); ++kept)
    for (std::size_t set = 0; set < io.sets(); ++set) {
      const LaneTransform::ColumnPair& columns = transform.columns()[kept];
      select(set);
      filter_column(transform, tiles, columns.kept, kept, false, work);
      if (columns.mirrored != columns.kept)
        filter_column(transform, tiles, columns.mirrored, kept, true, work);
    }
  for (std::size_t set = 0; set < io.sets(); ++set) {
    select(set);
    for (std::size_t row = 0; row < extent; ++row) {
      float* elements = work.result + row * work.result_row;
      inverse(elements, n, transform.twiddles());
      io.store_row(set, static_cast<int>(row), elements);
    }
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

namespace {

/// Where decimation in frequency puts a frequency.
int place_of(int frequency, int size) {
  if (size == 1) return 0;
  const int radix = size == 2 ? 2 : 4;
  return frequency % radix * (size / radix) + place_of(frequency / radix, size / radix);
}

}  // namespace

LaneTransform::LaneTransform(int size) : size_(size), mirrored_(static_cast<std::size_t>(size)) {
  for (int length = size; length >= 4; length /= 4)
    for (int j = 0; j < length / 4; ++j)
      for (int power = 1; power <= 3; ++power) {
        const double angle = -2 * std::numbers::pi * power * j / length;
        twiddles_.push_back(static_cast<float>(std::cos(angle)));
        twiddles_.push_back(static_cast<float>(std::sin(angle)));
      }
  for (int k = 0; k < size; ++k)
    mirrored_[static_cast<std::size_t>(place_of(k, size))] = place_of((size - k) % size, size);
  for (int place = 0; place < size; ++place)
    if (const int mirrored = mirrored_[static_cast<std::size_t>(place)]; place <= mirrored)
      columns_.push_back({place, mirrored});
}

void transform_lane_kernels(const LaneTransform& transform, const std::array<const float*, 2>& kernels,
                            int size, const std::array<float*, 2>& otfs, std::size_t stride,
                            std::size_t imaginary) {
  HWY_DYNAMIC_DISPATCH(transform_kernels)(transform, kernels, size, otfs, stride, imaginary);
}

void blur_lane_tiles(const LaneTransform& transform, const LaneTiles& tiles, LaneTileIo& io,
                     AlignedVector<float>& workspace) {
  HWY_DYNAMIC_DISPATCH(blur_tiles)(transform, tiles, io, workspace);
}

}  // namespace petzval
#endif
