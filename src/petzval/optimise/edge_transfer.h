// SPDX-License-Identifier: BSD-3-Clause
// What a lens leaves of contrast across an edge at some place of the sensor, and how that changes with the
// lens.
#pragma once

#include <petzval/analysis/field_tracer.h>
#include <petzval/lens/lens.h>

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

namespace petzval {

/// An edge on the sensor.
struct SensorEdge {
  double x_mm = 0, y_mm = 0;          ///< its middle, in image space
  double normal_x = 1, normal_y = 0;  ///< unit vector across it
  double half_length_mm = 0;          ///< of what has been measured
};

/// Light in which edges are seen.
struct EdgeLight {
  std::vector<double> wavelengths_nm;
  std::vector<double> shares;  ///< one a wavelength; they sum to 1
};

/// How finely pupils are looked at.
struct EdgeDetail {
  int places = 3;  ///< along an edge: 1, or Gauss's 3, whose MTFs are averaged by their weights
  int radial_nodes = 10, azimuths = 96;  ///< of the rays
  int degree = 10;                    ///< of the polynomial that stands for the wave, more where it has to be
  int chords = 32, chord_nodes = 24;  ///< of the overlap

  static EdgeDetail quick() { return {1, 7, 32, 8, 14, 12}; }
};

/// The objects whose chief rays land on the places of an edge: fields as FieldTracer::landing_mm has them.
using EdgeObjects = std::vector<std::array<double, 2>>;

/// For a lens at one wavelength; `start` (empty: none) says where to begin. Nothing where no chief ray lands
/// there.
std::optional<EdgeObjects> objects_of(FieldTracer& tracer, const SensorEdge& edge, const EdgeDetail& detail,
                                      const EdgeObjects& start = {});

/// Contrast at some frequencies, and its derivatives.
struct EdgeTransfer {
  Eigen::VectorXd modulus;  ///< |OTF|, without a photosite
  Eigen::MatrixXd slopes;   ///< a row a frequency, a column for each altered lens: per step
};

/// |Σ share · OTF| along the normal of an edge, by the overlap of the pupil with itself; as the light of all
/// wavelengths falls on one sensor, lateral colour is in it. The wave is a polynomial through real rays,
/// amplitude included, inside the real vignetted outline.
/// \param altered  lenses that differ a little from `lens`, for derivatives: their waves along the rays
/// through the same places of the stop, by Hamilton's principle (∂φ = (∂OPL − n'(α ∂x + β ∂y))/λ at a fixed
/// direction); their pupils are taken to be as wide as those of `lens`, moved as a whole. Nothing where no
/// light passes. \throws InputError as FieldTracer.
std::optional<EdgeTransfer> edge_transfer(const Lens& lens, std::span<const Lens> altered,
                                          const SensorEdge& edge, const EdgeObjects& objects,
                                          const EdgeLight& light, std::span<const double> frequencies_cpmm,
                                          const EdgeDetail& detail = {});

}  // namespace petzval
