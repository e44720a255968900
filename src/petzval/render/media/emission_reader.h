// SPDX-License-Identifier: BSD-3-Clause
// Media that shine, from their descriptions.
#pragma once

#include <petzval/render/lights/light_options.h>
#include <petzval/render/media/emission.h>
#include <petzval/render/media/grid_reader.h>

namespace petzval::render {

/// What a medium sends out, if anything. \param box  of a grid; null: homogeneous. \throws InputError with
/// file, line and column, and through `unsupported`.
std::shared_ptr<Emission> read_emission(const Parameters& parameters, const GridBox* box,
                                        const WavelengthGroups& groups, const LightOptions& options,
                                        Unsupported& unsupported);

/// The same of a "rgbgrid", which has "Le" as colours: D65 times each, as pbrt-v4 scales it.
std::shared_ptr<Emission> read_colour_emission(const Parameters& parameters, const GridBox& box,
                                               const WavelengthGroups& groups, const LightOptions& options);

}  // namespace petzval::render
