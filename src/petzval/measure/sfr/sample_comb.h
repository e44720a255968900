// SPDX-License-Identifier: BSD-3-Clause
// Edges along the pixel grid or its diagonals, whose samples lie at few distances.
#pragma once

#include <petzval/measure/sfr/edge_spread_model.h>

#include <span>
#include <vector>

namespace petzval {

/// The widest stretch [pixels] without a sample within 3 pixels of the edge.
double widest_gap_px(std::span<const EdgePoint> points);

/// The widest step [pixels] between rows of samples that all lie at nearly the same distances from an edge; 0
/// where the distances fill a tenth or more of the pixels.
double sample_comb_px(std::span<const EdgePoint> points);

/// Gives samples whose distances differ by less than a fiftieth of a pixel all the mean of them: over so
/// little, what differs between their values is anything but the slope of the edge.
void join_rows(std::vector<EdgePoint>& points);

/// What rows of samples cannot tell from a frequency is its alias. How much of it there is they do not say;
/// the fitted response half-way between the two, falling from there with the third power, is taken as its
/// standard deviation. 0 without a comb and at frequency 0.
double alias_deviation(const EdgeSpreadModel& model, double comb_px, double frequency_cpp);

}  // namespace petzval
