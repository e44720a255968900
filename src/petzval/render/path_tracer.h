// SPDX-License-Identifier: BSD-3-Clause
// How much light comes along a ray.
#pragma once

#include <petzval/numeric/sobol.h>
#include <petzval/render/world.h>

#include <limits>
#include <span>

namespace petzval::render {

struct PathOptions {
  int max_depth = 5;  ///< surfaces met after the first (pbrt-v4's maxdepth)
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
  /// To the first surface that is no mirror, along the path; infinite where none is met.
  double distance = 0;
};

/// The part of a PathLight that one light of the scene has sent.
struct SourceLight {
  Lanes shared = Lanes::all(0);
  float alone = 0;
};

/// The first surface along a ray, as pictures of depth, normals and albedo need it.
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
  PathLight trace(Vector3 origin, Vector3 direction, int group, int hero, SobolSample& sample,
                  double limit = std::numeric_limits<double>::infinity(), FirstSurface* first = nullptr,
                  std::span<SourceLight> of_sources = {}) const;

 private:
  struct Path;
  void add(Path& path, const Lanes& light, int source) const;
  void tell_skies(Path& path, const Lanes& weight, Vector3 direction, int group) const;
  void add_emitted(Path& path, const Hit& hit, const SurfacePoint& point, int group) const;
  void add_sky(Path& path, int group) const;
  void add_sampled_light(Path& path, const SurfacePoint& point, const Frame& frame, const Bsdf& bsdf,
                         Vector3 wo, int group, SobolSample& sample) const;
  bool scatter(Path& path, const SurfacePoint& point, const Frame& frame, const Bsdf& bsdf, Vector3 wo,
               int hero, SobolSample& sample) const;

  const World& world_;
  PathOptions options_;
};

}  // namespace petzval::render
