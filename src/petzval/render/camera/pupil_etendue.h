// SPDX-License-Identifier: BSD-3-Clause
// How much of a uniform field reaches each place of the film.
#pragma once

#include <petzval/render/camera/lens_camera.h>

#include <array>
#include <vector>

namespace petzval::render {

/// The irradiance of a film in a uniform field of unit radiance [sr]: ∬ dα dβ over the light that passes,
/// what losses leave of it. Found by rays on a grid in polar coordinates and a few wavelengths, linear in
/// between.
class PupilEtendue {
 public:
  /// \param radius_mm  of the film's corner.
  PupilEtendue(const LensCamera& camera, const WavelengthGroups& groups, double radius_mm);

  struct Value {
    double sr;
    bool exact;  ///< to a few parts in a thousand; not where vignetting sets in, or ends the picture
  };
  /// A place of the film among the rays' places.
  struct Place {
    std::array<std::size_t, 2> spokes;
    double outwards, turn;
  };
  Place place(double x_mm, double y_mm) const;
  Value at(int group, int lane, const Place& place) const;

 private:
  struct Node {
    double sr;
    bool bends;  ///< too much for straight lines
  };
  /// A band between two wavelengths that were followed.
  struct Between {
    std::size_t plane;
    double share;
  };
  Value on_plane(std::size_t plane, const Place& place) const;

  int groups_, azimuths_;
  std::vector<Between> between_;  ///< [band]
  double step_mm_;
  std::vector<Node> nodes_;  ///< [wavelength][azimuth][radius]
};

}  // namespace petzval::render
