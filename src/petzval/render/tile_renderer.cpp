// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/stop.h>
#include <petzval/render/group_samples.h>
#include <petzval/render/tile_renderer.h>

#include <algorithm>
#include <cmath>

namespace petzval::render {

namespace {

/// Paths that are followed before anybody is asked whether to go on.
constexpr std::size_t paths_between_questions = 4;
constexpr std::uint32_t wave_stream = 0x7761766eu;
/// Light straight from a lamp is spread over so many places: it is bright, and few paths may find it.
constexpr int places_of_lamp = 32;
/// Multiples of these fill a square evenly (Roberts 2018: powers of the inverse of the plastic number).
constexpr std::array<double, 2> even_places{0.7548776662466927, 0.5698402909980532};

double turned(double number, double by) {
  const double sum = number + by;
  return sum - std::floor(sum);
}

/// Follows the samples of one tile.
class TileRenderer {
 public:
  TileRenderer(const TileTask& task, const PixelWindow& tile, bool half, Film& film)
      : task_(task),
        tracer_(task.world, task.options.path),
        waves_(task.camera.waves()),
        tile_(tile),
        half_(half),
        whole_(film),
        film_(film.part(tile)),
        of_sources_(film.sources()) {}

  TileResult run(const std::vector<SampleRange>& of_group) {
    result_.strays.resize(of_group.size());
    result_.arriving.resize(whole_.arriving.size());
    for (int group = 0; group < task_.world.groups.count(); ++group)
      take_samples(group, of_group[static_cast<std::size_t>(group)]);
    whole_.put(film_);
    result_.done = true;
    return std::move(result_);
  }

 private:
  /// Of the i-th sample of a batch: those of a pixel follow each other, while its sums are at hand.
  Pixel pixel_of(std::size_t i) const {
    const int within = static_cast<int>(i / static_cast<std::size_t>(each_));
    return {tile_.left + within % tile_.columns(), tile_.top + within / tile_.columns()};
  }

  void take_samples(int group, SampleRange range) {
    lanes_ = task_.world.groups.lanes(group);
    of_group_ = GroupSamples::of(task_.world.groups, group, task_.options.seed);
    samples_.clear(), places_.clear(), times_.clear(), numbers_.clear();
    each_ = range.last - range.first;
    const std::size_t count = tile_.size() * static_cast<std::size_t>(each_);
    for (std::size_t i = 0; i < count; ++i)
      start_sample(range.first + static_cast<int>(i % static_cast<std::size_t>(each_)), pixel_of(i));
    rays_.assign(places_.size(), {});
    task_.camera.trace(group, task_.sampling, places_, rays_);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (i % paths_between_questions == 0) check_stop();
      follow(i, group);
    }
  }

  void start_sample(int index, Pixel pixel) {
    const bool inside = pixel.row >= 0 && pixel.column >= 0 && pixel.column < task_.sensor.columns;
    const auto number =
        inside ? static_cast<std::uint32_t>(pixel.row * task_.sensor.columns + pixel.column)
               : hashed(static_cast<std::uint32_t>(pixel.row), static_cast<std::uint32_t>(pixel.column));
    // The halves of a picture whose noise is wanted are independent of each other.
    const std::uint32_t stream = half_ ? ~of_group_.stream : of_group_.stream;
    const std::uint32_t seed = hashed(number, stream);
    samples_.emplace_back(seed, static_cast<std::uint32_t>(index), *of_group_.shifts);
    const auto [x, y, u, v] = samples_.back().next4();
    places_.push_back(task_.sampling.place(pixel, x, y, u, v));
    // The same in all pixels: even light stays even. And the paths are those without waves.
    if (waves_)
      numbers_.push_back(
          SobolSample(hashed(stream, wave_stream), static_cast<std::uint32_t>(index), *of_group_.shifts)
              .next4());
    if (const auto& motion = task_.options.motion)
      times_.push_back(motion->opens(pixel.row + 0.5, task_.sensor.rows) +
                       motion->exposure() * samples_.back().next2()[0]);
    // In turn from a random start: every wavelength leads equally often.
    places_.back().hero = static_cast<int>((hashed(seed, 0x68e31da4u) + static_cast<std::uint32_t>(index)) %
                                           static_cast<std::uint32_t>(lanes_));
  }

  void follow(std::size_t i, int group) {
    const CameraRay& ray = rays_[i];
    ++result_.rays;
    if (!ray.passes) return;
    ++result_.passed;
    const ClippingPlanes::Part part = task_.options.clipping.part_of(ray.origin, ray.direction);
    if (!(part.to > part.from)) return;
    if (task_.options.motion) moved_ = task_.options.motion->world_from_camera(times_[i]);
    const Transform& place = task_.options.motion ? moved_ : task_.world_from_camera;
    const Vector3 origin = place.point(ray.origin + part.from * ray.direction);
    const Vector3 along = place.direction(ray.direction), direction = normalised(along);
    FirstSurface first;
    std::ranges::fill(of_sources_, SourceLight());
    const PathLight light = tracer_.trace(
        origin, direction, group, places_[i].hero, samples_[i], (part.to - part.from) * length(along),
        film_.has_first_surfaces() ? &first : nullptr, of_sources_, ray.density);
    const SeenPoint seen{ray.origin, ray.direction, part.from + light.distance / length(along)};
    const int places = light.straight.is_black() ? 1 : places_of_lamp;
    if (!light.straight.is_black()) add_lamp(pixel_of(i), light.straight, ray);
    add_light(i, group, light.shared, light.alone, seen, places, 0);
    std::size_t bands = task_.world.groups.wavelengths_nm().size(), plane = bands;
    for (const SourceLight& each : of_sources_) {
      add_light(i, group, each.shared, each.alone, seen, places, plane);
      plane += bands;
    }
    if (!light.arriving.is_black())
      for (int lane = 0; lane < lanes_; ++lane)
        result_.arriving[band(group, lane)] += static_cast<double>(light.arriving[lane]);
    if (first.met) add_first(i, group, first, place);
  }

  /// \param first_plane  of the light that it is a part of (Film::at).
  void add_light(std::size_t i, int group, const Lanes& shared, float alone, const SeenPoint& seen,
                 int places, std::size_t first_plane) {
    const CameraRay& ray = rays_[i];
    const int hero = places_[i].hero;
    const Pixel own = pixel_of(i);
    const bool own_gathers = &task_.gathering == &task_.sampling;
    for (int lane = 0; lane < lanes_; ++lane) {
      double value = static_cast<double>(shared[lane] * ray.weight[lane]);
      if (lane == hero) value += static_cast<double>(alone * ray.weight_alone);
      if (value == 0) continue;
      const std::size_t plane = first_plane + band(group, lane);
      if (waves_) value = add_waves(i, group, lane, value, seen, places, plane);
      if (value == 0) continue;
      std::optional<Pixel> pixel = own;
      if (ray.spread && lane != hero)
        pixel = task_.gathering.pixel_at(places_[i],
                                         static_cast<double>(ray.column[static_cast<std::size_t>(lane)]),
                                         static_cast<double>(ray.row[static_cast<std::size_t>(lane)]));
      else if (!own_gathers)
        pixel = task_.gathering.pixel_at(places_[i], places_[i].column, places_[i].row);
      if (pixel) add(*pixel, group, plane, value);
    }
  }

  /// The share of waves, at places that wavelengths do not have in common. \returns what is left to rays.
  double add_waves(std::size_t i, int group, int lane, double value, const SeenPoint& seen, int places,
                   std::size_t plane) {
    const auto& [u, v, lot, turn] = numbers_[i];
    value /= task_.gathering.site_share();
    const WaveImage::Spread spread =
        waves_->spread_of(static_cast<int>(band(group, lane)), seen, {lot, turn});
    if (spread.share == 0) return value;
    for (int k = lane * places; k < (lane + 1) * places; ++k) {
      const auto [column, row] = spread.place(turned(u, k * even_places[0]), turned(v, k * even_places[1]));
      if (const auto pixel = task_.gathering.pixel_at(places_[i], column, row))
        add(*pixel, group, plane, value * spread.share / places);
    }
    return value * (1 - spread.share);
  }

  /// In the pixel where the hero lands: metering asks for no more.
  void add_lamp(Pixel pixel, const Lanes& light, const CameraRay& ray) {
    double sum = 0;
    for (int lane = 0; lane < lanes_; ++lane) sum += static_cast<double>(light[lane] * ray.weight[lane]);
    film_.lamps[tile_.index(pixel.column, pixel.row)] += sum;
  }

  /// As WavelengthGroups::band(), for lanes that have one.
  std::size_t band(int group, int lane) const {
    return static_cast<std::size_t>(group + lane * task_.world.groups.count());
  }

  void add(Pixel pixel, int group, std::size_t plane, double value) {
    const PixelWindow& all = whole_.window;
    if (!all.contains(pixel.column, pixel.row)) {
      const PixelWindow& picture = whole_.whole;
      return result_.outside.push_back(
          {plane * picture.size() + picture.index(pixel.column, pixel.row), value});
    }
    if (!tile_.contains(pixel.column, pixel.row))
      return result_.strays[static_cast<std::size_t>(group)].push_back(
          {plane * all.size() + all.index(pixel.column, pixel.row), value});
    const std::size_t within = tile_.index(pixel.column, pixel.row);
    film_.at(plane * tile_.size() + within) += value;
    if (half_ && plane < whole_.arriving.size())
      film_.half[(plane * tile_.size() + within) % film_.half.size()] += value;
  }

  void add_first(std::size_t i, int group, const FirstSurface& first, const Transform& place) {
    const Pixel pixel = pixel_of(i);
    const std::size_t at = tile_.index(pixel.column, pixel.row), plane = tile_.size();
    const auto groups = static_cast<std::size_t>(task_.world.groups.count());
    const double depth = place.inverse_point(first.position).z;
    const auto gather = [&](ExactSum* met, ExactSum* depths, ExactSum* normals, ExactSum* albedos) {
      met[static_cast<std::size_t>(group) * plane + at] += 1;
      depths[at] += depth;
      normals[at] += first.normal.x;
      normals[plane + at] += first.normal.y;
      normals[2 * plane + at] += first.normal.z;
      for (int lane = 0; lane < lanes_; ++lane)
        albedos[band(group, lane) * plane + at] += static_cast<double>(first.albedo[lane]);
    };
    gather(film_.met.data(), film_.depth.data(), film_.normal.data(), film_.albedo.data());
    if (!half_ || film_.half_first.empty()) return;
    ExactSum* sums = film_.half_first.data();
    gather(sums, sums + groups * plane, sums + (groups + 1) * plane, sums + (groups + 4) * plane);
  }

  const TileTask& task_;
  PathTracer tracer_;
  const WaveImage* waves_;
  PixelWindow tile_;
  bool half_;
  int each_ = 0;   ///< samples of a pixel in a batch
  int lanes_ = 0;  ///< of the group whose samples are taken
  GroupSamples of_group_;
  Film& whole_;
  Film film_;                            ///< of the tile
  std::vector<SourceLight> of_sources_;  ///< of one path, if wanted
  TileResult result_;
  std::vector<SobolSample> samples_;
  std::vector<FilmSample> places_;
  std::vector<std::array<double, 4>> numbers_;  ///< that choose where waves land, if any
  std::vector<double> times_;                   ///< of the samples, if the camera moves
  Transform moved_;                             ///< where it then is
  std::vector<CameraRay> rays_;
};

}  // namespace

TileResult render_tile(const TileTask& task, const PixelWindow& tile,
                       const std::vector<SampleRange>& of_group, bool half, Film& film) {
  return TileRenderer(task, tile, half, film).run(of_group);
}

}  // namespace petzval::render
