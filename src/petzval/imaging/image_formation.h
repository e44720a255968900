// SPDX-License-Identifier: BSD-3-Clause
// From a planar scene through a lens data table to the irradiance on a sensor.
#pragma once

#include <petzval/base/progress.h>
#include <petzval/image/spectral_image.h>
#include <petzval/imaging/distortion.h>
#include <petzval/imaging/pixel_gather.h>
#include <petzval/imaging/product_plan.h>
#include <petzval/imaging/psf_kernel.h>
#include <petzval/imaging/scene_aim.h>
#include <petzval/imaging/section_blur.h>
#include <petzval/imaging/source_light.h>
#include <petzval/optics/lens_data_table.h>
#include <petzval/optics/table_interpolation.h>
#include <petzval/scene/scene.h>
#include <petzval/sensor/sensor.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace petzval {

struct FormationMemory;

enum class BlurMethod {
  none,      ///< distortion and illumination alone
  product,   ///< mixtures of kernels by tiles, as many as the tolerance needs: fast, the default
  sections,  ///< one PSF a section, by Fourier transform: the paper's
  blended,   ///< the same with sections that fade into each other: no seams
  exact      ///< one PSF a cell, added up directly
};

struct ImagingOptions {
  BlurMethod method = BlurMethod::product;
  ProductOptions product = {};
  SectionOptions sections = {};  ///< `blend` follows from the method
  PsfInterpolation interpolation = PsfInterpolation::psf;
  RadialFit fit = {};  ///< of distortion and g_source over image height
  /// S: source cells are S × S to a pixel, 1 to most_cells; 0: as many as the tolerance needs (choose_cells).
  int supersample = 0;
  static constexpr int most_cells = 16;
  Surround surround = Surround::error;
  Photosite photosite = {};  ///< of the sensor, with its optical low-pass filter
  /// Of `product`: where a PSF reaches farther than twice so many pixels, the light beyond that many is
  /// formed by itself, on pixels that are wider (tail_coarseness()); 0: nowhere.
  int tail_pixels = 16;

  /// S; as long as it is not chosen 1, with which a frame needs the widest margin; without blur what the
  /// photosite needs.
  int cells_per_pixel() const {
    constexpr int of_a_photosite = 3;
    if (supersample != 0) return supersample;
    return method == BlurMethod::none && !photosite.is_plain() ? of_a_photosite : 1;
  }
  /// The cells whose light makes the pixels of a sensor: S × S to a pixel, and those about the frame that its
  /// pixels share in.
  SensorGeometry cells_of(const SensorGeometry& sensor) const;
  /// Whether the tolerance lets a picture be formed of less: one cell a pixel, coarser kernels, fewer PSFs.
  bool is_preview() const { return method == BlurMethod::product && product.tolerance >= of_a_preview; }
  static constexpr double of_a_preview = 5e-3;
  bool by_sections() const { return method == BlurMethod::sections || method == BlurMethod::blended; }
  /// The sections of the method.
  SectionOptions section_options() const;
  /// \throws InputError saying what would be right.
  void validate() const;
};

/// What there is to say about an image that was formed.
struct ImagingReport {
  /// Things a user should know, one line each: how the edges were treated, dark corners, light outside the
  /// PSF windows, undershoot.
  std::vector<std::string> notes = {};
  int cells_per_pixel = 1;  ///< along a side
  int margin_cells = 0;     ///< how far light may come in from outside the frame, the most of all bands
  int transform_size = 0;   ///< the largest, of `sections`
  /// Of `product`: what was chosen, for the band whose estimated error is the largest; a plan without a
  /// transform that is not direct stands for blended sections of `tile` cells, which PSFs beyond its
  /// transforms need.
  ProductPlan product = {};
  int scene_points_per_cell = 1;  ///< parts of a cell whose means over the scene are taken: this squared
  double sampling_error = 0;      ///< of the cells, estimated for the middle band
  /// Light farther from its chief ray than this was formed on coarser pixels [pixels]; 0: none was.
  int tail_pixels = 0;
  double table_error = 0;  ///< LensDataTable::interpolation_error
  /// Relative L2 error of the picture, of table, cells and blur together: ProductPlan::estimated_error.
  double estimated_error() const { return std::hypot(table_error, sampling_error, product.estimated_error); }
  double least_captured = 1;          ///< the least share of light that a PSF window in use holds
  double brightest = 0, darkest = 0;  ///< [W·m⁻²·nm⁻¹]
  /// What the steps took; of bands that were formed side by side, their shares of the time that all took.
  double distortion_seconds = 0, blur_seconds = 0;
  double kernel_seconds = 0;  ///< of `blur_seconds`, what `product` took to plan and to make its kernels
};

/// The bands that this process forms, where several share an image. All of them are planned by each, for a
/// band's plan follows that of the one before.
struct BandShare {
  int first = 0, end = std::numeric_limits<int>::max();
  /// Puts the pixels of a band that another has formed into a plane; absent: such bands are left out.
  std::function<void(int band, std::span<float> pixels)> known = {};

  bool has(std::size_t band) const { return static_cast<int>(band) >= first && static_cast<int>(band) < end; }
};

/// Forms the image, band by band, or several bands side by side if there are threads and memory for them
/// (Maeda, Catrysse & Wandell 2005; order: radiance, distortion, g_source, blur):
///
/// 1. A grid of source cells, S × S to a pixel, covers the frame and as much around it as a PSF reaches.
/// 2. Parts of cells take the scene's mean radiance over what they see about the object point whose light is
/// centred on them, times g_source (SceneRows), and cells share in their light (SourceFilter).
/// 3. The light of a cell is spread by the PSF of its place, seen through a window (PsfField): ProductBlur,
/// blur_sections() or blur_exact(). Light may come in from outside the frame; light that leaves it is lost.
/// 4. The cells in and about a pixel share in it (PixelTaps): the pixel's aperture is the photosite's, and
/// what source filter and window took off below the pixels' frequency is given back.
/// 5. Light that lands far from its chief ray is formed by itself, on coarser pixels, and added
/// (ImagingOptions::tail_pixels).
/// 6. Where weights of either sign leave less than no light, the pixels about it make it good
/// (without_negative_light).
///
/// \param scene  radiance; its bands must lie within the table's wavelengths, its distance must be the
/// table's (to
///   1e-3), and it must cover the field.
/// \param sensor  the frame, centred on the axis.
/// \param report  may be null.
/// \throws InputError for anything that does not fit, with what would help; in the case of a scene that is
/// too small,
///   by how many degrees. The bytes do not depend on the number of threads.
///
/// \param share  of the bands, when several processes form one image: it knows those of others.
/// \param memory  of images of this scene, or null.
SpectralImage form_image(const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
                         const ImagingOptions& options, const ProgressCallback& progress = {},
                         ImagingReport* report = nullptr, const BandShare& share = {},
                         FormationMemory* memory = nullptr);

/// What is done with the pixels of a band, row by row.
using TakeBand = std::function<void(std::span<const float> pixels)>;

/// The same without keeping the bands: each is handed over as it is ready, in order.
void form_bands(const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
                const ImagingOptions& options, const TakeBand& take, const ProgressCallback& progress = {},
                ImagingReport* report = nullptr, const BandShare& share = {},
                FormationMemory* memory = nullptr);

/// Several images of one scene, the camera turned or the scene moved: what they share is made once, the
/// kernels of each band too where there is memory for them. Everything given must outlive it.
///
///     ImageSeries series(scene, table, sensor.geometry, options);
///     const AimedLight ahead, aside{{{{.pan_deg = 2}}}};
///     const auto images = series.form(std::vector{ahead, aside});
class ImageSeries {
 public:
  /// \throws InputError as form_image(), but for a scene that is too small.
  ImageSeries(const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
              const ImagingOptions& options);
  ~ImageSeries();
  ImageSeries(const ImageSeries&) = delete;
  ImageSeries& operator=(const ImageSeries&) = delete;

  /// \param lights  one an image, by rows of pixels; aims are added to the view of a panorama. \throws
  /// InputError as form_image(), and as SceneAim::check().
  std::vector<SpectralImage> form(std::span<const AimedLight> lights, ImagingReport* report = nullptr);

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace petzval
