// SPDX-License-Identifier: BSD-3-Clause
// The rows of analyses as tables: what the program prints, its JSON names, and the data behind each plot.
#pragma once

#include <petzval/analysis/aberration_fans.h>
#include <petzval/analysis/chromatic.h>
#include <petzval/analysis/distortion_grid.h>
#include <petzval/analysis/encircled_energy.h>
#include <petzval/analysis/field_curvature.h>
#include <petzval/analysis/field_tables.h>
#include <petzval/analysis/footprints.h>
#include <petzval/analysis/ghosts.h>
#include <petzval/analysis/mtf.h>
#include <petzval/analysis/polarisation.h>
#include <petzval/analysis/seidel.h>
#include <petzval/analysis/spot_diagram.h>
#include <petzval/analysis/spots.h>
#include <petzval/analysis/tv_distortion.h>
#include <petzval/analysis/vignetting.h>
#include <petzval/analysis/wavefront.h>
#include <petzval/analysis/wavefront_zernike.h>
#include <petzval/report/table.h>

#include <vector>

namespace petzval {

/// One table row an analysis row, first its field and wavelength (0, all wavelengths together: a gap).
Table tabulate(Fields::Kind kind, const std::vector<SpotRow>& rows);
Table tabulate(Fields::Kind kind, const std::vector<WavefrontRow>& rows);
Table tabulate(Fields::Kind kind, const std::vector<MtfRow>& rows);
Table tabulate(Fields::Kind kind, const std::vector<DistortionRow>& rows);
Table tabulate(const std::vector<TvDistortion>& rows);
Table tabulate(const DistortionGrid& grid);
/// Outlines point by point.
Table tabulate(Fields::Kind kind, const std::vector<Footprint>& footprints);
Table tabulate(Fields::Kind kind, const std::vector<IlluminationRow>& rows);
Table tabulate(Fields::Kind kind, const std::vector<FieldCurvatureRow>& rows);
Table tabulate(Fields::Kind kind, const std::vector<LateralColourRow>& rows);
Table tabulate(Fields::Kind kind, const std::vector<VignettingRow>& rows);
Table tabulate(Fields::Kind kind, const std::vector<ChiefRayAngleRow>& rows);
Table tabulate(Fields::Kind kind, const std::vector<PolarisationRow>& rows);
Table tabulate(Fields::Kind kind, const std::vector<EncircledEnergyRow>& rows);

/// One row a point, a term or a sample.
Table tabulate(Fields::Kind kind, const std::vector<AberrationFans>& rows);
Table tabulate(Fields::Kind kind, const std::vector<SpotDiagram>& rows);
Table tabulate(Fields::Kind kind, const std::vector<WavefrontMap>& rows);
Table tabulate(Fields::Kind kind, const std::vector<WavefrontZernikeRow>& rows, ZernikeOrder order);

Table tabulate(const std::vector<AxialFocusRow>& rows);
/// \param sensor  the index of its surface, which is called so.
Table tabulate(const std::vector<Ghost>& rows, std::size_t sensor);
/// A row a surface, then the sum.
Table tabulate(const SeidelSums& sums);

}  // namespace petzval
