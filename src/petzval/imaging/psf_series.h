// SPDX-License-Identifier: BSD-3-Clause
// PSFs at many heights between the fields of a table, made when they are first asked for.
#pragma once

#include <petzval/base/parallel.h>
#include <petzval/imaging/psf_deposit.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

namespace petzval {

/// The samples that the PSFs of an interval share.
struct SampleLattice {
  double spacing_um = 1;
  double half_side_um = 0;  ///< of the square that holds their light

  /// Samples on either side of the middle one.
  int half() const { return static_cast<int>(std::ceil(half_side_um / spacing_um)); }
};

/// PSFs at evenly spaced heights within each interval between two fields. What lies between them is a mixture
/// of four of the interval by field_shares(), sample by sample. Neighbouring intervals of one spacing form a
/// run; over the last interval of a run its samples fade into those of the next, for kernels that jump where
/// the spacing does would draw a ring on a wall. PSFs are made once, by whichever thread comes first; what
/// they are does not depend on it.
class PsfSeries {
 public:
  using Mixture = std::vector<WeightedPsf>;

  /// \param height_mm  of the fields, increasing, at least one. \param lattices  one an interval (one where
  /// there is but one field). \param step_mm  that need not be gone below. Of each interval as many PSFs are
  /// kept as 64 MB allow, 4 at most.
  PsfSeries(std::vector<double> height_mm, std::vector<SampleLattice> lattices, double step_mm);

  /// \param make  (height [mm], lattice) ↦ MergedPsf. Heights beyond the fields: the first and the last.
  /// prepare() makes what these heights need, lest threads wait for one another later.
  template <typename Make>
  void prepare(const std::vector<double>& heights_mm, const Make& make) const {
    const std::vector<Node> nodes = nodes_of(heights_mm);
    parallel_for(nodes.size(), [&](std::size_t i) { psf(nodes[i], make); });
  }
  template <typename Make>
  Mixture at(double height_mm, const Make& make) const {
    Mixture mixture;
    for (const Share& share : shares_at(height_mm)) mixture.push_back({psf(share.node, make), share.weight});
    return mixture;
  }

 private:
  struct Entry {
    std::once_flag made;
    std::unique_ptr<MergedPsf> psf;
  };
  /// Intervals of one spacing. Nodes are counted through all intervals, steps_ an interval.
  struct Run {
    double spacing_um = 0;
    std::size_t first_node = 0, last_interval = 0;
    std::size_t size = 0;  ///< nodes from the first to the end of the last interval
    std::unique_ptr<Entry[]> entries;
  };
  struct Node {
    std::size_t run = 0, index = 0;
  };
  struct Share {
    Node node;
    double weight = 0;
  };
  /// None of them 0; those of one run stand together.
  std::vector<Share> shares_at(double height_mm) const;
  /// All that mixtures at these heights are made of, each once.
  std::vector<Node> nodes_of(const std::vector<double>& heights_mm) const;
  template <typename Make>
  const MergedPsf* psf(const Node& node, const Make& make) const {
    const Run& run = runs_[node.run];
    Entry& entry = run.entries[node.index - run.first_node];
    std::call_once(entry.made, [&] {
      const SampleLattice lattice{run.spacing_um, half_side_um(node.index)};
      entry.psf = std::make_unique<MergedPsf>(make(height_of(node.index), lattice));
    });
    return entry.psf.get();
  }
  double height_of(std::size_t node) const;
  double half_side_um(std::size_t node) const;

  std::vector<double> height_mm_;
  std::vector<SampleLattice> lattices_;
  std::size_t steps_ = 1;
  std::vector<Run> runs_;
};

}  // namespace petzval
