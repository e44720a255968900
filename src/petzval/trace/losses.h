// SPDX-License-Identifier: BSD-3-Clause
// What a lens takes from the light that passes: reflection at its surfaces, absorption in its glass.
#pragma once

#include <petzval/lens/coating.h>
#include <petzval/lens/lens.h>
#include <petzval/trace/pupil.h>
#include <petzval/trace/tracer.h>

#include <array>
#include <complex>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace petzval {

/// Which losses a trace counts. Light reflected twice or more, which comes back as ghosts and flare, is lost
/// here.
struct Losses {
  bool fresnel = false;                          ///< surfaces without a coating reflect as bare glass
  bool absorption = false;                       ///< by the extinction coefficients of the catalogue
  std::optional<Coating> air_glass = {};         ///< coating of all surfaces between air and glass
  std::map<std::size_t, Coating> surfaces = {};  ///< coatings of single surfaces, before `air_glass`

  bool any() const { return fresnel || absorption || air_glass || !surfaces.empty(); }
  /// As this lens has them: what its surfaces say themselves stands before `air_glass` and behind `surfaces`.
  Losses of(const Lens& lens) const;
  /// Of a surface between media of these indices; null: none.
  const Coating* coating(std::size_t surface, double index_before, double index_after) const;
  /// \throws InputError for a surface that the lens does not have, films between two glasses,
  /// and as Coating::validate().
  void validate(const Lens& lens) const;
};

/// What a lens does to the field of a ray: [out][in].
using Jones = std::array<std::array<std::complex<double>, 2>, 2>;

/// The transmittance of a lens at one wavelength, ray by ray, for unpolarised light. Immutable.
///
/// Reflection: Fresnel's equations for s and p (Born & Wolf, Principles of Optics, 7th ed. 1999, 1.5.2). Two
/// perpendicular polarisations are carried through the lens, and their powers averaged at its end: what one
/// surface polarises, the next one feels. Films let through what film_power() says of each polarisation; that
/// they delay one against the other counts in jones() alone. Absorption: Lambert's law,
/// exp(−4πk·distance/λ). A mirror throws back all, or the share that a coating of its own says. No gain where
/// facing surfaces cross and a gap is walked backwards.
class LensTransmittance {
 public:
  /// \throws InputError as Losses::validate, and where an index is not known.
  LensTransmittance(const Lens& lens, double wavelength_nm, const Losses& losses);

  /// From now on what apertures close inside their outer edges takes light too: all of it.
  void heed_obscurations(const Tracer& tracer);

  /// 0…1 for a ray that passed. \param start  the launched ray, in lens space (Tracer::from_image of
  /// one that runs backwards). \param path  what Tracer::trace or trace_backward recorded of it.
  double along(const Ray& start, const std::vector<Intersection>& path, bool backward = false) const;

  /// The Jones matrix of a ray that passed, delays of films included (film_amplitude): fields in the root of
  /// their power, in axes that the ray carries with it as a lens that does not polarise would turn them.
  /// Half the sum of its squares is along(). (R. A. Chipman, W.-S. T. Lam, G. Young, Polarized Light and
  /// Optical Systems, 2018, ch. 9 and 17.)
  Jones jones(const Ray& start, const std::vector<Intersection>& path) const;

  /// Glasses of the lens whose extinction is not known, and which count as perfectly clear.
  const std::vector<std::string>& clear_for_want_of_data() const { return clear_; }

 private:
  struct Interface {
    double index_before = 1, index_after = 1;
    bool mirror = false;  ///< throws back what `reflectance` says, or all
    /// Nothing: films, or Fresnel, if that counts.
    std::optional<AngleReflectance> reflectance = {};
    std::vector<ThinFilm> films = {};  ///< from the front
    double absorption_per_mm = 0;      ///< of the gap behind the surface, 4πk/λ
  };
  /// Figures that close a surface inside.
  struct Obscuration {
    std::size_t surface;
    double vertex_z_mm;
    Frame frame;
    std::vector<ApertureFigure> figures;
  };
  bool is_obscured(const std::vector<Intersection>& path, bool backward) const;
  /// Takes the fields of two polarisations along; power that glass absorbs is returned, what is left of it.
  template <class Number>
  double follow(const Ray& start, const std::vector<Intersection>& path, bool backward,
                std::array<std::array<Number, 3>, 2>& fields) const;

  bool fresnel_;
  double wavelength_nm_;
  std::vector<Interface> interfaces_;
  std::vector<std::string> clear_;
  std::vector<Obscuration> obscurations_;
};

/// Whether any surface has an aperture that is closed inside.
bool has_obscurations(const Lens& lens);

/// ∬ T du dv over the whole pupil of a pencil, in the unit of PupilBoundary::area().
double transmitted_area(const Tracer& tracer, const Pencil& pencil, const PupilBoundary& pupil,
                        const LensTransmittance& transmittance, int radial_nodes = 12);

}  // namespace petzval
