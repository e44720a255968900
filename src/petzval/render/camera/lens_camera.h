// SPDX-License-Identifier: BSD-3-Clause
// A real lens in front of the film.
#pragma once

#include <petzval/render/camera/film_camera.h>
#include <petzval/render/camera/lamp_guide.h>
#include <petzval/render/camera/wave_image.h>
#include <petzval/render/spectra/wavelength_groups.h>
#include <petzval/sensor/sensor.h>
#include <petzval/trace/exit_pupil_region.h>
#include <petzval/trace/kernel_path.h>
#include <petzval/trace/pupil_transmittance.h>
#include <petzval/trace/radiance_tracer.h>

#include <memory>
#include <optional>
#include <vector>

namespace petzval::render {

struct LensCameraOptions {
  /// exit_pupil: directions inside of the pupil as the film point sees it. rear_disk: points on the disk of
  /// the last surface's aperture, weighted A cos⁴θ/d², as the reports of CS348B (2006) have it: the same
  /// picture, more noise.
  enum class Sampling { exit_pupil, rear_disk };
  Sampling sampling = Sampling::exit_pupil;
  double scene_units_per_mm = 1e-3;
  Losses losses;  ///< reflection and absorption in the lens; none unless set
  /// How far outside of the film's frame light may be asked for: half of what a low-pass filter parts
  /// [pixels].
  double margin_pixels = 0;
  bool origin_at_front =
      false;  ///< the camera's place is the first vertex, as in 2006; else the film's centre
  /// Light of what is about in focus lands as waves do (WaveImage).
  bool diffraction = false;
  /// Light that others have found is landed, too (land()), also where no wavelengths part.
  bool lands = false;
  /// What is small and bright in the scene: directions are drawn towards it, too (LampGuide). Not over the
  /// disk of the last surface.
  std::vector<Lamp> lamps;
};

/// Light that comes to a lens, where it lands on the film.
struct LandedLight {
  RadianceRays rays;          ///< on the film, in the space of the lens; before: in front of it
  std::vector<float> per_sr;  ///< how densely directions are drawn to there; 0 for a ray that does not pass
};

/// Traces every film sample backwards through every surface, at its own wavelength: prescription, glass,
/// apertures and stop as they are. Wavelengths that dispersion parts share one scene path: the hero's ray,
/// found from the film, is sent back through the lens at the others, and each lands where it lands (étendue
/// is kept at every wavelength, so that densities in film phase space dA dα dβ may be compared; balance
/// heuristic over the wavelengths).
class LensCamera final : public FilmCamera {
 public:
  /// \param lens  focused and stopped down as it is used; its image surface is the film.
  /// \throws InputError if no light reaches the film, and as Tracer.
  LensCamera(const Lens& lens, const SensorGeometry& film, const WavelengthGroups& groups,
             const LensCameraOptions& options = {});

  void trace(int group, const FilmSampling& sampling, std::span<const FilmSample> samples,
             std::span<CameraRay> rays) const override;
  /// As trace(), for the leading wavelength alone: rays have no weights, and its density [1/sr] in all lanes.
  void lead(int group, const FilmSampling& sampling, std::span<const FilmSample> samples,
            std::span<CameraRay> rays) const;
  /// Sends light to the film that comes along rays which any camera in this place has found.
  /// \param from_scene  x to the right and y up from the camera's axis, z towards the film from its place
  /// [mm]; directions in which light travels.
  void land(int group, int lane, const RadianceRays& from_scene, LandedLight& landed) const;
  /// Of the k-th ray's light at a wavelength, what reflection and absorption leave; 1 without losses.
  float kept(int group, int lane, const LandedLight& landed, std::size_t k) const;
  double scene_units_per_mm() const { return options_.scene_units_per_mm; }
  bool loses() const { return transmittance_.has_value(); }
  /// The irradiance at a place of the film in a uniform field of unit radiance [sr], from `rays` rays.
  double etendue_sr(int group, int lane, double x_mm, double y_mm, std::size_t rays) const;
  /// Whether only the distance from the middle of the film decides about that.
  bool is_round() const { return round_; }
  bool disperses() const override { return disperses_; }
  const WaveImage* waves() const override { return waves_.get(); }

 private:
  struct Start {
    double alpha = 0, beta = 0, area = 0;  ///< direction cosines of travelling light; 1/density
  };
  struct Led;
  std::size_t film_radii(double corner_mm) const;
  ExitPupilRegions find_regions(const Lens& lens) const;
  /// Tracers of the middle of the spectrum and of its ends.
  std::vector<Tracer> spectrum_ends() const;
  Start start(double x_mm, double y_mm, double u, double v) const;
  Start unguided_start(double x_mm, double y_mm, double u, double v) const;
  Start guided_start(double x_mm, double y_mm, double u, double v) const;
  void densities(const PupilDirections& directions, float* per_sr) const;
  void follow_heroes(int group, const FilmSampling& sampling, std::span<const FilmSample> samples,
                     std::span<CameraRay> rays, bool alone) const;
  void launch(Led& led) const;
  void trace_led(Led& led) const;
  void trace_to_scene(Led& led) const;
  void share_among_wavelengths(const Led& led) const;
  float through(int group, int lane, const RadianceRays& landed, std::size_t k) const;
  void dim(const Led& led) const;
  std::size_t band(int group, int lane) const;

  SensorGeometry film_;
  WavelengthGroups groups_;
  LensCameraOptions options_;
  std::vector<Tracer> tracers_;               ///< by band; one when nothing disperses; with a round stop
  std::vector<KernelPath<double>> to_scene_;  ///< of each tracer
  std::vector<RadianceTracer> to_film_;       ///< of each tracer, if anything disperses or is to land
  std::shared_ptr<const WaveImage> waves_;    ///< if diffraction is wanted
  bool disperses_ = false, round_ = false;
  LampGuide guide_;
  std::optional<ExitPupilRegions> regions_;  ///< that directions are drawn from
  std::optional<PupilTransmittance> transmittance_;
  double rear_radius_mm_ = 0, rear_distance_mm_ = 0;
};

}  // namespace petzval::render
