// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/transfer_fit.h>
#include <petzval/base/error.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/paraxial_system.h>
#include <petzval/lens/transfer_limits.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace petzval {

namespace {

using Powers = std::array<int, 3>;
using Matrix = Eigen::MatrixXd;

constexpr int highest_degree = 7;
/// Rays for the fit: film heights, azimuths around half a pupil, and places from its middle to beyond its
/// rim.
constexpr int fit_heights = 28, fit_azimuths = 32, fit_rings = 9;
constexpr int held_heights = 17, held_azimuths = 24, held_rings = 7;
constexpr double beyond_rim = 1.04;
/// Of the tolerance: what a term must move a ray by to be kept.
constexpr double least_share = 0.05;

/// One ray at the rear plane and what the lens makes of it.
struct Sample {
  TransferRay rear, front;
  std::vector<std::array<double, 2>> at_apertures;  ///< and on the film, last
};

std::array<double, 2> on_film(const TransferRay& rear, double film_mm) {
  const double way = film_mm / std::sqrt(1 - rear.l * rear.l - rear.m * rear.m);
  return {rear.x - way * rear.l, rear.y - way * rear.m};
}

std::vector<Powers> powers_up_to(int degree) {
  std::vector<Powers> list;
  for (int sum = 0; sum <= degree; ++sum)
    for (int a = sum; a >= 0; --a)
      for (int b = sum - a; b >= 0; --b) list.push_back({a, b, sum - a - b});
  return list;
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

  std::vector<Sample> samples(int heights, int azimuths, int rings, double reach, double shift,
                              const std::vector<std::size_t>& apertures) const {
    std::vector<Sample> result;
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
           std::vector<Sample>& to) const {
    const std::optional<Ray> launched = pencil.ray(u, v);
    if (!launched) return;
    std::vector<Intersection> path;
    const Ray end = tracer_.trace_backward(*launched, Tracer::Clip::none, &path);
    if (end.status != RayStatus::ok) return;
    Sample sample{on_plane(*launched, rear_z_mm_), on_plane(end, 0), {}};
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

/// Terms of all samples: the even rows are x, the odd ones y; first the terms times place, then times
/// direction.
Matrix rows_of(const std::vector<Sample>& samples, const std::vector<Powers>& terms, double unit_mm) {
  const auto count = static_cast<Eigen::Index>(terms.size());
  Matrix rows(2 * static_cast<Eigen::Index>(samples.size()), 2 * count);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const TransferRay& ray = samples[i].rear;
    const double of[3] = {(ray.x * ray.x + ray.y * ray.y) / (unit_mm * unit_mm),
                          (ray.x * ray.l + ray.y * ray.m) / unit_mm, ray.l * ray.l + ray.m * ray.m};
    const auto row = 2 * static_cast<Eigen::Index>(i);
    for (Eigen::Index t = 0; t < count; ++t) {
      double term = 1;
      for (std::size_t v = 0; v < 3; ++v)
        for (int p = 0; p < terms[static_cast<std::size_t>(t)][v]; ++p) term *= of[v];
      rows(row, t) = term * ray.x, rows(row, count + t) = term * ray.l;
      rows(row + 1, t) = term * ray.y, rows(row + 1, count + t) = term * ray.m;
    }
  }
  return rows;
}

/// Least squares with columns of one size.
Matrix solved(Matrix rows, const Matrix& wanted) {
  if (rows.cols() == 0) return Matrix(0, wanted.cols());  // which Eigen's solver does not survive
  Eigen::VectorXd scale = rows.colwise().norm();
  for (Eigen::Index c = 0; c < rows.cols(); ++c) {
    if (scale(c) == 0) scale(c) = 1;
    rows.col(c) /= scale(c);
  }
  Matrix found = rows.colPivHouseholderQr().solve(wanted);
  for (Eigen::Index c = 0; c < rows.cols(); ++c) found.row(c) /= scale(c);
  return found;
}

/// First order of a ray against the light: place and direction in front by place and direction behind.
Eigen::Matrix2d first_order_of(const Lens& lens, double wavelength_nm) {
  const ParaxialMatrix whole = paraxial_system(lens, wavelength_nm).whole;
  Eigen::Matrix2d back;
  back << whole.d, whole.b, whole.c, whole.a;
  return back;
}

/// The same of rays alone: that of a fit, its determinant made 1.
Eigen::Matrix2d first_order_of(const Matrix& rows, const Matrix& wanted) {
  const Matrix found = solved(rows, wanted);
  Eigen::Matrix2d first;
  first << found(0, 0), found(rows.cols() / 2, 0), found(0, 1), found(rows.cols() / 2, 1);
  const double determinant = first.determinant();
  if (!(determinant > 0))
    throw InputError(
        "the rays do not tell the first order of a lens; more heights on the film and places in the pupil "
        "would "
        "be right");
  return first / std::sqrt(determinant);
}

/// The coefficients of one band: of each output, of each term. The first term is 1. \param known  the first
/// order; absent: as fitted, its determinant then made 1.
std::vector<std::vector<double>> fitted(const std::vector<Sample>& samples, const std::vector<Powers>& terms,
                                        double unit_mm, const std::optional<Eigen::Matrix2d>& known) {
  const Matrix rows = rows_of(samples, terms, unit_mm);
  const auto count = static_cast<Eigen::Index>(terms.size());
  const auto apertures = static_cast<Eigen::Index>(samples.front().at_apertures.size());
  Matrix wanted(rows.rows(), 2), places(rows.rows(), apertures);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto row = 2 * static_cast<Eigen::Index>(i);
    wanted.row(row) << samples[i].front.x, samples[i].front.l;
    wanted.row(row + 1) << samples[i].front.y, samples[i].front.m;
    for (Eigen::Index a = 0; a < apertures; ++a)
      for (Eigen::Index axis = 0; axis < 2; ++axis)
        places(row + axis, a) =
            samples[i].at_apertures[static_cast<std::size_t>(a)][static_cast<std::size_t>(axis)];
  }
  const Eigen::Matrix2d first = known ? *known : first_order_of(rows, wanted);
  wanted -= rows.col(0) * first.col(0).transpose() + rows.col(count) * first.col(1).transpose();
  Matrix higher(rows.rows(), 2 * count - 2);
  higher << rows.middleCols(1, count - 1), rows.rightCols(count - 1);
  const Matrix found = solved(higher, wanted), at = solved(rows, places);
  std::vector<std::vector<double>> coefficients(static_cast<std::size_t>(4 + 2 * apertures),
                                                std::vector<double>(terms.size()));
  for (Eigen::Index t = 0; t < count; ++t) {
    const auto term = static_cast<std::size_t>(t);
    for (Eigen::Index o = 0; o < 4; ++o)
      coefficients[static_cast<std::size_t>(o)][term] =
          t == 0 ? first(o / 2, o % 2) : found(t - 1 + (o % 2) * (count - 1), o / 2);
    for (Eigen::Index a = 0; a < apertures; ++a) {
      coefficients[static_cast<std::size_t>(4 + 2 * a)][term] = at(t, a);
      coefficients[static_cast<std::size_t>(5 + 2 * a)][term] = at(count + t, a);
    }
  }
  return coefficients;
}

struct Errors {
  std::vector<double> mm, rad;

  void add(const std::vector<Sample>& samples, const std::vector<Powers>& terms, double unit_mm,
           const std::vector<std::vector<double>>& coefficients) {
    const Matrix rows = rows_of(samples, terms, unit_mm);
    const auto count = static_cast<Eigen::Index>(terms.size());
    const auto carried = [&](std::size_t output) {
      Eigen::VectorXd of(2 * count);
      for (Eigen::Index t = 0; t < count; ++t)
        of(t) = coefficients[output][static_cast<std::size_t>(t)],
        of(count + t) = coefficients[output + 1][static_cast<std::size_t>(t)];
      return Eigen::VectorXd(rows * of);
    };
    const Eigen::VectorXd place = carried(0), direction = carried(2);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const auto row = 2 * static_cast<Eigen::Index>(i);
      const TransferRay& front = samples[i].front;
      mm.push_back(std::hypot(place(row) - front.x, place(row + 1) - front.y));
      rad.push_back(std::hypot(direction(row) - front.l, direction(row + 1) - front.m));
    }
  }
};

double middle_of(std::vector<double> list) {
  const auto middle = list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2);
  std::nth_element(list.begin(), middle, list.end());
  return *middle;
}

/// Everything that a fit of some terms needs.
struct Fitting {
  std::vector<double> wavelengths_nm;
  std::vector<std::vector<Sample>> samples, held;
  std::vector<std::optional<Eigen::Matrix2d>> first;
  double unit_mm = 0;

  void set_unit() {
    for (const std::vector<Sample>& band : samples)
      for (const Sample& sample : band) unit_mm = std::max(unit_mm, std::hypot(sample.rear.x, sample.rear.y));
  }

  std::vector<std::vector<std::vector<double>>> bands(const std::vector<Powers>& terms) const {
    std::vector<std::vector<std::vector<double>>> all;
    for (std::size_t b = 0; b < wavelengths_nm.size(); ++b)
      all.push_back(fitted(samples[b], terms, unit_mm, first[b]));
    return all;
  }
  Errors errors(const std::vector<Powers>& terms,
                const std::vector<std::vector<std::vector<double>>>& bands) const {
    Errors errors;
    for (std::size_t b = 0; b < bands.size(); ++b) errors.add(held[b], terms, unit_mm, bands[b]);
    return errors;
  }
};

bool meets(const Errors& errors, double mm, double rad) {
  return *std::max_element(errors.mm.begin(), errors.mm.end()) <= mm &&
         *std::max_element(errors.rad.begin(), errors.rad.end()) <= rad;
}

/// Terms that move some ray by more than a share of the tolerance.
std::vector<Powers> needed(const Fitting& fitting, const std::vector<Powers>& terms,
                           const std::vector<std::vector<std::vector<double>>>& bands, double mm,
                           double rad) {
  std::vector<Powers> kept{terms.front()};
  const auto count = static_cast<Eigen::Index>(terms.size());
  for (Eigen::Index t = 1; t < count; ++t) {
    double most = 0;
    for (std::size_t b = 0; b < bands.size(); ++b) {
      const std::vector<Powers> one{terms[static_cast<std::size_t>(t)]};
      const Matrix rows = rows_of(fitting.held[b], one, fitting.unit_mm);
      const double place = rows.col(0).cwiseAbs().maxCoeff(), direction = rows.col(1).cwiseAbs().maxCoeff();
      const auto at = static_cast<std::size_t>(t);
      for (std::size_t o = 0; o < bands[b].size(); ++o) {
        // A place in an aperture matters as little as one in front.
        const double tolerance = o == 2 || o == 3 ? rad : mm;
        most = std::max(most, std::abs(bands[b][o][at]) * (o % 2 == 0 ? place : direction) / tolerance);
      }
    }
    if (most > least_share) kept.push_back(terms[static_cast<std::size_t>(t)]);
  }
  return kept;
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
  if (request.degree && (*request.degree < 1 || *request.degree > highest_degree))
    throw InputError(fmt::format("a degree of {}; 1 to {} would be right", *request.degree, highest_degree));
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
std::vector<std::size_t> limiting(const Lens& lens, const Fitting& fitting, double film_radius_mm) {
  std::map<std::size_t, int> counts;
  for (const double nm : fitting.wavelengths_nm) SampledLens(lens, nm, film_radius_mm).count_limits(counts);
  if (counts.empty())
    throw InputError(fmt::format("{}: no light reaches the film within {:g} mm", lens.name, film_radius_mm));
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

Lens lens_with(const Lens& lens, const std::shared_ptr<const RayTransfer>& transfer) {
  Lens result = lens;
  Surface front, rear;
  front.transfer = transfer;
  front.stop = true;
  front.thickness_mm = transfer->length_mm;
  front.semi_diameter_mm = transfer->aperture_radii_mm.front();
  rear.thickness_mm = lens.surfaces.back().thickness_mm;
  rear.semi_diameter_mm = transfer->largest_radius_mm;
  result.surfaces = {front, rear};
  result.groups.clear();
  result.tolerances.clear();
  result.aperture = {Aperture::Kind::stop_semi_diameter_mm, transfer->aperture_radii_mm.front()};
  return result;
}

/// At some heights, by how much the light that a film point sees is another.
double worst_light(const Lens& lens, const Lens& fit, double film_radius_mm) {
  constexpr int heights = 6;
  const double nm = lens.reference_wavelength_nm;
  FieldTracer real(lens, nm), fitted(fit, nm);
  double worst = 0;
  for (int i = 0; i < heights; ++i) {
    const double height = film_radius_mm * i / heights;
    const auto field = real.object_field_at_image_height(height);
    if (!field) continue;
    const auto a = real.chief_ray(*field), b = fitted.chief_ray(*field);
    if (!a || !b) continue;
    const double light = real.g_sensor_sr(*a);
    if (light > 0) worst = std::max(worst, std::abs(fitted.g_sensor_sr(*b) / light - 1));
  }
  return worst;
}

/// A lens as rays to fit to.
struct Sampling {
  Sampling(const Lens& lens, const TransferFitRequest& request) {
    check(lens, request);
    film_radius_mm = film_radius_of(lens, request);
    fitting.wavelengths_nm = request.wavelengths_nm.empty() ? lens.wavelengths_nm : request.wavelengths_nm;
    std::sort(fitting.wavelengths_nm.begin(), fitting.wavelengths_nm.end());
    const std::vector<std::size_t> apertures = limiting(lens, fitting, film_radius_mm);
    for (const double nm : fitting.wavelengths_nm) {
      const SampledLens sampled(lens, nm, film_radius_mm);
      fitting.samples.push_back(
          sampled.samples(fit_heights, fit_azimuths, fit_rings, beyond_rim, 0, apertures));
      fitting.held.push_back(sampled.samples(held_heights, held_azimuths, held_rings, 1, 0.37, apertures));
      fitting.first.emplace_back(first_order_of(lens, nm));
    }
    fitting.set_unit();
    const Tracer tracer(lens, lens.reference_wavelength_nm);
    for (const std::size_t surface : apertures)
      radii_mm.push_back(
          std::sqrt(tracer.clip_radius_sq(surface, Tracer::Clip::apertures) / (1 + Tracer::rim_tolerance)));
  }

  Fitting fitting;
  double film_radius_mm = 0;
  std::vector<double> radii_mm;  ///< of the apertures, without the film
};

/// Rays of a table by wavelength, every fourth of those that pass held out. \param film_radius_mm  as asked
/// for, or that of the rays.
Fitting fitting_of(const RayTable& table, const TransferFitRequest& request, double& film_radius_mm) {
  constexpr std::size_t held_one_in = 4;
  std::map<double, std::vector<Sample>> bands;
  for (const RayTable::Row& row : table.rows) {
    Sample sample{row.rear, row.front, row.at_apertures};
    sample.at_apertures.push_back(on_film(row.rear, table.film_mm));
    bands[row.wavelength_nm].push_back(std::move(sample));
  }
  const auto passes = [&](const Sample& sample) {
    for (std::size_t i = 0; i < table.aperture_radii_mm.size(); ++i)
      if (std::hypot(sample.at_apertures[i][0], sample.at_apertures[i][1]) > table.aperture_radii_mm[i])
        return false;
    return true;
  };
  const auto height = [](const Sample& sample) {
    return std::hypot(sample.at_apertures.back()[0], sample.at_apertures.back()[1]);
  };
  film_radius_mm = request.film_radius_mm.value_or(0);
  if (!request.film_radius_mm)
    for (const auto& [nm, samples] : bands)
      for (const Sample& sample : samples)
        if (passes(sample)) film_radius_mm = std::max(film_radius_mm, height(sample));
  Fitting fitting;
  fitting.wavelengths_nm = request.wavelengths_nm;
  if (fitting.wavelengths_nm.empty())
    for (const auto& [nm, samples] : bands) fitting.wavelengths_nm.push_back(nm);
  std::sort(fitting.wavelengths_nm.begin(), fitting.wavelengths_nm.end());
  for (const double nm : fitting.wavelengths_nm) {
    const auto band = bands.find(nm);
    if (band == bands.end()) throw InputError(fmt::format("the table of rays has none at {:g} nm", nm));
    fitting.samples.emplace_back(), fitting.held.emplace_back(), fitting.first.emplace_back();
    std::size_t inside = 0;
    for (const Sample& sample : band->second) {
      const bool hold = passes(sample) && height(sample) <= film_radius_mm && ++inside % held_one_in == 0;
      (hold ? fitting.held : fitting.samples).back().push_back(sample);
    }
    if (fitting.held.back().empty())
      throw InputError(
          fmt::format("the table of rays has {} at {:g} nm that reach the film; some hundreds would be right",
                      inside, nm));
  }
  fitting.set_unit();
  return fitting;
}

/// The largest degree that twice as many equations as unknowns are there for.
int most_degree_for(const Fitting& fitting) {
  std::size_t rays = fitting.samples.front().size();
  for (const std::vector<Sample>& band : fitting.samples) rays = std::min(rays, band.size());
  int degree = 0;
  while (degree < highest_degree && 2 * powers_up_to(degree + 1).size() <= rays) ++degree;
  return degree;
}

struct FoundTerms {
  int degree = 0;
  std::vector<Powers> terms;
  std::vector<std::vector<std::vector<double>>> bands;
};

FoundTerms terms_for(const Fitting& fitting, const TransferFitRequest& request, double efl_mm,
                     const std::string& name) {
  const double mm = request.tolerance_mm, rad = mm / efl_mm;
  const int most = most_degree_for(fitting);
  FoundTerms found;
  found.degree = request.degree.value_or(1);
  for (;; ++found.degree) {
    if (found.degree > most && most < highest_degree)
      throw InputError(
          fmt::format("{}: too few rays for polynomials of degree {}, and none of degree {} is within "
                      "{:g} mm, {:g} rad of them; more rays or a larger tolerance would be right",
                      name, found.degree, most, mm, rad));
    found.terms = powers_up_to(found.degree);
    found.bands = fitting.bands(found.terms);
    if (request.degree || meets(fitting.errors(found.terms, found.bands), mm, rad)) break;
    if (found.degree == highest_degree)
      throw InputError(
          fmt::format("{}: no ray transfer of degree {} or less is within {:g} mm, {:g} rad of its rays; a "
                      "smaller film radius, a smaller stop or a larger tolerance would be right",
                      name, highest_degree, mm, rad));
  }
  const std::vector<Powers> fewer = needed(fitting, found.terms, found.bands, mm, rad);
  if (fewer.size() < found.terms.size()) {
    const auto again = fitting.bands(fewer);
    if (request.degree || meets(fitting.errors(fewer, again), mm, rad))
      found.terms = fewer, found.bands = again;
  }
  return found;
}

/// Without length and apertures.
RayTransfer transfer_of(const Fitting& fitting, const FoundTerms& found) {
  RayTransfer transfer;
  transfer.unit_mm = transfer.largest_radius_mm = fitting.unit_mm;
  transfer.terms = found.terms;
  for (std::size_t b = 0; b < found.bands.size(); ++b)
    transfer.bands.push_back({fitting.wavelengths_nm[b], found.bands[b], {}});
  return transfer;
}

/// \param lens  what else than its surfaces the fit has.
TransferFit fit_with(const Fitting& fitting, const FoundTerms& found, const Lens& lens,
                     RayTransfer transfer) {
  TransferFit fit;
  for (const auto& band : found.bands)
    fit.determinant_error =
        std::max(fit.determinant_error, std::abs(band[0][0] * band[3][0] - band[1][0] * band[2][0] - 1));
  try {
    fit.lens = lens_with(lens, made_ready(std::move(transfer)));
  } catch (const InputError& error) {
    throw InputError(lens.name + ": " + error.what());
  }
  const Errors errors = fitting.errors(found.terms, found.bands);
  fit.accuracy.median_mm = middle_of(errors.mm);
  fit.accuracy.worst_mm = *std::max_element(errors.mm.begin(), errors.mm.end());
  fit.accuracy.median_rad = middle_of(errors.rad);
  fit.accuracy.worst_rad = *std::max_element(errors.rad.begin(), errors.rad.end());
  fit.accuracy.rays = errors.mm.size();
  fit.degree = found.degree;
  fit.terms = found.terms.size();
  return fit;
}

}  // namespace

TransferFit fit_transfer(const Lens& lens, const TransferFitRequest& request) {
  const Sampling sampling(lens, request);
  const FoundTerms found =
      terms_for(sampling.fitting, request, std::abs(first_order(lens).efl_mm), lens.name);
  RayTransfer transfer = transfer_of(sampling.fitting, found);
  transfer.length_mm = lens.total_track_mm() - lens.surfaces.back().thickness_mm;
  transfer.aperture_radii_mm = sampling.radii_mm;
  // Light that goes elsewhere than to the film was not fitted, and does not pass.
  transfer.aperture_radii_mm.push_back(sampling.film_radius_mm);
  TransferFit fit = fit_with(sampling.fitting, found, lens, std::move(transfer));
  fit.accuracy.worst_light = worst_light(lens, fit.lens, sampling.film_radius_mm);
  return fit;
}

TransferFit fit_transfer(const RayTable& table, const TransferFitRequest& request) {
  check(request);
  const std::string name = table.name.empty() ? "a table of rays" : table.name;
  double film_radius_mm = 0;
  const Fitting fitting = fitting_of(table, request, film_radius_mm);
  // The power, for what the tolerance of a place is worth in direction.
  const auto rough = fitting.bands(powers_up_to(std::min(2, most_degree_for(fitting))));
  const double power = std::abs(rough[rough.size() / 2][2][0]);
  if (!(power > 0)) throw InputError(name + ": has no power");
  const FoundTerms found = terms_for(fitting, request, 1 / power, name);
  RayTransfer transfer = transfer_of(fitting, found);
  transfer.length_mm = table.length_mm;
  transfer.aperture_radii_mm = table.aperture_radii_mm;
  transfer.aperture_radii_mm.push_back(film_radius_mm);
  Lens lens;
  lens.name = name;
  lens.wavelengths_nm = fitting.wavelengths_nm;
  lens.reference_wavelength_nm = fitting.wavelengths_nm[fitting.wavelengths_nm.size() / 2];
  lens.fields = {Fields::Kind::paraxial_image_height_mm,
                 {0, 0.5 * film_radius_mm, 0.7 * film_radius_mm, 0.95 * film_radius_mm}};
  Surface last;
  last.thickness_mm = table.film_mm;
  lens.surfaces = {last};
  return fit_with(fitting, found, lens, std::move(transfer));
}

RayTable ray_table(const Lens& lens, const TransferFitRequest& request) {
  const Sampling sampling(lens, request);
  RayTable table;
  table.name = lens.name;
  table.length_mm = lens.total_track_mm() - lens.surfaces.back().thickness_mm;
  table.film_mm = lens.surfaces.back().thickness_mm;
  table.aperture_radii_mm = sampling.radii_mm;
  for (std::size_t b = 0; b < sampling.fitting.wavelengths_nm.size(); ++b)
    for (const auto* samples : {&sampling.fitting.samples[b], &sampling.fitting.held[b]})
      for (const Sample& sample : *samples)
        table.rows.push_back({sampling.fitting.wavelengths_nm[b],
                              sample.front,
                              sample.rear,
                              {sample.at_apertures.begin(), sample.at_apertures.end() - 1}});
  return table;
}

}  // namespace petzval
