// SPDX-License-Identifier: BSD-3-Clause
// Lens data tables for images: PSFs where they are needed.
#pragma once

#include <petzval/imaging/spread_wanted.h>
#include <petzval/optics/build.h>

namespace petzval {

/// The table of a lens as one image needs it: PSFs of as few fields as serve. A PSF in the middle between two
/// is compared with what they say of it (HeightKernels). Where its kernel differs by more than three tenths
/// of the tolerance (by light on the axis; RMS over the frame, rings of a small share of it allowed up to
/// four times as much), or a wall would, it is taken too, and the halves are looked at if it was more than
/// four times what it may be. Light that is formed apart (SpreadWanted::tail_um) is compared apart.
///
/// PSFs lie at fields that options.field_count asks for, or up to eight times closer as long as the image
/// does not turn back inwards (HeightTable::last_rising_field()). The middle wavelength chooses, then the
/// first and the last. Previews, from a tolerance of 5·10⁻³ on, go by the middle wavelength and the fields
/// asked for, and a wall may differ by a tenth of the tolerance; from 10⁻² on light is sampled as coarsely as
/// the cells allow (CoarseLight), and by rays where waves carry too little of it beyond them. Chief rays and
/// illumination are those of all fields asked for and of all with a PSF.
///
/// Places over the frame have PSFs on every fourth row and column of their lattice, more towards its rim
/// where they are needed, on every second or on all, at any tolerance: the fewest that tell the kernels in
/// the middles of their meshes, at the middle wavelength, to the tolerance (RMS; over whole meshes that is
/// half as much) and a wall to three tenths of it. \throws InputError as build_lens_data_table().
LensDataTable build_image_table(const Lens& lens, const TableOptions& options, const SpreadWanted& wanted,
                                const ProgressCallback& progress = {});

/// A table that is kept, for pictures that ask this of it: PSFs at all fields that options.field_count asks
/// for, and at those between them that build_image_table() would take too. Places over the frame: all of
/// them, as build_lens_data_table(). \throws InputError as that.
LensDataTable build_table_of_pictures(const Lens& lens, const TableOptions& options,
                                      const SpreadWanted& wanted, const ProgressCallback& progress = {});

}  // namespace petzval
