// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/imaging/frame_kernels.h>
#include <petzval/imaging/height_kernels.h>
#include <petzval/imaging/psf_kernel.h>

namespace petzval {

namespace {

std::unique_ptr<const KernelMaker> kernels_of(const LensDataTable& table, double wavelength_nm,
                                              double cell_um, PsfInterpolation interpolation,
                                              const LightCentres& centres, LatticeSteps steps) {
  if (!table.frame)
    return std::make_unique<HeightKernels>(table, wavelength_nm, cell_um, interpolation, centres, steps);
  if (interpolation == PsfInterpolation::otf)
    throw InputError(
        "OTFs are interpolated between field heights, not over the frame; `interpolate` psf does");
  return std::make_unique<FrameKernels>(table, wavelength_nm, cell_um, centres, steps);
}

}  // namespace

PsfReach psf_reach(const LensDataTable& table, double wavelength_nm, double cell_um,
                   const LightCentres& centres) {
  return table.frame ? frame_reach(table, wavelength_nm, cell_um, centres)
                     : height_reach(table, wavelength_nm, cell_um, centres);
}

PsfField::PsfField(const LensDataTable& table, double wavelength_nm, double cell_um,
                   PsfInterpolation interpolation, const LightCentres& centres, LatticeSteps steps)
    : cell_um_(cell_um), maker_(kernels_of(table, wavelength_nm, cell_um, interpolation, centres, steps)) {}

}  // namespace petzval
