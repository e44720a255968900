// SPDX-License-Identifier: BSD-3-Clause
// The far tail of a diffraction PSF over a scene without an end.
#pragma once

#include <petzval/target/visible_regions.h>
#include <petzval/wave/otf.h>

#include <array>
#include <vector>

namespace petzval {

/// A smooth kernel with the tail of a PSF. A point at height a above the picture sees a region under a solid
/// angle; the kernel a/(2π (r² + a²)^(3/2)) of that view has the transform exp(−2πa|f|) and falls as 1/r³, as
/// the PSF of a sharp-edged pupil does. Three heights with the right weights q match the terms 1/r³ and 1/r⁵
/// and leave none in 1/r⁷. Taken off the OTF they leave a kernel that falls as 1/r⁹, which a periodic
/// transform does not wrap; put back as solid angles, which are elementary for polygons of any extent, they
/// are exact.
struct FarKernel {
  std::array<double, 3> height_px{}, weight{};

  bool is_zero() const { return weight[0] == 0; }
  /// Σ q exp(−2πa|f|).
  double transform(double frequency_cpp) const;
};

/// For a PSF whose tail holds beyond some 5 heights. `smallest_px`: the lowest height.
FarKernel far_kernel(const PsfTail& tail, double pitch_um, double smallest_px);

/// The largest extent, over the lowest height, of a contour that counts as a spot: its third moments then
/// weigh below 1e-4 of a far field that is itself below 1e-2.
inline constexpr double spot_extent = 0.125;

/// The larger side of the box about a contour.
double extent_of(const Contour& contour);

/// Σ step · (kernel over the region), at places in the picture. Regions may reach to infinity. Runs of short
/// edges, as curves have them, are seen as their chords and the moments of what lies between.
class FarField {
 public:
  FarField(const std::vector<Region>& regions, const FarKernel& kernel);

  /// At column + ½, row + ½ of every pixel: computed on a grid of a fifth of the lowest height and
  /// interpolated by polynomials of degree 9, which meets the field to 1e-9. Adds to `values`, row-major.
  void add_to(std::vector<double>& values, int columns, int rows) const;
  double at(Vertex place) const;

 private:
  struct Side {
    Vertex a, b;
    double step;
  };
  /// A contour so small against the lowest height that its moments say all: to the second order.
  struct Spot {
    Vertex centre;
    double area, xx, xy, yy;  ///< times the step
  };
  double of_side(const Side& side, Vertex place) const;
  double of_spot(const Spot& spot, Vertex place) const;

  std::vector<Side> sides_;
  std::vector<Spot> spots_;
  FarKernel kernel_;
};

}  // namespace petzval
