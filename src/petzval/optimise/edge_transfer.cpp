// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/wave_rays.h>
#include <petzval/base/units.h>
#include <petzval/numeric/quadrature.h>
#include <petzval/optimise/edge_transfer.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>

namespace petzval {

namespace {

/// A chief ray lands where it shall to this [mm], in so many steps.
constexpr double landing_tolerance_mm = 2e-4;
constexpr int landing_steps = 40;
/// A wave that a polynomial misses by more than this [waves] gets a higher one.
constexpr double close_wave = 3e-3;
constexpr int degrees_more = 4, highest_degree = 18;
/// Of Gauss's three places along an edge, from its middle over half its length.
const double outer_place = std::sqrt(0.6);

struct Place {
  double x_mm, y_mm, share;
};

std::vector<Place> places_of(const SensorEdge& edge, const EdgeDetail& detail) {
  if (detail.places == 1) return {{edge.x_mm, edge.y_mm, 1}};
  const double along = outer_place * edge.half_length_mm;
  const double dx = -edge.normal_y * along, dy = edge.normal_x * along;
  return {{edge.x_mm - dx, edge.y_mm - dy, 5.0 / 18},
          {edge.x_mm, edge.y_mm, 8.0 / 18},
          {edge.x_mm + dx, edge.y_mm + dy, 5.0 / 18}};
}

/// How far the image moves with the object near the axis [mm per degree or per mm].
std::optional<double> image_per_object(FieldTracer& tracer) {
  const double small = tracer.lens().object_distance_mm ? 1e-3 * *tracer.lens().object_distance_mm : 0.1;
  const auto middle = tracer.landing_mm(0, 0), beside = tracer.landing_mm(0, small);
  if (!middle || !beside) return {};
  const double per_object = ((*beside)[1] - (*middle)[1]) / small;
  if (!(std::abs(per_object) > 0)) return {};
  return per_object;
}

/// By secants of slope `per_object`, shortened where no chief ray gets so far.
std::optional<std::array<double, 2>> object_at(FieldTracer& tracer, const Place& place,
                                               std::array<double, 2> object, double per_object) {
  std::array<double, 2> step{};
  for (int i = 0; i < landing_steps; ++i) {
    const auto at = tracer.landing_mm(object[0], object[1]);
    if (!at) {
      if (i == 0) object = {0, 0};
      for (std::size_t k = 0; k < 2; ++k) object[k] -= step[k] *= 0.5;
      if (std::hypot(step[0], step[1]) * std::abs(per_object) < landing_tolerance_mm && i > 0) return {};
      continue;
    }
    const double miss_x = place.x_mm - (*at)[0], miss_y = place.y_mm - (*at)[1];
    if (std::hypot(miss_x, miss_y) < landing_tolerance_mm) return object;
    step = {miss_x / per_object, miss_y / per_object};
    object[0] += step[0], object[1] += step[1];
  }
  return {};
}

/// Products T_i(x) T_j(y), i + j ≤ degree, over the box about the pupil whose sides are along the normal of
/// an edge (x) and along the edge (y).
class Basis {
 public:
  /// \param ex, ey  unit vector along the normal.
  Basis(int degree, const std::vector<std::array<double, 2>>& outline, double ex, double ey)
      : degree_(degree), ex_(ex), ey_(ey) {
    std::array<double, 2> low{1e300, 1e300}, high{-1e300, -1e300};
    for (const auto& [alpha, beta] : outline) {
      const std::array at{alpha * ex + beta * ey, beta * ex - alpha * ey};
      for (std::size_t k = 0; k < 2; ++k)
        low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
    }
    for (std::size_t k = 0; k < 2; ++k)
      middle_[k] = 0.5 * (low[k] + high[k]), half_[k] = 0.5 * (high[k] - low[k]);
  }
  Eigen::Index terms() const { return (degree_ + 1) * (degree_ + 2) / 2; }
  Eigen::Index line_terms() const { return degree_ + 1; }
  void row(double alpha, double beta, double* values, Eigen::Index stride) const {
    std::array<double, most_terms> t, s;
    chebyshev((alpha * ex_ + beta * ey_ - middle_[0]) / half_[0], t.data());
    chebyshev((beta * ex_ - alpha * ey_ - middle_[1]) / half_[1], s.data());
    for (std::size_t i = 0; i <= static_cast<std::size_t>(degree_); ++i)
      for (std::size_t j = 0; i + j <= static_cast<std::size_t>(degree_); ++j) {
        *values = t[i] * s[j];
        values += stride;
      }
  }
  /// Sums of terms, a column each, become series in T_i(x) along the line at y = `across`.
  Eigen::MatrixXd along(double across, const Eigen::MatrixXd& coefficients) const {
    std::array<double, most_terms> s;
    chebyshev((across - middle_[1]) / half_[1], s.data());
    Eigen::MatrixXd series(line_terms(), coefficients.cols());
    Eigen::Index from = 0;
    for (Eigen::Index i = 0; i < line_terms(); ++i) {
      const Eigen::Index count = line_terms() - i;
      series.row(i) =
          Eigen::Map<const Eigen::RowVectorXd>(s.data(), count) * coefficients.middleRows(from, count);
      from += count;
    }
    return series;
  }
  /// T_i at x = `where`, line_terms() of them.
  void line_row(double where, double* values) const { chebyshev((where - middle_[0]) / half_[0], values); }

 private:
  static constexpr std::size_t most_terms = 32;
  void chebyshev(double x, double* t) const {
    t[0] = 1, t[1] = x;
    for (int i = 2; i <= degree_; ++i) t[i] = 2 * x * t[i - 1] - t[i - 2];
  }

  int degree_;
  double ex_, ey_;
  std::array<double, 2> middle_{}, half_{};
};

using Outline = std::vector<std::array<double, 2>>;

/// A polygon through points of a smooth curve holds less than the curve: made as large again.
void keep_area(Outline& outline) {
  std::array<double, 2> middle{};
  for (const auto& point : outline)
    for (std::size_t k = 0; k < 2; ++k) middle[k] += point[k] / static_cast<double>(outline.size());
  const double angle = 2 * pi / static_cast<double>(outline.size());
  const double factor = std::sqrt(angle / std::sin(angle));
  for (auto& point : outline)
    for (std::size_t k = 0; k < 2; ++k) point[k] = middle[k] + factor * (point[k] - middle[k]);
}

/// The pupil of a place at one wavelength: its outline in exit directions, and the wave there.
struct PlacePupil {
  Outline outline;
  double index = 1;              ///< in front of the sensor
  Eigen::MatrixXd coefficients;  ///< amplitude, phase [waves], then what every altered lens adds to that
  std::optional<Basis> basis;
};

std::vector<PupilNode> whole_pupil(const PupilBoundary& boundary, int radial_nodes) {
  std::vector<PupilNode> nodes = pupil_nodes(boundary, radial_nodes);
  if (!boundary.mirrored()) return nodes;
  const std::size_t half = nodes.size();
  for (std::size_t i = 0; i < half; ++i) nodes.push_back({-nodes[i].u, nodes[i].v, nodes[i].weight});
  return nodes;
}

RayBatch launched(const Pencil& pencil, const std::vector<PupilNode>& nodes) {
  RayBatch rays;
  for (const PupilNode& node : nodes) {
    const Ray ray = pencil.ray(node.u, node.v).value_or(Ray{{0, 0, 0}, {1, 0, 0}});
    rays.push_back(ray.point_mm[0], ray.point_mm[1], ray.point_mm[2], ray.direction[0], ray.direction[1],
                   ray.direction[2], ray.opl_mm);
  }
  return rays;
}

RayBatch traced(const Tracer& tracer, RayBatch rays) {
  tracer.trace(rays, Tracer::Clip::none);
  return rays;
}

class PupilReader {
 public:
  /// \param turn  of the field from +y towards +x [rad].
  PupilReader(const Lens& lens, double nm, double field, double turn, const EdgeDetail& detail)
      : tracer_(lens, nm, Tracer::Clip::apertures, -degrees(turn)), detail_(detail), turn_(turn) {
    if (const auto chief = tracer_.chief_ray(field)) chief_ = *chief;
  }

  /// About a fixed place of the sensor, (x, y) in its own axes [mm]. \param ex, ey  the edge's normal, turned
  /// with the field.
  std::optional<PlacePupil> read(std::span<const Lens> altered, double x_mm, double y_mm, double ex,
                                 double ey) const {
    if (!chief_) return {};
    const std::optional<PupilBoundary> boundary = tracer_.object_pupil(*chief_, detail_.azimuths);
    if (!boundary) return {};
    const Pencil pencil = Pencil::from_object(tracer_.lens(), chief_->object_field);
    PlacePupil pupil;
    pupil.index = tracer_.tracer().image_index();
    for (std::size_t i = 0; i < boundary->radius.size(); ++i) {
      const auto [u, v] = boundary->rim(i);
      const auto ray = pencil.ray(u, v);
      if (!ray) continue;
      const Ray at = tracer_.tracer().trace(*ray, Tracer::Clip::none);
      if (at.status == RayStatus::ok) pupil.outline.push_back({at.direction[0], at.direction[1]});
    }
    if (pupil.outline.size() < 8) return {};
    const std::vector<PupilNode> nodes = whole_pupil(*boundary, detail_.radial_nodes);
    const Outline traced_outline = pupil.outline;
    keep_area(pupil.outline);
    for (int degree = detail_.degree;; degree += degrees_more) {
      pupil.basis.emplace(degree, traced_outline, ex, ey);
      const auto missed = fit(pupil, *boundary, nodes, pencil, altered, x_mm, y_mm);
      if (!missed) return {};
      const bool enough = 2 * Basis(degree + degrees_more, traced_outline, ex, ey).terms() >
                          static_cast<Eigen::Index>(nodes.size());
      if (*missed < close_wave || degree >= highest_degree || enough) return pupil;
    }
  }

 private:
  /// \returns the rms of the phase that the polynomial misses [waves]; nothing where rays are too few.
  std::optional<double> fit(PlacePupil& pupil, const PupilBoundary& boundary,
                            const std::vector<PupilNode>& nodes, const Pencil& pencil,
                            std::span<const Lens> altered, double x_mm, double y_mm) const {
    const std::vector<WaveRay> waves = trace_wave_rays(tracer_, *chief_, boundary, nodes);
    const RayBatch launch = launched(pencil, nodes), here = traced(tracer_.tracer(), launch);
    std::vector<RayBatch> there;
    for (const Lens& lens : altered) there.push_back(through_altered(lens, pencil, nodes));
    // The place in the turned axes of the tracer.
    const double c = std::cos(turn_), s = std::sin(turn_);
    const double place_x = x_mm * c - y_mm * s, place_y = x_mm * s + y_mm * c;
    const double off_x = chief_->image_x_mm - place_x, off_y = chief_->image_height_mm - place_y;
    const auto turns = mean_turns(here, there);
    const double per_mm = tracer_.tracer().image_index() / (tracer_.tracer().wavelength_nm() * mm_per_nm);
    const double opl_per_mm = 1 / (tracer_.tracer().wavelength_nm() * mm_per_nm);
    const auto columns = static_cast<Eigen::Index>(2 + altered.size());
    Eigen::MatrixXd rows(static_cast<Eigen::Index>(nodes.size()), pupil.basis->terms());
    Eigen::MatrixXd values(rows.rows(), columns);
    Eigen::Index count = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (!waves[i].passes || here.status[i] != RayStatus::ok) continue;
      const double alpha = here.l[i], beta = here.m[i];
      values(count, 0) = waves[i].amplitude;
      values(count, 1) = waves[i].phase_waves - per_mm * (off_x * alpha + off_y * beta);
      bool all = true;
      for (std::size_t k = 0; k < there.size(); ++k) {
        const RayBatch& at = there[k];
        all = all && at.status[i] == RayStatus::ok;
        const auto [more_alpha, more_beta] = turns[k];
        values(count, static_cast<Eigen::Index>(2 + k)) =
            opl_per_mm * (at.opl_mm[i] - here.opl_mm[i]) -
            per_mm * ((at.x_mm[i] - place_x) * (alpha + more_alpha) - (here.x_mm[i] - place_x) * alpha +
                      (at.y_mm[i] - place_y) * (beta + more_beta) - (here.y_mm[i] - place_y) * beta);
      }
      if (!all) continue;
      pupil.basis->row(alpha, beta, &rows(count, 0), rows.outerStride());
      ++count;
    }
    if (count < 2 * rows.cols()) return {};
    const auto used = rows.topRows(count);
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(used.cols(), used.cols());
    normal.selfadjointView<Eigen::Lower>().rankUpdate(used.transpose());
    pupil.coefficients =
        Eigen::LDLT<Eigen::MatrixXd, Eigen::Lower>(normal).solve(used.transpose() * values.topRows(count));
    if (!pupil.coefficients.allFinite()) return {};
    return std::sqrt((used * pupil.coefficients.col(1) - values.col(1).head(count)).squaredNorm() /
                     static_cast<double>(count));
  }

  /// The rays of the same places of the stop, through another lens: labels move with its chief ray.
  RayBatch through_altered(const Lens& lens, const Pencil& pencil, std::vector<PupilNode> nodes) const {
    const Tracer tracer = Tracer(lens, tracer_.tracer().wavelength_nm()).turned(turn_);
    const double nudge = label_nudge(tracer, pencil);
    const auto stop_at = [&](double u, double v) {
      const Tracer::Clearance at = pencil.clearance(tracer, u, v, Tracer::Clip::none);
      return std::array{at.stop_x_mm, at.stop_y_mm};
    };
    const auto at = stop_at(chief_->u, chief_->v), right = stop_at(chief_->u + nudge, chief_->v),
               above = stop_at(chief_->u, chief_->v + nudge);
    const double xu = (right[0] - at[0]) / nudge, yu = (right[1] - at[1]) / nudge;
    const double xv = (above[0] - at[0]) / nudge, yv = (above[1] - at[1]) / nudge;
    const double per_area = 1 / (xu * yv - xv * yu);
    const double du = per_area * (xv * at[1] - yv * at[0]), dv = per_area * (yu * at[0] - xu * at[1]);
    if (std::isfinite(du) && std::isfinite(dv))
      for (PupilNode& node : nodes) node.u += du, node.v += dv;
    return traced(tracer, launched(pencil, nodes));
  }

  /// By how much the rays of each altered lens come in at other directions, on average: a pupil that has
  /// moved as a whole has the same OTF.
  static std::vector<std::array<double, 2>> mean_turns(const RayBatch& here,
                                                       const std::vector<RayBatch>& there) {
    std::vector<std::array<double, 2>> turns;
    for (const RayBatch& at : there) {
      std::array<double, 2> sum{};
      double count = 0;
      for (std::size_t i = 0; i < at.size(); ++i) {
        if (at.status[i] != RayStatus::ok || here.status[i] != RayStatus::ok) continue;
        sum[0] += at.l[i] - here.l[i], sum[1] += at.m[i] - here.m[i];
        ++count;
      }
      turns.push_back({sum[0] / std::max(1.0, count), sum[1] / std::max(1.0, count)});
    }
    return turns;
  }

  FieldTracer tracer_;
  EdgeDetail detail_;
  double turn_;
  std::optional<ChiefRay> chief_;
};

/// A convex outline cut by lines along a direction.
class Cuts {
 public:
  /// \param ex, ey  unit vector along the lines.
  Cuts(const Outline& outline, double ex, double ey) {
    for (const auto& [alpha, beta] : outline)
      points_.push_back({alpha * ex + beta * ey, beta * ex - alpha * ey});
    low_ = high_ = points_[0][1];
    for (const auto& point : points_) low_ = std::min(low_, point[1]), high_ = std::max(high_, point[1]);
  }
  struct Cut {
    double low = 0, high = 0;
    double length() const { return high - low; }
  };
  Cut at(double across) const {
    Cut cut{1e300, -1e300};
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const auto &a = points_[i], &b = points_[(i + 1) % points_.size()];
      if ((a[1] <= across) == (b[1] <= across)) continue;
      const double where = a[0] + (across - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
      cut = {std::min(cut.low, where), std::max(cut.high, where)};
    }
    return cut.low <= cut.high ? cut : Cut{};
  }
  /// Across which the lines are longer than s: lengths of a convex outline are concave.
  Cut longer_than(double s) const {
    double best = low_, longest = 0;
    constexpr int steps = 48, halvings = 36;
    for (int i = 1; i < steps; ++i) {
      const double here = low_ + (high_ - low_) * i / steps;
      if (const double length = at(here).length(); length > longest) best = here, longest = length;
    }
    if (longest <= s) return {};
    const auto edge = [&](double outside) {
      double inside = best;
      for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (inside + outside);
        (at(middle).length() > s ? inside : outside) = middle;
      }
      return inside;
    };
    return {edge(low_), edge(high_)};
  }

 private:
  std::vector<std::array<double, 2>> points_;  ///< along, across
  double low_ = 0, high_ = 0;
};

/// OTF and its derivatives, not yet over that at frequency zero.
Eigen::VectorXcd overlap(const PlacePupil& pupil, const Cuts& cuts, double shift, const EdgeDetail& detail) {
  const Eigen::Index altered = pupil.coefficients.cols() - 2;
  const Cuts::Cut range = cuts.longer_than(shift);
  if (!(range.length() > 0)) return Eigen::VectorXcd::Zero(1 + altered);
  const QuadratureRule across = gauss_legendre(detail.chords, -pi / 2, pi / 2),
                       along = gauss_legendre(detail.chord_nodes);
  Eigen::MatrixXd rows(pupil.basis->line_terms(), 2 * detail.chord_nodes);
  std::complex<double> sum = 0;
  Eigen::MatrixX2d parts(detail.chord_nodes, 2), slopes = Eigen::MatrixX2d::Zero(altered, 2);
  Eigen::MatrixXd differences(altered, detail.chord_nodes);
  // Lines end as roots do at both ends of the range: nodes of an angle take that up.
  for (std::size_t i = 0; i < across.nodes.size(); ++i) {
    const double at = 0.5 * (range.low + range.high) + 0.5 * range.length() * std::sin(across.nodes[i]);
    const double weight = across.weights[i] * 0.5 * range.length() * std::cos(across.nodes[i]);
    const Cuts::Cut cut = cuts.at(at);
    const double length = std::max(0.0, cut.length() - shift);
    for (Eigen::Index k = 0; k < detail.chord_nodes; ++k) {
      const double far = cut.low + shift + length * along.nodes[static_cast<std::size_t>(k)];
      pupil.basis->line_row(far, &rows(0, 2 * k));
      pupil.basis->line_row(far - shift, &rows(0, 2 * k + 1));
    }
    const Eigen::MatrixXd values = pupil.basis->along(at, pupil.coefficients).transpose() * rows;
    for (Eigen::Index k = 0; k < detail.chord_nodes; ++k) {
      const auto far = values.col(2 * k), near = values.col(2 * k + 1);
      const double share = weight * length * along.weights[static_cast<std::size_t>(k)];
      const std::complex<double> part =
          share * far[0] * near[0] * std::polar(1.0, 2 * pi * (far[1] - near[1]));
      sum += part;
      parts.row(k) << part.real(), part.imag();
      differences.col(k) = far.tail(altered) - near.tail(altered);
    }
    slopes.noalias() += differences * parts;
  }
  Eigen::VectorXcd sums(1 + altered);
  sums[0] = sum;
  sums.tail(altered).real() = -2 * pi * slopes.col(1);
  sums.tail(altered).imag() = 2 * pi * slopes.col(0);
  return sums;
}

}  // namespace

std::optional<EdgeObjects> objects_of(FieldTracer& tracer, const SensorEdge& edge, const EdgeDetail& detail,
                                      const EdgeObjects& start) {
  const std::optional<double> per_object = image_per_object(tracer);
  if (!per_object) return {};
  EdgeObjects objects;
  for (const Place& place : places_of(edge, detail)) {
    const std::size_t i = objects.size();
    const std::array<double, 2> guess =
        i < start.size() ? start[i] : std::array{place.x_mm / *per_object, place.y_mm / *per_object};
    const auto object = object_at(tracer, place, guess, *per_object);
    if (!object) return {};
    objects.push_back(*object);
  }
  return objects;
}

std::optional<EdgeTransfer> edge_transfer(const Lens& lens, std::span<const Lens> altered,
                                          const SensorEdge& edge, const EdgeObjects& objects,
                                          const EdgeLight& light, std::span<const double> frequencies_cpmm,
                                          const EdgeDetail& detail) {
  const auto frequencies = static_cast<Eigen::Index>(frequencies_cpmm.size());
  const auto columns = static_cast<Eigen::Index>(altered.size());
  EdgeTransfer result{Eigen::VectorXd::Zero(frequencies), Eigen::MatrixXd::Zero(frequencies, columns)};
  const std::vector<Place> places = places_of(edge, detail);
  for (std::size_t p = 0; p < places.size(); ++p) {
    const auto [across, along] = objects[p];
    const double field = std::hypot(across, along), turn = field > 0 ? std::atan2(across, along) : 0;
    const double c = std::cos(turn), s = std::sin(turn);
    const double ex = edge.normal_x * c - edge.normal_y * s, ey = edge.normal_x * s + edge.normal_y * c;
    Eigen::MatrixXcd sums = Eigen::MatrixXcd::Zero(frequencies, 1 + columns);
    for (std::size_t w = 0; w < light.wavelengths_nm.size(); ++w) {
      const double nm = light.wavelengths_nm[w];
      const PupilReader reader(lens, nm, field, turn, detail);
      const auto pupil = reader.read(altered, places[p].x_mm, places[p].y_mm, ex, ey);
      if (!pupil) return {};
      const Cuts cuts(pupil->outline, ex, ey);
      const double whole = overlap(*pupil, cuts, 0, detail)[0].real();
      for (Eigen::Index k = 0; k < frequencies; ++k)
        sums.row(k) +=
            light.shares[w] / whole *
            overlap(*pupil, cuts,
                    nm * mm_per_nm * frequencies_cpmm[static_cast<std::size_t>(k)] / pupil->index, detail)
                .transpose();
    }
    for (Eigen::Index k = 0; k < frequencies; ++k) {
      const double modulus = std::abs(sums(k, 0));
      result.modulus[k] += places[p].share * modulus;
      for (Eigen::Index j = 0; j < columns && modulus > 0; ++j)
        result.slopes(k, j) += places[p].share * (std::conj(sums(k, 0)) * sums(k, 1 + j)).real() / modulus;
    }
  }
  return result;
}

}  // namespace petzval
