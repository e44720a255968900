// SPDX-License-Identifier: BSD-3-Clause
// The lens data table of Maeda, Catrysse & Wandell 2005: all that image formation needs to know of a lens.
#pragma once

#include <petzval/lens/first_order.h>
#include <petzval/wave/psf.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// Places of a table that lie over the frame in two dimensions: a lattice on which the chief rays of every
/// wavelength land. Place number row · (places along x') + column.
struct FramePlaces {
  std::vector<double> x_mm, y_mm;  ///< in image space, increasing, two or more of each
  /// What each place sees, [place][wavelength]: the object's field (degrees from the axis or mm) as a vector
  /// along x' and y', so turned that a lens without distortion sees along the direction in which it images.
  std::vector<double> object_x, object_y;
  /// Direction of a PSF's t, [place][wavelength]: anticlockwise from +y' as seen from the film [degrees]; its
  /// s lies where t's right is when t points up, along +x' at 0.
  std::vector<double> psf_azimuth_deg;

  std::size_t count() const { return x_mm.size() * y_mm.size(); }
  std::size_t place(std::size_t column, std::size_t row) const { return row * x_mm.size() + column; }
  /// For messages: "(1.2, −0.4) mm".
  std::string name(std::size_t place) const;
};

/// What a lens at one focus and stop does to light: chief rays, g_source, g_sensor and PSFs, place by place
/// and wavelength by wavelength. Places are object fields from the axis outwards, for a centred lens, or lie
/// over the frame in two dimensions (`frame`), for any. Arrays are [place][wavelength].
struct LensDataTable {
  std::string lens_name;
  std::string provenance;  ///< program, version, options: one line
  std::string lens_json;   ///< the prescription it was built from, native JSON; may be empty
  std::optional<double> object_distance_mm;  ///< object to vertex 1; absent = infinity
  double vertex_to_sensor_mm = 0;            ///< vertex 1 to the image surface, along the axis
  /// Real height at the stop of the rays that its rim lets through; absent where it is not known, as in
  /// tables of other programs.
  std::optional<double> stop_semi_diameter_mm;
  FirstOrder first_order;  ///< NaN: not known, as in tables of other programs

  /// Object field, from 0, increasing: degrees when the object is at infinity, mm when it is finite. Empty
  /// where places lie over the frame, as is real_image_height_mm.
  std::vector<double> fields;
  std::optional<FramePlaces> frame;
  std::vector<double> wavelengths_nm;        ///< increasing
  std::vector<double> real_image_height_mm;  ///< |height| of the real chief ray on the image surface
  std::vector<double> g_source_sr;           ///< flux per area of chief-ray image, per radiance
  std::vector<double> g_sensor_sr;           ///< irradiance of a uniform wall, per radiance
  /// Of fields between two others, and of rows and columns of a lattice between two others, it may be empty
  /// (size 0): light is spread there as the PSFs about it say. Such tables are for one image
  /// (build_image_table()); files hold none.
  std::vector<Psf> psf;
  /// Relative L2 error of an image by what its PSFs miss of light between their places, as
  /// build_image_table() estimates it; 0: not known.
  double interpolation_error = 0;

  bool has_psf(std::size_t entry) const { return psf[entry].size > 0; }
  bool finite_object() const { return object_distance_mm.has_value(); }
  std::size_t places() const { return frame ? frame->count() : fields.size(); }
  std::size_t index(std::size_t place, std::size_t wavelength) const {
    return place * wavelengths_nm.size() + wavelength;
  }
  /// A place in words: "field 12", "(1.2, −0.4) mm".
  std::string place_name(std::size_t place) const;
  /// "deg" or "mm".
  const char* field_unit() const { return finite_object() ? "mm" : "deg"; }
  /// Tangent of the object angle, seen from vertex 1's plane at the object distance (finite: h / distance),
  /// of a field value.
  double field_tangent(double field) const;
  /// \throws InputError unless sizes agree, axes increase, heights increase with field (chief rays keep their
  /// order over the frame), nothing is NaN or negative and no more light arrives than a hemisphere holds (π
  /// sr).
  void validate() const;
};

/// Rows and columns of a lattice over the frame at whose crossings PSFs lie: all, or some with the outermost
/// among them.
struct PsfLattice {
  std::vector<std::size_t> columns, rows;

  bool holds(std::size_t column, std::size_t row) const;
};
PsfLattice psf_lattice(const LensDataTable& table, std::size_t wavelength);

/// \throws InputError if places lie over the frame, saying what knows tables by field height only.
void require_by_height(const LensDataTable& table, const char* what);

}  // namespace petzval
