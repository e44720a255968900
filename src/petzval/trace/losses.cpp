// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/trace/losses.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

using Vec = std::array<double, 3>;

double dot(const Vec& a, const Vec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vec scaled(const Vec& a, double factor) {
  return {a[0] * factor, a[1] * factor, a[2] * factor};
}

/// A unit vector perpendicular to a unit vector.
Vec perpendicular(const Vec& direction) {
  const Vec axis = std::abs(direction[0]) < 0.6 ? Vec{1, 0, 0} : Vec{0, 1, 0};
  const Vec across = cross(direction, axis);
  return scaled(across, 1 / std::sqrt(dot(across, across)));
}

/// The axes of the plane of incidence before and after a surface.
struct Incidence {
  Vec s, p_before, p_after;
  double cosine_before, cosine_after;
};

Incidence incidence(const Vec& before, const Vec& after, const Vec& normal) {
  const Vec across = cross(before, normal);
  const double sine = std::sqrt(dot(across, across));
  // At normal incidence any axis will do.
  constexpr double smallest_sine = 1e-12;
  const Vec s = sine > smallest_sine ? scaled(across, 1 / sine) : perpendicular(before);
  return {s, cross(before, s), cross(after, s), std::abs(dot(before, normal)), std::abs(dot(after, normal))};
}

/// Square roots of the share of the power that a surface lets through.
struct Amplitudes {
  double s = 1, p = 1;
};

Amplitudes fresnel(double n1, double n2, const Incidence& at) {
  const double c1 = at.cosine_before, c2 = at.cosine_after;
  const double r_s = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2);
  const double r_p = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2);
  return {std::sqrt(1 - r_s * r_s), std::sqrt(1 - r_p * r_p)};
}

Amplitudes through_films(double before, const std::vector<ThinFilm>& films, double after,
                         double cosine_before, double wavelength_nm) {
  const auto share = [&](Polarisation polarisation) {
    return film_power(before, films, after, cosine_before, wavelength_nm, polarisation).transmittance;
  };
  return {std::sqrt(share(Polarisation::s)), std::sqrt(share(Polarisation::p))};
}

/// An electric field, in units of the square root of its power, through a surface.
Vec transmit(const Vec& field, const Incidence& at, const Amplitudes& through) {
  const double s = through.s * dot(field, at.s), p = through.p * dot(field, at.p_before);
  Vec out;
  for (std::size_t axis = 0; axis < 3; ++axis) out[axis] = s * at.s[axis] + p * at.p_after[axis];
  return out;
}

bool is_air_to_glass(double index_before, double index_after) {
  return (index_before == 1) != (index_after == 1);
}

}  // namespace

const Coating* Losses::coating(std::size_t surface, double index_before, double index_after) const {
  if (const auto own = surfaces.find(surface); own != surfaces.end()) return &own->second;
  return air_glass && is_air_to_glass(index_before, index_after) ? &*air_glass : nullptr;
}

void Losses::validate(const Lens& lens) const {
  if (air_glass) air_glass->validate();
  for (const auto& [surface, coating] : surfaces) {
    if (surface >= lens.surfaces.size())
      throw InputError(fmt::format("a coating for surfaces[{}], but {} has surfaces[0] to surfaces[{}]",
                                   surface, lens.name, lens.surfaces.size() - 1));
    coating.validate();
    const bool front_is_air = surface == 0 || lens.medium_behind(surface - 1).is_air();
    if (coating.has_films() && lens.surfaces[surface].mirror)
      throw InputError(
          fmt::format("films on surfaces[{}], which is a mirror; a reflectance would be right", surface));
    if (coating.has_films() && front_is_air == lens.surfaces[surface].material.is_air())
      throw InputError(fmt::format(
          "films on surfaces[{}], which does not lie between air and glass; a reflectance would be right",
          surface));
  }
}

LensTransmittance::LensTransmittance(const Lens& lens, double wavelength_nm, const Losses& losses)
    : fresnel_(losses.fresnel), wavelength_nm_(wavelength_nm) {
  losses.validate(lens);
  double before = 1;
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
    const Material& material = lens.medium_behind(i);
    Interface interface;
    interface.mirror = lens.surfaces[i].mirror;
    interface.index_before = before;
    interface.index_after = material.index(wavelength_nm);
    before = interface.index_after;
    if (const Coating* coating = losses.coating(i, interface.index_before, interface.index_after)) {
      if (coating->has_films())
        interface.films = coating->films(wavelength_nm, interface.index_before);
      else
        interface.reflectance = coating->at(wavelength_nm);
    }
    if (losses.absorption && !material.is_air()) {
      if (const std::optional<double> k = material.extinction(wavelength_nm))
        interface.absorption_per_mm = 4 * pi * *k / (wavelength_nm * mm_per_nm);
      else
        clear_.push_back(material.description());
    }
    interfaces_.push_back(interface);
  }
}

void LensTransmittance::heed_obscurations(const Tracer& tracer) {
  obscurations_.clear();
  for (std::size_t i = 0; i < tracer.surface_count(); ++i) {
    const Tracer::PreparedSurface& surface = tracer.surfaces()[i];
    Obscuration closed{i, surface.vertex_z_mm, surface.frame, {}};
    for (const ApertureFigure& figure : surface.apertures)
      if (figure.obscures) closed.figures.push_back(figure);
    if (!closed.figures.empty()) obscurations_.push_back(std::move(closed));
  }
}

bool LensTransmittance::is_obscured(const std::vector<Intersection>& path, bool backward) const {
  for (const Obscuration& closed : obscurations_) {
    const std::size_t step = backward ? interfaces_.size() - 1 - closed.surface : closed.surface;
    if (step >= path.size()) continue;
    const Frame::Vector at = closed.frame.point_from_lens(path[step].point_mm, closed.vertex_z_mm);
    for (const ApertureFigure& figure : closed.figures)
      if (figure.share_sq(at[0], at[1]) > 1 + Tracer::rim_tolerance) return true;
  }
  return false;
}

bool has_obscurations(const Lens& lens) {
  return std::any_of(lens.surfaces.begin(), lens.surfaces.end(), [](const Surface& surface) {
    return std::any_of(surface.apertures.begin(), surface.apertures.end(),
                       [](const ApertureFigure& figure) { return figure.obscures; });
  });
}

double LensTransmittance::along(const Ray& start, const std::vector<Intersection>& path,
                                bool backward) const {
  if (is_obscured(path, backward)) return 0;
  Vec before = start.direction;
  Vec first = perpendicular(before), second = cross(before, first);
  double transmitted = 1;
  const auto absorb = [&](std::size_t gap, const Vec& from, const Vec& to, const Vec& direction) {
    const Vec along = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    transmitted *= std::exp(-interfaces_[gap].absorption_per_mm * std::max(dot(along, direction), 0.0));
  };
  if (backward && !path.empty())
    absorb(interfaces_.size() - 1, start.point_mm, path[0].point_mm, start.direction);
  const std::size_t count = std::min(path.size(), interfaces_.size());
  for (std::size_t step = 0; step < count; ++step) {
    const std::size_t i = backward ? interfaces_.size() - 1 - step : step;
    const Interface& interface = interfaces_[i];
    const Vec& after = path[step].direction_after;
    const Incidence at = incidence(before, after, path[step].normal);
    Amplitudes through;
    if (interface.reflectance)
      through.s = through.p =
          std::sqrt(interface.mirror ? *interface.reflectance : 1 - *interface.reflectance);
    else if (interface.mirror)
      through = {};
    else if (!interface.films.empty())  // the same from both sides
      through = through_films(interface.index_before, interface.films, interface.index_after,
                              backward ? at.cosine_after : at.cosine_before, wavelength_nm_);
    else if (fresnel_)
      through = backward ? fresnel(interface.index_after, interface.index_before, at)
                         : fresnel(interface.index_before, interface.index_after, at);
    first = transmit(first, at, through);
    second = transmit(second, at, through);
    if (step + 1 < path.size())
      absorb(backward ? i - 1 : i, path[step].point_mm, path[step + 1].point_mm, after);
    before = after;
  }
  return transmitted * 0.5 * (dot(first, first) + dot(second, second));
}

double transmitted_area(const Tracer& tracer, const Pencil& pencil, const PupilBoundary& pupil,
                        const LensTransmittance& transmittance, int radial_nodes) {
  double sum = 0;
  std::vector<Intersection> path;
  for (const PupilNode& node : pupil_nodes(pupil, radial_nodes)) {
    const std::optional<Ray> launched = pencil.ray(node.u, node.v);
    if (!launched) continue;
    path.clear();
    const Ray traced = pencil.backward() ? tracer.trace_backward(*launched, Tracer::Clip::none, &path)
                                         : tracer.trace(*launched, Tracer::Clip::none, &path);
    if (traced.status == RayStatus::ok)
      sum += node.weight * transmittance.along(*launched, path, pencil.backward());
  }
  return sum;
}

}  // namespace petzval
