// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/analysis/wave_rays.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/pose.h>
#include <petzval/lens/wavelength_range.h>
#include <petzval/render/camera/wave_image.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace petzval::render {

namespace {

/// Film beyond the frame whose points are followed. Light of a disk of q = 9, the widest that waves have half
/// of, is moved by two radii at most, 2 · √2 · 9 λN.
constexpr double margin_lambda_n = 25;
/// RMS spot of a round pupil with one wave of defocus [λN].
constexpr double spread_per_wave = 2 * std::numbers::sqrt2;
/// Between two nodes of defocus a mixture of their PSFs stands for the one there: at the peak it is too low
/// by (2π h)²/96, 0.4 % of the peak for h = 0.1 waves.
constexpr double fine_step_waves = 0.1, coarse_step_waves = 0.25, fine_waves = 1;
/// Wavelengths with PSFs of their own, at most.
constexpr std::size_t most_node_bands = 8;
/// Of a stop with blades.
constexpr std::size_t bladed_azimuths = 8;
constexpr double sample_lambda_n = 0.3;
constexpr int largest_psf = 128;
/// Objects beyond 100 km are infinitely far.
constexpr double least_vergence = 1e-8;
/// In front of the lens, or of a pupil before it.
constexpr double nearest_mm = 1;
constexpr int spot_azimuths = 24, spot_radii = 6, focus_rounds = 3;

std::vector<double> defocus_nodes() {
  std::vector<double> result{0};
  while (spread_per_wave * result.back() < WaveImage::only_rays) {
    const double step = result.back() < fine_waves - 1e-9 ? fine_step_waves : coarse_step_waves;
    result.push_back(result.back() + step);
    result.insert(result.begin(), -result.back());
  }
  return result;
}

/// Of rays through a pupil that is round in the stop, about their centroid.
struct RaySpot {
  double variance_mm2 = 0, lambda_n_mm = 0;
};

std::optional<RaySpot> ray_spot(FieldTracer& tracer, double field) {
  const std::optional<ChiefRay> chief = tracer.chief_ray(field);
  const auto pupil = chief ? tracer.round_object_pupil(*chief, spot_azimuths) : std::nullopt;
  if (!pupil) return {};
  std::vector<PupilNode> nodes = pupil_nodes(*pupil, spot_radii);
  for (std::size_t i = 0; i < pupil->own(); ++i)  // the rim, for the pupil's width
    nodes.push_back({pupil->rim(i)[0], pupil->rim(i)[1], 0});
  const std::vector<WaveRay> rays = trace_wave_rays(tracer, *chief, *pupil, nodes);
  double sum = 0, t = 0, square = 0, alpha = 0, low = 2, high = -2;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const WaveRay& ray = rays[i];
    if (!ray.passes) continue;
    const double weight = nodes[i].weight;
    sum += weight, t += weight * ray.t_mm;
    square += weight * (ray.s_mm * ray.s_mm + ray.t_mm * ray.t_mm);
    alpha = std::max(alpha, std::abs(ray.alpha));
    low = std::min(low, ray.beta), high = std::max(high, ray.beta);
  }
  const double width = std::max(2 * alpha, high - low);
  if (!(sum > 0) || !(width > 0)) return {};
  const double lambda_mm = tracer.tracer().wavelength_nm() * mm_per_nm / tracer.tracer().image_index();
  return RaySpot{std::max(0.0, square / sum - t * t / (sum * sum)), lambda_mm / width};
}

/// Chooses one of two neighbours on a line by a number, which it uses up.
std::size_t either(double place, std::size_t count, double& number) {
  const double within = std::clamp(place, 0.0, static_cast<double>(count - 1));
  const std::size_t low = std::min(static_cast<std::size_t>(within), count - 1);
  const double share = within - static_cast<double>(low);
  const bool upper = number < share;
  number = upper ? number / share : (number - share) / (1 - share);
  return upper ? low + 1 : low;
}

/// Nodes are evenly spread over the bands.
std::vector<std::size_t> bands_with_nodes(std::size_t bands) {
  std::vector<std::size_t> result;
  const std::size_t count = std::min(bands, most_node_bands);
  for (std::size_t i = 0; i < count; ++i) result.push_back((2 * i + 1) * bands / (2 * count));
  return result;
}

}  // namespace

/// In the lens's own terms.
struct WaveImage::Place {
  double angle = 0, vergence = 0;
  double x = 0, y = 1;  ///< unit vector from the axis to the object
};

double WaveImage::Focus::vergence(double waves) const {
  return best_vergence + waves * lambda_n_mm * spread_per_wave / slope_mm2;
}

double WaveImage::Focus::waves(double vergence) const {
  return slope_mm2 * (vergence - best_vergence) / (lambda_n_mm * spread_per_wave);
}

double WaveImage::Focus::spread(double vergence) const {
  return std::hypot(least_mm, slope_mm2 * (vergence - best_vergence)) / lambda_n_mm;
}

WaveImage::WaveImage(const Lens& lens, const SensorGeometry& film, std::vector<double> wavelengths_nm,
                     const Options& options)
    : lens_(lens),
      film_(film),
      wavelengths_nm_(std::move(wavelengths_nm)),
      options_(options),
      defocus_waves_(defocus_nodes()),
      node_bands_(bands_with_nodes(wavelengths_nm_.size())),
      azimuths_(lens.stop_blades().count > 0 ? bladed_azimuths : 1),
      psfs_(node_bands_.size() * radii * azimuths_ * defocus_waves_.size()) {
  require_centred(lens_,
                  "rendered diffraction is that of centred lenses, by film radius; pictures of flat scenes "
                  "have that of any");
  // Wherever an object stands, the stop is as wide as it is.
  lens_.aperture = {Aperture::Kind::stop_semi_diameter_mm, stop_radius_mm(lens)};
  const std::vector<double>& nm = wavelengths_nm_;
  const double pitch_mm = film_.pitch_um * mm_per_um;
  const double lambda_n_mm = std::ranges::max(nm) * mm_per_nm * first_order(lens_).working_f_number;
  margin_pixels_ = static_cast<int>(std::ceil(margin_lambda_n * lambda_n_mm / pitch_mm));

  // Rays that land within the margin may belong to points as far beyond it.
  const double reach_mm = film_.half_diagonal_mm() + 2 * margin_pixels_ * pitch_mm;
  const std::size_t optics = petzval::disperses(lens_, nm) ? nm.size() : 1;
  std::vector<std::optional<ChiefImage>> chiefs(optics);
  parallel_tasks(optics,
                 [&](std::size_t i) { chiefs[i].emplace(lens_, nm[i], Tracer::Clip::apertures, reach_mm); });
  last_mm_ = reach_mm;
  for (std::optional<ChiefImage>& each : chiefs) {
    last_mm_ = std::min(last_mm_, each->last_height_mm());
    chiefs_.push_back(*std::move(each));
  }
  focus_.resize(nm.size() * radii);
  parallel_tasks(optics * radii,
                 [&](std::size_t i) { focus_[i] = find_focus(i / radii, height_mm(i % radii)); });
  for (std::size_t i = optics * radii; i < focus_.size(); ++i) {
    focus_[i] = focus_[i % radii];
    focus_[i].lambda_n_mm *= nm[i / radii] / nm[0];
  }
  for (std::size_t band = 0; band < nm.size(); ++band)
    node_band_of_.push_back(band * node_bands_.size() / nm.size());
}

WaveImage::~WaveImage() {
  for (std::atomic<const Node*>& each : psfs_) delete each.load();
}

/// The lens with its object plane at a vergence.
Lens WaveImage::focused_at(std::size_t optics, double vergence) const {
  Lens lens = lens_;
  lens.object_distance_mm.reset();
  if (vergence > least_vergence) lens.object_distance_mm = 1 / vergence - chiefs_[optics].pupil_z_mm();
  return lens;
}

/// In that plane, towards positive y: a far object's field angle is that of its light, which goes down.
double WaveImage::field_of(std::size_t optics, double angle, double vergence) const {
  const ChiefImage& chief = chiefs_[optics];
  return vergence > least_vergence ? chief.radius_mm(angle, chief.pupil_z_mm() - 1 / vergence)
                                   : -degrees(angle);
}

WaveImage::Focus WaveImage::find_focus(std::size_t optics, double height_mm) const {
  const ChiefImage& chief = chiefs_[optics];
  const double angle = chief.angle_at(height_mm);
  const double most_vergence = 1 / (std::max(0.0, chief.pupil_z_mm()) + nearest_mm);
  const double efl_mm = std::abs(first_order(lens_).efl_mm);
  Focus result;
  double first = 0, step = std::min(1 / (20 * efl_mm), most_vergence / 4);
  for (int round = 0; round < focus_rounds; ++round) {
    std::array<double, 3> variance{};
    double lambda_n_mm = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double vergence = first + static_cast<double>(i) * step;
      FieldTracer tracer(focused_at(optics, vergence), wavelengths_nm_[optics]);
      const std::optional<RaySpot> spot = ray_spot(tracer, field_of(optics, angle, vergence));
      if (!spot) return {};
      variance[i] = spot->variance_mm2;
      lambda_n_mm = spot->lambda_n_mm;
    }
    // The parabola through them, in steps from the first.
    const double second = (variance[0] - 2 * variance[1] + variance[2]) / 2;
    const double slope = variance[1] - variance[0] - second;
    if (!(second > 0)) return {};
    const double least = -slope / (2 * second);
    result = {first + step * least, std::sqrt(second) / step,
              std::sqrt(std::max(0.0, variance[0] - second * least * least)), lambda_n_mm};
    step = result.vergence(1) - result.best_vergence;
    first = std::clamp(result.best_vergence - step, 0.0, std::max(0.0, most_vergence - 2 * step));
  }
  return result;
}

WaveImage::Node WaveImage::make_psf(std::size_t band, std::size_t radius, std::size_t azimuth,
                                    double waves) const {
  const std::size_t optics = optics_of(band);
  const ChiefImage& chief = chiefs_[optics];
  const Focus& focus = this->focus(band, radius);
  const double most_vergence = 1 / (std::max(0.0, chief.pupil_z_mm()) + nearest_mm);
  const double vergence = std::clamp(focus.vergence(waves), 0.0, most_vergence);
  FieldTracer tracer(focused_at(optics, vergence), wavelengths_nm_[band], Tracer::Clip::apertures,
                     360.0 * static_cast<double>(azimuth) / static_cast<double>(azimuths_));
  tracer.set_losses(options_.losses);
  const auto ray = tracer.chief_ray(field_of(optics, chief.angle_at(height_mm(radius)), vergence));
  if (!ray) return {};
  PsfOptions options;
  options.largest_size = largest_psf;
  const std::optional<PsfPlan> plan = plan_psf(tracer, *ray, options);
  if (!plan) return {};
  const double lambda_n_um = focus.lambda_n_mm * um_per_mm;
  options.spacing_um = std::max(sample_lambda_n * lambda_n_um, plan->size * plan->spacing_um / largest_psf);
  const std::optional<Psf> psf = point_spread(tracer, *ray, options);
  if (!psf) return {};
  return PsfSampler(*psf, 2 * psf->spacing_um <= lambda_n_um);
}

/// Whoever asks first makes it; two that ask at once make the same.
const WaveImage::Node& WaveImage::psf(std::size_t node_band, std::size_t radius, std::size_t azimuth,
                                      std::size_t defocus) const {
  std::atomic<const Node*>& kept =
      psfs_[((node_band * radii + radius) * azimuths_ + azimuth) * defocus_waves_.size() + defocus];
  if (const Node* node = kept.load(std::memory_order_acquire)) return *node;
  auto made = std::make_unique<const Node>(
      make_psf(node_bands_[node_band], radius, azimuth, defocus_waves_[defocus]));
  const Node* before = nullptr;
  return kept.compare_exchange_strong(before, made.get(), std::memory_order_acq_rel) ? *made.release()
                                                                                     : *before;
}

std::optional<WaveImage::Place> WaveImage::place_of(const SeenPoint& point, std::size_t optics) const {
  const ChiefImage& chief = chiefs_[optics];
  const bool far = std::isinf(point.distance);
  const Vector3 seen =
      far ? point.direction
          : (1 / options_.scene_units_per_mm) * (point.origin + point.distance * point.direction);
  const double across = std::hypot(seen.x, seen.y), z_mm = options_.origin_z_mm - seen.z;
  const std::optional<double> angle =
      far ? chief.angle_of_direction(across, seen.z) : chief.angle_of(across, z_mm);
  if (!angle) return {};
  Place place{*angle, far ? 0 : 1 / (chief.pupil_z_mm() - z_mm)};
  if (across > 0) place.x = seen.x / across, place.y = seen.y / across;
  return place;
}

std::array<double, 2> WaveImage::Spread::place(double u, double v) const {
  const auto [s, t] = psf->place(u, v);
  return {column + s * along_s[0] + t * along_t[0], row + s * along_s[1] + t * along_t[1]};
}

WaveImage::Spread WaveImage::spread_of(int of_band, const SeenPoint& point,
                                       const std::array<double, 2>& lots) const {
  const auto band = static_cast<std::size_t>(of_band);
  const std::optional<Place> place = place_of(point, optics_of(band));
  if (!place) return {};
  const double height = chiefs_[optics_of(band)].height_mm(place->angle);
  const double at = std::abs(height) / last_mm_ * (radii - 1);
  if (at > radii - 1) return {};
  const std::size_t inner = std::min(static_cast<std::size_t>(at), radii - 2);
  const Focus &low = focus(band, inner), &high = focus(band, inner + 1);
  if (low.lambda_n_mm == 0 || high.lambda_n_mm == 0) return {};
  const double q =
      std::lerp(low.spread(place->vergence), high.spread(place->vergence), at - static_cast<double>(inner));
  Spread result;
  result.share = std::clamp((only_rays - q) / (only_rays - only_waves), 0.0, 1.0);
  if (result.share == 0) return {};

  // One of the nodes about it.
  auto [lot, turn] = lots;
  const std::size_t radius = either(at, radii, lot);
  const double waves = focus(band, radius).waves(place->vergence);
  const auto above = std::upper_bound(defocus_waves_.begin() + 1, defocus_waves_.end() - 1, waves);
  const double defocus =
      static_cast<double>(above - defocus_waves_.begin()) - (*above - waves) / (*above - *(above - 1));
  std::size_t azimuth = 0;
  double x = place->x, y = place->y;  // where the PSF's own object lies
  if (azimuths_ > 1) {
    const double turns = std::atan2(-x, y) / (2 * pi);
    azimuth = either((turns < 0 ? turns + 1 : turns) * static_cast<double>(azimuths_), azimuths_ + 1, turn) %
              azimuths_;
    const double angle = 2 * pi * static_cast<double>(azimuth) / static_cast<double>(azimuths_);
    x = -std::sin(angle), y = std::cos(angle);
  }
  const std::size_t node_band = node_band_of_[band];
  const Node& psf = this->psf(node_band, radius, azimuth, either(defocus, defocus_waves_.size(), lot));
  if (!psf) return {};

  // Along t, away from the axis, and s beside it; pictures are upright.
  const double pitch_mm = film_.pitch_um * mm_per_um;
  const double scale = (height < 0 ? -1 : 1) * mm_per_um * focus(band, radius).lambda_n_mm /
                       focus(node_bands_[node_band], radius).lambda_n_mm / pitch_mm;
  result.psf = &*psf;
  result.along_s = {-scale * y, -scale * x};
  result.along_t = {-scale * x, scale * y};
  result.column = film_.columns / 2.0 - height * place->x / pitch_mm;
  result.row = film_.rows / 2.0 + height * place->y / pitch_mm;
  return result;
}

}  // namespace petzval::render
