// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/lane_blur.h>

#include <cmath>
#include <numbers>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/imaging/lane_blur.cpp"
#include <hwy/foreach_target.h>
#include <petzval/imaging/lane_fft-inl.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {
namespace {

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
      forward_padded(work.sums, tiles.weights + a * tiles.tile, tiles.tile, n, transform.twiddles(),
                     work.line);
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
      forward_padded(work.turned + a * work.turned_node + k * work.turned_row,
                     tiles.weights + b * static_cast<std::size_t>(tiles.tile), tiles.tile, n,
                     transform.twiddles(), work.line);
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
  const auto each_row = [&](const auto& use) HWY_ATTR {
    for (std::size_t set = 0; set < io.sets(); ++set) {
      select(set);
      for (std::size_t row = 0; row < extent; ++row) use(set, row, work.result + row * work.result_row);
    }
  };
  each_row([&](std::size_t, std::size_t, float* elements)
               HWY_ATTR { inverse(elements, n, transform.twiddles()); });
  io.begin_store();
  each_row([&](std::size_t set, std::size_t row, const float* elements) {
    io.store_row(set, static_cast<int>(row), elements);
  });
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

void blur_lane_tiles(const LaneTransform& transform, const LaneTiles& tiles, LaneTileIo& io,
                     AlignedVector<float>& workspace) {
  HWY_DYNAMIC_DISPATCH(blur_tiles)(transform, tiles, io, workspace);
}

}  // namespace petzval
#endif
