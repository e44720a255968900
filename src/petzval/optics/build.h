// SPDX-License-Identifier: BSD-3-Clause
// Building the lens data table from a prescription.
#pragma once

#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/base/progress.h>
#include <petzval/optics/lens_data_table.h>
#include <petzval/trace/losses.h>
#include <petzval/trace/tracer.h>

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace petzval {

struct TableOptions {
  std::vector<double> wavelengths_nm = {};  ///< empty: the lens's own
  /// Real image height that the table must reach [mm]: half the sensor diagonal. The table goes on until a
  /// PSF radius beyond it, or until no ray passes (less than a thousandth of the pupil's area on axis). 0:
  /// the lens's largest field.
  double max_image_height_mm = 0;
  int field_count = 31;  ///< evenly spaced object fields, 0 included
  int psf_size = 0;      ///< cells a side of every PSF, as wide as each one needs; 0: as many as needed, too
  int largest_psf_size = 256;
  CoarseLight coarse = {};  ///< PsfOptions::coarse, and illumination to fit, of places by height
  /// Where the places of the table lie.
  enum class Places {
    automatic,  ///< over the frame for a lens with poses or blades, by height for any other
    by_height,
    over_frame
  };
  Places places = Places::automatic;
  /// Half the width and half the height of the frame that places cover, and a PSF radius more [mm]; absent:
  /// the square about the circle of max_image_height_mm.
  std::optional<std::array<double, 2>> half_frame_mm = {};
  int frame_places = 17;  ///< along the longer side of the frame, evenly spaced
  Tracer::Clip clip = Tracer::Clip::apertures;
  Losses losses = {};  ///< that g_source, g_sensor and the PSFs count

  /// \throws InputError saying what would be right.
  void validate() const;
};

/// The table of a lens as it stands (MountedLens::lens()): chief rays aimed at the real stop, g_source,
/// g_sensor and diffraction PSFs through the vignetted pupil, at every field and wavelength. Deterministic
/// for any number of threads. Every PSF holds 99 % of its light or says in `captured` what it does hold.
/// Memory: at most places × wavelengths × largest_psf_size² × 4 bytes. \throws InputError if no ray passes on
/// the axis, if a lens with poses or blades is asked for by height (such tables turn with the azimuth of the
/// field, polygons and tilted surfaces do not), or an index is not known at a wavelength.
LensDataTable build_lens_data_table(const Lens& lens, const TableOptions& options,
                                    const ProgressCallback& progress = {});

/// The table of a lens by field height in parts: what its chief rays say of all fields at once, PSFs of
/// whatever fields and wavelengths are asked for. An entry has the same bytes whenever it is made.
class HeightTable {
 public:
  /// Traces the chief rays. \throws InputError as build_lens_data_table().
  HeightTable(const Lens& lens, const TableOptions& options);

  /// The last field up to which the image of every wavelength moves outwards from each field to the next, by
  /// four tenths of what it does on average or more. Beyond it all but turns back, and light per area is
  /// without bound.
  std::size_t last_rising_field() const;
  /// Adds PSFs. From one thread; it takes as many as there are.
  void add_psfs(std::span<const std::size_t> fields, std::span<const std::size_t> wavelengths,
                const ProgressCallback& progress = {});
  /// Of these fields at every wavelength that has none yet.
  void add_missing_psfs(std::span<const std::size_t> fields, const ProgressCallback& progress = {});
  void remove_psf(std::size_t field, std::size_t wavelength);
  const LensDataTable& table() const { return table_; }
  /// With g_source and g_sensor of fields without PSFs, between those of fields with one.
  LensDataTable finished() &&;
  /// The same with no more than some fields, in increasing order.
  LensDataTable finished(std::span<const std::size_t> fields) &&;

 private:
  struct Ray {
    std::optional<ChiefRay> chief;
    double object_area = 0;  ///< FieldTracer::object_area_per_image_area()
  };
  void add_entry(std::size_t field, std::size_t wavelength);
  void add_entries(std::span<const std::array<std::size_t, 2>> field_and_wavelength,
                   const ProgressCallback& progress);

  Lens lens_;
  TableOptions options_;
  double sign_;
  std::vector<std::vector<Ray>> rays_;  ///< [wavelength][field]
  LensDataTable table_;
};

/// Whether a lens's places lie over the frame unless they are asked for by height.
bool needs_places_over_frame(const Lens& lens);

}  // namespace petzval
