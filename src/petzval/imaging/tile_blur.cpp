// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/imaging/tile_blur.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/imaging/tile_blur.cpp"
#include <hwy/foreach_target.h>
#include <petzval/imaging/tile_fft-inl.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {
namespace {

/// Takes the transform of a line: sums += otf · element, or sums = otf · element.
template <bool first>
HWY_ATTR HWY_INLINE void filter(const PaddedLine& line, const TileTransform& transform, const float* otf,
                                float* data, float* sums) {
  const std::size_t element = element_floats();
  forward(line, transform.size(), transform.twiddles(), data, [&](std::size_t k, const Complex& x) HWY_ATTR {
    const Complex product = multiply(x, load(otf + k * element));
    store(first ? product : add(load(sums + k * element), product), sums + k * element);
  });
}

/// The same for the block that holds −k where the transfer functions kept are those at k. \param last  that
/// of the last lane; null: as the others.
template <bool first>
HWY_ATTR HWY_INLINE void filter_mirrored(const PaddedLine& line, const TileTransform& transform,
                                         const float* otf, const float* last, float* data, float* sums) {
  const Lanes d;
  const std::size_t element = element_floats();
  const int* mirrored = transform.mirrored().data();
  const auto last_lane = hn::Eq(hn::Iota(d, 0.0F), hn::Set(d, static_cast<float>(hn::Lanes(d) - 1)));
  forward(line, transform.size(), transform.twiddles(), data, [&](std::size_t k, const Complex& x) HWY_ATTR {
    Complex h = load(otf + static_cast<std::size_t>(mirrored[k]) * element);
    if (last != nullptr)
      h = {hn::IfThenElse(last_lane, hn::Set(d, last[2 * k]), h.re),
           hn::IfThenElse(last_lane, hn::Set(d, last[2 * k + 1]), h.im)};
    const Complex product = multiply_conjugate(x, h);
    store(first ? product : add(load(sums + k * element), product), sums + k * element);
  });
}

/// What a tile becomes on the way.
class TileWork {
 public:
  TileWork(const TileTransform& transform, const TileMixture& mixture, AlignedVector<float>& memory)
      // One element more than a block: strides of a power of two would all meet in the same few cache sets.
      : turned_block((whole_vectors(mixture.tile) * hn::Lanes(Lanes()) + 1) * element_floats()),
        turned_node(transform.columns().size() / hn::Lanes(Lanes()) * turned_block),
        result_block((transform.columns().size() + 1) * element_floats()),
        pass(mixture.tile, room(transform, mixture, memory)) {
    sums = memory.data() + RowPass::floats(mixture.tile, transform.size());
    turned = sums + transform.columns().size() * element_floats();
    result = turned + static_cast<std::size_t>(mixture.nodes) * turned_node;
  }

  std::size_t turned_block, turned_node, result_block;  ///< floats from one to the next
  RowPass pass;
  float* sums;
  float* turned;  ///< [node along x][block of columns][row]
  float* result;  ///< [block of rows][column]

 private:
  float* room(const TileTransform& transform, const TileMixture& mixture,
              AlignedVector<float>& memory) const {
    memory.resize(
        RowPass::floats(mixture.tile, transform.size()) + transform.columns().size() * element_floats() +
        static_cast<std::size_t>(mixture.nodes) * turned_node + whole_vectors(mixture.extent) * result_block);
    return memory.data();
  }
};

HWY_ATTR void transform_rows(const TileTransform& transform, const TileMixture& mixture,
                             const TileLight& light, const TileWork& work) {
  const std::size_t lanes = hn::Lanes(Lanes()), element = 2 * lanes;
  const int n = transform.size();
  const RowPass& pass = work.pass;
  std::fill(pass.real, pass.elements, 0.0F);
  for (std::size_t block = 0; block < whole_vectors(mixture.tile); ++block) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const int row = static_cast<int>(block * lanes + lane);
      float *real = pass.real + lane * pass.width, *imaginary = pass.imaginary + lane * pass.width;
      if (row < mixture.tile) {
        light.load_row(row, real, imaginary);
      } else {
        std::fill_n(real, pass.width, 0.0F);
        std::fill_n(imaginary, pass.width, 0.0F);
      }
    }
    rows_to_elements(pass);
    for (int a = 0; a < mixture.nodes; ++a) {
      forward({pass.elements, mixture.weights + a * mixture.tile, mixture.tile}, n, transform.twiddles(),
              pass.line);
      float* turned = work.turned + static_cast<std::size_t>(a) * work.turned_node + block * lanes * element;
      for (std::size_t b = 0; b < transform.columns().size(); b += lanes, turned += work.turned_block)
        turn_columns(pass.line, transform.columns().data() + b, turned);
    }
  }
}

/// \param kept  the block whose transfer functions are used. \param mirrored  for its mirrored columns.
HWY_ATTR void filter_block(const TileTransform& transform, const TileMixture& mixture, std::size_t kept,
                           bool mirrored, const TileWork& work) {
  const std::size_t lanes = hn::Lanes(Lanes()), element = 2 * lanes;
  const int n = transform.size();
  const auto side = static_cast<std::size_t>(n), nodes = static_cast<std::size_t>(mixture.nodes);
  const std::size_t block = kept + (mirrored ? transform.kept_blocks() : 0);
  float* line = work.pass.line;
  for (std::size_t a = 0; a < nodes; ++a)
    for (std::size_t b = 0; b < nodes; ++b) {
      const PaddedLine column{work.turned + a * work.turned_node + block * work.turned_block,
                              mixture.weights + b * static_cast<std::size_t>(mixture.tile), mixture.tile};
      const float *otf = mixture.otfs[b * nodes + a], *of_block = otf + kept * side * element;
      const float* last = kept + 1 == transform.kept_blocks() ? otf + side * side : nullptr;
      const bool first = a + b == 0;
      if (mirrored && first)
        filter_mirrored<true>(column, transform, of_block, last, line, work.sums);
      else if (mirrored)
        filter_mirrored<false>(column, transform, of_block, last, line, work.sums);
      else if (first)
        filter<true>(column, transform, of_block, line, work.sums);
      else
        filter<false>(column, transform, of_block, line, work.sums);
    }
  inverse(work.sums, n, transform.twiddles());
  for (std::size_t rows = 0; rows < whole_vectors(mixture.extent); ++rows)
    turn_back(work.sums + rows * lanes * element, transform.columns().data() + block * lanes,
              work.result + rows * work.result_block);
}

HWY_ATTR void blur(const TileTransform& transform, const TileMixture& mixture, const TileLight& light,
                   AlignedVector<float>& memory, float* blurred) {
  const std::size_t lanes = hn::Lanes(Lanes()), element = 2 * lanes;
  const auto side = static_cast<std::size_t>(transform.size());
  const TileWork work(transform, mixture, memory);
  transform_rows(transform, mixture, light, work);
  for (std::size_t kept = 0; kept < transform.kept_blocks(); ++kept)
    for (const bool mirrored : {false, true}) filter_block(transform, mixture, kept, mirrored, work);
  for (std::size_t rows = 0; rows < whole_vectors(mixture.extent); ++rows, blurred += 2 * lanes * side) {
    float* result = work.result + rows * work.result_block;
    inverse(result, transform.size(), transform.twiddles());
    for (std::size_t column = 0; column < static_cast<std::size_t>(mixture.extent); column += lanes)
      for (const std::size_t part : {std::size_t{0}, std::size_t{1}})
        transpose([&](std::size_t i) HWY_ATTR { return result + (column + i) * element + part * lanes; },
                  [&](std::size_t i) HWY_ATTR { return blurred + (2 * i + part) * side + column; });
  }
}

HWY_ATTR std::size_t width() {
  return hn::Lanes(Lanes());
}

}  // namespace
}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(width);
HWY_EXPORT(blur);

std::size_t lane_count() {
  return HWY_DYNAMIC_DISPATCH(width)();
}

namespace {

/// Where decimation in frequency puts a frequency.
int place_of(int frequency, int size, int shortest) {
  if (size == shortest) return frequency;
  return frequency % 4 * (size / 4) + place_of(frequency / 4, size / 4, shortest);
}

}  // namespace

TileTransform::TileTransform(int size)
    : size_(size),
      mirrored_(static_cast<std::size_t>(size)),
      kept_blocks_(static_cast<std::size_t>(size) / 2 / lane_count()) {
  if (std::find(sizes.begin(), sizes.end(), size) == sizes.end())
    throw InputError(
        fmt::format("transforms of {0} x {0}: one of {1} is right", size, fmt::join(sizes, ", ")));
  const int shortest = shortest_block(size);
  for (int length = size; length > shortest; length /= 4)
    for (int j = 0; j < length / 4; ++j)
      for (int power = 1; power <= 3; ++power) {
        const double angle = -2 * std::numbers::pi * power * j / length;
        twiddles_.push_back(static_cast<float>(std::cos(angle)));
        twiddles_.push_back(static_cast<float>(std::sin(angle)));
      }
  for (int k = 0; k < size; ++k)
    mirrored_[static_cast<std::size_t>(place_of(k, size, shortest))] =
        place_of((size - k) % size, size, shortest);
  std::vector<int> partners;
  for (int place = 0; place < size; ++place)
    if (const int partner = mirrored_[static_cast<std::size_t>(place)]; place < partner) {
      columns_.push_back(place);
      partners.push_back(partner);
    }
  columns_.push_back(place_of(0, size, shortest));
  columns_.insert(columns_.end(), partners.begin(), partners.end());
  columns_.push_back(place_of(size / 2, size, shortest));
}

std::size_t blurred_floats(const TileTransform& transform, const TileMixture& mixture) {
  const std::size_t lanes = lane_count();
  const std::size_t rows = (static_cast<std::size_t>(mixture.extent) + lanes - 1) / lanes * lanes;
  return 2 * rows * static_cast<std::size_t>(transform.size());
}

void blur_tile(const TileTransform& transform, const TileMixture& mixture, const TileLight& light,
               AlignedVector<float>& workspace, float* blurred) {
  HWY_DYNAMIC_DISPATCH(blur)(transform, mixture, light, workspace, blurred);
}

}  // namespace petzval
#endif
