// SPDX-License-Identifier: BSD-3-Clause
// How the light of a place spreads: what kinds of lens data tables answer.
#pragma once

#include <petzval/imaging/psf_deposit.h>

#include <array>
#include <vector>

namespace petzval {

/// Which places of the image have the same kernels.
enum class KernelSymmetry {
  none,     ///< none
  turned,   ///< those opposite the axis: turned by half a turn
  mirrored  ///< those on either side of both axes too: mirrored
};

/// How far the kernels of one wavelength reach.
struct PsfReach {
  int radius = 0;             ///< cells
  double least_captured = 1;  ///< the least share of light that a PSF's window caught
};

/// Steps along a cell of the lattices on which PSFs lie that kernels are taken from. Of light seen through
/// the window cubic splines between four steps miss 5·10⁻⁵; three are for previews, at half the work.
enum class LatticeSteps { fine = 4, coarse = 3 };

/// The kernels of one wavelength on cells of one size, at every place of the image. Made by field height
/// (HeightKernels) or over the frame in two dimensions (FrameKernels); whoever follows the light knows
/// neither. Places are in image space [mm], where the light has its centre. From any thread.
class KernelMaker {
 public:
  virtual ~KernelMaker() = default;

  /// Of unit sum, with the radius of reach().
  virtual Kernel kernel_at(double x_mm, double y_mm) const = 0;
  /// Makes ready what kernels at these places share, with all threads; else the first that needs it does.
  virtual void prepare(const std::vector<std::array<double, 2>>& places_mm) const = 0;

  virtual const PsfReach& reach() const = 0;
  virtual KernelSymmetry symmetry() const = 0;
  /// The distance from the axis about which kernels may change from cell to cell; 0: nowhere.
  virtual double rim_mm() const = 0;
  /// Numbers that a kernel is made of, about: its cost.
  virtual double coefficients() const = 0;
};

}  // namespace petzval
