// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/field_rows.h>
#include <petzval/base/units.h>
#include <petzval/optimise/ray_merit.h>
#include <petzval/trace/pupil.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace petzval {

namespace {

/// Nodes of a pupil: enough for aberrations up to the ninth order, and few enough to be quick.
constexpr int merit_azimuths = 16, merit_radii = 5;
/// Of a contrast, to which many waves may add up.
constexpr int mtf_azimuths = 32, mtf_radii = 8;
constexpr double nm_per_mm_of_path = 1e6;

/// Whether the lens is round about its axis whatever the variables.
bool stays_round(const Lens& lens, const OptimiseRequest& request) {
  return is_round(lens) && std::ranges::none_of(request.variables, [](const LensVariable& variable) {
           return variable.number.is_pose();
         });
}

}  // namespace

std::vector<double> azimuths_of(const Lens& lens, const OptimiseRequest& request) {
  if (!request.azimuths_deg.empty()) return request.azimuths_deg;
  const double first = request.at.azimuth_deg;
  if (stays_round(lens, request)) return {first};
  return {first, first + 90, first + 180, first + 270};
}

/// A list of numbers and their derivatives.
struct RayMerit::Columns {
  Eigen::MatrixXd values;  ///< of rays: x, y, path, α, β; of residuals: one column
  std::vector<Eigen::MatrixXd> slopes;

  /// Column `c` and its derivatives, side by side.
  Eigen::MatrixXd joined(Eigen::Index c) const {
    const Eigen::MatrixXd& by = slopes[static_cast<std::size_t>(c)];
    Eigen::MatrixXd all(values.rows(), 1 + by.cols());
    all << values.col(c), by;
    return all;
  }
};

RayMerit::RayMerit(const Lens& lens, const OptimiseRequest& request)
    : kind_(request.merit), frequency_cpmm_(request.mtf_frequency_cpmm) {
  const FieldTableRequest at = with_own_lists(request.at, lens);
  wavelengths_nm_ = at.wavelengths_nm;
  for (const LensVariable& variable : request.variables) numbers_.push_back(variable.number);
  const bool whole = !stays_round(lens, request);
  std::vector<double> weights = request.field_weights;
  if (weights.empty()) weights.assign(at.fields.size(), 1);
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  const std::vector<double> azimuths_deg = azimuths_of(lens, request);
  for (std::size_t a = 0; a < azimuths_deg.size(); ++a) {
    const std::size_t first = fields_.size();
    for (std::size_t f = 0; f < at.fields.size(); ++f) {
      if (a > 0 && at.fields[f] == 0) continue;
      const double share = at.fields[f] == 0 ? 1 : 1 / static_cast<double>(azimuths_deg.size());
      const double angle = whole ? radians(azimuths_deg[a]) : 0;
      fields_.push_back({f, weights[f] / total * share, std::cos(angle), std::sin(angle)});
    }
    for (std::size_t w = 0; w < wavelengths_nm_.size(); ++w) {
      FieldTracer tracer(lens, wavelengths_nm_[w], at.clip, azimuths_deg[a]);
      for (std::size_t i = first; i < fields_.size(); ++i) launch(tracer, at, w, whole, fields_[i]);
    }
  }
}

void RayMerit::launch(FieldTracer& tracer, const FieldTableRequest& at, std::size_t wavelength, bool whole,
                      FieldRays& field) const {
  const bool contrast = kind_ == OptimiseMerit::mtf;
  const Lens& lens = tracer.lens();
  const double object = object_field(lens, at.field_kind, at.fields[field.field]);
  const std::optional<ChiefRay> chief = tracer.chief_ray(object);
  const auto pupil =
      chief ? tracer.object_pupil(*chief, contrast ? mtf_azimuths : merit_azimuths) : std::nullopt;
  if (!pupil) throw no_ray_passes(lens, at.fields[field.field], wavelengths_nm_[wavelength]);
  const Pencil pencil = Pencil::from_object(lens, object);
  const double per_wavelength = 1 / static_cast<double>(wavelengths_nm_.size());
  const bool halves = whole && pupil->mirrored();
  const auto to_lens = [&](auto& axes) {
    const double x = axes[0], y = axes[1];
    axes[0] = field.cosine * x - field.sine * y, axes[1] = field.sine * x + field.cosine * y;
  };
  for (const PupilNode& node : pupil_nodes(*pupil, contrast ? mtf_radii : merit_radii))
    for (const double side : {1.0, -1.0}) {
      if (side < 0 && !halves) continue;
      std::optional<Ray> launched = pencil.ray(side * node.u, node.v);
      if (!launched) continue;
      Ray end = tracer.tracer().trace(*launched, Tracer::Clip::none);
      if (end.status != RayStatus::ok) continue;
      const double share = per_wavelength * node.weight / pupil->area(), weight = halves ? share / 2 : share;
      if (whole) {
        for (auto* axes : {&launched->point_mm, &launched->direction, &end.point_mm, &end.direction})
          to_lens(*axes);
        field.x_mm += weight * end.point_mm[0], field.y_mm += weight * end.point_mm[1];
      }
      field.rays.push_back(
          {wavelength, *launched, weight, pupil->mirrored() && !whole, end.direction[0], end.direction[1]});
    }
}

Eigen::Index RayMerit::rows() const {
  Eigen::Index count = 0;
  for (const FieldRays& field : fields_) count += rows_of(field);
  return count;
}

Eigen::Index RayMerit::rows_of(const FieldRays& field) const {
  const auto rays = static_cast<Eigen::Index>(field.rays.size());
  return kind_ == OptimiseMerit::mtf ? 2 : kind_ == OptimiseMerit::rms_spot ? 2 * rays : rays;
}

/// 1 less |Σ w exp(2πi f y)| in per cent, and the same along x, where mirrored rays leave a cosine.
void RayMerit::mtf_rows(const FieldRays& field, const Columns& rays, Columns& rows) const {
  const auto count = static_cast<Eigen::Index>(field.rays.size());
  const double radians_per_mm = 2 * pi * frequency_cpmm_, scale = 100 * std::sqrt(field.weight / 2);
  for (const Eigen::Index axis : {1, 0}) {
    const bool mirrored = axis == 0 && field.rays.front().mirrored;
    const double x = axis == 0 ? field.cosine : -field.sine, y = axis == 0 ? field.sine : field.cosine;
    const Eigen::VectorXd places = x * rays.values.col(0) + y * rays.values.col(1);
    const Eigen::MatrixXd by = x * rays.slopes[0] + y * rays.slopes[1];
    double total = 0, cosine = 0, sine = 0;
    Eigen::RowVectorXd cosine_by = Eigen::RowVectorXd::Zero(by.cols()), sine_by = cosine_by;
    for (Eigen::Index i = 0; i < count; ++i) {
      const double weight = field.rays[static_cast<std::size_t>(i)].weight;
      const double phase = radians_per_mm * places[i], c = std::cos(phase), s = std::sin(phase);
      total += weight, cosine += weight * c;
      cosine_by -= weight * s * radians_per_mm * by.row(i);
      if (mirrored) continue;
      sine += weight * s;
      sine_by += weight * c * radians_per_mm * by.row(i);
    }
    const double length = std::max(std::hypot(cosine, sine), std::numeric_limits<double>::min());
    const Eigen::Index row = 1 - axis;
    rows.values(row, 0) = scale * (1 - length / total);
    rows.slopes[0].row(row) = -scale / total * (cosine * cosine_by + sine * sine_by) / length;
  }
}

/// Places against the mean of the field, which of mirrored rays lies at x = 0.
void RayMerit::spot_rows(const FieldRays& field, const Columns& rays, Columns& rows) const {
  const auto count = static_cast<Eigen::Index>(field.rays.size());
  Eigen::VectorXd weights(count);
  for (Eigen::Index i = 0; i < count; ++i) weights[i] = field.rays[static_cast<std::size_t>(i)].weight;
  for (const Eigen::Index axis : {0, 1}) {
    Eigen::MatrixXd all = rays.joined(axis);
    if (axis == 1 || !field.rays.front().mirrored)
      all.rowwise() -= Eigen::RowVectorXd(weights.transpose() * all);
    all = (weights * field.weight).cwiseSqrt().asDiagonal() * all * um_per_mm;
    const Eigen::Index first = axis * count;
    rows.values.middleRows(first, count) = all.leftCols(1);
    rows.slopes[0].middleRows(first, count) = all.rightCols(all.cols() - 1);
  }
}

/// Paths to the feet of perpendiculars from one point of the image, piston of every wavelength and a move of
/// the point removed: what is left does not come together anywhere on the sensor.
void RayMerit::wave_rows(const FieldRays& field, const Columns& rays, Columns& rows) const {
  const auto count = static_cast<Eigen::Index>(field.rays.size());
  const bool mirrored = field.rays.front().mirrored;
  const auto pistons = static_cast<Eigen::Index>(wavelengths_nm_.size());
  Eigen::VectorXd weights(count);
  Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(count, pistons + (mirrored ? 1 : 2));
  for (Eigen::Index i = 0; i < count; ++i) {
    const FieldRay& ray = field.rays[static_cast<std::size_t>(i)];
    weights[i] = ray.weight;
    basis(i, static_cast<Eigen::Index>(ray.wavelength)) = 1;
    basis(i, pistons) = ray.beta;
    if (!mirrored) basis(i, pistons + 1) = ray.alpha;
  }
  const Eigen::MatrixXd weighted = weights.asDiagonal() * basis;
  Eigen::MatrixXd all = rays.joined(2);
  all -= basis * (weighted.transpose() * basis).ldlt().solve(weighted.transpose() * all);
  all = (weights * field.weight).cwiseSqrt().asDiagonal() * all * nm_per_mm_of_path;
  rows.values = all.leftCols(1);
  rows.slopes[0] = all.rightCols(all.cols() - 1);
}

std::optional<Eigen::VectorXd> RayMerit::residuals(const Lens& lens, Eigen::MatrixXd* slopes) const {
  const std::vector<LensNumber> numbers = slopes ? numbers_ : std::vector<LensNumber>();
  std::vector<DerivedTracer> tracers;
  for (const double wavelength : wavelengths_nm_) tracers.emplace_back(lens, wavelength, numbers);
  const auto variables = static_cast<Eigen::Index>(numbers.size());
  Eigen::VectorXd result(rows());
  if (slopes) slopes->resize(rows(), variables);
  Eigen::Index first = 0;
  for (const FieldRays& field : fields_) {
    const auto count = static_cast<Eigen::Index>(field.rays.size());
    Columns rays{Eigen::MatrixXd(count, 3),
                 std::vector<Eigen::MatrixXd>(3, Eigen::MatrixXd(count, variables))};
    for (Eigen::Index i = 0; i < count; ++i) {
      const FieldRay& launched = field.rays[static_cast<std::size_t>(i)];
      const DerivedTracer& tracer = tracers[launched.wavelength];
      const std::optional<DerivedRay> traced = tracer.trace(launched.launch);
      if (!traced) return {};
      const Ray& end = traced->ray;
      const double x = end.point_mm[0] - field.x_mm, y = end.point_mm[1] - field.y_mm,
                   alpha = end.direction[0], beta = end.direction[1], index = tracer.tracer().image_index();
      // The path to the foot of the perpendicular from the field's point (of a centred lens that of the axis,
      // which differs by a move of the point), from where a plane wave would come.
      rays.values.row(i) << end.point_mm[0], end.point_mm[1], end.opl_mm - index * (alpha * x + beta * y);
      for (Eigen::Index v = 0; v < variables; ++v) {
        const DerivedRay::Slope& by = traced->by[static_cast<std::size_t>(v)];
        rays.slopes[0](i, v) = by.x_mm;
        rays.slopes[1](i, v) = by.y_mm;
        rays.slopes[2](i, v) =
            by.opl_mm - index * (by.alpha * x + alpha * by.x_mm + by.beta * y + beta * by.y_mm);
      }
    }
    const Eigen::Index more = rows_of(field);
    Columns rows{Eigen::MatrixXd(more, 1), {Eigen::MatrixXd(more, variables)}};
    if (kind_ == OptimiseMerit::mtf)
      mtf_rows(field, rays, rows);
    else
      kind_ == OptimiseMerit::rms_spot ? spot_rows(field, rays, rows) : wave_rows(field, rays, rows);
    result.segment(first, more) = rows.values.col(0);
    if (slopes) slopes->middleRows(first, more) = rows.slopes[0];
    first += more;
  }
  return result;
}

double RayMerit::merit(const Eigen::VectorXd& residuals) const {
  return std::sqrt(residuals.squaredNorm());
}

std::vector<double> RayMerit::by_field(const Eigen::VectorXd& residuals) const {
  std::vector<double> squares, weights;
  Eigen::Index first = 0;
  for (const FieldRays& field : fields_) {
    const Eigen::Index more = rows_of(field);
    const std::size_t least = field.field + 1;
    if (squares.size() < least) squares.resize(least), weights.resize(least);
    squares[field.field] += residuals.segment(first, more).squaredNorm();
    weights[field.field] += field.weight;
    first += more;
  }
  for (std::size_t i = 0; i < squares.size(); ++i) squares[i] = std::sqrt(squares[i] / weights[i]);
  return squares;
}

}  // namespace petzval
