// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/imaging/node_kernel.h>
#include <petzval/imaging/transform_blur.h>

#include <algorithm>
#include <array>

namespace petzval {

namespace {

/// One of the four quadrants: right of the axis, below it.
struct Quadrant {
  bool right, below;
};

/// Pairs of quadrants that share all kernels, as real and imaginary part.
using QuadrantPair = std::array<Quadrant, 2>;

std::vector<QuadrantPair> pairs_of(std::size_t set, bool symmetric) {
  if (symmetric) return {{{{true, true}, {false, true}}}, {{{true, false}, {false, false}}}};
  if (set == 0) return {{{{true, true}, {false, false}}}};
  return {{{{false, true}, {true, false}}}};
}

/// The rows of the result that a run of tile rows can reach, in both halves: blurred by itself and added in
/// order, so that the sums do not depend on the threads.
struct ResultStrip {
  std::vector<int> slot_of_row;  ///< −1: not reached
  AlignedVector<float> values;
  std::size_t columns;

  ResultStrip(int rows, int columns_of_result)
      : slot_of_row(static_cast<std::size_t>(rows), -1),
        columns(static_cast<std::size_t>(columns_of_result)) {}
  void reach(const OutwardAxis& down, int from, int to, int margin) {
    for (const bool below : {true, false})
      for (int outward = from; outward < to; ++outward) {
        const int row = down.cell(outward, below) - margin;
        if (row >= 0 && row < static_cast<int>(slot_of_row.size()))
          slot_of_row[static_cast<std::size_t>(row)] = 0;
      }
    int slots = 0;
    for (int& slot : slot_of_row)
      if (slot == 0) slot = slots++;
    values.assign(static_cast<std::size_t>(slots) * columns, 0.0F);
  }
  float* row(int index) {
    const int slot = slot_of_row[static_cast<std::size_t>(index)];
    return slot < 0 ? nullptr : values.data() + static_cast<std::size_t>(slot) * columns;
  }
};

}  // namespace

/// Moves light between planes and the lanes of one batch.
class TileIo : public LaneTileIo {
 public:
  TileIo(const TransformBlur& blur, const CellPlane& source, int margin, ResultStrip& result)
      : blur_(blur), source_(source), margin_(margin), result_(result), lanes_(lane_count()) {}

  void set_place(std::size_t first_lane, const std::vector<QuadrantPair>& pairs) {
    first_lane_ = first_lane;
    pairs_ = pairs;
  }
  std::size_t sets() const override { return pairs_.size(); }
  void load_row(std::size_t set, int row, float* elements) override;
  void store_row(std::size_t set, int row, const float* elements) override;

 private:
  /// Calls use(tile row, tile column, lane) for the lanes that hold tiles.
  template <typename Use>
  void each_tile(const Use& use) const {
    const std::size_t end = std::min(lanes_, blur_.tile_lanes() - std::min(first_lane_, blur_.tile_lanes()));
    for (std::size_t lane = 0; lane < end; ++lane) {
      const std::size_t down = (first_lane_ + lane) / blur_.lanes_per_row(),
                        across = (first_lane_ + lane) % blur_.lanes_per_row();
      if (across + 1 < blur_.lanes_per_row()) use(static_cast<int>(down), static_cast<int>(across), lane);
    }
  }

  const TransformBlur& blur_;
  const CellPlane& source_;
  int margin_;
  ResultStrip& result_;
  std::size_t lanes_, first_lane_ = 0;
  std::vector<QuadrantPair> pairs_;
};

void TileIo::load_row(std::size_t set, int row, float* elements) {
  const int tile = blur_.plan_.tile;
  std::fill_n(elements, static_cast<std::size_t>(tile) * 2 * lanes_, 0.0F);
  each_tile([&](int tile_row, int tile_column, std::size_t lane) {
    const int outward_row = tile_row * tile + row, first = tile_column * tile;
    if (outward_row >= blur_.down_.count()) return;
    const int count = std::min(tile, blur_.across_.count() - first);
    for (std::size_t part = 0; part < 2; ++part) {
      const Quadrant& quadrant = pairs_[set][part];
      const float* in = source_.row(static_cast<std::size_t>(blur_.down_.cell(outward_row, quadrant.below))) +
                        blur_.across_.cell(first, quadrant.right);
      const std::ptrdiff_t step = quadrant.right ? 1 : -1;
      float* out = elements + part * lanes_ + lane;
      const float share = blur_.down_.share(outward_row);
      for (int i = 0; i < count; ++i, in += step, out += 2 * lanes_) *out = share * *in;
      if (first == 0) elements[part * lanes_ + lane] *= blur_.across_.share(0);
    }
  });
}

void TileIo::store_row(std::size_t set, int row, const float* elements) {
  const int tile = blur_.plan_.tile, extent = tile + 2 * blur_.radius_;
  const int columns = static_cast<int>(result_.columns), rows = static_cast<int>(result_.slot_of_row.size());
  each_tile([&](int tile_row, int tile_column, std::size_t lane) {
    const int outward_row = tile_row * tile + row - blur_.radius_, first = tile_column * tile - blur_.radius_;
    for (std::size_t part = 0; part < 2; ++part) {
      const Quadrant& quadrant = pairs_[set][part];
      const int result_row = blur_.down_.cell(outward_row, quadrant.below) - margin_;
      if (result_row < 0 || result_row >= rows) continue;
      const int base = blur_.across_.cell(first, quadrant.right) - margin_;
      const float* in = elements + part * lanes_ + lane;
      float* out = result_.row(result_row);
      // base ± i must lie within the result.
      const int from = quadrant.right ? std::max(0, -base) : std::max(0, base - (columns - 1));
      const int to = quadrant.right ? std::min(extent, columns - base) : std::min(extent, base + 1);
      const std::ptrdiff_t step = quadrant.right ? 1 : -1;
      in += static_cast<std::ptrdiff_t>(from) * static_cast<std::ptrdiff_t>(2 * lanes_);
      out += base + step * from;
      for (int i = from; i < to; ++i, in += 2 * lanes_, out += step) *out += *in;
    }
  });
}

TransformBlur::TransformBlur(const PsfField& psfs, const SensorGeometry& grid, const ProductPlan& plan,
                             KernelSets memory)
    : plan_(plan),
      grid_(grid),
      across_(grid.columns),
      down_(grid.rows),
      transform_(plan.transform),
      radius_(psfs.radius()),
      tiles_across_((across_.count() + plan.tile - 1) / plan.tile),
      tiles_down_((down_.count() + plan.tile - 1) / plan.tile),
      nodes_(lobatto_nodes(plan.nodes)),
      sets_(std::move(memory)) {
  const std::size_t lanes = lane_count();
  batches_ = (tile_lanes() + lanes - 1) / lanes;
  // The last batch reads one node row and one node beyond its lanes.
  nodes_padded_ = (batches_ * lanes + lanes_per_row() + 1 + lanes - 1) / lanes * lanes;
  const std::vector<float> weights = cell_weights(nodes_, plan.tile);
  weights_.assign(weights.begin(), weights.end());
  sets_.resize(psfs.mirror_symmetric() ? 1 : 2);
  for (std::size_t set = 0; set < sets_.size(); ++set) make_kernels(psfs, set == 1, sets_[set]);
}

std::size_t TransformBlur::phase_floats() const {
  return transform_.columns().size() * static_cast<std::size_t>(plan_.transform) * 2 * nodes_padded_;
}

void TransformBlur::make_kernels(const PsfField& psfs, bool mirrored, KernelSet& set) const {
  const std::size_t lanes = lane_count(), phases = nodes_.size() - 1, blocks = nodes_padded_ / lanes;
  const auto rows = static_cast<std::size_t>(tiles_down_), columns = static_cast<std::size_t>(tiles_across_);
  std::vector<double> places;
  for (std::size_t node = 0; node <= phases * std::max(rows, columns); ++node)
    places.push_back(plan_.tile * (double(node / phases) + nodes_[node % phases]));
  const NodeKernels kernels(psfs, across_, down_, places, phases * columns + 1, phases * rows + 1, mirrored);

  const auto size = static_cast<std::size_t>(2 * radius_ + 1), block_floats = size * size * lanes;
  const double scale = 1 / (double(plan_.transform) * plan_.transform);  // transforms are not normalised
  set.resize(phases * phases * phase_floats());
  const std::size_t pairs = (blocks + 1) / 2;
  parallel_for(phases * phases * pairs, [&](std::size_t task) {
    const std::size_t phase = task / pairs, first = task % pairs * 2 * lanes;
    const std::size_t phase_down = phase / phases, phase_across = phase % phases;
    AlignedVector<float> weights(2 * block_floats, 0.0F);
    for (std::size_t lane = 0; lane < 2 * lanes; ++lane) {
      const std::size_t down = (first + lane) / lanes_per_row(), across = (first + lane) % lanes_per_row();
      // Behind the last tile only the node that it shares with the next one is wanted.
      if (down > rows || (down == rows && phase_down > 0) || (across == columns && phase_across > 0))
        continue;
      kernels.lay(phases * across + phase_across, phases * down + phase_down, scale,
                  weights.data() + lane / lanes * block_floats + lane % lanes, lanes);
    }
    float* otfs = set.data() + phase * phase_floats() + first;
    const bool both = first + lanes < nodes_padded_;
    transform_lane_kernels(transform_, {weights.data(), weights.data() + block_floats},
                           static_cast<int>(size), {otfs, both ? otfs + lanes : nullptr}, 2 * nodes_padded_,
                           nodes_padded_);
  });
}

std::vector<const float*> TransformBlur::otfs_of(const KernelSet& set, std::size_t first_lane) const {
  const std::size_t phases = nodes_.size() - 1;
  std::vector<const float*> otfs;
  for (std::size_t b = 0; b <= phases; ++b)
    for (std::size_t a = 0; a <= phases; ++a) {
      const std::size_t phase = (b % phases) * phases + a % phases;
      const std::size_t beyond = (b == phases ? lanes_per_row() : 0) + (a == phases ? 1 : 0);
      otfs.push_back(set.data() + phase * phase_floats() + first_lane + beyond);
    }
  return otfs;
}

CellPlane TransformBlur::blur(const CellPlane& source, int margin) const {
  if (source.grid.columns != grid_.columns || source.grid.rows != grid_.rows)
    throw InputError("the plane to be blurred has another grid than the blur was made for");
  CellPlane result(grown(grid_, -margin));
  const std::size_t lanes = lane_count();
  // A fixed number of strips, so that their sums are the same for any number of threads.
  constexpr std::size_t most_strips = 8;
  const std::size_t strips = std::clamp<std::size_t>(batches_ / 2, 1, most_strips);
  std::vector<ResultStrip> parts;
  for (std::size_t i = 0; i < strips; ++i) parts.emplace_back(result.grid.rows, result.grid.columns);
  parallel_for(strips, [&](std::size_t strip) {
    const std::size_t from = strip * batches_ / strips, to = (strip + 1) * batches_ / strips;
    const auto first_row = static_cast<int>(from * lanes / lanes_per_row()),
               last_row = static_cast<int>((to * lanes - 1) / lanes_per_row());
    parts[strip].reach(down_, first_row * plan_.tile - radius_, (last_row + 1) * plan_.tile + radius_,
                       margin);
    TileIo io(*this, source, margin, parts[strip]);
    AlignedVector<float> workspace;
    LaneTiles tiles{plan_.tile, plan_.tile + 2 * radius_, plan_.nodes,  weights_.data(),
                    {},         2 * nodes_padded_,        nodes_padded_};
    for (std::size_t batch = from; batch < to; ++batch)
      for (std::size_t set = 0; set < sets_.size(); ++set) {
        tiles.otfs = otfs_of(sets_[set], batch * lanes);
        io.set_place(batch * lanes, pairs_of(set, sets_.size() == 1));
        blur_lane_tiles(transform_, tiles, io, workspace);
      }
  });
  parallel_for(result.rows(), [&](std::size_t row) {
    float* sums = result.row(row);
    for (ResultStrip& part : parts)
      if (const float* values = part.row(static_cast<int>(row)))
        for (std::size_t column = 0; column < result.columns(); ++column) sums[column] += values[column];
  });
  return result;
}

}  // namespace petzval
