// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/stop.h>
#include <petzval/base/units.h>
#include <petzval/render/shared_tile.h>

#include <algorithm>
#include <cstdint>

namespace petzval::render {

namespace {

constexpr std::size_t shared_paths_between_questions = 4;
/// Where a ray lands, in pixels of the picture (most_shared_side).
struct LandedPixel {
  std::int16_t column = -1, row = -1;

  bool is_on_film() const { return row >= 0; }
  friend bool operator==(const LandedPixel&, const LandedPixel&) = default;
};
using LandedPixels = std::array<LandedPixel, lane_count>;

/// Rays that frames have found, and where they land in each frame.
class SharedTile {
 public:
  SharedTile(const SharedTask& task, const PixelWindow& tile, const SharedSamples& samples)
      : task_(task),
        tile_(tile),
        samples_(samples),
        tracer_(task.world, task.options.path),
        lanes_(task.world.groups.lanes(samples.group)) {}

  SharedTileResult run() {
    result_.frames.resize(frames());
    for (std::size_t frame = 0; frame < frames(); ++frame) send(frame);
    landed_.resize(frames());
    led_.assign(rays_.size(), Lanes::all(0));
    const RadianceRays light = light_of_rays();
    for (std::size_t frame = 0; frame < frames(); ++frame) land(frame, light);
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      if (i % shared_paths_between_questions == 0) check_stop();
      follow(i);
    }
    return std::move(result_);
  }

 private:
  /// A path that got through the lens of its frame.
  struct Sent {
    Vector3 origin, direction;  ///< as CameraRay has them
    float density;              ///< with which its frame leads to it [1/sr]
    std::size_t frame;
    SobolSample numbers;
  };
  /// Where rays land in one frame; if wavelengths do not part, in the first lane.
  struct Landing {
    std::vector<LandedPixels> pixels;  ///< [ray]
    std::vector<Lanes> kept;           ///< what losses leave, if there are any, [ray]
  };

  std::size_t frames() const { return task_.cameras.size(); }
  /// Lanes that land together count once.
  int slots(std::size_t frame) const { return task_.cameras[frame].disperses() ? lanes_ : 1; }

  void send(std::size_t frame) {
    std::vector<SobolSample> numbers;
    std::vector<FilmSample> places;
    const auto at = static_cast<std::uint32_t>(frame), every = static_cast<std::uint32_t>(samples_.every);
    for (int row = tile_.top; row < tile_.bottom; ++row)
      for (int column = tile_.left; column < tile_.right; ++column) {
        const auto number = static_cast<std::uint32_t>(row * task_.sensor.columns + column);
        const std::uint32_t seed = hashed(number, samples_.numbers.stream), turn = hashed(seed, 0x68e31da4u);
        if ((at + turn) % every != 0) continue;
        for (int i = 0; i < samples_.own; ++i) {
          // One sequence through all frames: what is alike in them is stratified together.
          const std::uint32_t index =
              at / every * static_cast<std::uint32_t>(samples_.own) + static_cast<std::uint32_t>(i);
          numbers.emplace_back(seed, index, *samples_.numbers.shifts);
          const auto [x, y, u, v] = numbers.back().next4();
          places.push_back(task_.sampling.place({column, row}, x, y, u, v));
          places.back().hero = static_cast<int>((turn / every + index) % static_cast<std::uint32_t>(lanes_));
        }
      }
    std::vector<CameraRay> rays(places.size());
    task_.cameras[frame].lead(samples_.group, task_.sampling, places, rays);
    SharedBox& box = result_.frames[frame];
    box.rays = rays.size();
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (rays[i].passes) {
        rays_.push_back({rays[i].origin, rays[i].direction, rays[i].density[0], frame, numbers[i]});
        places_.push_back(places[i]);
        ++box.passed;
      }
  }

  /// The rays as light that comes from the scene [mm].
  RadianceRays light_of_rays() const {
    RadianceRays light(rays_.size());
    const double per_unit = 1 / task_.cameras.front().scene_units_per_mm();
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      const Sent& ray = rays_[i];
      light.x_mm[i] = static_cast<float>(ray.origin.x * per_unit);
      light.y_mm[i] = static_cast<float>(ray.origin.y * per_unit);
      light.z_mm[i] = static_cast<float>(-ray.origin.z * per_unit);
      light.l[i] = static_cast<float>(-ray.direction.x);
      light.m[i] = static_cast<float>(-ray.direction.y);
      light.n[i] = static_cast<float>(ray.direction.z);
    }
    return light;
  }

  void land(std::size_t frame, const RadianceRays& light) {
    const LensCamera& camera = task_.cameras[frame];
    Landing& landing = landed_[frame];
    landing.pixels.assign(rays_.size(), {});
    if (camera.loses()) landing.kept.assign(rays_.size(), Lanes::all(0));
    LandedLight landed;
    int left = most_shared_side, top = most_shared_side, right = -1, bottom = -1;
    for (int slot = 0; slot < slots(frame); ++slot) {
      camera.land(samples_.group, slot, light, landed);
      for (std::size_t i = 0; i < rays_.size(); ++i) {
        const LandedPixel pixel = land_ray(frame, slot, i, landed);
        if (!pixel.is_on_film()) continue;
        landing.pixels[i][static_cast<std::size_t>(slot)] = pixel;
        left = std::min<int>(left, pixel.column), right = std::max<int>(right, pixel.column);
        top = std::min<int>(top, pixel.row), bottom = std::max<int>(bottom, pixel.row);
      }
    }
    SharedBox& box = result_.frames[frame];
    if (right >= 0) box.window = {left, top, right + 1, bottom + 1};
    box.cells.resize(box.window.size());
  }

  /// \returns the pixel, and adds to the densities that lead to the ray; nothing for a ray that misses.
  LandedPixel land_ray(std::size_t frame, int slot, std::size_t i, const LandedLight& landed) {
    const LensCamera& camera = task_.cameras[frame];
    float density = landed.per_sr[i];
    const FilmSample& found_by = places_[i];
    double column = middle_column_ - static_cast<double>(landed.rays.x_mm[i]) * per_mm_;
    double row = middle_row_ + static_cast<double>(landed.rays.y_mm[i]) * per_mm_;
    // Where it began is known.
    if (rays_[i].frame == frame && (!camera.disperses() || slot == found_by.hero)) {
      column = found_by.column, row = found_by.row;
      density = rays_[i].density;
    }
    if (!(density > 0)) return {};
    const std::optional<Pixel> pixel = task_.sampling.pixel_at(found_by, column, row);
    if (!pixel) return {};
    const int end = camera.disperses() ? slot + 1 : lanes_;
    for (int lane = slot; lane < end; ++lane) led_[i][lane] += density;
    if (camera.loses())
      for (int lane = slot; lane < end; ++lane)
        landed_[frame].kept[i][lane] = camera.kept(samples_.group, lane, landed, i);
    return {static_cast<std::int16_t>(pixel->column), static_cast<std::int16_t>(pixel->row)};
  }

  void follow(std::size_t i) {
    Sent& ray = rays_[i];
    const int hero = places_[i].hero;
    // Paths a pixel that each wavelength of each frame leads.
    const double each = static_cast<double>(samples_.own) / (samples_.every * lanes_);
    double density = 0;
    for (int lane = 0; lane < lanes_; ++lane) density += each * static_cast<double>(led_[i][lane]);
    if (!(density > 0)) return;
    const ClippingPlanes::Part part = task_.options.clipping.part_of(ray.origin, ray.direction);
    PathLight light;
    if (part.to > part.from) {
      const Transform& place = task_.world_from_camera;
      const Vector3 along = place.direction(ray.direction);
      light = tracer_.trace(place.point(ray.origin + part.from * ray.direction), normalised(along),
                            samples_.group, hero, ray.numbers, (part.to - part.from) * length(along), nullptr,
                            {}, led_[i]);
    }
    Lanes value = 1 / density * light.shared;
    value[hero] +=
        static_cast<float>(static_cast<double>(light.alone) / (each * static_cast<double>(led_[i][hero])));
    const Lanes straight = 1 / density * light.straight;
    for (std::size_t frame = 0; frame < frames(); ++frame)
      add(frame, i, value, Lanes::all(1 / density), straight);
    for (int lane = 0; lane < lanes_; ++lane)
      result_.arriving[static_cast<std::size_t>(lane)] += static_cast<double>(light.arriving[lane]);
  }

  void add(std::size_t frame, std::size_t i, Lanes value, Lanes field, const Lanes& straight) {
    SharedBox& box = result_.frames[frame];
    const bool parts = task_.cameras[frame].disperses();
    const LandedPixels& pixels = landed_[frame].pixels[i];
    const auto cell = [&](const LandedPixel& at) -> SharedCell& {
      return box.cells[box.window.index(at.column, at.row)];
    };
    if (!landed_[frame].kept.empty()) value *= landed_[frame].kept[i], field *= landed_[frame].kept[i];
    const auto all = static_cast<std::size_t>(lanes_);
    if (!parts || std::all_of(pixels.begin(), pixels.begin() + lanes_,
                              [&](const LandedPixel& each) { return each == pixels[0]; })) {
      if (!pixels[0].is_on_film()) return;
      SharedCell& to = cell(pixels[0]);
      to.light += value;
      to.field += field;
    } else {
      for (std::size_t lane = 0; lane < all; ++lane) {
        if (!pixels[lane].is_on_film()) continue;
        SharedCell& to = cell(pixels[lane]);
        to.light.v[lane] += value.v[lane];
        to.field.v[lane] += field.v[lane];
      }
    }
    if (straight.is_black()) return;
    const LandedPixel& at = pixels[static_cast<std::size_t>(parts ? places_[i].hero : 0)];
    float sum = 0;
    for (std::size_t lane = 0; lane < all; ++lane) sum += straight.v[lane];
    if (at.is_on_film()) box.lamps.emplace_back(Pixel{at.column, at.row}, sum);
  }

  const SharedTask& task_;
  PixelWindow tile_;
  SharedSamples samples_;
  PathTracer tracer_;
  int lanes_;
  double per_mm_ = 1 / (task_.sensor.pitch_um * mm_per_um);
  double middle_column_ = task_.sensor.columns / 2.0, middle_row_ = task_.sensor.rows / 2.0;
  std::vector<Sent> rays_;
  std::vector<FilmSample> places_;  ///< where they began
  std::vector<Lanes> led_;          ///< density of each ray with each wavelength leading, over all frames
  std::vector<Landing> landed_;     ///< [frame]
  SharedTileResult result_;
};

}  // namespace

SharedTileResult share_tile(const SharedTask& task, const PixelWindow& tile, const SharedSamples& samples) {
  return SharedTile(task, tile, samples).run();
}

}  // namespace petzval::render
