// SPDX-License-Identifier: BSD-3-Clause
// PSFs at many heights between the fields of a table, made when they are first asked for.
#pragma once

#include <petzval/imaging/psf_deposit.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

namespace petzval {

/// The samples that the PSFs of an interval share.
struct SampleLattice {
  double spacing_um = 1;
  int half = 0;  ///< samples on either side of the middle one
};

/// PSFs at evenly spaced heights within each interval between two fields, on one lattice an interval. What
/// lies between them is a mixture of four of the interval by field_shares(), nearly always sample by sample.
/// They are made once, by whichever thread comes first; what they are does not depend on it.
class PsfSeries {
 public:
  using Mixture = std::vector<WeightedPsf>;

  /// \param height_mm  of the fields, increasing, at least one. \param lattices  one an interval (one where
  /// there is but one field). \param step_mm  that need not be gone below. Of each interval as many PSFs are
  /// kept as 64 MB allow, 8 at most.
  PsfSeries(std::vector<double> height_mm, std::vector<SampleLattice> lattices, double step_mm);

  /// \param make  (height [mm], lattice) ↦ MergedPsf. Heights beyond the fields: the first and the last.
  template <typename Make>
  Mixture at(double height_mm, const Make& make) const {
    Mixture mixture;
    for (const Share& share : shares_at(height_mm)) {
      if (share.weight == 0) continue;
      Entry& entry = entries_[share.index];
      std::call_once(entry.made, [&] {
        entry.psf = std::make_unique<MergedPsf>(make(height_of(share.index), lattice_of(share.index)));
      });
      mixture.push_back({entry.psf.get(), share.weight});
    }
    return mixture;
  }

 private:
  struct Entry {
    std::once_flag made;
    std::unique_ptr<MergedPsf> psf;
  };
  struct Share {
    std::size_t index = 0;
    double weight = 0;
  };
  /// In the order of their heights, so that those of one lattice stand together.
  std::array<Share, 4> shares_at(double height_mm) const;
  double height_of(std::size_t index) const;
  const SampleLattice& lattice_of(std::size_t index) const {
    return lattices_[std::min(index / steps_, lattices_.size() - 1)];
  }

  std::vector<double> height_mm_;
  std::vector<SampleLattice> lattices_;
  std::size_t steps_ = 1, count_ = 1;
  std::unique_ptr<Entry[]> entries_;  ///< steps of the first interval, of the second, …, the last field
};

}  // namespace petzval
