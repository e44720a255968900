// SPDX-License-Identifier: BSD-3-Clause
// What the surfaces of a lens scatter of the light of a picture.
#pragma once

#include <petzval/base/progress.h>
#include <petzval/flare/scatter_field.h>
#include <petzval/image/spectral_image.h>

#include <span>

namespace petzval {

struct ScatterLightOptions {
  Losses losses = {};
  Tracer::Clip clip = Tracer::Clip::apertures;
  /// What lies beyond the frame and is no source: dark, or as bright as the frame on the whole, as far out as
  /// half the frame.
  enum class Surround { dark, mean };
  Surround surround = Surround::dark;
  int cells = 160;  ///< along the longer side of the frame, at most a pixel each, 8 to 2048
  int nodes = 9;    ///< of the frame along each side, whose scatter is computed, 2 to 33
  int across = 10;  ///< rays along a side of what a source lights of each surface, 4 to 512

  /// \throws InputError saying what would be right.
  void validate() const;
};

struct ScatterLightReport {
  double scattered_share = 0;  ///< of the light of the frame, that is taken from it, the mean over bands
  double returned_share = 0;   ///< of the same light, that comes back into the frame
  int outside_sources = 0;     ///< sources whose image lies beyond the frame
};

/// What scatter adds to a picture and takes from it [W·m⁻²·nm⁻¹], in the picture's frame and bands: each
/// point keeps what is not scattered of its light, and the layer is negative where that is more than what
/// comes from elsewhere. Light of the frame is taken in cells, each spread by the scatter of its place in the
/// frame, which is that of nodes linearly in between (scatter_field.h; of the reference wavelength, its
/// BSDFs and coatings those of each band). Sources whose image is not in the frame are added as points: what
/// they light of the first surfaces reaches the sensor though they are not seen. \param light  of a picture
/// without scatter, those of its sources that are seen included. \throws InputError as ScatterTracer, and for
/// a lens that says nothing of scatter; Cancelled.
SpectralImage scatter_light(const Lens& lens, const SpectralImage& light,
                            std::span<const BrightSource> sources, const ScatterLightOptions& options = {},
                            const ProgressCallback& progress = {}, ScatterLightReport* report = nullptr);

}  // namespace petzval
