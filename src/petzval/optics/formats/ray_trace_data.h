// SPDX-License-Identifier: BSD-3-Clause
// A lens as ISET's ray trace model holds it, whatever file it stands in.
#pragma once

#include <petzval/optics/lens_data_table.h>

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// The content of ISET's `rayTrace` structure and of the text files it is made from. Arrays are
/// [field][wavelength], field-major. Numbers that a file does not give are NaN.
struct RayTraceData {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::string program;  ///< that computed it
  std::string lens_file;
  double reference_wavelength_nm = unknown;
  double object_distance_mm = unknown;  ///< from vertex 1; from 10^9 mm on, infinity
  double magnification = unknown;       ///< negative for a real image; 0 at infinity
  double f_number = unknown;            ///< efl / entrance pupil diameter
  double effective_f_number = unknown;  ///< at the object distance: 1 / (2 NA)
  double effective_focal_length_mm = unknown;
  double field_of_view_deg = unknown;  ///< full

  std::vector<double> field_height_mm;  ///< paraxial image height, from 0, increasing
  std::vector<double> wavelengths_nm;
  std::vector<double> distorted_height_mm;    ///< of the real chief ray
  std::vector<double> relative_illumination;  ///< as in the file, per cent too
  std::vector<Psf> psf;
  std::vector<double> transmittance;  ///< of the lens, by wavelength; empty: 1
  /// What Petzval keeps beside it (kept_beside()); empty in files of others.
  std::string kept;
};

/// What the structure does not say.
struct RayTraceReading {
  /// Light of a uniform wall on the axis, g_sensor(0) [sr]. Absent: π / (1 + 4 N² (1 + |m|)²).
  std::optional<double> g_axis_sr;
  /// Relative illumination is that of a uniform wall (what Zemax and CODE V print), or that of an object
  /// point before the blur (what ISET multiplies by).
  enum class Illumination { sensor, source } illumination = Illumination::sensor;
  /// Vertex 1 to the sensor. A finite object's distance from the sensor needs it.
  double vertex_to_sensor_mm = 0;

  bool says_something() const {
    return g_axis_sr || illumination != Illumination::sensor || vertex_to_sensor_mm != 0;
  }
};

struct ImportedTable {
  LensDataTable table;
  std::vector<std::string> notes;  ///< what had to be assumed
};

/// The table, valid. Object fields follow from paraxial image heights by focal length or magnification. With
/// `kept` that agrees with the rest, the table is what it was made from, bit for bit. Of relative
/// illumination per cent become shares, and that of a wall becomes 1 on the axis. \throws InputError saying
/// what is missing or wrong.
ImportedTable table_of(const RayTraceData& data, const RayTraceReading& reading = {});

/// The structure of a table. \throws InputError for a table that it cannot hold: PSFs on several grids
/// (on_common_grid() is the remedy), fields of 90 degrees and more, no focal length.
RayTraceData ray_trace_data(const LensDataTable& table);

/// g_source of the points whose blur gives a wall the illumination g_sensor: the light of height h is centred
/// on h + c(h) (the PSF's centre of gravity), so that g_source(h) = g_sensor(h + c) · (1 + c′) (h + c)/h.
/// Arrays are [field][wavelength] as in the table, whose heights and PSFs are used.
std::vector<double> source_from_sensor(const LensDataTable& table);

}  // namespace petzval
