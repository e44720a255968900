// SPDX-License-Identifier: BSD-3-Clause
// What a surface of a lens reflects and lets through, by angle and polarisation, from either side.
#pragma once

#include <petzval/lens/lens.h>
#include <petzval/trace/losses.h>

#include <array>
#include <vector>

namespace petzval {

/// Two perpendicular fields of unpolarised light, in units of the square root of its power.
struct LightFields {
  std::array<double, 3> first{}, second{};

  /// Half of each polarisation. \param direction  unit.
  static LightFields unpolarised(const std::array<double, 3>& direction);
  double power() const;
};

/// A surface at one wavelength. Without a coating it reflects as bare glass does (Fresnel; Born & Wolf,
/// Principles of Optics, 7th ed. 1999, 1.5.2), polarisations and the signs of their fields followed. Films
/// (F. Abelès 1950) are tabulated over the cosine on the side of the lower index and interpolated linearly;
/// their fields turn their sign as those of glass do near normal incidence, and by how much they delay one
/// polarisation against the other is not followed. A measured reflectance goes by the angle on that side, if
/// it tells any; beyond the critical angle everything is reflected.
class SurfaceReflection {
 public:
  SurfaceReflection(double index_before, double index_after, const Coating* coating, double wavelength_nm);
  /// A surface of this reflectance, from the front alone: the sensor's.
  static SurfaceReflection mirror(double reflectance, double index_before);

  bool reflects() const { return kind_ != Kind::nothing; }
  /// The fields behind the surface or before it. \param direction  of the light that meets it. \param after
  /// of the light that leaves it. \param normal  unit, on either side. \param behind  whether it comes from
  /// behind.
  LightFields transmitted(const LightFields& light, const std::array<double, 3>& direction,
                          const std::array<double, 3>& after, const std::array<double, 3>& normal,
                          bool behind) const;
  LightFields reflected(const LightFields& light, const std::array<double, 3>& direction,
                        const std::array<double, 3>& after, const std::array<double, 3>& normal,
                        bool behind) const;

 private:
  enum class Kind { nothing, bare, measured, films };
  /// Factors of the two fields.
  struct Factors {
    double s = 0, p = 0;
  };
  struct FilmRow {
    Factors through, back;
  };
  Factors factors(double cosine, bool behind, bool reflect) const;
  void tabulate(const Coating& coating, double wavelength_nm);

  Kind kind_ = Kind::bare;
  double index_before_, index_after_;
  AngleReflectance reflectance_;
  std::array<std::vector<FilmRow>, 2> films_;  ///< from the front, from behind; over the cosine, evenly
};

}  // namespace petzval
