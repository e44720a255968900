// SPDX-License-Identifier: BSD-3-Clause
// Ghosts: light that two or four surfaces of a lens reflect, by paraxial optics.
#pragma once

#include <petzval/lens/lens.h>
#include <petzval/trace/losses.h>

#include <cstddef>
#include <optional>
#include <vector>

namespace petzval {

struct GhostOptions {
  std::vector<double> wavelengths_nm = {};  ///< empty: the lens's reference wavelength
  /// Coatings and absorption. Surfaces without a coating reflect as bare glass.
  Losses losses = {};
  double sensor_reflectance = 0;      ///< of the sensor's surface; 0: no ghosts that it takes part in
  double source_diameter_deg = 0.53;  ///< seen from the lens; the Sun's
  int reflections = 2;  ///< or 4: ghosts of four reflections, too, down to 1e-4 of the brightest

  /// \throws InputError saying what would be right.
  void validate() const;
};

/// One way of light: through the lens to surface `first`, back to surface `second` in front of it, and on to
/// the sensor; or on to `third`, back to `fourth` in front of that, and on. A surface is its index; the
/// sensor's is the number of surfaces.
struct Ghost {
  std::size_t first = 0, second = 0;
  double wavelength_nm = 0;
  /// Where the ghost of the lens's object is in focus, from the image surface along z; ±infinity where its
  /// light leaves collimated.
  double focus_mm = 0;
  /// On the sensor, of the light of the point on the axis, as far as all clear apertures let it pass.
  double diameter_mm = 0;
  double magnification = 0;  ///< height of the ghost's chief ray on the sensor over that of the image
  double transmittance = 0;  ///< of the light on this way, at normal incidence
  /// Irradiance in the middle of the ghost, over that of the lens's front by the source, which faces it.
  double irradiance = 0;
  /// The same over the irradiance in the middle of the source's image.
  double relative_irradiance = 0;
  std::optional<std::size_t> third = {}, fourth = {};  ///< of four reflections
};

/// All double reflections, and those of four on request, of each wavelength the brightest first. Rays are
/// paraxial: an even source whose disc and the disc of a single point make the ghost by convolution, with the
/// flux over the area of the larger of the two in its middle. Heights and slopes go through the unfolded
/// lens: a surface of curvature c in index n that light meets from the front has the power −2nc, from behind
/// 2nc. Powers are of normal incidence. (M. Hullin et al., ACM Trans. Graph. 30 (2011) 108, trace the same
/// ways with real rays.)
/// \throws InputError for a reflectance outside 0…1, a source that is not positive, other reflections than 2
/// or 4, and as Losses::validate().
std::vector<Ghost> ghosts(const Lens& lens, const GhostOptions& options = {});

}  // namespace petzval
