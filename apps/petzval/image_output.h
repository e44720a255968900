// SPDX-License-Identifier: BSD-3-Clause
// What `image` writes and tells.
#pragma once

#include <petzval/image/formats/npy_bands.h>
#include <petzval/simulate/image.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include <petzval/simulate/outputs.h>

#include "flare_option.h"

namespace petzval::app {

/// An image, and what it was made of.
struct FormedImage {
  ImagePlan plan;
  ImageReport report;
  std::optional<SpectralImage> light;  ///< where the file does not hold it already
  std::optional<NpyBandFile> file;     ///< as large_file() made it
};

/// A single .npy file of an image that is large: its bands go there as they are formed.
std::optional<NpyBandFile> large_file(const std::vector<std::string>& outputs, const ImagePlan& plan);

/// Writes everything that was asked for.
Outputs write_image(const std::vector<std::string>& paths, const FlareChoice& flare, FormedImage& image,
                    const std::optional<Sensor>& sensor, const OutputOptions& options,
                    const Context& context);

nlohmann::ordered_json summary_json(const FormedImage& image, const Outputs& made,
                                    const std::vector<std::string>& outputs);
void print_summary(const FormedImage& image, const Outputs& made);

}  // namespace petzval::app
