// SPDX-License-Identifier: BSD-3-Clause
// Whether samples show an edge, or light that changes smoothly.
#pragma once

#include <petzval/measure/sfr/edge_alignment.h>
#include <petzval/measure/sfr/edge_samples.h>

#include <span>
#include <vector>

namespace petzval {

/// How many of the residuals on a lattice of pixels are worth as much as independent ones: their number over
/// the integrated autocorrelation times along rows and columns, each summed until it is no longer positive
/// (after C. J. Geyer, Statistical Science 7, 473, 1992). \param spacing  of the lattice [pixels].
double independent_samples(std::span<const EdgeSample> residuals, int spacing);

/// Twice the logarithm of the odds of the fitted edge against light without one, by the Bayesian information
/// criterion (G. Schwarz, Ann. Statist. 6, 461, 1978). Light without an edge is a polynomial of place, up to
/// the fifth order, with as many terms as explain the samples best. \param unknowns  of the edge that the
/// samples settle. \param enough  where more of it is not needed, which a part of the samples may show.
double edge_evidence(const EdgeProfile& profile, const std::vector<EdgeSample>& samples, int spacing,
                     double unknowns, double enough);

}  // namespace petzval
