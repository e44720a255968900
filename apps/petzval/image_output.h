// SPDX-License-Identifier: BSD-3-Clause
// What `image` writes and tells.
#pragma once

#include <petzval/image/formats/npy_bands.h>
#include <petzval/imaging/image_formation.h>
#include <petzval/optics/lens_data_table.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "image_option.h"

namespace petzval::app {

/// An image, and what it was made of.
struct FormedImage {
  SensorGeometry frame;
  std::optional<SpectralImage> light;  ///< where the file does not hold it already
  std::optional<NpyBandFile> file;     ///< as large_file() made it
  Scene scene;
  LensDataTable table;
  ImagingReport report;
  std::string method;  ///< method_text
};

/// How the image was blurred, in a line.
std::string method_text(const ImagingOptions& options, const ImagingReport& report);

/// Where the scene stands.
std::string distance_text(const Scene& scene);

/// A file for the bands of a large image whose one output it is, while they are made: where that cannot be,
/// absent. \throws Failure if there is no room for it.
std::optional<NpyBandFile> large_file(const std::vector<std::string>& outputs, const SensorGeometry& frame,
                                      const Scene& scene);

/// Writes all outputs or none of them, and gives up the values of the light, but nothing else of the image.
/// \return what the sensor made of the light, if it was asked to.
std::optional<Shot> write_outputs(const ImageChoice& choice, FormedImage& image,
                                  const std::optional<Sensor>& sensor, const Shared& shared);

nlohmann::ordered_json summary_json(const FormedImage& image, const std::optional<Shot>& shot,
                                    const std::vector<std::string>& outputs);

void print_summary(const FormedImage& image, const std::optional<Shot>& shot);

}  // namespace petzval::app
