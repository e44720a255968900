// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/trace/losses.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

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

/// The axes of the plane of incidence before and after a surface: across the ray on either side.
struct Incidence {
  Vec s_before, p_before, s_after, p_after;
  double cosine_before, cosine_after;
};

Incidence incidence(const Vec& before, const Vec& after, const Vec& normal) {
  const Vec across = cross(before, normal);
  const double sine = std::sqrt(dot(across, across));
  // At normal incidence any axis will do.
  constexpr double smallest_sine = 1e-12;
  const Vec s = sine > smallest_sine ? scaled(across, 1 / sine) : perpendicular(before);
  Incidence at{
      s, cross(before, s), s, cross(after, s), std::abs(dot(before, normal)), std::abs(dot(after, normal))};
  // Scatter leaves the plane: the axes turn with the ray, by the smallest turn from the plane to it.
  const double length = std::sqrt(dot(at.p_after, at.p_after));
  if (std::abs(dot(after, s)) > smallest_sine && length > smallest_sine) {
    at.p_after = scaled(at.p_after, 1 / length);
    at.s_after = cross(at.p_after, after);
  }
  return at;
}

/// Square roots of the share of the power that a surface lets through, with what films delay if complex.
template <class Number>
struct Amplitudes {
  Number s = 1, p = 1;
};

template <class Number>
Amplitudes<Number> fresnel(double n1, double n2, const Incidence& at) {
  const double c1 = at.cosine_before, c2 = at.cosine_after;
  const double r_s = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2);
  const double r_p = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2);
  return {std::sqrt(1 - r_s * r_s), std::sqrt(1 - r_p * r_p)};
}

template <class Number>
Amplitudes<Number> through_films(double before, const std::vector<ThinFilm>& films, double after,
                                 double cosine_before, double wavelength_nm) {
  const auto amplitude = [&](Polarisation polarisation) -> Number {
    if constexpr (std::is_same_v<Number, double>)
      return std::sqrt(
          film_power(before, films, after, cosine_before, wavelength_nm, polarisation).transmittance);
    else
      return film_amplitude(before, films, after, cosine_before, wavelength_nm, polarisation);
  };
  return {amplitude(Polarisation::s), amplitude(Polarisation::p)};
}

template <class Number>
Number component(const std::array<Number, 3>& field, const Vec& axis) {
  return field[0] * axis[0] + field[1] * axis[1] + field[2] * axis[2];
}

/// An electric field, in units of the square root of its power, through a surface.
template <class Number>
std::array<Number, 3> transmit(const std::array<Number, 3>& field, const Incidence& at,
                               const Amplitudes<Number>& through) {
  const Number s = through.s * component(field, at.s_before), p = through.p * component(field, at.p_before);
  std::array<Number, 3> out;
  for (std::size_t axis = 0; axis < 3; ++axis) out[axis] = s * at.s_after[axis] + p * at.p_after[axis];
  return out;
}

/// Two perpendicular fields across a ray. \param first  across it, a unit vector.
template <class Number>
std::array<std::array<Number, 3>, 2> fields_across(const Vec& direction, const Vec& first) {
  const Vec second = cross(direction, first);
  std::array<std::array<Number, 3>, 2> fields;
  for (std::size_t axis = 0; axis < 3; ++axis) fields[0][axis] = first[axis], fields[1][axis] = second[axis];
  return fields;
}

bool is_air_to_glass(double index_before, double index_after) {
  return (index_before == 1) != (index_after == 1);
}

}  // namespace

const Coating* Losses::coating(std::size_t surface, double index_before, double index_after) const {
  if (const auto own = surfaces.find(surface); own != surfaces.end()) return &own->second;
  return air_glass && is_air_to_glass(index_before, index_after) ? &*air_glass : nullptr;
}

Losses Losses::of(const Lens& lens) const {
  Losses all = *this;
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
    if (const std::optional<Coating>& own = lens.surfaces[i].coating) all.surfaces.emplace(i, *own);
  return all;
}

void Losses::validate(const Lens& lens) const {
  if (air_glass) air_glass->validate();
  for (const auto& [surface, coating] : surfaces) {
    if (surface >= lens.surfaces.size())
      throw InputError(fmt::format("a coating for surfaces[{}], but {} has surfaces[0] to surfaces[{}]",
                                   surface, lens.name, lens.surfaces.size() - 1));
    coating.validate();
    const bool front_is_air = lens.medium_before(surface).is_air();
    if (coating.has_films() && lens.surfaces[surface].mirror)
      throw InputError(
          fmt::format("films on surfaces[{}], which is a mirror; a reflectance would be right", surface));
    if (coating.has_films() && front_is_air == lens.surfaces[surface].material.is_air())
      throw InputError(fmt::format(
          "films on surfaces[{}], which does not lie between air and glass; a reflectance would be right",
          surface));
  }
}

LensTransmittance::LensTransmittance(const Lens& lens, double wavelength_nm, const Losses& given)
    : fresnel_(given.fresnel), wavelength_nm_(wavelength_nm) {
  const Losses losses = given.of(lens);
  losses.validate(lens);
  double before = lens.object_material.index(wavelength_nm);
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
        interface.reflectance = coating->by_angle_at(wavelength_nm);
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

template <class Number>
double LensTransmittance::follow(const Ray& start, const std::vector<Intersection>& path, bool backward,
                                 std::array<std::array<Number, 3>, 2>& fields) const {
  Vec before = start.direction;
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
    Amplitudes<Number> through;
    if (interface.reflectance) {
      // The angle is that on the side of the air.
      const bool from_air = (interface.index_before <= interface.index_after) != backward;
      const auto [s, p] =
          interface.reflectance->at(from_air || interface.mirror ? at.cosine_before : at.cosine_after);
      through.s = std::sqrt(interface.mirror ? s : 1 - s);
      through.p = std::sqrt(interface.mirror ? p : 1 - p);
    } else if (interface.mirror)
      through = {};
    else if (!interface.films.empty())  // the same from both sides
      through = through_films<Number>(interface.index_before, interface.films, interface.index_after,
                                      backward ? at.cosine_after : at.cosine_before, wavelength_nm_);
    else if (fresnel_)
      through = backward ? fresnel<Number>(interface.index_after, interface.index_before, at)
                         : fresnel<Number>(interface.index_before, interface.index_after, at);
    for (auto& field : fields) field = transmit(field, at, through);
    if (step + 1 < path.size())
      absorb(backward ? i - 1 : i, path[step].point_mm, path[step + 1].point_mm, after);
    before = after;
  }
  return transmitted;
}

double LensTransmittance::along(const Ray& start, const std::vector<Intersection>& path,
                                bool backward) const {
  if (is_obscured(path, backward)) return 0;
  auto fields = fields_across<double>(start.direction, perpendicular(start.direction));
  const double left = follow(start, path, backward, fields);
  return left * 0.5 * (dot(fields[0], fields[0]) + dot(fields[1], fields[1]));
}

Jones LensTransmittance::jones(const Ray& start, const std::vector<Intersection>& path) const {
  Jones result{};
  if (is_obscured(path, false)) return result;
  // y as the ray sees it: so the axes of a pencil's rays go together.
  const double along_y = start.direction[1];
  const Vec y{-along_y * start.direction[0], 1 - along_y * along_y, -along_y * start.direction[2]};
  const Vec first = scaled(y, 1 / std::sqrt(dot(y, y)));
  auto fields = fields_across<std::complex<double>>(start.direction, first);
  const double left = std::sqrt(follow(start, path, false, fields));
  // The axes alone.
  auto axes = fields_across<double>(start.direction, first);
  Vec before = start.direction;
  for (std::size_t step = 0; step < std::min(path.size(), interfaces_.size()); ++step) {
    const Incidence at = incidence(before, path[step].direction_after, path[step].normal);
    for (auto& axis : axes) axis = transmit(axis, at, Amplitudes<double>());
    before = path[step].direction_after;
  }
  for (std::size_t out = 0; out < 2; ++out)
    for (std::size_t in = 0; in < 2; ++in) result[out][in] = left * component(fields[in], axes[out]);
  return result;
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
    const Ray start = pencil.backward() ? tracer.from_image(*launched) : *launched;
    if (traced.status == RayStatus::ok)
      sum += node.weight * transmittance.along(start, path, pencil.backward());
  }
  return sum;
}

}  // namespace petzval
