// SPDX-License-Identifier: BSD-3-Clause
// The lens data table of one image: PSFs where they are needed.
#pragma once

#include <petzval/optics/build.h>

namespace petzval {

/// How closely a table must say how light spreads.
struct SpreadWanted {
  double cell_um = 0;    ///< of the cells that the image will be formed on
  double tolerance = 0;  ///< ProductOptions::tolerance
};

/// The table of a lens as one image needs it. From a tolerance of 3·10⁻³ on, that of a preview, PSFs are made
/// for as few fields as serve; chief rays and illumination are those of all. A PSF in the middle between two
/// is compared with what they say of it (HeightKernels), at the middle wavelength. Where its kernel differs
/// by more than three tenths of the tolerance (RMS over the frame, rings of a small share of it allowed up to
/// four times as much), or a wall would by a tenth, it is taken too, and the halves are looked at if it
/// was more than four times what it may be. From 10⁻² on light is sampled as coarsely as the cells allow
/// (CoarseLight), and by rays where waves carry too little of it beyond them. Finer pictures
/// have the table of build_lens_data_table().
///
/// Places over the frame have PSFs on every fourth row and column of their lattice, more towards its rim
/// where they are needed, on every second or on all, at any tolerance: the fewest that tell the kernels in
/// the middles of their meshes, at the middle wavelength, to the tolerance (RMS; over whole meshes that is
/// half as much) and a wall to three tenths of it. \throws InputError as build_lens_data_table().
LensDataTable build_image_table(const Lens& lens, const TableOptions& options, const SpreadWanted& wanted,
                                const ProgressCallback& progress = {});

}  // namespace petzval
