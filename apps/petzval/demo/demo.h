// SPDX-License-Identifier: BSD-3-Clause
// The 2005 paper again, figure by figure. Each function below makes one section of the page and its files.
#pragma once

#include <petzval/base/progress.h>
#include <petzval/base/staged_files.h>
#include <petzval/image/spectral_image.h>
#include <petzval/imaging/image_formation.h>
#include <petzval/lens/lens.h>
#include <petzval/optics/build.h>
#include <petzval/report/html.h>
#include <petzval/report/svg_plot.h>
#include <petzval/scene/scene.h>
#include <petzval/sensor/sensor.h>

#include <string>
#include <vector>

namespace petzval::app {

/// The wavelength of the paper's monochromatic figures.
inline constexpr double paper_wavelength_nm = 587.5618;
/// Fig. 4: the 1/3 inch sensor.
inline constexpr SensorGeometry third_inch_sensor{768, 576, 6.25};

/// What the sections share.
struct Demo {
  std::string folder;
  StagedFiles& files;  ///< of the folder: they appear when all are made
  std::string scene;   ///< of the multispectral figure: a chart's name or a file
  Lens edmund, fisheye;
  html::Page page;
  ProgressCallback progress;  ///< of the section at work

  /// Writes a file of the page and returns its link.
  std::string write(const std::string& name, const std::string& bytes) const;
  /// Writes an image as PNG and as a figure of the page.
  html::Image picture(const std::string& name, const SpectralImage& image, const std::string& description,
                      const Scene* scene = nullptr) const;
};

/// An image, and what it took.
struct Formed {
  SpectralImage image;
  ImagingReport report;
  double seconds = 0;
};
Formed form(const Demo& demo, const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
            const ImagingOptions& options);

/// Full horizontal angle [deg] of a plane that the corners of a sensor see through a lens data table, and
/// `spare` times more.
double covering_angle_deg(const LensDataTable& table, const SensorGeometry& sensor, double spare);
/// From the plane of the table to the sensor [m]; absent: infinity.
std::optional<double> scene_distance_m(const LensDataTable& table);

/// The text with true minus signs.
std::string with_minus(std::string text);

void layout_section(Demo& demo);                                    ///< Fig. 5 and first-order data
void distortion_section(Demo& demo, const LensDataTable& table);    ///< Fig. 6
void illumination_section(Demo& demo, const LensDataTable& table);  ///< Figs. 7 and 8
void psf_section(Demo& demo);                                       ///< Fig. 9
void checkerboard_section(Demo& demo, const LensDataTable& table);  ///< Figs. 10 and 11
void multispectral_section(Demo& demo);                             ///< Figs. 12 and 13
void altered_lens_section(Demo& demo);                              ///< what the abstract promises

}  // namespace petzval::app
