// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/transfer_samples.h>
#include <petzval/base/error.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/paraxial_system.h>
#include <petzval/lens/transfer_limits.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace petzval {

namespace {

/// Rays for the fit: film heights, azimuths around half a pupil, and places from its middle to beyond its
/// rim.
constexpr int fit_heights = 28, fit_azimuths = 32, fit_rings = 9;
constexpr int held_heights = 17, held_azimuths = 24, held_rings = 7;
constexpr double beyond_rim = 1.04;

std::array<double, 2> on_film(const TransferRay& rear, double film_mm) {
  const double way = film_mm / std::sqrt(1 - rear.l * rear.l - rear.m * rear.m);
  return {rear.x - way * rear.l, rear.y - way * rear.m};
}

/// A lens at one wavelength, sampled from film points.
class SampledLens {
 public:
  SampledLens(const Lens& lens, double wavelength_nm, double film_radius_mm)
      : lens_(lens),
        tracer_(lens, wavelength_nm),
        film_radius_mm_(film_radius_mm),
        rear_z_mm_(tracer_.vertex_z_mm(tracer_.surface_count() - 1)) {}

  const Tracer& tracer() const { return tracer_; }

  /// How often each surface is the one at the rim.
  void count_limits(std::map<std::size_t, int>& limits) const {
    ChiefRayMarch march(lens_, tracer_, ChiefRayMarch::From::image);
    for (int i = 0; i <= fit_heights; ++i) {
      const double height = film_radius_mm_ * i / fit_heights;
      const Pencil pencil = Pencil::from_image(tracer_, height);
      const auto pupil = pupil_of(march, pencil, height, 64);
      if (!pupil) continue;
      for (std::size_t k = 0; k < pupil->own(); ++k) {
        const auto [u, v] = pupil->rim(k);
        const Tracer::Clearance at = pencil.clearance(tracer_, u, v, Tracer::Clip::apertures);
        if (at.surface >= 0 && std::isfinite(at.worst)) ++limits[static_cast<std::size_t>(at.surface)];
      }
    }
  }

  std::vector<TransferSample> samples(int heights, int azimuths, int rings, double reach, double shift,
                                      const std::vector<std::size_t>& apertures) const {
    std::vector<TransferSample> result;
    ChiefRayMarch march(lens_, tracer_, ChiefRayMarch::From::image);
    for (int i = 0; i < heights; ++i) {
      const double height = film_radius_mm_ * (i + shift) / (heights - 1 + shift);
      const Pencil pencil = Pencil::from_image(tracer_, height);
      const auto pupil = pupil_of(march, pencil, height, 2 * azimuths);
      if (!pupil) continue;
      for (std::size_t k = 0; k < pupil->own(); ++k) {
        const auto [u, v] = pupil->rim(k);
        for (int ring = 1; ring <= rings; ++ring) {
          // As many rays near the middle as an even cover has.
          const double share = reach * std::sqrt((ring - 0.5 * (shift > 0)) / rings);
          add(pencil, pupil->centre_u + share * (u - pupil->centre_u),
              pupil->centre_v + share * (v - pupil->centre_v), apertures, result);
        }
      }
    }
    return result;
  }

 private:
  std::optional<PupilBoundary> pupil_of(ChiefRayMarch& march, const Pencil& pencil, double height,
                                        int azimuths) const {
    const std::optional<double> chief = march.v_at(height);
    return chief ? find_pupil(tracer_, pencil, *chief, azimuths) : std::nullopt;
  }

  void add(const Pencil& pencil, double u, double v, const std::vector<std::size_t>& apertures,
           std::vector<TransferSample>& to) const {
    const std::optional<Ray> launched = pencil.ray(u, v);
    if (!launched) return;
    std::vector<Intersection> path;
    const Ray end = tracer_.trace_backward(*launched, Tracer::Clip::none, &path);
    if (end.status != RayStatus::ok) return;
    TransferSample sample{on_plane(*launched, rear_z_mm_), on_plane(end, 0), {}};
    for (const std::size_t surface : apertures) {
      const auto& point = path[tracer_.surface_count() - 1 - surface].point_mm;
      sample.at_apertures.push_back({point[0], point[1]});
    }
    sample.at_apertures.push_back({launched->point_mm[0], launched->point_mm[1]});
    to.push_back(std::move(sample));
  }

  static TransferRay on_plane(const Ray& ray, double z) {
    const double way = (z - ray.point_mm[2]) / ray.direction[2];
    return {ray.point_mm[0] + way * ray.direction[0], ray.point_mm[1] + way * ray.direction[1],
            ray.direction[0], ray.direction[1]};
  }

  const Lens& lens_;
  Tracer tracer_;
  double film_radius_mm_, rear_z_mm_;
};

/// First order of a ray against the light: place and direction in front by place and direction behind.
Eigen::Matrix2d first_order_of(const Lens& lens, double wavelength_nm) {
  const ParaxialMatrix whole = paraxial_system(lens, wavelength_nm).whole;
  Eigen::Matrix2d back;
  back << whole.d, whole.b, whole.c, whole.a;
  return back;
}

double film_radius_of(const Lens& lens, const TransferFitRequest& request) {
  constexpr double beyond_fields = 1.02;
  if (request.film_radius_mm) return *request.film_radius_mm;
  double largest = 0;
  for (const double field : lens.fields.values)
    largest =
        std::max(largest, std::abs(paraxial_image_height_mm(lens, field, lens.reference_wavelength_nm)));
  if (!(largest > 0 && std::isfinite(largest)))
    throw InputError(lens.name + ": its fields give no radius on the film; give one in mm");
  return beyond_fields * largest;
}

void check(const TransferFitRequest& request) {
  if (!(request.tolerance_mm > 0 && std::isfinite(request.tolerance_mm)))
    throw InputError(fmt::format("a tolerance of {} mm; it must be positive", request.tolerance_mm));
  if (request.degree && (*request.degree < 1 || *request.degree > highest_transfer_degree))
    throw InputError(
        fmt::format("a degree of {}; 1 to {} would be right", *request.degree, highest_transfer_degree));
  if (request.film_radius_mm && !(std::isfinite(*request.film_radius_mm) && *request.film_radius_mm > 0))
    throw InputError(fmt::format("a film radius of {} mm; it must be positive", *request.film_radius_mm));
}

void check(const Lens& lens, const TransferFitRequest& request) {
  check(request);
  lens.validate();
  require_centred(lens, "ray transfers are those of centred lenses");
  require_glass(lens, "fitting needs");
  require_no_bends(lens, "fitting needs");
  require_no_mirrors(lens, "ray transfers are those of lenses without one");
  if (!lens.surfaces.back().material.is_air())
    throw InputError(lens.name +
                     ": glass reaches up to the sensor; a lens with air behind it would be right");
  if (lens.stop_blades().count > 0)
    throw InputError(lens.name + ": its stop has blades; a round one would be right");
}

/// The stop, and the others that limit most.
std::vector<std::size_t> limiting(const Lens& lens, const TransferSamples& samples) {
  std::map<std::size_t, int> counts;
  for (const double nm : samples.wavelengths_nm)
    SampledLens(lens, nm, samples.film_radius_mm).count_limits(counts);
  if (counts.empty())
    throw InputError(
        fmt::format("{}: no light reaches the film within {:g} mm", lens.name, samples.film_radius_mm));
  counts.erase(lens.stop_index());
  std::vector<std::size_t> apertures{lens.stop_index()};
  while (apertures.size() + 1 < most_transfer_apertures && !counts.empty()) {
    const auto most = std::max_element(counts.begin(), counts.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    apertures.push_back(most->first);
    counts.erase(most);
  }
  return apertures;
}

double largest_radius_mm(const TransferSamples& all) {
  double largest = 0;
  for (const std::vector<TransferSample>& band : all.fitted)
    for (const TransferSample& sample : band)
      largest = std::max(largest, std::hypot(sample.rear.x, sample.rear.y));
  return largest;
}

}  // namespace

TransferSamples transfer_samples(const Lens& lens, const TransferFitRequest& request) {
  check(lens, request);
  TransferSamples all;
  all.film_radius_mm = film_radius_of(lens, request);
  all.wavelengths_nm = request.wavelengths_nm.empty() ? lens.wavelengths_nm : request.wavelengths_nm;
  std::sort(all.wavelengths_nm.begin(), all.wavelengths_nm.end());
  const std::vector<std::size_t> apertures = limiting(lens, all);
  for (const double nm : all.wavelengths_nm) {
    const SampledLens sampled(lens, nm, all.film_radius_mm);
    all.fitted.push_back(sampled.samples(fit_heights, fit_azimuths, fit_rings, beyond_rim, 0, apertures));
    all.held.push_back(sampled.samples(held_heights, held_azimuths, held_rings, 1, 0.37, apertures));
    all.first.emplace_back(first_order_of(lens, nm));
  }
  all.unit_mm = largest_radius_mm(all);
  const Tracer tracer(lens, lens.reference_wavelength_nm);
  for (const std::size_t surface : apertures)
    all.radii_mm.push_back(
        std::sqrt(tracer.clip_radius_sq(surface, Tracer::Clip::apertures) / (1 + Tracer::rim_tolerance)));
  return all;
}

TransferSamples transfer_samples(const RayTable& table, const TransferFitRequest& request) {
  check(request);
  constexpr std::size_t held_one_in = 4;
  std::map<double, std::vector<TransferSample>> bands;
  for (const RayTable::Row& row : table.rows) {
    TransferSample sample{row.rear, row.front, row.at_apertures};
    sample.at_apertures.push_back(on_film(row.rear, table.film_mm));
    bands[row.wavelength_nm].push_back(std::move(sample));
  }
  const auto passes = [&](const TransferSample& sample) {
    for (std::size_t i = 0; i < table.aperture_radii_mm.size(); ++i)
      if (std::hypot(sample.at_apertures[i][0], sample.at_apertures[i][1]) > table.aperture_radii_mm[i])
        return false;
    return true;
  };
  const auto height = [](const TransferSample& sample) {
    return std::hypot(sample.at_apertures.back()[0], sample.at_apertures.back()[1]);
  };
  TransferSamples all;
  all.radii_mm = table.aperture_radii_mm;
  all.film_radius_mm = request.film_radius_mm.value_or(0);
  if (!request.film_radius_mm)
    for (const auto& [nm, samples] : bands)
      for (const TransferSample& sample : samples)
        if (passes(sample)) all.film_radius_mm = std::max(all.film_radius_mm, height(sample));
  all.wavelengths_nm = request.wavelengths_nm;
  if (all.wavelengths_nm.empty())
    for (const auto& [nm, samples] : bands) all.wavelengths_nm.push_back(nm);
  std::sort(all.wavelengths_nm.begin(), all.wavelengths_nm.end());
  for (const double nm : all.wavelengths_nm) {
    const auto band = bands.find(nm);
    if (band == bands.end()) throw InputError(fmt::format("the table of rays has none at {:g} nm", nm));
    all.fitted.emplace_back(), all.held.emplace_back(), all.first.emplace_back();
    std::size_t inside = 0;
    for (const TransferSample& sample : band->second) {
      const bool hold = passes(sample) && height(sample) <= all.film_radius_mm && ++inside % held_one_in == 0;
      (hold ? all.held : all.fitted).back().push_back(sample);
    }
    if (all.held.back().empty())
      throw InputError(
          fmt::format("the table of rays has {} at {:g} nm that reach the film; some hundreds would be right",
                      inside, nm));
  }
  all.unit_mm = largest_radius_mm(all);
  return all;
}

}  // namespace petzval
