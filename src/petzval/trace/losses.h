// SPDX-License-Identifier: BSD-3-Clause
// What a lens takes from the light that passes: reflection at its surfaces, absorption in its glass.
#pragma once

#include <petzval/lens/lens.h>
#include <petzval/trace/pupil.h>
#include <petzval/trace/tracer.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace petzval {

/// Share of the light that a coated surface reflects, whatever the angle and the polarisation.
struct CoatingReflectance {
  /// (wavelength [nm], reflectance 0…1), increasing wavelengths; linear in between, held at the ends.
  std::vector<std::pair<double, double>> table = {};

  static CoatingReflectance constant(double reflectance) { return {{{0.0, reflectance}}}; }
  double at(double wavelength_nm) const;
};

/// Which losses a trace counts. Light reflected twice or more, which comes back as ghosts and flare, is lost
/// here.
struct Losses {
  bool fresnel = false;                              ///< surfaces without a coating reflect as bare glass
  bool absorption = false;                           ///< by the extinction coefficients of the catalogue
  std::optional<CoatingReflectance> air_glass = {};  ///< coating of all surfaces between air and glass
  std::map<std::size_t, CoatingReflectance> surfaces =
      {};  ///< coatings of single surfaces, before `air_glass`

  bool any() const { return fresnel || absorption || air_glass || !surfaces.empty(); }
  /// \throws InputError for a surface that the lens does not have, an empty or unsorted table, or a
  /// reflectance outside 0…1.
  void validate(const Lens& lens) const;
};

/// The transmittance of a lens at one wavelength, ray by ray, for unpolarised light. Immutable.
///
/// Reflection: Fresnel's equations for s and p (Born & Wolf, Principles of Optics, 7th ed. 1999, 1.5.2). Two
/// perpendicular polarisations are carried through the lens, and their powers averaged at its end: what one
/// surface polarises, the next one feels. Absorption: Lambert's law, exp(−4πk·distance/λ), no gain where
/// facing surfaces cross and a gap is walked backwards.
class LensTransmittance {
 public:
  /// \throws InputError as Losses::validate, and where an index is not known.
  LensTransmittance(const Lens& lens, double wavelength_nm, const Losses& losses);

  /// 0…1 for a ray that passed. \param start  the launched ray. \param path  what Tracer::trace or
  /// trace_backward recorded of it.
  double along(const Ray& start, const std::vector<Intersection>& path, bool backward = false) const;

  /// Glasses of the lens whose extinction is not known, and which count as perfectly clear.
  const std::vector<std::string>& clear_for_want_of_data() const { return clear_; }

 private:
  struct Interface {
    double index_before, index_after;
    std::optional<double> reflectance = {};  ///< nothing: Fresnel, if that counts
    double absorption_per_mm;                ///< of the gap behind the surface, 4πk/λ
  };
  bool fresnel_;
  std::vector<Interface> interfaces_;
  std::vector<std::string> clear_;
};

/// ∬ T du dv over the whole pupil of a pencil, in the unit of PupilBoundary::area().
double transmitted_area(const Tracer& tracer, const Pencil& pencil, const PupilBoundary& pupil,
                        const LensTransmittance& transmittance, int radial_nodes = 12);

}  // namespace petzval
