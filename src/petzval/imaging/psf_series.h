// SPDX-License-Identifier: BSD-3-Clause
// PSFs at many heights between the fields of a table, made when they are first asked for.
#pragma once

#include <petzval/base/parallel.h>
#include <petzval/imaging/smooth_psf.h>

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

namespace petzval {

/// PSFs at evenly spaced heights within each interval between two fields. What lies between them is a mixture
/// of four of the interval by field_shares(), coefficient by coefficient. PSFs are made once, by whichever
/// thread comes first; what they are does not depend on it.
class PsfSeries {
 public:
  using Mixture = std::vector<WeightedPsf>;

  /// \param height_mm  of the fields, increasing, at least one. \param coefficients  of a PSF of each
  /// interval (one where there is but one field). \param step_mm  that need not be gone below. Of each
  /// interval as many PSFs are kept as 64 MB allow, 4 at most.
  PsfSeries(std::vector<double> height_mm, const std::vector<double>& coefficients, double step_mm);

  /// \param make  (height [mm], interval) ↦ SmoothPsf. Heights beyond the fields: the first and the last.
  /// prepare() makes what these heights need, lest threads wait for one another later.
  template <typename Make>
  void prepare(const std::vector<double>& heights_mm, const Make& make) const {
    const std::vector<std::size_t> nodes = nodes_of(heights_mm);
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
    std::unique_ptr<SmoothPsf> psf;
  };
  /// Nodes are counted through all intervals, steps_ an interval.
  struct Share {
    std::size_t node = 0;
    double weight = 0;
  };
  /// None of them 0.
  std::vector<Share> shares_at(double height_mm) const;
  /// All that mixtures at these heights are made of, each once.
  std::vector<std::size_t> nodes_of(const std::vector<double>& heights_mm) const;
  template <typename Make>
  const SmoothPsf* psf(std::size_t node, const Make& make) const {
    Entry& entry = entries_[node];
    std::call_once(entry.made, [&] {
      entry.psf = std::make_unique<SmoothPsf>(make(height_of(node), interval_of(node)));
    });
    return entry.psf.get();
  }
  double height_of(std::size_t node) const;
  std::size_t interval_of(std::size_t node) const;

  std::vector<double> height_mm_;
  std::size_t steps_ = 1, nodes_ = 1;
  std::unique_ptr<Entry[]> entries_;
};

}  // namespace petzval
