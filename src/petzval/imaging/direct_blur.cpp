// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/imaging/direct_blur.h>
#include <petzval/imaging/node_kernel.h>
#include <petzval/imaging/row_convolution.h>

#include <algorithm>
#include <cstdlib>

namespace petzval {

/// What the rows of a strip of the result take from: for every source row within reach its light, weighted
/// for each node along the columns, and the kernels of those nodes at that row.
class DirectStrip {
 public:
  DirectStrip(const DirectBlur& blur, const CellPlane& source, int first_row, int end_row);
  /// Adds all light that arrives in a row of the grid. \param margin  columns of the grid left of the result.
  void gather(int row, int margin, std::span<float> result);

 private:
  /// A source row in one half of the plane, counted from the axis.
  struct SourceRow {
    int row;
    bool below;
    std::size_t slot;
  };
  /// A tile's stretch of a source row.
  float* light(std::size_t slot, bool right, int tile, std::size_t node) {
    return light_.data() + place(slot, right, tile, node) * light_floats_;
  }
  float* kernel(std::size_t slot, bool right, int tile, std::size_t node) {
    return kernels_.data() + place(slot, right, tile, node) * blur_.taps() * blur_.taps();
  }
  std::size_t place(std::size_t slot, bool right, int tile, std::size_t node) const {
    return ((slot * 2 + (right ? 1 : 0)) * static_cast<std::size_t>(blur_.tiles_across_) +
            static_cast<std::size_t>(tile)) *
               blur_.nodes_.size() +
           node;
  }
  void prepare(const CellPlane& source, const SourceRow& row, bool right, int tile);

  const DirectBlur& blur_;
  std::size_t before_, light_floats_;
  std::vector<SourceRow> rows_;
  std::vector<float> light_, kernels_, sums_;
  std::vector<RowTerm> terms_;
};

DirectStrip::DirectStrip(const DirectBlur& blur, const CellPlane& source, int first_row, int end_row)
    : blur_(blur),
      before_(static_cast<std::size_t>(2 * blur.radius_)),
      light_floats_(before_ + static_cast<std::size_t>(blur.plan_.tile) + before_ + row_padding()),
      sums_(static_cast<std::size_t>(blur.plan_.tile) + before_ + row_padding()) {
  const int from = std::max(0, first_row - blur.radius_),
            to = std::min(source.grid.rows, end_row + blur.radius_);
  for (const bool below : {false, true})
    for (int outward = 0; outward < blur.down_.count(); ++outward)
      if (const int row = blur.down_.cell(outward, below); row >= from && row < to)
        rows_.push_back({row, below, rows_.size()});
  const std::size_t places =
      rows_.size() * 2 * static_cast<std::size_t>(blur.tiles_across_) * blur.nodes_.size();
  light_.assign(places * light_floats_, 0.0F);
  kernels_.resize(places * blur.taps() * blur.taps());
  for (const SourceRow& row : rows_)
    for (const bool right : {false, true})
      for (int tile = 0; tile < blur.tiles_across_; ++tile) prepare(source, row, right, tile);
}

void DirectStrip::prepare(const CellPlane& source, const SourceRow& row, bool right, int tile) {
  const int side = blur_.plan_.tile;
  const int outward = row.below ? row.row - blur_.down_.cell(0, true) : blur_.down_.cell(0, false) - row.row;
  const int tile_row = outward / side;
  const auto cell = static_cast<std::size_t>(outward % side), nodes = blur_.nodes_.size();
  const std::size_t set = kernel_set({right, row.below}, blur_.sets_.size());
  const std::size_t size = blur_.taps() * blur_.taps();
  const std::size_t first_down = (nodes - 1) * static_cast<std::size_t>(tile_row),
                    first_across = (nodes - 1) * static_cast<std::size_t>(tile);
  for (std::size_t b = 0; b < nodes; ++b) {
    float* mixed = kernel(row.slot, right, tile, b);
    std::fill_n(mixed, size, 0.0F);
    for (std::size_t a = 0; a < nodes; ++a) {
      const float weight = blur_.weights_[a * static_cast<std::size_t>(side) + cell];
      const float* at_node = blur_.kernel(set, first_down + a, first_across + b);
      for (std::size_t i = 0; i < size; ++i) mixed[i] += weight * at_node[i];
    }
  }
  const int first = tile * side, count = std::min(side, blur_.across_.count() - first);
  const float* in = source.row(static_cast<std::size_t>(row.row));
  for (int i = 0; i < count; ++i) {
    const float value = blur_.down_.share(outward) * blur_.across_.share(first + i) *
                        in[blur_.across_.cell(first + i, right)];
    for (std::size_t b = 0; b < nodes; ++b)
      light(row.slot, right, tile, b)[before_ + static_cast<std::size_t>(i)] =
          value * blur_.weights_[b * static_cast<std::size_t>(side) + static_cast<std::size_t>(i)];
  }
}

void DirectStrip::gather(int row, int margin, std::span<float> result) {
  const int columns = static_cast<int>(result.size()), radius = blur_.radius_;
  std::vector<SourceRow> reach;
  for (const SourceRow& source : rows_)
    if (std::abs(row - source.row) <= radius) reach.push_back(source);
  for (const bool right : {false, true})
    for (int tile = 0; tile < blur_.tiles_across_; ++tile) {
      terms_.clear();
      for (const SourceRow& source : reach) {
        const int further = source.below ? row - source.row : source.row - row;
        const std::size_t kernel_row = static_cast<std::size_t>(further + radius) * blur_.taps();
        for (std::size_t b = 0; b < blur_.nodes_.size(); ++b)
          terms_.push_back({light(source.slot, right, tile, b) + before_,
                            kernel(source.slot, right, tile, b) + kernel_row});
      }
      const int first = tile * blur_.plan_.tile - radius;
      const int count =
          std::min(blur_.plan_.tile, blur_.across_.count() - tile * blur_.plan_.tile) + 2 * radius;
      convolve_rows(terms_, radius, static_cast<std::size_t>(count), sums_.data());
      const int base = blur_.across_.cell(first, right) - margin, step = right ? 1 : -1;
      for (int i = 0, column = base; i < count; ++i, column += step)
        if (column >= 0 && column < columns)
          result[static_cast<std::size_t>(column)] += sums_[static_cast<std::size_t>(i)];
    }
}

DirectBlur::DirectBlur(const PsfField& psfs, const SensorGeometry& grid, const ProductPlan& plan)
    : plan_(plan),
      grid_(grid),
      across_(grid.columns),
      down_(grid.rows),
      radius_(psfs.radius()),
      tiles_across_((across_.count() + plan.tile - 1) / plan.tile),
      tiles_down_((down_.count() + plan.tile - 1) / plan.tile),
      nodes_(lobatto_nodes(plan.nodes)),
      weights_(cell_weights(nodes_, plan.tile)),
      sets_(kernel_set_count(psfs.symmetry())) {
  const std::size_t across = nodes_across(),
                    down = (nodes_.size() - 1) * static_cast<std::size_t>(tiles_down_) + 1,
                    size = taps() * taps(), phases = nodes_.size() - 1;
  for (std::size_t set = 0; set < sets_.size(); ++set) {
    const Quadrant quadrant = quadrants_of_set(set, sets_.size()).front();
    sets_[set].resize(across * down * size);
    parallel_for(across * down, [&](std::size_t node) {
      const auto position = [&](std::size_t index) {
        return plan_.tile * (double(index / phases) + nodes_[index % phases]);
      };
      const Kernel kernel =
          kernel_at_node(psfs, across_, down_, position(node % across), position(node / across), quadrant);
      std::transform(kernel.weights.begin(), kernel.weights.end(),
                     sets_[set].begin() + static_cast<std::ptrdiff_t>(node * size),
                     [](double weight) { return static_cast<float>(weight); });
    });
  }
}

CellPlane DirectBlur::blur(const CellPlane& source, int margin) const {
  if (source.grid.columns != grid_.columns || source.grid.rows != grid_.rows)
    throw InputError("the plane to be blurred has another grid than the blur was made for");
  CellPlane result(grown(grid_, -margin));
  constexpr int strip_rows = 64;
  const int rows = result.grid.rows;
  parallel_for(static_cast<std::size_t>((rows + strip_rows - 1) / strip_rows), [&](std::size_t index) {
    const int from = static_cast<int>(index) * strip_rows, to = std::min(rows, from + strip_rows);
    DirectStrip strip(*this, source, from + margin, to + margin);
    for (int row = from; row < to; ++row)
      strip.gather(row + margin, margin, {result.row(static_cast<std::size_t>(row)), result.columns()});
  });
  return result;
}

}  // namespace petzval
