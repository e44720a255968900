// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/imaging/transform_blur.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <utility>

namespace petzval {

namespace {

/// Uses what threads make in the order of its tickets, while they go on to make more: a fast thread does not
/// wait for a slow one until a good deal has piled up.
class InOrder {
 public:
  using Made = AlignedVector<float>;
  using Use = std::function<void(std::size_t ticket, const Made& made)>;
  InOrder(std::size_t most_waiting, Use use) : most_waiting_(most_waiting), use_(std::move(use)) {}

  /// \return  memory that has been used, or none.
  Made hand_in(std::size_t ticket, Made made) {
    std::unique_lock lock(mutex_);
    waiting_.emplace(ticket, std::move(made));
    if (!using_) use_ready(lock);
    changed_.wait(lock, [&] { return abandoned_ || waiting_.size() <= most_waiting_; });
    if (spare_.empty()) return {};
    Made spare = std::move(spare_.back());
    spare_.pop_back();
    return spare;
  }
  /// Nobody waits any more.
  void abandon() {
    const std::lock_guard lock(mutex_);
    abandoned_ = true;
    changed_.notify_all();
  }

 private:
  void use_ready(std::unique_lock<std::mutex>& lock) {
    using_ = true;
    for (auto next = waiting_.find(turn_); next != waiting_.end(); next = waiting_.find(++turn_)) {
      Made made = std::move(next->second);
      waiting_.erase(next);
      lock.unlock();
      use_(turn_, made);
      lock.lock();
      spare_.push_back(std::move(made));
      changed_.notify_all();
    }
    using_ = false;
  }

  const std::size_t most_waiting_;
  const Use use_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::size_t, Made> waiting_;
  std::vector<Made> spare_;
  std::size_t turn_ = 0;
  bool using_ = false, abandoned_ = false;
};

}  // namespace

/// The light of a pair of tiles, as it lies on the source plane.
class TransformBlur::Light : public TileLight {
 public:
  Light(const TransformBlur& blur, const CellPlane& source, const QuadrantPair& pair, int tile)
      : blur_(blur),
        source_(source),
        pair_(pair),
        first_row_(tile / blur.tiles_across_ * blur.plan_.tile),
        first_column_(tile % blur.tiles_across_ * blur.plan_.tile) {}

  bool is_dark() const {
    for (int row = 0; row < std::min(blur_.plan_.tile, blur_.down_.count() - first_row_); ++row)
      if (!is_dark(row, pair_.real) || (pair_.imaginary && !is_dark(row, *pair_.imaginary))) return false;
    return true;
  }

  void load_row(int row, float* real, float* imaginary) const override {
    load_row(row, pair_.real, real);
    if (pair_.imaginary)
      load_row(row, *pair_.imaginary, imaginary);
    else
      std::fill_n(imaginary, blur_.plan_.tile, 0.0F);
  }

 private:
  int columns_from_first() const { return std::min(blur_.plan_.tile, blur_.across_.count() - first_column_); }
  const float* first_of(int row, const Quadrant& quadrant) const {
    return source_.row(static_cast<std::size_t>(blur_.down_.cell(first_row_ + row, quadrant.below))) +
           blur_.across_.cell(first_column_, quadrant.right);
  }
  bool is_dark(int row, const Quadrant& quadrant) const {
    const int count = columns_from_first();
    const float* in = first_of(row, quadrant) - (quadrant.right ? 0 : count - 1);
    return std::all_of(in, in + count, [](float value) { return value == 0; });
  }
  void load_row(int row, const Quadrant& quadrant, float* out) const {
    const int outward_row = first_row_ + row;
    const int count = outward_row < blur_.down_.count() ? columns_from_first() : 0;
    std::fill(out + count, out + blur_.plan_.tile, 0.0F);
    if (count == 0) return;
    const float* in = first_of(row, quadrant);
    const float share = blur_.down_.share(outward_row);
    if (quadrant.right)
      for (int i = 0; i < count; ++i) out[i] = share * in[i];
    else
      for (int i = 0; i < count; ++i) out[i] = share * in[-i];
    if (first_column_ == 0) out[0] *= blur_.across_.share(0);
  }

  const TransformBlur& blur_;
  const CellPlane& source_;
  const QuadrantPair& pair_;
  int first_row_, first_column_;
};

TransformBlur::TransformBlur(const PsfField& psfs, const SensorGeometry& grid, const ProductPlan& plan,
                             KernelSets memory)
    : plan_(plan),
      psfs_(&psfs),
      grid_(grid),
      across_(grid.columns),
      down_(grid.rows),
      transform_(plan.transform),
      radius_(psfs.radius()),
      tiles_across_((across_.count() + plan.tile - 1) / plan.tile),
      tiles_down_((down_.count() + plan.tile - 1) / plan.tile),
      nodes_(lobatto_nodes(plan.nodes)),
      needed_(TilesInZone(plan.zone, across_, down_, plan.tile).nodes(phases())),
      sets_(std::move(memory)) {
  const std::vector<float> weights = cell_weights(nodes_, plan.tile);
  weights_.assign(weights.begin(), weights.end());
  sets_.resize(kernel_set_count(psfs.symmetry()));
  slots_ = {0};
  for (const char needed : needed_) slots_.push_back(slots_.back() + (needed != 0 ? 1 : 0));
  if (plan_.rows_held != 0) return;
  for (std::size_t set = 0; set < sets_.size(); ++set) {
    sets_[set].resize(slots_.back() * transform_.otf_floats());
    make_otfs(node_kernels(psfs, set), 0, nodes_down(), sets_[set].data());
  }
}

std::vector<TransformBlur::QuadrantPair> TransformBlur::pairs_of(std::size_t set, std::size_t set_count) {
  const std::vector<Quadrant> quadrants = quadrants_of_set(set, set_count);
  std::vector<QuadrantPair> pairs;
  for (std::size_t i = 0; i < quadrants.size(); i += 2) {
    pairs.push_back({quadrants[i]});
    if (i + 1 < quadrants.size()) pairs.back().imaginary = quadrants[i + 1];
  }
  return pairs;
}

NodeKernels TransformBlur::node_kernels(const PsfField& psfs, std::size_t set) const {
  std::vector<double> places;
  for (std::size_t node = 0; node < std::max(nodes_across(), nodes_down()); ++node)
    places.push_back(plan_.tile * (double(node / phases()) + nodes_[node % phases()]));
  return {psfs,
          across_,
          down_,
          places,
          nodes_across(),
          nodes_down(),
          quadrants_of_set(set, sets_.size()).front(),
          needed_};
}

void TransformBlur::make_otfs(const NodeKernels& kernels, std::size_t first_row, std::size_t end_row,
                              float* out) const {
  const int size = 2 * radius_ + 1;
  const auto weights = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  const double scale = 1 / (double(plan_.transform) * plan_.transform);  // transforms are not normalised
  const std::size_t first = first_row * nodes_across(), floats = transform_.otf_floats();
  std::vector<std::size_t> wanted;
  for (std::size_t node = first; node < end_row * nodes_across(); ++node)
    if (needed_[node] != 0) wanted.push_back(node);
  // Two kernels share a transform; a task has several of those, and one workspace.
  constexpr std::size_t kernels_a_task = 8;
  parallel_for((wanted.size() + kernels_a_task - 1) / kernels_a_task, [&](std::size_t task) {
    AlignedVector<float> pair(2 * weights), workspace;
    const std::size_t end = std::min(wanted.size(), (task + 1) * kernels_a_task);
    for (std::size_t at = task * kernels_a_task; at < end; at += 2) {
      const bool both = at + 1 < end;
      for (std::size_t i = 0; i < (both ? 2U : 1U); ++i) {
        const std::size_t node = wanted[at + i];
        kernels.lay(node % nodes_across(), node / nodes_across(), scale, pair.data() + i * weights);
      }
      transform_kernels(transform_, {pair.data(), both ? pair.data() + weights : nullptr}, size,
                        {out + at * floats, both ? out + (at + 1) * floats : nullptr}, workspace);
    }
  });
}

TileMixture TransformBlur::mixture_of(const Strip& strip, std::size_t set, int tile) const {
  TileMixture mixture{plan_.tile, plan_.tile + 2 * radius_, plan_.nodes, weights_.data(), {}};
  const auto row = static_cast<std::size_t>(tile / tiles_across_),
             column = static_cast<std::size_t>(tile % tiles_across_);
  const std::size_t before = slots_before(phases() * static_cast<std::size_t>(strip.first_row));
  for (std::size_t b = 0; b <= phases(); ++b)
    for (std::size_t a = 0; a <= phases(); ++a)
      mixture.otfs.push_back(
          (*strip.sets)[set].data() +
          (slots_[(phases() * row + b) * nodes_across() + phases() * column + a] - before) *
              transform_.otf_floats());
  return mixture;
}

std::vector<TransformBlur::TileRun> TransformBlur::runs(std::size_t first_set, std::size_t end_set,
                                                        const Strip& strip) const {
  // Small tiles go together, so that there is more to do than to wait for. The two halves of all runs take
  // turns: threads work apart from each other, each along tiles that share kernels.
  constexpr int elements_a_run = 1 << 16;
  const int begin = strip.first_row * tiles_across_, end = strip.end_row * tiles_across_;
  const int length = std::max(1, elements_a_run / (plan_.transform * plan_.transform));
  std::vector<TileRun> in_rows;
  for (std::size_t set = first_set; set < end_set; ++set)
    for (int first = begin; first < end; first += length)
      for (const QuadrantPair& pair : pairs_of(set, sets_.size()))
        in_rows.push_back({set, pair, first, std::min(end, first + length)});
  std::vector<TileRun> result;
  const std::size_t half = (in_rows.size() + 1) / 2;
  for (std::size_t i = 0; i < half; ++i) {
    result.push_back(in_rows[i]);
    if (half + i < in_rows.size()) result.push_back(in_rows[half + i]);
  }
  return result;
}

void TransformBlur::add(const float* blurred, const QuadrantPair& pair, int tile, int margin,
                        CellPlane& result) const {
  const int extent = plan_.tile + 2 * radius_, columns = result.grid.columns;
  const int first_row = tile / tiles_across_ * plan_.tile - radius_,
            first_column = tile % tiles_across_ * plan_.tile - radius_;
  const auto add_row = [&](int row, const Quadrant& quadrant, const float* in) {
    const int result_row = down_.cell(first_row + row, quadrant.below) - margin;
    if (result_row < 0 || result_row >= result.grid.rows) return;
    const int base = across_.cell(first_column, quadrant.right) - margin;
    float* out = result.row(static_cast<std::size_t>(result_row));
    // base ± i must lie within the result.
    const int from = quadrant.right ? std::max(0, -base) : std::max(0, base - (columns - 1));
    const int to = quadrant.right ? std::min(extent, columns - base) : std::min(extent, base + 1);
    if (quadrant.right)
      for (int i = from; i < to; ++i) out[base + i] += in[i];
    else
      for (int i = from; i < to; ++i) out[base - i] += in[i];
  };
  for (int row = 0; row < extent; ++row, blurred += 2 * static_cast<std::ptrdiff_t>(plan_.transform)) {
    add_row(row, pair.real, blurred);
    if (pair.imaginary) add_row(row, *pair.imaginary, blurred + plan_.transform);
  }
}

CellPlane TransformBlur::blur(const CellPlane& source, int margin) const {
  if (source.grid.columns != grid_.columns || source.grid.rows != grid_.rows)
    throw InputError("the plane to be blurred has another grid than the blur was made for");
  CellPlane result(grown(grid_, -margin));
  if (plan_.rows_held != 0) {
    blur_strip_by_strip(source, margin, result);
  } else {
    const Strip whole{0, tiles_down_, &sets_};
    blur_runs(runs(0, sets_.size(), whole), whole, source, margin, result);
  }
  return result;
}

void TransformBlur::blur_strip_by_strip(const CellPlane& source, int margin, CellPlane& result) const {
  const std::size_t floats = transform_.otf_floats();
  KernelSets held(sets_.size());
  for (std::size_t set = 0; set < sets_.size(); ++set) {
    const NodeKernels kernels = node_kernels(*psfs_, set);
    KernelSet& otfs = held[set];
    for (int first = 0; first < tiles_down_; first += plan_.rows_held) {
      const Strip strip{first, std::min(tiles_down_, first + plan_.rows_held), &held};
      const std::size_t first_row = phases() * static_cast<std::size_t>(first),
                        end_row = phases() * static_cast<std::size_t>(strip.end_row) + 1;
      // The last row of nodes is the first of the next strip.
      const std::size_t row_floats = (slots_before(first_row + 1) - slots_before(first_row)) * floats;
      if (first > 0) std::copy_n(otfs.data() + otfs.size() - row_floats, row_floats, otfs.data());
      otfs.resize((slots_before(end_row) - slots_before(first_row)) * floats);
      const std::size_t made = first == 0 ? 0 : 1;
      make_otfs(kernels, first_row + made, end_row, otfs.data() + (made == 0 ? 0 : row_floats));
      blur_runs(runs(set, set + 1, strip), strip, source, margin, result);
    }
    otfs = {};
  }
}

void TransformBlur::blur_runs(const std::vector<TileRun>& all, const Strip& strip, const CellPlane& source,
                              int margin, CellPlane& result) const {
  // Runs are blurred by whoever is free, but added to the result one after the other, so that sums are the
  // same for any number of threads.
  const std::size_t floats =
      blurred_floats(transform_, mixture_of(strip, all.front().set, all.front().first));
  constexpr std::size_t waiting_a_thread = 4;
  const auto threads = std::min(all.size(), static_cast<std::size_t>(thread_count()));
  InOrder sums(waiting_a_thread * threads, [&](std::size_t ticket, const AlignedVector<float>& blurred) {
    const TileRun& run = all[ticket];
    for (int tile = run.first; tile < run.end; ++tile)
      if (!Light(*this, source, run.pair, tile).is_dark())
        add(blurred.data() + floats * static_cast<std::size_t>(tile - run.first), run.pair, tile, margin,
            result);
  });
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    AlignedVector<float> workspace, blurred;
    for (std::size_t ticket; (ticket = next++) < all.size();) {
      const TileRun& run = all[ticket];
      blurred.resize(floats * static_cast<std::size_t>(run.end - run.first));
      for (int tile = run.first; tile < run.end; ++tile)
        if (const Light light(*this, source, run.pair, tile); !light.is_dark())
          blur_tile(transform_, mixture_of(strip, run.set, tile), light, workspace,
                    blurred.data() + floats * static_cast<std::size_t>(tile - run.first));
      blurred = sums.hand_in(ticket, std::move(blurred));
    }
  };
  parallel_for(threads, [&](std::size_t) {
    try {
      work();
    } catch (...) {
      sums.abandon();  // lest others wait for ever
      throw;
    }
  });
}

}  // namespace petzval
