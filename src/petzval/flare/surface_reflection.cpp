// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/flare/surface_reflection.h>
#include <petzval/wave/thin_film.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

using FieldVector = std::array<double, 3>;

double field_dot(const FieldVector& a, const FieldVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

FieldVector field_cross(const FieldVector& a, const FieldVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

FieldVector unit_across(const FieldVector& direction) {
  const FieldVector axis = std::abs(direction[0]) < 0.6 ? FieldVector{1, 0, 0} : FieldVector{0, 1, 0};
  FieldVector across = field_cross(direction, axis);
  const double scale = 1 / std::sqrt(field_dot(across, across));
  for (double& each : across) each *= scale;
  return across;
}

/// Steps of the tables of films over the cosine: 1e-6 of the light, for films of a few quarter waves.
constexpr int film_steps = 1024;

}  // namespace

LightFields LightFields::unpolarised(const std::array<double, 3>& direction) {
  const double half = std::sqrt(0.5);
  LightFields fields;
  const FieldVector one = unit_across(direction), other = field_cross(direction, one);
  for (std::size_t i = 0; i < 3; ++i) fields.first[i] = half * one[i], fields.second[i] = half * other[i];
  return fields;
}

double LightFields::power() const {
  return field_dot(first, first) + field_dot(second, second);
}

SurfaceReflection::SurfaceReflection(double index_before, double index_after, const Coating* coating,
                                     double wavelength_nm)
    : index_before_(index_before), index_after_(index_after) {
  if (coating && coating->has_films()) {
    kind_ = Kind::films;
    tabulate(*coating, wavelength_nm);
  } else if (coating) {
    reflectance_ = coating->by_angle_at(wavelength_nm);
    kind_ = reflectance_.any() ? Kind::measured : Kind::nothing;
  } else if (index_before == index_after) {
    kind_ = Kind::nothing;
  }
}

SurfaceReflection SurfaceReflection::mirror(double reflectance, double index_before) {
  SurfaceReflection surface(index_before, index_before, nullptr, 0);
  surface.reflectance_ = {{}, {{reflectance, reflectance}}};
  surface.kind_ = reflectance > 0 ? Kind::measured : Kind::nothing;
  return surface;
}

void SurfaceReflection::tabulate(const Coating& coating, double wavelength_nm) {
  std::vector<ThinFilm> films = coating.films(wavelength_nm, index_before_);
  for (const bool behind : {false, true}) {
    const double before = behind ? index_after_ : index_before_,
                 after = behind ? index_before_ : index_after_;
    if (behind) std::ranges::reverse(films);
    for (int step = 0; step <= film_steps; ++step) {
      // Grazing light has no power of its own to share: the first row is all reflected.
      FilmRow row{{0, 0}, {1, -1}};
      if (step > 0) {
        const double low = static_cast<double>(step) / film_steps;
        const double least = std::min(before, after);
        const double sine = least / before * std::sqrt(1 - low * low);
        const double cosine = before == least ? low : std::sqrt(1 - sine * sine);
        const auto power = [&](Polarisation which) {
          return film_power(before, films, after, cosine, wavelength_nm, which);
        };
        const FilmPower s = power(Polarisation::s), p = power(Polarisation::p);
        row = {{std::sqrt(s.transmittance), std::sqrt(p.transmittance)},
               {std::sqrt(s.reflectance), -std::sqrt(p.reflectance)}};
      }
      films_[behind].push_back(row);
    }
  }
}

SurfaceReflection::Factors SurfaceReflection::factors(double cosine, bool behind, bool reflect) const {
  const double n1 = behind ? index_after_ : index_before_, n2 = behind ? index_before_ : index_after_;
  const double ratio = n1 / n2, under = 1 - ratio * ratio * (1 - cosine * cosine);
  if (under <= 0) return reflect ? Factors{1, -1} : Factors{0, 0};
  const double cosine_after = std::sqrt(under);
  switch (kind_) {
    case Kind::nothing:
      return reflect ? Factors{0, 0} : Factors{1, 1};
    case Kind::measured: {
      const auto [s, p] = reflectance_.at(n1 <= n2 ? cosine : cosine_after);
      return reflect ? Factors{std::sqrt(s), -std::sqrt(p)} : Factors{std::sqrt(1 - s), std::sqrt(1 - p)};
    }
    case Kind::bare: {
      const double s = (n1 * cosine - n2 * cosine_after) / (n1 * cosine + n2 * cosine_after);
      const double p = (n2 * cosine - n1 * cosine_after) / (n2 * cosine + n1 * cosine_after);
      if (reflect) return {s, p};
      return {std::sqrt(1 - s * s), std::sqrt(1 - p * p)};
    }
    case Kind::films: {
      const double at = film_steps * std::min(1.0, n1 < n2 ? cosine : cosine_after);
      const auto row = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(film_steps - 1));
      const double share = at - static_cast<double>(row);
      const auto pick = [&](const FilmRow& each) { return reflect ? each.back : each.through; };
      const Factors a = pick(films_[behind][row]), b = pick(films_[behind][row + 1]);
      return {a.s + share * (b.s - a.s), a.p + share * (b.p - a.p)};
    }
  }
  return {};
}

namespace {

/// What becomes of both fields.
LightFields turned_fields(const LightFields& light, const FieldVector& direction, const FieldVector& after,
                          const FieldVector& normal, double by_s, double by_p) {
  FieldVector s = field_cross(direction, normal);
  const double sine_sq = field_dot(s, s);
  constexpr double least_sine_sq = 1e-24;  // at normal incidence any axis will do
  if (sine_sq > least_sine_sq) {
    const double scale = 1 / std::sqrt(sine_sq);
    for (double& each : s) each *= scale;
  } else {
    s = unit_across(direction);
  }
  const FieldVector p_before = field_cross(direction, s), p_after = field_cross(after, s);
  const auto turned = [&](const FieldVector& field) {
    const double along_s = by_s * field_dot(field, s), along_p = by_p * field_dot(field, p_before);
    FieldVector result;
    for (std::size_t i = 0; i < 3; ++i) result[i] = along_s * s[i] + along_p * p_after[i];
    return result;
  };
  return {turned(light.first), turned(light.second)};
}

}  // namespace

LightFields SurfaceReflection::transmitted(const LightFields& light, const FieldVector& direction,
                                           const FieldVector& after, const FieldVector& normal,
                                           bool behind) const {
  if (kind_ == Kind::nothing && index_before_ == index_after_) return light;
  const Factors by = factors(std::min(1.0, std::abs(field_dot(direction, normal))), behind, false);
  return turned_fields(light, direction, after, normal, by.s, by.p);
}

LightFields SurfaceReflection::reflected(const LightFields& light, const FieldVector& direction,
                                         const FieldVector& after, const FieldVector& normal,
                                         bool behind) const {
  const Factors by = factors(std::min(1.0, std::abs(field_dot(direction, normal))), behind, true);
  return turned_fields(light, direction, after, normal, by.s, by.p);
}

}  // namespace petzval
