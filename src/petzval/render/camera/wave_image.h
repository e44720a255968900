// SPDX-License-Identifier: BSD-3-Clause
// Where light of the scene lands by wave optics.
#pragma once

#include <petzval/render/camera/chief_image.h>
#include <petzval/render/camera/psf_sampler.h>
#include <petzval/render/vector3.h>
#include <petzval/sensor/sensor.h>
#include <petzval/trace/losses.h>

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <vector>

namespace petzval::render {

/// What a camera ray sees: a place on its way, at mirrors counted on behind them.
struct SeenPoint {
  Vector3 origin, direction;  ///< of the ray; camera space, scene units
  double distance = 0;        ///< in lengths of `direction`; infinite where nothing is met
};

/// A path that comes through the lens says how bright a point of the scene is; waves say where its light
/// lands: about the image of its chief ray, as the diffraction PSF of a point in that direction and at that
/// distance has it (analysis/point_spread.h). This holds where the point is about in focus. Where it is not,
/// rays land as well, and cost nothing. The share of waves is set by the RMS radius q of the rays' spot in
/// units of λN, N the lens's working f-number there:
///
///     w = 1 for q ≤ 6,   (12 − q)/6 between,   0 for q ≥ 12.
///
/// A round pupil that is out of focus by W waves at its rim has q = 2√2 W. PSFs are made where they are asked
/// for, at nodes of film radius (and azimuth, if the stop has blades), defocus and wavelength; between nodes
/// light is that of one or the other, by lot. (docs/RENDERING.md, Diffraction.)
class WaveImage {
 public:
  struct Options {
    double scene_units_per_mm = 1e-3;
    double origin_z_mm = 0;  ///< of camera space, in lens space
    Losses losses;
  };

  static constexpr double only_waves = 6, only_rays = 12;  ///< q
  /// The least that a PSF reaches from the image point [λN]: the square that holds 99 % of Airy's light.
  static constexpr double reach_lambda_n = 18.5;

  /// \param lens  as it is used; its image surface is the film. \throws InputError unless it is centred and
  /// has a viewpoint.
  WaveImage(const Lens& lens, const SensorGeometry& film, std::vector<double> wavelengths_nm,
            const Options& options);
  ~WaveImage();
  WaveImage(const WaveImage&) = delete;
  WaveImage& operator=(const WaveImage&) = delete;

  /// The light of a point at one wavelength.
  struct Spread {
    double share = 0;  ///< of waves; the rest is that of rays
    /// Column and row where waves land, for two numbers in [0, 1); if they have a share.
    std::array<double, 2> place(double u, double v) const;

    const PsfSampler* psf = nullptr;
    double column = 0, row = 0;                  ///< of the chief ray
    std::array<double, 2> along_s{}, along_t{};  ///< [pixels/µm]
  };
  /// \param lots  two numbers in [0, 1) that choose among nodes.
  Spread spread_of(int band, const SeenPoint& point, const std::array<double, 2>& lots) const;

  /// How far beyond the frame there are points whose light is wanted within it.
  int margin_pixels() const { return margin_pixels_; }

 private:
  /// Of a wavelength at a film radius: the rays' spot by vergence, the reciprocal of the distance from the
  /// pupil [1/mm], to first order: blur² = least² + (slope (vergence − best))².
  struct Focus {
    double best_vergence = 0, slope_mm2 = 0, least_mm = 0, lambda_n_mm = 0;  ///< λN 0: no light
    double vergence(double waves) const;
    double waves(double vergence) const;
    double spread(double vergence) const;  ///< q
  };
  struct Place;
  /// A PSF, made when it is asked for; empty where no light comes.
  using Node = std::optional<PsfSampler>;

  std::optional<Place> place_of(const SeenPoint& point, std::size_t optics) const;
  Focus find_focus(std::size_t optics, double height_mm) const;
  const Focus& focus(std::size_t band, std::size_t radius) const { return focus_[band * radii + radius]; }
  Lens focused_at(std::size_t optics, double vergence) const;
  double field_of(std::size_t optics, double angle, double vergence) const;
  double height_mm(std::size_t radius) const { return last_mm_ * static_cast<double>(radius) / (radii - 1); }
  Node make_psf(std::size_t band, std::size_t radius, std::size_t azimuth, double waves) const;
  const Node& psf(std::size_t node_band, std::size_t radius, std::size_t azimuth, std::size_t defocus) const;
  std::size_t optics_of(std::size_t band) const { return chiefs_.size() > 1 ? band : 0; }

  static constexpr std::size_t radii = 9;

  Lens lens_;
  SensorGeometry film_;
  std::vector<double> wavelengths_nm_;
  Options options_;
  int margin_pixels_ = 0;
  std::vector<ChiefImage> chiefs_;         ///< by band; one where nothing disperses
  double last_mm_ = 0;                     ///< film radius up to which there are PSFs
  std::vector<Focus> focus_;               ///< [band][radius], of the round stop
  std::vector<double> defocus_waves_;      ///< of nodes, increasing
  std::vector<std::size_t> node_bands_;    ///< that have PSFs of their own
  std::vector<std::size_t> node_band_of_;  ///< by band, whose PSFs serve it, to scale: an index of these
  std::size_t azimuths_ = 1;
  /// [node band][radius][azimuth][defocus]; null until it is asked for.
  mutable std::vector<std::atomic<const Node*>> psfs_;
};

}  // namespace petzval::render
