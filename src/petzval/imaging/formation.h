// SPDX-License-Identifier: BSD-3-Clause
// The bands of images of one scene through one table, several side by side.
#pragma once

#include <petzval/imaging/band_blur.h>
#include <petzval/imaging/formation_memory.h>
#include <petzval/imaging/image_formation.h>
#include <petzval/imaging/pixel_gather.h>
#include <petzval/imaging/source_light.h>

#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace petzval {

class BandProgress;

/// What all images of a scene through one table share, and the bands that are formed at a time.
class Formation {
 public:
  /// \param keeps  kernels are kept for more images, where there is room. \param memory  of earlier images of
  /// the scene, or null.
  /// \throws InputError for whatever form() would refuse but an aim.
  Formation(const Scene& of_scene, const LensDataTable& of_table, const SensorGeometry& of_sensor,
            const ImagingOptions& asked, bool keeps, FormationMemory* memory = nullptr);
  /// \param take  is handed each band of every light, then the next band.
  void form(std::span<const AimedLight> lights, const TakeBand& take, const ProgressCallback& callback,
            ImagingReport& report, const BandShare& share = {});

  const Scene& scene;
  const LensDataTable& table;
  const SensorGeometry sensor;
  ImagingOptions options;

 private:
  /// Where bands are formed.
  struct Place {
    Place(const Formation& of) : blur(of.table, of.centres, of.options, says, of.contrast) {}
    ImagingReport says;
    BandBlur blur;
    std::optional<std::size_t> chosen;  ///< the band whose plan the blur holds
    std::vector<CellPlane> ideal;       ///< before the blur, of the first lights
    std::vector<CellPlane> pixels;      ///< of each light
    double seconds = 0;
  };

  /// Everything that can be refused is refused before the work starts.
  const LensDataTable& checked() const;

  void check_aims(std::span<const AimedLight> lights, std::vector<std::string>& notes) const;

  Place& place_of(std::size_t band) { return places[band % places.size()]; }

  /// Whether so many places have room, going by the first.
  bool fits(std::size_t count) const;
  /// As many bands at a time as threads and memory allow.
  std::size_t places_at_once() const;

  void choose(std::size_t band, Place& place);
  /// How many lights are looked up together.
  std::size_t lights_at_once(std::size_t band) const;
  /// Light before the blur, on cells, of some lights.
  std::vector<CellPlane> ideal(std::size_t band, std::span<const AimedLight> some) const;

  /// Chooses the band's kernels beside making its first lights, if they are not chosen yet.
  void begin(std::size_t band, std::span<const AimedLight> lights);
  void work(std::size_t band, std::span<const AimedLight> lights, BandProgress& progress);

  /// \return the time that the band took.
  double hand_over(std::size_t band, const TakeBand& take, BandProgress& progress, ImagingReport& report);

  static void share_time(double seconds, double of_bands, ImagingReport& report);

  void note_unused_layout(ImagingReport& report) const;

  const bool may_keep;
  const LightCentres centres;
  double contrast = 0;   ///< CellChoice::contrast
  SensorGeometry frame;  ///< of cells
  std::vector<BandPlan> plans;
  LightPath path;
  PixelTaps taps;
  ImagingReport of_all;  ///< what there is to say of every image
  std::deque<Place> places;
  std::optional<ProductPlan> last_plan;
};

}  // namespace petzval
