// SPDX-License-Identifier: BSD-3-Clause
// How much light comes along a ray.
#pragma once

#include <petzval/numeric/sobol.h>
#include <petzval/render/world.h>

#include <limits>
#include <span>

namespace petzval::render {

struct PathOptions {
  /// Surfaces met after the first, and places where media scatter (pbrt-v4's maxdepth).
  int max_depth = 5;
  /// How light sources are found: by asking them, by chance, or both with weights that make the best of it.
  enum class Lights { both, sampled, by_chance };
  Lights lights = Lights::both;
};

/// Radiance along one ray [W·m⁻²·sr⁻¹·nm⁻¹].
struct PathLight {
  Lanes shared = Lanes::all(0);  ///< over paths that all wavelengths of the group could have taken
  Lanes straight =
      Lanes::all(0);  ///< the part of `shared` that comes from a lamp itself, scattered by nothing
  /// Irradiance of the first surface straight from the lights [W·m⁻²·nm⁻¹].
  Lanes arriving = Lanes::all(0);
  float alone = 0;  ///< of the hero wavelength, over paths through dispersing glass, which only it takes
  /// To the first surface that is no mirror, or where a medium scatters, along the path; infinite where none
  /// is met.
  double distance = 0;
};

/// The part of a PathLight that one light of the scene has sent.
struct SourceLight {
  Lanes shared = Lanes::all(0);
  float alone = 0;
};

/// The first surface along a ray, as pictures of depth, normals and albedo need it: seen through media as if
/// they were clear.
struct FirstSurface {
  bool met = false;
  Vector3 position, normal;
  Lanes albedo = Lanes::all(0);
};

/// Spectral path tracing with next-event estimation, multiple importance sampling (Veach 1997, balance
/// heuristic) and Russian roulette.
class PathTracer {
 public:
  /// `world` must outlive this.
  PathTracer(const World& world, const PathOptions& options) : world_(world), options_(options) {}

  /// \param limit  far clipping distance. \param first  if given, is told of the first surface.
  /// \param of_sources  if not empty, one for each of Lights::sources, to which its light is added.
  /// \param led_by  how likely each wavelength would have led to this ray, up to a factor
  /// (CameraRay::density).
  PathLight trace(Vector3 origin, Vector3 direction, int group, int hero, SobolSample& sample,
                  double limit = std::numeric_limits<double>::infinity(), FirstSurface* first = nullptr,
                  std::span<SourceLight> of_sources = {}, const Lanes& led_by = Lanes::all(1)) const;

 private:
  struct Path;
  /// trace(), made for worlds with media and for those without, which need not ask at each step.
  template <bool media>
  PathLight follow(Path& path, int group, SobolSample& sample, double limit, FirstSurface* first) const;
  const Material& material_met(const Geometry& geometry, const TexturePoint& point, int group,
                               SobolSample& sample) const;
  Vector3 tilted_normal(const Material& material, const Geometry& geometry, const Hit& hit,
                        const SurfacePoint& point) const;
  void add(Path& path, const Lanes& light, int source) const;
  void tell_skies(Path& path, const Lanes& weight, Vector3 from, Vector3 direction, int group) const;
  void add_emitted(Path& path, const Hit& hit, const SurfacePoint& point, int group) const;
  void add_sky(Path& path, int group) const;
  template <bool media>
  void add_sampled_light(Path& path, const SurfacePoint& point, const Frame& frame, const Bsdf& bsdf,
                         Vector3 wo, const Geometry& geometry, int group, SobolSample& sample) const;
  template <bool media, class Pdf>
  void add_asked(Path& path, LightSample& light, Vector3 origin, int medium, const Lanes& f, double cos,
                 const Pdf& scatter_pdf, int group, SobolSample& sample) const;
  template <bool media>
  bool scatter(Path& path, const SurfacePoint& point, const Frame& frame, const Bsdf& bsdf, Vector3 wo,
               const Geometry& geometry, SobolSample& sample) const;
  bool goes_on(Path& path, double roulette) const;

  // Through media: path_media.cpp.
  /// To what is met next, at a distance, or to where the medium scatters before: the distance to there.
  /// \param beside  of add_beside().
  std::optional<double> fly(Path& path, double distance, int group, SobolSample& sample,
                            const std::optional<Equiangular>& beside) const;
  /// Light of the medium itself from all of the ray that is to be flown along, so that nobody asks for it.
  void add_glow(Path& path, double distance, int group, SobolSample& sample) const;
  /// Light that a homogeneous medium scatters near to a lamp, on the ray that is to be flown along. Returns
  /// how it was looked for.
  std::optional<Equiangular> add_beside(Path& path, double distance, int group, SobolSample& sample) const;
  bool scatter_in_medium(Path& path, double distance, int group, SobolSample& sample) const;
  /// The straight way to a light; absent where something stands in it.
  std::optional<Passage> open_way(const Path& path, Vector3 origin, const LightSample& light, int medium,
                                  int group, SobolSample& sample) const;
  const Medium& medium_of(const Path& path, int medium) const;
  /// On meeting a surface: what is below it, if that varies from place to place.
  void enter(Path& path, const Geometry& geometry, const TexturePoint& point, int group) const;
  FirstSurface first_beyond(const Path& path, double limit, int group, SobolSample& sample) const;

  const World& world_;
  PathOptions options_;
};

}  // namespace petzval::render
