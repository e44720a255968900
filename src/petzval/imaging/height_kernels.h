// SPDX-License-Identifier: BSD-3-Clause
// The kernels of a centred lens: by the height of a place, turned to its azimuth.
#pragma once

#include <petzval/imaging/field_mixture.h>
#include <petzval/imaging/kernel_maker.h>
#include <petzval/imaging/psf_kernel.h>
#include <petzval/imaging/psf_series.h>
#include <petzval/numeric/interpolation.h>

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace petzval {

/// As psf_reach(), of a table by field height.
PsfReach height_reach(const LensDataTable& table, double wavelength_nm, double cell_um,
                      const LightCentres& centres);

/// The kernels of one wavelength of a table by field height.
///
/// For light that lands about (x', y') the PSFs of the four fields about that height (field_shares()), at the
/// bracketing wavelengths, are stretched to the widths of the height, mixed, seen through a round window
/// (SmoothPsf), rotated to the azimuth of (x', y'), taken at the middles of the cells and normalised to sum 1
/// (after Maeda, Catrysse & Wandell 2005, section 2.2.3; the sum is the OTF at zero frequency). The kernel
/// has the centroid of the PSF, and its spread and that of the window, wherever the cells lie. Beyond the
/// heights of the table its last PSF holds.
class HeightKernels : public KernelMaker {
 public:
  /// \throws InputError if the wavelength lies outside the table, a PSF is empty, damaged or dark, or spans
  /// more than 4000 cells.
  /// \param centres  what kernels are centred on, and heights counted to: the chief rays unless given.
  HeightKernels(const LensDataTable& table, double wavelength_nm, double cell_um,
                PsfInterpolation interpolation, const LightCentres& centres,
                LatticeSteps steps = LatticeSteps::fine);

  Kernel kernel_at(double x_mm, double y_mm) const override;
  /// At (0, height), from PSFs mixed at this height; what others need is not made ready by it.
  Kernel lone_kernel(double height_mm) const;
  void prepare(const std::vector<std::array<double, 2>>& places_mm) const override;
  const PsfReach& reach() const override { return reach_; }
  /// PSFs that are the same left and right of the tangential plane, as those of a centred lens are, have
  /// mirrored kernels at mirrored places.
  KernelSymmetry symmetry() const override {
    return mirror_symmetric_ ? KernelSymmetry::mirrored : KernelSymmetry::turned;
  }
  /// From there on kernels are those of the last field, turned.
  double rim_mm() const override { return layers_[0].height_mm.back(); }
  double coefficients() const override;

 private:
  /// The moments of PSFs of unit sum over height: smooth curves, for where the spread of light grows ever
  /// faster with height, bends in it at each field of the table would show on a wall.
  class MomentCurves {
   public:
    MomentCurves() = default;
    MomentCurves(const std::vector<double>& height_mm, const std::vector<MergedPsf>& psfs);
    Moments at(double height_mm) const {
      return {{s_(height_mm), t_(height_mm)}, ss_(height_mm), st_(height_mm), tt_(height_mm)};
    }

   private:
    MonotoneCubic s_, t_, ss_, st_, tt_;
  };
  /// One wavelength of the table.
  struct Layer {
    double weight = 1;
    std::vector<double> height_mm;
    std::vector<MergedPsf> psfs;
    std::vector<double> half_side_um;  ///< of the square about a kernel's centre that holds their light
    MomentCurves moments;
  };
  /// The two PSFs of a layer between which a height lies.
  struct Pair {
    const MergedPsf *low, *high;
    double weight_high;
  };
  static Pair pair_at(const Layer& layer, double height_mm);
  /// Of the PSF at this height [cells], its tangential direction along the rows' growing numbers.
  Moments moments_at(double height_mm) const;
  /// Lays a PSF down on a lattice, stretched to the spread that PSFs have at this height, and by factors
  /// along s and t beyond it.
  void add(const Layer& layer, const MergedPsf& psf, const FieldShare& share, double height_mm,
           const std::array<double, 2>& beyond, Kernel& lattice) const;
  /// The mixture of fields and wavelengths for a height, stretched so.
  Kernel mixture_at(double height_mm, std::size_t interval, const std::array<double, 2>& beyond) const;
  double spacing_um() const;
  /// Of the lattice for the PSFs of an interval between two fields: as wide as their light.
  int half_of(std::size_t interval) const;
  /// mixture_at() with the spread of the height.
  SmoothPsf psf_at(double height_mm, std::size_t interval) const;
  Kernel interpolated_psf(const std::array<double, 2>& direction, double height_mm) const;
  Kernel interpolated_otf(const std::array<double, 2>& direction, double height_mm) const;

  double cell_um_;
  double steps_;  ///< of the lattices, along a cell
  PsfInterpolation interpolation_;
  std::vector<Layer> layers_;
  std::unique_ptr<PsfSeries> series_;
  PsfReach reach_;
  bool mirror_symmetric_ = true;
};

}  // namespace petzval
