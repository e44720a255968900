// SPDX-License-Identifier: BSD-3-Clause
// The geometry of a surface, whatever its kind: what drawings, reports, checks and paraxial optics ask for.
#pragma once

#include <petzval/lens/lens.h>
#include <petzval/lens/shapes/shape_data.h>

#include <string>
#include <vector>

namespace petzval {

/// The shape made ready for evaluation; powers of r in mm. Terms that are zero do not count. \throws
/// InputError for a kind that is none.
ShapeData<double> shape_of(const Surface& surface);

/// Sag and slopes at a place [mm]; NaN beyond the rim.
SurfacePoint<double> surface_point(const ShapeData<double>& shape, double x_mm, double y_mm);

/// The largest height at which there is a surface [mm]: that of the conic, or infinity.
double rim_mm(const ShapeData<double>& shape);

/// A plane, with nothing besides.
bool is_flat(const Surface& surface);
/// A sphere or a plane.
bool is_spherical(const Surface& surface);

/// Principal curvatures [1/mm] of a round surface at a distance r from the axis: in the meridian and across
/// it.
struct PrincipalCurvatures {
  double meridional, sagittal;
};
PrincipalCurvatures principal_curvatures(const ShapeData<double>& shape, double r_mm);

/// The sag of a surface near its vertex, of one that is not round along y, C r²/2 + G r⁴/8. A term in r, a
/// cone, has no paraxial limit and is left out, as other programs do.
struct VertexSeries {
  double curvature_per_mm, fourth_per_mm3;
};
VertexSeries vertex_series(const Surface& surface);
double vertex_curvature_per_mm(const Surface& surface);

/// The surface with all lengths multiplied by a factor: shape, gap and clear aperture.
Surface scaled_surface(Surface surface, double factor);

/// What the shape has beside its radius, for tables: "conic -0.6", "r^4 1e-05", "qcon", ….
std::vector<std::string> shape_remarks(const Surface& surface);

}  // namespace petzval
