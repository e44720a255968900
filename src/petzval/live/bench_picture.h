// SPDX-License-Identifier: BSD-3-Clause
// The picture of the bench: light, exposure, development, each kept as long as it holds.
#pragma once

#include <petzval/live/bench.h>
#include <petzval/live/bench_scene.h>
#include <petzval/live/bench_shown.h>
#include <petzval/simulate/imaging_session.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// How much a picture is to tell.
enum class PictureQuality {
  preview,  ///< as many pixels as are made in a tenth of a second, three bands, one cell a pixel
  full,     ///< at most 640 pixels across, fewer of a blur that is wide, 16 bands, blur to a hundredth
  finest    ///< all pixels of the sensor, added up to at most 1.6 million of them, and 31 bands
};

/// The pictures of one bench.
class BenchPicture {
 public:
  /// \param used  stopped down and focused, before the scene. \param sensor_path  what read_sensor() takes.
  void show(const BenchState& state, const CoatedLens& used, const BenchScene& scene,
            const std::string& sensor_path, PictureQuality quality, const Context& context,
            const SendReply& send);

  /// Files of the last picture of full quality, or of the finest. \throws InputError if there is none yet.
  void write(const std::string& path, const Context& context) const;

 private:
  struct Shot {
    std::string light_key = {}, stray_key = {}, shown_key = {};
    std::string scene_key = {};
    std::optional<ImagingSession> session = {};  ///< of the scene, but for spectral files and the finest
    std::optional<Scene> cube = {};              ///< a spectral file
    std::vector<double> wavelengths_nm = {};
    int scene_columns = 0;                    ///< of a chart; 0: figures as they are
    std::optional<TableCamera> optics = {};   ///< of the light
    std::optional<SpectralImage> light = {};  ///< without what goes astray
    SourcesFound sources = {};                ///< that the scene holds, for stray light
    std::optional<SpectralImage> stray = {};  ///< with it; absent: nothing does
    ShownSensor sensor = {};
    double spread_um = 0;  ///< how far light spreads about its chief ray
    OutputOptions outputs = {};
    std::string method = {};
    double estimated_error = 0;  ///< of the light, without what goes astray

    const SpectralImage& lit() const { return stray ? *stray : *light; }
  };
  struct Stage;
  /// Forms the light unless it holds. \returns whether a scene was there already and light was formed anew.
  bool form_light(Shot& shot, const Stage& stage);
  void form_image_light(Shot& shot, const Stage& stage);
  void form_stray_light(Shot& shot, const Stage& stage);
  nlohmann::json message_of(const Shot& shot, const Stage& stage) const;
  /// Few where blur is wide. The same whatever was shown before.
  static int most_columns(const Stage& stage);
  /// How many pixels a preview has from now on, by how long the last one took.
  void choose_preview(double seconds);

  static constexpr std::size_t preview_sizes = 4;
  Shot previews_[preview_sizes], full_, finest_;
  std::size_t preview_size_ = 1;
};

}  // namespace petzval
