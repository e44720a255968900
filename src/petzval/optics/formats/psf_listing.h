// SPDX-License-Identifier: BSD-3-Clause
// PSFs as Zemax lists them in text windows.
#pragma once

#include <petzval/optics/formats/psf_grid.h>

#include <optional>
#include <string>
#include <string_view>

namespace petzval {

/// A listing "of Huygens PSF Data" or "of FFT PSF Data", or a bare matrix of numbers without a header.
struct PsfListing {
  NumberGrid grid;
  double spacing_um = 0;  ///< 0: the listing does not say
  /// Row and column of the chief ray, from 0; where the listing does not say, size/2.
  int centre_row = 0, centre_column = 0;
  /// Where the PSF lies in the image [mm], x to the right and y upwards on the page.
  std::optional<std::pair<double, double>> image_point_mm;
};

/// Understands the header lines "Data spacing is 0.25 µm.", "Image grid size: 128 by 128", "Center point is:
/// 65, 65" (also "row 65, column 65"), "Center coordinates: x, y"; "Data area is 32 by 32 µm." must agree
/// with spacing and grid. The numbers follow the line "Values are …" ("relative intensity.", "normalized.",
/// "not normalized."). Text may be UTF-16, UTF-8 or Latin-1. \param expected_size  samples a side, for a
/// listing that does not say; 0: a square number of them. \param file  for messages. \throws InputError with
/// file and line.
PsfListing read_psf_listing(std::string_view bytes, const std::string& file, int expected_size = 0);

/// A listing with the field at −y′, as ISET's macros for Zemax place it: away from the axis is down. Numbers
/// have as many digits as they need to be read back the same.
std::string psf_listing_text(const Psf& psf, int size, double wavelength_nm, double image_height_mm,
                             const std::string& title);

/// The frame of what psf_listing_text() writes.
PsfFrame listing_frame(int size);

}  // namespace petzval
