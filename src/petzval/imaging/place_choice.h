// SPDX-License-Identifier: BSD-3-Clause
// The places over the frame whose PSFs an image needs.
#pragma once

#include <petzval/imaging/spread_wanted.h>
#include <petzval/optics/frame_build.h>

#include <cstddef>
#include <vector>

namespace petzval {

/// What build_image_table() says of places over the frame.
struct ChosenPlaces {
  std::vector<std::size_t> places;
  double error = 0;  ///< LensDataTable::interpolation_error
};

/// Leaves no PSF of the middle wavelength behind, with which it chooses.
ChosenPlaces choose_places(FrameTable& parts, const SpreadWanted& wanted, const ProgressCallback& progress);

}  // namespace petzval
