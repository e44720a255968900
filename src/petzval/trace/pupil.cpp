// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/numeric/quadrature.h>
#include <petzval/trace/pupil.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

/// Boundaries are found to this share of their radius.
constexpr double boundary_tolerance = 1e-12;
/// An inner point nearer to an aperture than this is exchanged for a more central one.
constexpr double comfortable_clearance = -0.5;

class PupilSearch {
 public:
  PupilSearch(const Tracer& tracer, const Pencil& pencil, Tracer::Clip clip)
      : tracer_(tracer), pencil_(pencil), clip_(clip) {}

  double worst(double u, double v) const { return pencil_.clearance(tracer_, u, v, clip_).worst; }

  /// How far from the chief ray, in v, the rim of the stop lies to first order.
  double stop_scale(double chief_v) const {
    const double nudge = 1e-6 * std::max(1e-3, std::abs(chief_v));
    const auto above = pencil_.clearance(tracer_, 0, chief_v + nudge, Tracer::Clip::none);
    const auto below = pencil_.clearance(tracer_, 0, chief_v - nudge, Tracer::Clip::none);
    const double slope = (above.stop_y_mm - below.stop_y_mm) / (2 * nudge);
    return above.reached_stop && below.reached_stop && slope != 0 ? std::abs(tracer_.stop_radius_mm() / slope)
                                                                  : nudge;
  }

  /// The meridional ray that clears the apertures best: the clearance is quasi-convex along v, so a coarse
  /// scan and a golden section find it. Nothing if none passes.
  std::optional<double> best_centre(double chief_v, double scale) const {
    if (worst(0, chief_v) < comfortable_clearance) return chief_v;
    constexpr int steps = 60;
    double best = chief_v, best_worst = worst(0, chief_v);
    for (int i = -steps; i <= steps; ++i) {
      const double v = chief_v + 3.0 * scale * i / steps, w = worst(0, v);
      if (w < best_worst) {
        best = v;
        best_worst = w;
      }
    }
    double low = best - 3.0 * scale / steps, high = best + 3.0 * scale / steps;
    const double golden = 0.5 * (std::sqrt(5.0) - 1);
    for (int i = 0; i < 60; ++i) {
      const double a = high - golden * (high - low), b = low + golden * (high - low);
      (worst(0, a) < worst(0, b) ? high : low) = worst(0, a) < worst(0, b) ? b : a;
    }
    const double refined = 0.5 * (low + high);
    if (worst(0, refined) < best_worst) best = refined;
    if (worst(0, best) < 0) return best;
    return {};
  }

  /// Distance to the boundary from an inner point (0, v) along azimuth φ.
  double radius(double v, double azimuth, double guess) const {
    const double du = std::sin(azimuth), dv = std::cos(azimuth);
    const auto at = [&](double r) { return worst(r * du, v + r * dv); };
    double inside = 0, outside = guess;
    double worst_inside = at(0.0), worst_outside = at(outside);
    for (int i = 0; worst_outside < 0 && i < 200; ++i) {
      inside = outside;
      worst_inside = worst_outside;
      outside *= 1.3;
      worst_outside = at(outside);
    }
    return refine(at, inside, worst_inside, outside, worst_outside);
  }

 private:
  /// The Illinois form of false position, with bisection while the outer value is infinite or progress
  /// stalls.
  template <class F>
  static double refine(const F& at, double inside, double worst_inside, double outside,
                       double worst_outside) {
    int side = 0;
    for (int i = 0; i < 200 && outside - inside > boundary_tolerance * outside; ++i) {
      double next = 0.5 * (inside + outside);
      if (std::isfinite(worst_outside) && i % 8 != 7)
        next = (inside * worst_outside - outside * worst_inside) / (worst_outside - worst_inside);
      if (!(next > inside && next < outside)) next = 0.5 * (inside + outside);
      if (next == inside || next == outside) break;
      const double value = at(next);
      if (value < 0) {
        inside = next;
        worst_inside = value;
        if (side == -1) worst_outside *= 0.5;
        side = -1;
      } else {
        if (value == 0) return next;
        outside = next;
        worst_outside = value;
        if (side == 1) worst_inside *= 0.5;
        side = 1;
      }
    }
    return inside;
  }

  const Tracer& tracer_;
  const Pencil& pencil_;
  Tracer::Clip clip_;
};

}  // namespace

double PupilBoundary::azimuth(std::size_t i) const {
  return 2 * pi * (static_cast<double>(i) + 0.5) / static_cast<double>(radius.size());
}

double PupilBoundary::area() const {
  double sum = 0;
  for (const double r : radius) sum += r * r;
  return sum * pi / static_cast<double>(radius.size());
}

std::optional<PupilBoundary> find_pupil(const Tracer& tracer, const Pencil& pencil, double chief_v,
                                        int azimuths, Tracer::Clip clip) {
  if (azimuths < 8 || azimuths % 2 != 0)
    throw InputError("a pupil boundary needs an even number of azimuths, 8 or more");
  const PupilSearch search(tracer, pencil, clip);
  const double scale = search.stop_scale(chief_v);
  const std::optional<double> centre = search.best_centre(chief_v, scale);
  if (!centre) return {};
  PupilBoundary boundary;
  boundary.centre_v = *centre;
  boundary.chief_v = chief_v;
  const auto count = static_cast<std::size_t>(azimuths);
  boundary.radius.resize(count);
  double guess = scale;
  for (std::size_t i = 0; i < count / 2; ++i) {
    const double found = search.radius(*centre, boundary.azimuth(i), guess);
    boundary.radius[i] = boundary.radius[count - 1 - i] = found;
    guess = found > 0 ? found * 1.02 : scale;
  }
  return boundary;
}

std::vector<PupilNode> half_pupil_nodes(const PupilBoundary& boundary, int radial_nodes) {
  const QuadratureRule radial = gauss_legendre(radial_nodes);
  const std::size_t azimuths = boundary.radius.size();
  const double step = 2 * pi / static_cast<double>(azimuths);
  std::vector<PupilNode> nodes;
  nodes.reserve(azimuths / 2 * radial.nodes.size());
  for (std::size_t i = 0; i < azimuths / 2; ++i) {
    const double rim = boundary.radius[i], azimuth = boundary.azimuth(i);
    for (std::size_t k = 0; k < radial.nodes.size(); ++k) {
      const double r = rim * radial.nodes[k];
      nodes.push_back({r * std::sin(azimuth), boundary.centre_v + r * std::cos(azimuth),
                       r * rim * radial.weights[k] * step});
    }
  }
  return nodes;
}

}  // namespace petzval
