// SPDX-License-Identifier: BSD-3-Clause
// The colour of what scatters light below a surface.
#pragma once

namespace petzval::render {

/// The share of the light let into a half space that comes out of it again. It scatters evenly, below a
/// smooth boundary of relative index `eta` ≥ 1 on which light falls evenly from all sides. `albedo`: the
/// share of a collision that scatters, 0 to 1. The reflection function by H-functions, iterated in the form
/// of Bosma & de Rooij, Astron. Astrophys. 126 (1983) 283 (Chandrasekhar, Radiative Transfer, 1960, chapter
/// 5); between it and the boundary, light goes to and fro by a linear system.
double diffuse_albedo(double albedo, double eta);

/// The `albedo` that makes diffuse_albedo() this one. \param reflectance  0 to 1. \param g  mean cosine of
/// scattering, which counts by similarity: as much as what scatters evenly at the same absorption and reduced
/// scattering.
double scattering_albedo(double reflectance, double eta, double g);

}  // namespace petzval::render
