// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/tile_blur.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/imaging/tile_kernels.cpp"
#include <hwy/foreach_target.h>
#include <petzval/imaging/tile_fft-inl.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {
namespace {

/// Of two real kernels a and b, whose transforms come as those of a + ib at k and at −k.
HWY_ATTR HWY_INLINE void separate(const Complex& plus, const Complex& minus, Complex& a, Complex& b) {
  const Vector half = hn::Set(Lanes(), 0.5F);
  a = {hn::Mul(half, hn::Add(plus.re, minus.re)), hn::Mul(half, hn::Sub(plus.im, minus.im))};
  b = {hn::Mul(half, hn::Add(plus.im, minus.im)), hn::Mul(half, hn::Sub(minus.re, plus.re))};
}

/// The last lane of the last mirrored block, conjugate, behind the blocks.
void separate_last(const TileTransform& transform, const float* line, const std::array<float*, 2>& otfs) {
  const auto n = static_cast<std::size_t>(transform.size());
  const std::size_t lanes = hn::Lanes(Lanes()), element = 2 * lanes;
  for (std::size_t k = 0; k < n; ++k) {
    const float* plus = line + k * element + lanes - 1;
    const float* minus = line + static_cast<std::size_t>(transform.mirrored()[k]) * element + lanes - 1;
    const std::size_t at = n * n + 2 * k;
    otfs[0][at] = 0.5F * (plus[0] + minus[0]);
    otfs[0][at + 1] = -0.5F * (plus[lanes] - minus[lanes]);
    if (otfs[1] == nullptr) continue;
    otfs[1][at] = 0.5F * (plus[lanes] + minus[lanes]);
    otfs[1][at + 1] = -0.5F * (minus[0] - plus[0]);
  }
}

HWY_ATTR void kernel_otfs(const TileTransform& transform, const std::array<const float*, 2>& kernels,
                          int size, const std::array<float*, 2>& otfs, AlignedVector<float>& memory) {
  const Lanes d;
  const std::size_t lanes = hn::Lanes(d), element = 2 * lanes;
  const int n = transform.size();
  const auto side = static_cast<std::size_t>(n), count = static_cast<std::size_t>(size);
  const std::size_t blocks = side / lanes, row_blocks = whole_vectors(size);
  const std::size_t turned_block = (row_blocks * lanes + 1) * element;
  memory.resize(RowPass::floats(size, n) + side * element + blocks * turned_block);
  const RowPass pass(size, memory.data());
  float *line = pass.line, *other = memory.data() + RowPass::floats(size, n),
        *turned = other + side * element;
  std::fill(pass.real, pass.elements, 0.0F);
  for (std::size_t block = 0; block < row_blocks; ++block) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::size_t row = block * lanes + lane;
      const auto lay = [&](const float* kernel, float* out) {
        if (kernel != nullptr && row < count)
          std::copy_n(kernel + row * count, count, out);
        else
          std::fill_n(out, count, 0.0F);
      };
      lay(kernels[0], pass.real + lane * pass.width);
      lay(kernels[1], pass.imaginary + lane * pass.width);
    }
    rows_to_elements(pass);
    forward({pass.elements, nullptr, size}, n, transform.twiddles(), line);
    for (std::size_t b = 0; b < blocks; ++b)
      turn_columns(line, transform.columns().data() + b * lanes,
                   turned + b * turned_block + block * lanes * element);
  }
  const auto columns_of = [&](std::size_t block, float* out) HWY_ATTR {
    forward({turned + block * turned_block, nullptr, size}, n, transform.twiddles(), out);
  };
  const auto last_lane = hn::Eq(hn::Iota(d, 0.0F), hn::Set(d, static_cast<float>(lanes - 1)));
  for (std::size_t block = 0; block < blocks / 2; ++block) {
    columns_of(block, line);
    columns_of(blocks / 2 + block, other);
    const bool last = block + 1 == blocks / 2;
    for (std::size_t k = 0; k < side; ++k) {
      const std::size_t mirrored = static_cast<std::size_t>(transform.mirrored()[k]) * element;
      Complex minus = load(other + mirrored);
      if (last) {
        const Complex own = load(line + mirrored);
        minus = {hn::IfThenElse(last_lane, own.re, minus.re), hn::IfThenElse(last_lane, own.im, minus.im)};
      }
      Complex a, b;
      separate(load(line + k * element), minus, a, b);
      const std::size_t at = (block * side + k) * element;
      store(a, otfs[0] + at);
      if (otfs[1] != nullptr) store(b, otfs[1] + at);
    }
    if (last) separate_last(transform, other, otfs);
  }
}

}  // namespace
}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(kernel_otfs);

void transform_kernels(const TileTransform& transform, const std::array<const float*, 2>& kernels, int size,
                       const std::array<float*, 2>& otfs, AlignedVector<float>& workspace) {
  HWY_DYNAMIC_DISPATCH(kernel_otfs)(transform, kernels, size, otfs, workspace);
}

}  // namespace petzval
#endif
