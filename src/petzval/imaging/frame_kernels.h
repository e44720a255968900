// SPDX-License-Identifier: BSD-3-Clause
// The kernels of a lens whose table lies over the frame in two dimensions.
#pragma once

#include <petzval/imaging/frame_light.h>
#include <petzval/imaging/kernel_maker.h>
#include <petzval/imaging/smooth_psf.h>
#include <petzval/numeric/lattice_spline.h>
#include <petzval/optics/lens_data_table.h>

#include <array>
#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

namespace petzval {

/// As psf_reach(), of a table over the frame.
PsfReach frame_reach(const LensDataTable& table, double wavelength_nm, double cell_um,
                     const LightCentres& centres);

/// The PSFs of the sixteen places about a place, at the bracketing wavelengths, are each seen through the
/// round window of a kernel (SmoothPsf), turned as they lie in the table, moved and stretched along their own
/// axes to the centre and the spread that light has at the place, and mixed: by cubics through four places
/// along x' and along y' (field_shares()). Centres and spreads over the frame are bicubic splines.
class FrameKernels : public KernelMaker {
 public:
  /// \throws InputError if the wavelength lies outside the table, or a PSF spans more than 4000 cells.
  FrameKernels(const LensDataTable& table, double wavelength_nm, double cell_um, const LightCentres& centres,
               LatticeSteps steps = LatticeSteps::fine);

  Kernel kernel_at(double x_mm, double y_mm) const override;
  void prepare(const std::vector<std::array<double, 2>>& places_mm) const override;
  const PsfReach& reach() const override { return reach_; }
  KernelSymmetry symmetry() const override { return KernelSymmetry::none; }
  double rim_mm() const override { return 0; }
  double coefficients() const override;

 private:
  /// One PSF of the table, made when it is first needed.
  struct Entry {
    std::once_flag made;
    std::unique_ptr<SmoothPsf> psf;
  };
  /// Centre and spread of light [cells], along x' and y'.
  struct Spread {
    std::array<double, 2> mean{};
    double xx = 0, xy = 0, yy = 0;  ///< about the mean
  };
  /// One wavelength of the table.
  struct Layer {
    std::size_t wavelength = 0;
    double weight = 1;
    PsfLattice lattice;
    std::vector<double> x_mm, y_mm;            ///< of its columns and rows
    std::unique_ptr<Entry[]> entries;          ///< [place]
    std::vector<double> cosines, sines;        ///< of the azimuths of PSFs
    LatticeSpline mean_x, mean_y, xx, xy, yy;  ///< [cells]
    Spread spread_at(double x_mm, double y_mm) const;
  };
  struct Share {
    std::size_t place;
    double weight;
  };
  /// Where the chief ray lands whose light has its centre at a place; beyond the lattice, on its edge.
  std::array<double, 2> known_chief_mm(double x_mm, double y_mm) const;
  std::vector<Share> shares_at(const Layer& layer, const std::array<double, 2>& chief_mm) const;
  const SmoothPsf& psf(const Layer& layer, std::size_t place) const;
  void find_spreads(const LightCentres& centres, Layer& layer) const;

  const LensDataTable& table_;
  double cell_um_;
  double steps_;  ///< of the lattices, along a cell
  FrameCentres centres_;
  std::vector<Layer> layers_;
  PsfReach reach_;
};

}  // namespace petzval
