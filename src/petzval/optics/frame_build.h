// SPDX-License-Identifier: BSD-3-Clause
// Filling a lens data table place by place over the frame.
#pragma once

#include <petzval/analysis/point_spread.h>
#include <petzval/base/progress.h>
#include <petzval/optics/build.h>
#include <petzval/optics/frame_symmetry.h>

#include <cstddef>
#include <span>
#include <vector>

namespace petzval {

/// A pupil that vignetting has shrunk to this share of the one on axis counts as dark: its PSF is wider than
/// any grid.
inline constexpr double dark_pupil_share = 1e-3;

/// The sign of object fields that image to +y'.
double towards_positive_image(const Lens& lens);
PsfOptions psf_options_of(const TableOptions& options);
/// With what the lens says where nothing is asked. \throws InputError as TableOptions::validate().
TableOptions completed(const Lens& lens, TableOptions options);
/// What a table says of the lens as a whole.
LensDataTable blank_table(const Lens& lens, const TableOptions& options);

/// The table of a lens over the frame in parts: what chief rays and pupils say of every place at once, PSFs
/// of whatever places and wavelengths are asked for. A lattice lies over the frame; each place has the object
/// whose chief ray lands there. Where no light arrives g is 0, the object is where its neighbours point, and
/// the PSF is that of the next place with light towards the middle. Of places that a lens treats alike
/// (FrameSymmetry) one is computed. An entry has the same bytes whenever it is made.
class FrameTable {
 public:
  /// \param options  with its wavelengths and the frame. \param blank  what is said of the lens as a whole,
  /// and the wavelengths. \throws InputError where no ray passes in the middle.
  FrameTable(const Lens& lens, const TableOptions& options, LensDataTable blank);
  /// The same of a lens by its name alone, options completed. \throws InputError as build_lens_data_table().
  FrameTable(const Lens& lens, const TableOptions& options);

  /// Adds PSFs. From one thread; it takes as many as there are.
  void add_psfs(std::span<const std::size_t> places, std::span<const std::size_t> wavelengths,
                const ProgressCallback& progress = {});
  void remove_psf(std::size_t place, std::size_t wavelength);
  const LensDataTable& table() const { return table_; }
  LensDataTable finished() &&;

 private:
  void find_light();
  void choose_windows();
  bool illuminate(std::size_t place, std::size_t wavelength, double dark_area);
  void make_psf(std::size_t place, std::size_t wavelength);
  std::size_t light_of(std::size_t place, std::size_t wavelength) const;
  void extend_into_darkness(std::size_t wavelength);

  Lens lens_;
  TableOptions options_;
  FrameSymmetry symmetry_;
  PsfOptions psf_options_;
  LensDataTable table_;
  std::vector<Psf> made_;  ///< [place][wavelength], of the places that stand for others
  std::vector<char> lit_;  ///< [place][wavelength]
};

}  // namespace petzval
