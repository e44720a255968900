// SPDX-License-Identifier: BSD-3-Clause
// How much light a smooth boundary reflects.
#pragma once

namespace petzval::render {

/// Of unpolarised light on a boundary of relative index `eta` (far side / near side), `cos_incident` ≥ 0; 1
/// at total reflection. (Born & Wolf, Principles of Optics, 7th ed., section 1.5.)
double dielectric_reflectance(double cos_incident, double eta);

/// The same of a metal of relative index eta + i k.
double conductor_reflectance(double cos_incident, double eta, double k);

/// ∫ 2 F(cos) cos dcos: what diffuse light is reflected by.
double mean_dielectric_reflectance(double eta);

}  // namespace petzval::render
