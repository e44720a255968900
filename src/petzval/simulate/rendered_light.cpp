// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/simulate/clip_light.h>
#include <petzval/simulate/prepared_world.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

namespace petzval {

namespace {

/// Work that tells nothing of its own.
Context quiet(std::uint64_t seed) {
  Context inner;
  inner.threads = thread_count();
  inner.seed = seed;
  return inner;
}

/// A picture of some rows of a frame as one of all.
SpectralImage among_dark_rows(const SpectralImage& part, int first, int rows) {
  SpectralImage whole(part.columns(), rows, part.wavelengths_nm(), part.pitch_um(), part.pixel_aperture());
  whole.photosite = part.photosite;
  whole.lens = part.lens;
  const auto before = static_cast<std::size_t>(first) * static_cast<std::size_t>(part.columns());
  for (int band = 0; band < part.bands(); ++band)
    std::ranges::copy(part.band(band), whole.band(band).subspan(before).begin());
  return whole;
}

class RenderedLight : public ClipLight {
 public:
  RenderedLight(const RenderRequest& scene, const ClipOptions& options, const Context& context)
      : per_exposure_(options.instants), seed_(context.seed), first_(first_scene(scene, context)) {}

  int rows() const override { return first_.film.rows; }

  SpectralImage first(const Context& context) const override {
    return render_scene(first_, context).irradiance;
  }

  std::vector<double> instants(double from_s, double to_s, double exposure_s) const override {
    if (!moves()) return {from_s, to_s};
    constexpr double rounding = 1e-9;
    const double steps = std::max(1.0, std::ceil((to_s - from_s) / exposure_s * per_exposure_ - rounding));
    std::vector<double> at{from_s};
    for (double k = 1; k <= steps; ++k)
      at.push_back(k == steps ? to_s : from_s + (to_s - from_s) * k / steps);
    return at;
  }

  void walk(const std::vector<double>& instants, const RowsOf& rows_of, const See& see) const override {
    for (std::size_t k = 0; k < instants.size(); ++k) {
      if (!moves()) {
        see(k, nullptr);
        continue;
      }
      const SpectralImage light = at(instants[k], rows_of(k));
      see(k, &light);
    }
  }

 private:
  static PreparedScene first_scene(RenderRequest request, const Context& context) {
    if (request.is_piece() || !request.checkpoint.empty())
      throw InputError("frames of a clip are whole; neither `region` nor `checkpoint` would be right");
    request.scene_time = 0;
    PreparedScene scene = prepare_scene(request, context);
    if (scene.wants_autofocus()) autofocus(scene, context);
    return scene;
  }

  bool moves() const { return first_.world->description->moves; }

  /// Through the lens as it is focused at the beginning. Random numbers are those of the instant.
  SpectralImage at(double t_s, RowRange rows) const {
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(t_s);
    constexpr std::uint64_t spread = 0x9E3779B97F4A7C15;  // of the golden ratio: bits that differ little part
    const Context own = quiet(seed_ ^ (bits * spread >> 1));
    RenderRequest request = first_.request;
    request.scene_time = t_s;
    PreparedScene scene = prepare_scene(request, own);
    scene.lens = first_.lens;
    scene.focus = first_.focus;
    const int end = std::min(rows.end, scene.film.rows);
    if (scene.world->camera.crop || (rows.first == 0 && end == scene.film.rows))
      return render_scene(scene, own).irradiance;
    scene.request.region = {0, rows.first, scene.film.columns, end - rows.first};
    return among_dark_rows(render_scene(scene, own).irradiance, rows.first, scene.film.rows);
  }

  int per_exposure_;
  std::uint64_t seed_;
  PreparedScene first_;
};

}  // namespace

std::unique_ptr<ClipLight> rendered_light(const RenderRequest& scene, const ClipOptions& options,
                                          const Context& context) {
  return std::make_unique<RenderedLight>(scene, options, context);
}

}  // namespace petzval
