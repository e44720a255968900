// SPDX-License-Identifier: BSD-3-Clause
// Where an edge runs.
#pragma once

#include <petzval/measure/sfr/edge_samples.h>

#include <span>
#include <vector>

namespace petzval {

/// An edge: a straight line, or one bent by a polynomial of up to the fifth order.
struct EdgeLine {
  double centre_x = 0, centre_y = 0;  ///< a point of the line [pixels]
  double normal_rad = 0;              ///< direction from dark to bright, from +x towards +y
  double half_length = 1;             ///< of the samples along the edge [pixels]
  /// bend[k]: offset along the normal times (along/half_length)^(k + 1), k = 0 … order − 1.
  std::vector<double> bend;

  /// Coordinate along the edge over half_length; the normal turned by +90° is its direction.
  double along(double x, double y) const;
  /// Distance from the edge, positive on the bright side [pixels].
  double distance(double x, double y) const;
  /// The edge against the nearer pixel axis, −45 to 45 degrees, positive from +x towards +y (clockwise in the
  /// picture). For a bent edge, at its middle.
  double angle_deg() const;
  /// Of its curvature at its middle [pixels]; infinite for a straight line.
  double radius_px() const;
};

/// The coordinates of many places about a line.
class EdgeFrame {
 public:
  explicit EdgeFrame(const EdgeLine& line);
  struct Place {
    double along = 0, distance = 0;
  };
  /// EdgeLine::along() and EdgeLine::distance().
  Place at(double x, double y) const {
    const double dx = x - line_.centre_x, dy = y - line_.centre_y;
    const Place place{(dy * cos_ - dx * sin_) * per_half_length_, dx * cos_ + dy * sin_};
    return bent_ ? unbent(place) : place;
  }

 private:
  Place unbent(Place place) const;

  const EdgeLine& line_;
  double cos_, sin_, per_half_length_;
  bool bent_;
};

/// A first guess: line, width and levels of the straight edge with a logistic profile that fits the samples
/// best, by Levenberg-Marquardt from two starts, the structure of the gradient and the plane through all
/// values. Works for blurs as wide as the ROI.
struct EdgeGuess {
  EdgeLine line;
  double dark = 0, bright = 0;
  double scale_px = 1;  ///< of the logistic function: 10 % to 90 % takes 4.39 of it
  double rms_residual = 0;
};

/// \param spacing  of the sample lattice [pixels].
/// \throws InputError when no edge stands out: a step below four times the residual, or one that runs past
/// the samples.
EdgeGuess guess_edge(std::span<const EdgeSample> samples, double spacing);
/// The same from one start, a line that is known to within the blur.
EdgeGuess guess_edge(std::span<const EdgeSample> samples, const EdgeLine& start);

}  // namespace petzval
