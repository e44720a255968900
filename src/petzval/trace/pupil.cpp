// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/numeric/quadrature.h>
#include <petzval/trace/clearance_batch.h>
#include <petzval/trace/pupil.h>
#include <petzval/trace/stop_corners.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace petzval {

namespace {

/// Boundaries are found to this share of their radius.
constexpr double boundary_tolerance = 1e-12;
/// An inner point nearer to an aperture than this is exchanged for a more central one.
constexpr double comfortable_clearance = -0.5;
/// Factor by which the search goes outwards until it has passed the boundary.
constexpr double growth = 1.3;
constexpr int most_rounds = 400;
/// For the first look, which finds the stretch.
constexpr int first_azimuths = 16;
constexpr double widest_stretch = 100;

class PupilSearch {
 public:
  /// \param u  of the rays that are looked at: the chief ray's.
  PupilSearch(const Tracer& tracer, const Pencil& pencil, Tracer::Clip clip, double u)
      : tracer_(tracer), pencil_(pencil), clip_(clip), u_(u) {}

  double worst(double v) const { return pencil_.clearance(tracer_, u_, v, clip_).worst; }

  /// The meridional ray that clears the apertures best: the clearance is quasi-convex along v, so a coarse
  /// scan and a golden section find it. Nothing if none passes.
  std::optional<double> best_centre(double chief_v, double scale, ClearanceBatch& clearances) const {
    double best = chief_v, best_worst = worst(chief_v);
    if (best_worst < comfortable_clearance) return chief_v;
    constexpr int steps = 60;
    std::vector<double> v;
    for (int i = -steps; i <= steps; ++i) v.push_back(chief_v + 3.0 * scale * i / steps);
    const std::vector<double> u(v.size(), u_);
    std::vector<double> scanned(v.size());
    clearances.measure(u, v, scanned);
    for (std::size_t i = 0; i < v.size(); ++i)
      if (scanned[i] < best_worst) {
        best = v[i];
        best_worst = scanned[i];
      }
    double low = best - 3.0 * scale / steps, high = best + 3.0 * scale / steps;
    constexpr int section_steps = 40;  // to 1e-8 of the interval: any inner point will do
    const double golden = 0.5 * (std::sqrt(5.0) - 1);
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double at_a = worst(a), at_b = worst(b);
    for (int i = 0; i < section_steps; ++i) {
      if (at_a < at_b) {
        high = std::exchange(b, a);
        at_b = at_a;
        a = high - golden * (high - low);
        at_a = worst(a);
      } else {
        low = std::exchange(a, b);
        at_a = at_b;
        b = low + golden * (high - low);
        at_b = worst(b);
      }
    }
    const double refined = 0.5 * (low + high);
    if (worst(refined) < best_worst) best = refined;
    if (worst(best) < 0) return best;
    return {};
  }

 private:
  const Tracer& tracer_;
  const Pencil& pencil_;
  Tracer::Clip clip_;
  double u_;
};

/// The boundary along one azimuth, closed in on from both sides.
struct Bracket {
  double sine, cosine;
  double inside = 0, outside, worst_inside, worst_outside;
  int last_side = 0;
  bool bracketed = false;

  bool done() const { return bracketed && !(outside - inside > boundary_tolerance * outside); }
  /// Where to look next: farther out while the boundary is not passed, then by the Illinois form of false
  /// position, with bisection while the outer value is infinite and every eighth time.
  double next(int round) const {
    if (!bracketed) return outside;
    const double middle = 0.5 * (inside + outside);
    if (!std::isfinite(worst_outside) || round % 8 == 7) return middle;
    const double crossing =
        (inside * worst_outside - outside * worst_inside) / (worst_outside - worst_inside);
    return crossing > inside && crossing < outside ? crossing : middle;
  }
  void look(double radius, double worst) {
    if (!bracketed) {
      bracketed = !(worst < 0);
      if (bracketed) {
        worst_outside = worst;
      } else {
        inside = radius;
        worst_inside = worst;
        outside = growth * radius;
      }
      return;
    }
    // A middle that is one of the ends: there is nothing between them.
    if (radius == inside || radius == outside)
      outside = inside;
    else if (worst < 0) {
      inside = radius;
      worst_inside = worst;
      if (last_side == -1) worst_outside *= 0.5;
      last_side = -1;
    } else {
      outside = radius;
      worst_outside = worst;
      if (last_side == 1) worst_inside *= 0.5;
      last_side = 1;
    }
  }
};

/// All azimuths in lockstep, so that their rays fill the lanes.
void close_in(std::vector<Bracket>& brackets, double centre_u, double centre_v, ClearanceBatch& clearances) {
  std::vector<double> u, v, radius, worst;
  std::vector<std::size_t> open;
  for (int round = 0; round < most_rounds; ++round) {
    u.clear(), v.clear(), radius.clear(), open.clear();
    for (std::size_t i = 0; i < brackets.size(); ++i) {
      if (brackets[i].done()) continue;
      open.push_back(i);
      radius.push_back(brackets[i].next(round));
      u.push_back(centre_u + radius.back() * brackets[i].sine);
      v.push_back(centre_v + radius.back() * brackets[i].cosine);
    }
    if (open.empty()) return;
    worst.resize(open.size());
    clearances.measure(u, v, worst);
    for (std::size_t k = 0; k < open.size(); ++k) brackets[open[k]].look(radius[k], worst[k]);
  }
}

double even_azimuth(std::size_t i, std::size_t count) {
  return 2 * pi * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
}

}  // namespace

double PupilBoundary::azimuth(std::size_t i) const {
  const double even = mirrored() ? even_azimuth(i, radius.size()) : turns[i];
  const double azimuth = std::atan2(stretch * std::sin(even), std::cos(even));
  return azimuth < 0 ? azimuth + 2 * pi : azimuth;
}

std::array<double, 2> PupilBoundary::rim(std::size_t i) const {
  const double turn = azimuth(i);
  return {centre_u + radius[i] * std::sin(turn), centre_v + radius[i] * std::cos(turn)};
}

double PupilBoundary::azimuth_weight(std::size_t i) const {
  const double even = mirrored() ? even_azimuth(i, radius.size()) : turns[i];
  const double step = mirrored() ? 2 * pi / static_cast<double>(radius.size()) : turn_weights[i];
  const double sine = stretch * std::sin(even), cosine = std::cos(even);
  return stretch / (sine * sine + cosine * cosine) * step;
}

double PupilBoundary::area() const {
  double sum = 0;
  for (std::size_t i = 0; i < radius.size(); ++i) sum += 0.5 * radius[i] * radius[i] * azimuth_weight(i);
  return sum;
}

namespace {

/// Finds the boundary around boundary.centre_v, with boundary.stretch. `guess` is where each search begins.
void find_radii(std::size_t azimuths, double worst_at_centre, double guess, ClearanceBatch& clearances,
                PupilBoundary& boundary) {
  boundary.radius.resize(azimuths);
  std::vector<Bracket> brackets(boundary.own());
  for (std::size_t i = 0; i < brackets.size(); ++i) {
    const double azimuth = boundary.azimuth(i);
    brackets[i] = {std::sin(azimuth), std::cos(azimuth), 0, guess, worst_at_centre, 0};
  }
  close_in(brackets, boundary.centre_u, boundary.centre_v, clearances);
  for (std::size_t i = 0; i < brackets.size(); ++i) {
    boundary.radius[i] = brackets[i].inside;
    if (boundary.mirrored()) boundary.radius[azimuths - 1 - i] = brackets[i].inside;
  }
}

/// Width along u over height along v of a boundary.
double stretch_of(const PupilBoundary& boundary) {
  double right = 0, left = 0, high = -1e300, low = 1e300;
  for (std::size_t i = 0; i < boundary.own(); ++i) {
    const double azimuth = boundary.azimuth(i);
    right = std::max(right, boundary.radius[i] * std::sin(azimuth));
    left = boundary.mirrored() ? -right : std::min(left, boundary.radius[i] * std::sin(azimuth));
    high = std::max(high, boundary.radius[i] * std::cos(azimuth));
    low = std::min(low, boundary.radius[i] * std::cos(azimuth));
  }
  const double stretch = (right - left) / (high - low);
  return std::isfinite(stretch) ? std::clamp(stretch, 1 / widest_stretch, widest_stretch) : 1;
}

/// Evenly, all round.
void set_even_turns(int azimuths, PupilBoundary& boundary) {
  const auto count = static_cast<std::size_t>(azimuths);
  boundary.turn_weights.assign(count, 2 * pi / azimuths);
  for (std::size_t i = 0; i < count; ++i) boundary.turns.push_back(even_azimuth(i, count));
}

/// From corner to corner of the polygon, in Gauss-Legendre nodes. Corners that no ray of the pencil reaches
/// part nothing.
void set_turns(const Tracer& tracer, const Pencil& pencil, double scale, int azimuths,
               PupilBoundary& boundary) {
  if (tracer.stop_blades().count == 0) return set_even_turns(azimuths, boundary);
  std::vector<double> corners;
  for (const auto& [u, v] : aim_at_corners(tracer, pencil, {boundary.chief_u, boundary.chief_v}, scale)) {
    const double turn = std::atan2((u - boundary.centre_u) / boundary.stretch, v - boundary.centre_v);
    corners.push_back(turn < 0 ? turn + 2 * pi : turn);
  }
  std::sort(corners.begin(), corners.end());
  if (corners.empty()) corners.push_back(0);
  corners.push_back(corners.front() + 2 * pi);
  constexpr int fewest_nodes = 6;
  const int panels = static_cast<int>(corners.size()) - 1;
  for (int panel = 0; panel < panels; ++panel) {
    const auto p = static_cast<std::size_t>(panel);
    // Long panels, where corners were not found, get their share.
    const double share = (corners[p + 1] - corners[p]) / (2 * pi);
    const int nodes = std::max(fewest_nodes, static_cast<int>(std::ceil(azimuths * share)));
    const QuadratureRule rule = gauss_legendre(nodes, corners[p], corners[p + 1]);
    boundary.turns.insert(boundary.turns.end(), rule.nodes.begin(), rule.nodes.end());
    boundary.turn_weights.insert(boundary.turn_weights.end(), rule.weights.begin(), rule.weights.end());
  }
}

}  // namespace

std::optional<PupilBoundary> find_pupil(const Tracer& tracer, const Pencil& pencil, double chief_v,
                                        int azimuths, Tracer::Clip clip, double chief_u) {
  if (azimuths < 8 || azimuths % 2 != 0)
    throw InputError("a pupil boundary needs an even number of azimuths, 8 or more");
  const PupilSearch search(tracer, pencil, clip, chief_u);
  const double scale = pupil_scale(tracer, pencil, {chief_u, chief_v});
  ClearanceBatch clearances(tracer, pencil, clip);
  const std::optional<double> centre = search.best_centre(chief_v, scale, clearances);
  if (!centre) return {};
  PupilBoundary boundary;
  boundary.centre_u = boundary.chief_u = chief_u;
  boundary.centre_v = *centre;
  boundary.chief_v = chief_v;
  const double worst_at_centre = search.worst(*centre);
  const bool whole = (tracer.stop_blades().count > 0 && clip != Tracer::Clip::none) || !tracer.is_centred();
  if (whole) set_turns(tracer, pencil, scale, first_azimuths, boundary);
  find_radii(whole ? boundary.turns.size() : first_azimuths, worst_at_centre, scale, clearances, boundary);
  boundary.stretch = stretch_of(boundary);
  boundary.turns.clear(), boundary.turn_weights.clear();
  const double guess = *std::max_element(boundary.radius.begin(), boundary.radius.end());
  if (whole) set_turns(tracer, pencil, scale, azimuths, boundary);
  find_radii(whole ? boundary.turns.size() : static_cast<std::size_t>(azimuths), worst_at_centre,
             guess > 0 ? guess : scale, clearances, boundary);
  return boundary;
}

std::vector<PupilNode> pupil_nodes(const PupilBoundary& boundary, int radial_nodes) {
  const QuadratureRule radial = gauss_legendre(radial_nodes);
  const double stands_for = boundary.mirrored() ? 2 : 1;
  std::vector<PupilNode> nodes;
  nodes.reserve(boundary.own() * radial.nodes.size());
  for (std::size_t i = 0; i < boundary.own(); ++i) {
    const double rim = boundary.radius[i], azimuth = boundary.azimuth(i);
    const double step = boundary.azimuth_weight(i);
    for (std::size_t k = 0; k < radial.nodes.size(); ++k) {
      const double r = rim * radial.nodes[k];
      nodes.push_back({boundary.centre_u + r * std::sin(azimuth), boundary.centre_v + r * std::cos(azimuth),
                       stands_for * (r * rim * radial.weights[k] * step)});
    }
  }
  return nodes;
}

}  // namespace petzval
