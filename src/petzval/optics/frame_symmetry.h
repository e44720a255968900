// SPDX-License-Identifier: BSD-3-Clause
// Which places of a frame a lens treats alike.
#pragma once

#include <petzval/lens/lens.h>
#include <petzval/optics/lens_data_table.h>

#include <cstddef>

namespace petzval {

/// What takes the light of a lens over its frame into itself.
struct FrameSymmetry {
  bool across = false;  ///< x' → −x'
  bool down = false;    ///< y' → −y'
  bool turned = false;  ///< half a turn

  bool any() const { return across || down || turned; }
  bool mirrors() const { return across || down; }
};

/// All of them for a round stop; for a polygon those of its edges; none for a lens that is not round but for
/// its blades.
FrameSymmetry frame_symmetry(const Lens& lens);

/// Another place, whose light is also that of a place: what stands for both.
struct FrameTwin {
  std::size_t place = 0;
  bool across = false, down = false;  ///< the ways to it

  bool mirrored() const { return across != down; }
  /// Of a PSF's t at the place, from that at the other [degrees, above −180 to 180].
  double azimuth_deg(double at_twin_deg) const;
};

/// \param place  of a lattice that lies evenly about the axis.
FrameTwin twin_of(const FrameSymmetry& symmetry, const FramePlaces& frame, std::size_t place);

/// What lies in the largest disk about the middle of a PSF, on an odd number of cells a side, so that it is
/// the same in axes that are turned or mirrored: unit sum, `captured` the less.
Psf round_psf(const Psf& psf);
/// s → −s. \param psf  on an odd number of cells a side.
Psf mirrored_psf(Psf psf);

}  // namespace petzval
