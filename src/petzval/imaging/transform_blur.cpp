// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/imaging/node_kernel.h>
#include <petzval/imaging/transform_blur.h>

#include <algorithm>
#include <atomic>
#include <limits>

namespace petzval {

namespace {

using QuadrantPair = TransformBlur::QuadrantPair;

std::vector<QuadrantPair> pairs_of(std::size_t set, bool symmetric) {
  if (symmetric) return {{{{true, true}, {false, true}}}, {{{true, false}, {false, false}}}};
  if (set == 0) return {{{{true, true}, {false, false}}}};
  return {{{{false, true}, {true, false}}}};
}

/// Lets threads by one after the other, in the order of their tickets.
class Turns {
 public:
  void await(std::size_t ticket) const {
    for (std::size_t now; (now = turn_.load()) < ticket;) turn_.wait(now);
  }
  void end(std::size_t ticket) {
    turn_.compare_exchange_strong(ticket, ticket + 1);
    turn_.notify_all();
  }
  /// Nobody waits any more.
  void abandon() {
    turn_.store(std::numeric_limits<std::size_t>::max());
    turn_.notify_all();
  }

 private:
  std::atomic<std::size_t> turn_{0};
};

}  // namespace

/// Moves light between planes and the lanes of one batch.
class TileIo : public LaneTileIo {
 public:
  TileIo(const TransformBlur& blur, const CellPlane& source, int margin, CellPlane& result,
         const Turns& turns)
      : blur_(blur), source_(source), margin_(margin), result_(result), turns_(turns), lanes_(lane_count()) {}

  void set_place(std::size_t ticket, std::size_t first_lane, const std::vector<QuadrantPair>& pairs) {
    ticket_ = ticket;
    first_lane_ = first_lane;
    pairs_ = pairs;
  }
  std::size_t sets() const override { return pairs_.size(); }
  void load_row(std::size_t set, int row, float* elements) override;
  void begin_store() override { turns_.await(ticket_); }
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
  CellPlane& result_;
  const Turns& turns_;
  std::size_t lanes_, ticket_ = 0, first_lane_ = 0;
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
      const TransformBlur::Quadrant& quadrant = pairs_[set][part];
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
  const int columns = result_.grid.columns, rows = result_.grid.rows;
  each_tile([&](int tile_row, int tile_column, std::size_t lane) {
    const int outward_row = tile_row * tile + row - blur_.radius_, first = tile_column * tile - blur_.radius_;
    for (std::size_t part = 0; part < 2; ++part) {
      const TransformBlur::Quadrant& quadrant = pairs_[set][part];
      const int result_row = blur_.down_.cell(outward_row, quadrant.below) - margin_;
      if (result_row < 0 || result_row >= rows) continue;
      const int base = blur_.across_.cell(first, quadrant.right) - margin_;
      const float* in = elements + part * lanes_ + lane;
      float* out = result_.row(static_cast<std::size_t>(result_row));
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

std::vector<TransformBlur::Item> TransformBlur::items_for(std::size_t threads) const {
  std::vector<Item> items;
  for (std::size_t set = 0; set < sets_.size(); ++set)
    for (std::size_t batch = 0; batch < batches_; ++batch)
      items.push_back({set, batch * lane_count(), pairs_of(set, sets_.size() == 1)});
  // The last ones, which not all threads get one of, are halved if they can be. The order of sums, set by set
  // within a batch, is the same.
  const std::size_t whole = items.size() - items.size() % threads;
  std::vector<Item> halves;
  for (std::size_t i = whole; i < items.size(); ++i)
    for (const QuadrantPair& pair : items[i].pairs)
      halves.push_back({items[i].set, items[i].first_lane, {pair}});
  items.resize(whole);
  items.insert(items.end(), halves.begin(), halves.end());
  return items;
}

CellPlane TransformBlur::blur(const CellPlane& source, int margin) const {
  if (source.grid.columns != grid_.columns || source.grid.rows != grid_.rows)
    throw InputError("the plane to be blurred has another grid than the blur was made for");
  CellPlane result(grown(grid_, -margin));
  // Batches are transformed by whoever is free, but added to the result one after the other, so that sums are
  // the same for any number of threads.
  const std::vector<Item> items = items_for(static_cast<std::size_t>(thread_count()));
  std::atomic<std::size_t> next{0};
  Turns turns;
  const auto work = [&] {
    TileIo io(*this, source, margin, result, turns);
    AlignedVector<float> workspace;
    LaneTiles tiles{plan_.tile, plan_.tile + 2 * radius_, plan_.nodes,  weights_.data(),
                    {},         2 * nodes_padded_,        nodes_padded_};
    for (std::size_t ticket; (ticket = next++) < items.size();) {
      const auto& [set, first_lane, pairs] = items[ticket];
      tiles.otfs = otfs_of(sets_[set], first_lane);
      io.set_place(ticket, first_lane, pairs);
      blur_lane_tiles(transform_, tiles, io, workspace);
      turns.end(ticket);
    }
  };
  parallel_for(std::min(items.size(), static_cast<std::size_t>(thread_count())), [&](std::size_t) {
    try {
      work();
    } catch (...) {
      turns.abandon();  // lest others wait for ever
      throw;
    }
  });
  return result;
}

}  // namespace petzval
