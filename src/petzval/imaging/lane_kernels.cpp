// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/lane_blur.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/imaging/lane_kernels.cpp"
#include <hwy/foreach_target.h>
#include <petzval/imaging/lane_fft-inl.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {
namespace {

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
      store({hn::Load(d, kernels[0] + at), hn::Load(d, kernels[1] + at)}, other + column * element);
    }
    forward_padded(other, nullptr, size, n, transform.twiddles(), line);
    for (std::size_t k = 0; k < side; ++k)
      store(load(line + k * element), turned + k * turned_row + row * element);
  }
  const auto column_of = [&](int k, float* out) {
    forward_padded(turned + static_cast<std::size_t>(k) * turned_row, nullptr, size, n, transform.twiddles(),
                   out);
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

}  // namespace
}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(transform_kernels);

void transform_lane_kernels(const LaneTransform& transform, const std::array<const float*, 2>& kernels,
                            int size, const std::array<float*, 2>& otfs, std::size_t stride,
                            std::size_t imaginary) {
  HWY_DYNAMIC_DISPATCH(transform_kernels)(transform, kernels, size, otfs, stride, imaginary);
}

}  // namespace petzval
#endif
