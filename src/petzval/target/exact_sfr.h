// SPDX-License-Identifier: BSD-3-Clause
// The true response along the edges of a target.
#pragma once

#include <petzval/target/render_target.h>

#include <cstddef>
#include <string>
#include <vector>

namespace petzval {

/// An edge of a polygon, both counted from 1, and the SFR across it at 0, 0.01, … 1 cycles/pixel: signed
/// where the transfer function is real, so that reversed contrast is negative.
struct ExactSfr {
  std::size_t polygon = 0, edge = 0;
  double angle_deg = 0, length_px = 0;
  std::vector<double> sfr;
};

/// Of all edges, in order. \throws InputError for more than 20,000 edges; Cancelled.
std::vector<ExactSfr> exact_sfr(const TargetScene& scene, const Otf& otf, const TargetOptions& options);

/// A row for every edge and frequency: polygon, edge, angle_deg, length_px, frequency_cpp, sfr.
std::string exact_sfr_csv(const std::vector<ExactSfr>& edges);

/// The lowest frequency at which edges along the grid keep half their contrast, to 1e-4; 4 if there is none
/// below [cycles/pixel].
double mtf50_cpp(const Otf& otf, const TargetOptions& options);

}  // namespace petzval
