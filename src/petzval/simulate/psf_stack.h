// SPDX-License-Identifier: BSD-3-Clause
// The PSFs of a lens by field and wavelength, all on one grid.
#pragma once

#include <petzval/analysis/field_tables.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/base/context.h>
#include <petzval/lens/lens.h>

#include <cstddef>
#include <vector>

namespace petzval {

/// Each is laid out as Psf has it, centred on its own chief ray, with the sum 1.
struct PsfStack {
  Fields::Kind field_kind = Fields::Kind::angle_deg;
  std::vector<double> fields = {}, wavelengths_nm = {};
  int size = 0;                              ///< cells a side
  double spacing_um = 0;                     ///< of the cells
  std::vector<float> values = {};            ///< [field][wavelength][t][s]
  std::vector<double> captured = {};         ///< [field][wavelength], share of the light inside the window
  std::vector<double> image_height_mm = {};  ///< [field][wavelength], of the chief ray, signed

  std::size_t psf_cells() const { return static_cast<std::size_t>(size) * static_cast<std::size_t>(size); }
};

/// The PSFs of a lens.
///
///     const PsfStack stack = psf_stack(lens, {.fields = {0, 10}, .wavelengths_nm = {450, 550, 650}});
///     const float* first = stack.values.data();  // stack.size × stack.size cells
///
/// \param at  empty lists: the lens's own. \param options  a size or a spacing that is left open holds all:
/// the finest spacing that any PSF wants and the widest window, in at most `largest_size` cells a side.
/// \param fft_pupil_samples  above 0: by the plain FFT's model (fft_point_spread()) with so many samples
/// across the pupil, to compare with other programs. \throws InputError naming a field and a wavelength at
/// which no ray passes, or whose PSF is wider than samples of the FFT span; Cancelled.
PsfStack psf_stack(const Lens& lens, const FieldTableRequest& at = {}, const PsfOptions& options = {},
                   const Context& context = {}, int fft_pupil_samples = 0);

}  // namespace petzval
