// SPDX-License-Identifier: BSD-3-Clause
// From the PSFs of a lens data table to the weights with which one cell's light reaches the cells about it.
#pragma once

#include <petzval/imaging/kernel_maker.h>
#include <petzval/imaging/light_centre.h>
#include <petzval/optics/lens_data_table.h>

#include <memory>
#include <vector>

namespace petzval {

/// What is interpolated between the fields and wavelengths of a table.
enum class PsfInterpolation {
  psf,  ///< the PSFs, by a cubic through four fields (the same thing as the complex OTFs by that cubic)
  otf   ///< modulus and phase of the OTFs of two fields, each linearly: overshoots where zeros move; to
        ///< compare
};

/// What a PsfField says of itself, without making one. \throws InputError as PsfField.
PsfReach psf_reach(const LensDataTable& table, double wavelength_nm, double cell_um,
                   const LightCentres& centres = {});

/// The kernels of one wavelength at every place of the image, whatever the kind of the table.
class PsfField {
 public:
  /// \throws InputError if the wavelength lies outside the table, a PSF is empty, damaged or dark, or spans
  /// more than 4000 cells, and for OTFs of a table over the frame.
  /// \param centres  what kernels are centred on, and heights counted to: the chief rays unless given.
  PsfField(const LensDataTable& table, double wavelength_nm, double cell_um,
           PsfInterpolation interpolation = PsfInterpolation::psf, const LightCentres& centres = {},
           LatticeSteps steps = LatticeSteps::fine);

  /// Of every kernel that kernel_at() returns: no PSF of this wavelength reaches farther at any azimuth.
  int radius() const { return maker_->reach().radius; }
  double cell_um() const { return cell_um_; }
  /// KernelMaker::rim_mm().
  double rim_mm() const { return maker_->rim_mm(); }
  /// Coefficients that a kernel is made of, about.
  double coefficients() const { return maker_->coefficients(); }
  KernelSymmetry symmetry() const { return maker_->symmetry(); }
  /// The least share of light that a PSF's window caught when the table was made.
  double least_captured() const { return maker_->reach().least_captured; }

  /// \param x_mm, y_mm  where the chief ray, or the centre of the light, lands in image space (x' > 0 is left
  /// of the picture's middle).
  Kernel kernel_at(double x_mm, double y_mm) const { return maker_->kernel_at(x_mm, y_mm); }
  void prepare(const std::vector<std::array<double, 2>>& places_mm) const { maker_->prepare(places_mm); }

 private:
  double cell_um_;
  std::unique_ptr<const KernelMaker> maker_;
};

}  // namespace petzval
