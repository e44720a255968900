// SPDX-License-Identifier: BSD-3-Clause
// Where the light of a chief ray's point lands on average: the radial curves by which a cell looks out.
#pragma once

#include <petzval/numeric/lattice_spline.h>
#include <petzval/optics/table_interpolation.h>

#include <array>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace petzval {

/// The two table wavelengths about λ and their weights; one of them where λ meets it. A table of one
/// wavelength serves the same surroundings as RadialProfiles::at_wavelength() says.
/// \throws InputError for a wavelength that the table does not cover.
std::vector<std::pair<std::size_t, double>> bracketing_wavelengths(const LensDataTable& table,
                                                                   double wavelength_nm);

/// How far beyond its chief ray [mm, away from the axis] the light of each entry of a table has its centre of
/// gravity.
///
/// A kernel about the chief ray carries the divergence by which a uniform wall differs from g_source; cells
/// are too coarse to do that well, and kernels that neighbouring cells share do it worse. Counted from the
/// centre of light there is none left: cells look out along the ray whose light is centred on them, with
/// g_source × (area about the chief rays / area about the centres), and kernels spread it evenly about them.
/// It is the same picture to within what cells can resolve.
class LightCentres {
 public:
  /// Zero throughout: the chief rays themselves.
  LightCentres() = default;
  /// Zero on the axis; and from one field to the next the centres move at least half and at most twice as far
  /// as the chief rays. What that leaves out (at the rim of a fisheye, in PSFs that no lens has) stays in the
  /// kernels. Over a frame in two dimensions they are zero at a wavelength where centres would move by more
  /// than half as far as the chief rays, against them.
  explicit LightCentres(const LensDataTable& table);

  double offset_mm(std::size_t entry) const { return offsets_mm_.empty() ? 0 : offsets_mm_[entry]; }
  /// Of a table over the frame: along x' and y'.
  std::array<double, 2> frame_offset_mm(std::size_t entry) const {
    return frame_offsets_mm_.empty() ? std::array<double, 2>{} : frame_offsets_mm_[entry];
  }
  bool none() const { return offsets_mm_.empty() && frame_offsets_mm_.empty(); }

 private:
  void find_over_frame(const LensDataTable& table);

  std::vector<double> offsets_mm_;  ///< [field][wavelength], as in the table
  std::vector<std::array<double, 2>> frame_offsets_mm_;
};

/// Of a number that each PSF over the frame has. \param lattice  where PSFs lie.
LatticeSpline spline_of_psfs(const FramePlaces& frame, const PsfLattice& lattice,
                             const std::function<double(std::size_t place)>& value);

/// The radial curves of a lens at one wavelength over the height of the centre of light.
class LightProfile {
 public:
  /// Over the height of the chief ray; a conversion.
  LightProfile(RadialProfile chief);
  /// \throws InputError for a wavelength that the table does not cover.
  LightProfile(RadialProfile chief, const LensDataTable& table, const LightCentres& centres,
               double wavelength_nm);

  double object_field(double height_mm) const { return chief_.object_field(chief_height_mm(height_mm)); }
  /// Flux per area about the centres of light.
  double g_source_sr(double height_mm) const;
  /// The height that the table's last field reaches.
  double max_height_mm() const { return max_height_mm_; }

 private:
  double chief_height_mm(double height_mm) const { return moved_ ? centre_.inverse(height_mm) : height_mm; }

  RadialProfile chief_;
  bool moved_ = false;
  MonotoneCubic centre_;  ///< height of the centre over that of the chief ray
  double max_height_mm_;
};

}  // namespace petzval
