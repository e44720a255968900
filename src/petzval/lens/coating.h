// SPDX-License-Identifier: BSD-3-Clause
// Coatings of lens surfaces: measured reflectances, or stacks of thin films.
#pragma once

#include <petzval/glass/material.h>
#include <petzval/wave/thin_film.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace petzval {

/// A film of a coating, of one material.
struct CoatingLayer {
  Material material = {};
  double thickness_nm = 0;
};

/// Measured reflectances at one wavelength.
struct AngleReflectance {
  std::vector<double> angles_deg = {};             ///< of incidence in air, increasing; none: all the same
  std::vector<std::array<double, 2>> values = {};  ///< of s and p, one an angle, or one
  /// Linear between the angles, held at the ends: {s, p}. \param cosine  of the angle in air.
  std::array<double, 2> at(double cosine) const;
  bool any() const;
};

/// Either measured reflectances or films, which say how they depend on angle and polarisation.
struct Coating {
  /// (wavelength [nm], reflectance 0…1), increasing wavelengths; linear in between, held at the ends. At
  /// normal incidence, if angles are told.
  std::vector<std::pair<double, double>> table = {};
  /// For each entry of the table the reflectances of s and p at `angles_deg`; none: all angles alike.
  std::vector<std::vector<std::array<double, 2>>> by_angle = {};
  std::vector<double> angles_deg = {};
  /// From the air to the glass; with layers there is no table.
  std::vector<CoatingLayer> layers = {};
  std::string name = {}, source = {};
  std::string bundled = {};  ///< the name of the bundled one that it is, as lens files have it; may be empty

  static Coating constant(double reflectance) {
    Coating coating;
    coating.table = {{0.0, reflectance}};
    return coating;
  }

  bool has_films() const { return !layers.empty(); }
  /// By the table, at normal incidence. \throws InputError for a coating of films.
  double at(double wavelength_nm) const;
  /// The same at all angles.
  AngleReflectance by_angle_at(double wavelength_nm) const;
  /// The films at a wavelength in the order in which light from `index_before` meets them: air has the
  /// index 1. \throws InputError where an index is not known.
  std::vector<ThinFilm> films(double wavelength_nm, double index_before) const;
  /// At normal incidence, on a surface between these. \throws InputError where an index is not known.
  double reflectance(double wavelength_nm, double index_before, double index_after) const;
  /// \throws InputError for a coating without anything, or with both; an unsorted table; a reflectance
  /// outside 0…1; a thickness that is not positive.
  void validate() const;
};

/// Reads a coating, thin films or measured reflectances, by path or bundled name ("mgf2"): JSON, "format":
/// "petzval-coating/1", strict (docs/LENS_FORMAT.md).
///
///     camera.losses.air_glass = read_coating("mgf2");
///
/// \throws InputError with file and line, saying what would be right.
Coating read_coating(const std::string& path_or_name);

}  // namespace petzval
