// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/stop.h>
#include <petzval/base/units.h>
#include <petzval/colour/rgb_to_spectrum.h>
#include <petzval/render/disk_point.h>
#include <petzval/render/lights/environment.h>

#include <algorithm>

namespace petzval::render {

namespace {

/// Index of the interval of a cumulative list that holds `at`, and how far into it.
std::size_t find_interval(const double* begin, std::size_t count, double at, double& share) {
  const double* above = std::upper_bound(begin + 1, begin + count, at);
  const std::size_t i = std::min(static_cast<std::size_t>(above - begin) - 1, count - 2);
  const double low = begin[i], high = begin[i + 1];
  share = high > low ? std::clamp((at - low) / (high - low), 0.0, 1 - 1e-12) : 0.5;
  return i;
}

/// Running sums scaled to end at 1; even if all weights are 0. Returns the sum.
double accumulate(const double* weights, std::size_t count, double* cumulative) {
  cumulative[0] = 0;
  for (std::size_t i = 0; i < count; ++i) cumulative[i + 1] = cumulative[i] + weights[i];
  const double sum = cumulative[count];
  for (std::size_t i = 1; i <= count; ++i)
    cumulative[i] = sum > 0 ? cumulative[i] / sum : static_cast<double>(i) / static_cast<double>(count);
  return sum;
}

}  // namespace

SquareDistribution::SquareDistribution(std::vector<double> weights, int width, int height)
    : width_(width), height_(height) {
  const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
  rows_.resize(h + 1);
  cells_.resize(h * (w + 1));
  std::vector<double> sums(h);
  for (std::size_t row = 0; row < h; ++row)
    sums[row] = accumulate(&weights[row * w], w, &cells_[row * (w + 1)]);
  accumulate(sums.data(), h, rows_.data());
}

SquareDistribution::Point SquareDistribution::sample(double u, double v) const {
  const auto w = static_cast<std::size_t>(width_), h = static_cast<std::size_t>(height_);
  double down, across;
  const std::size_t row = find_interval(rows_.data(), h + 1, v, down);
  const double* cells = &cells_[row * (w + 1)];
  const std::size_t cell = find_interval(cells, w + 1, u, across);
  const double density = (rows_[row + 1] - rows_[row]) * static_cast<double>(h) *
                         (cells[cell + 1] - cells[cell]) * static_cast<double>(w);
  return {(static_cast<double>(cell) + across) / static_cast<double>(w),
          (static_cast<double>(row) + down) / static_cast<double>(h), density};
}

double SquareDistribution::density(double u, double v) const {
  const auto w = static_cast<std::size_t>(width_), h = static_cast<std::size_t>(height_);
  const auto place = [](double at, std::size_t count) {
    return std::min(static_cast<std::size_t>(std::max(0.0, at * static_cast<double>(count))), count - 1);
  };
  const std::size_t row = place(v, h), cell = place(u, w);
  const double* cells = &cells_[row * (w + 1)];
  return (rows_[row + 1] - rows_[row]) * static_cast<double>(h) * (cells[cell + 1] - cells[cell]) *
         static_cast<double>(w);
}

Vector3 sphere_from_square(double u, double v) {
  const double a = 2 * u - 1, b = 2 * v - 1, up = std::abs(a), vp = std::abs(b);
  const double from_edge = 1 - (up + vp), r = 1 - std::abs(from_edge);
  const double phi = (r == 0 ? 1 : (vp - up) / r + 1) * pi / 4;
  const double z = std::copysign(1 - r * r, from_edge), rho = r * std::sqrt(std::max(0.0, 2 - r * r));
  return {std::copysign(std::cos(phi), a) * rho, std::copysign(std::sin(phi), b) * rho, z};
}

void square_from_sphere(Vector3 d, double& u, double& v) {
  const double x = std::abs(d.x), y = std::abs(d.y), r = std::sqrt(std::max(0.0, 1 - std::abs(d.z)));
  const double phi = x == 0 && y == 0 ? 0 : std::atan2(std::min(x, y), std::max(x, y)) * 2 / pi;
  const double share = x < y ? 1 - phi : phi;
  double vp = share * r, up = r - vp;
  if (d.z < 0) {
    std::swap(up, vp);
    up = 1 - up, vp = 1 - vp;
  }
  u = (std::copysign(up, d.x) + 1) / 2;
  v = (std::copysign(vp, d.y) + 1) / 2;
}

namespace {

/// The real spherical harmonics to order 2 of a unit direction.
std::array<double, 9> harmonics(Vector3 d) {
  static const double c0 = std::sqrt(1 / (4 * pi)), c1 = std::sqrt(3 / (4 * pi)),
                      c2 = std::sqrt(15 / (4 * pi)), c20 = std::sqrt(5 / (16 * pi)),
                      c22 = std::sqrt(15 / (16 * pi));
  return {c0,
          c1 * d.y,
          c1 * d.z,
          c1 * d.x,
          c2 * d.x * d.y,
          c2 * d.y * d.z,
          c20 * (3 * d.z * d.z - 1),
          c2 * d.x * d.z,
          c22 * (d.x * d.x - d.y * d.y)};
}

/// What a cosine leaves of each order (Ramamoorthi & Hanrahan 2001, equation 8).
constexpr std::array<double, 9> cosine_of_order{pi,     2 * pi / 3, 2 * pi / 3, 2 * pi / 3, pi / 4,
                                                pi / 4, pi / 4,     pi / 4,     pi / 4};

/// Light that is even all around is found as well by the directions that surfaces scatter to, so that it is
/// asked for little (MIS compensation: Karlík, Šik, Vévoda, Skřivan & Křivánek, ACM Trans. Graph. 38 (2019)
/// 6, who ask for nothing of it).
void leave_even_part(std::vector<double>& weights, double mean) {
  constexpr double least = 0.05;  // of the light, so that asking alone finds everything
  for (double& each : weights) each = std::max(each - mean, least * each);
}

}  // namespace

struct Environment::Sky {
  std::shared_ptr<const PictureFile> picture;
  SquareDistribution distribution;
  struct Pixel {
    SigmoidReflectance shape;
    float scale;
  };
  std::vector<Pixel> pixels;
  WavelengthGroups groups;

  /// Of the picture, as SquareDistribution has it.
  double luminance_at(double u, double v) const {
    const int side = picture->width;
    const auto cell = [&](double at) { return std::clamp(static_cast<int>(at * side), 0, side - 1); };
    const float* p = picture->pixel(cell(u), cell(v));
    const bool grey = picture->channels == 1;
    return static_cast<double>(std::max(0.0f, p[0]) + std::max(0.0f, p[grey ? 0 : 1]) +
                               std::max(0.0f, p[grey ? 0 : 2])) /
           3;
  }
  const Pixel& at(double u, double v) const {
    const int side = picture->width;
    const int column = std::clamp(static_cast<int>(u * side), 0, side - 1);
    const int row = std::clamp(static_cast<int>(v * side), 0, side - 1);
    return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(side) +
                  static_cast<std::size_t>(column)];
  }
};

Environment::Environment(BandSpectrum radiance, Transform world_from_light)
    : radiance_(std::move(radiance)),
      world_from_light_(std::move(world_from_light)),
      mean_(mean_of(radiance_)) {}

Environment::Environment(const std::shared_ptr<const PictureFile>& picture, BandSpectrum white,
                         const WavelengthGroups& groups, Transform world_from_light)
    : radiance_(std::move(white)), world_from_light_(std::move(world_from_light)) {
  const ReflectanceTable table;
  std::vector<Sky::Pixel> pixels;
  std::vector<double> weights;
  double sum = 0, squares = 0;
  for (int row = 0; row < picture->height; ++row) {
    check_stop();
    for (int column = 0; column < picture->width; ++column) {
      const float* p = picture->pixel(column, row);
      const bool grey = picture->channels == 1;
      const LinearRgb rgb{std::max(0.0f, p[0]), std::max(0.0f, p[grey ? 0 : 1]),
                          std::max(0.0f, p[grey ? 0 : 2])};
      const double scale = 2 * std::max({rgb.r, rgb.g, rgb.b});
      Sky::Pixel pixel{{}, static_cast<float>(scale)};
      if (scale > 0) pixel.shape = table({rgb.r / scale, rgb.g / scale, rgb.b / scale});
      pixels.push_back(pixel);
      weights.push_back((rgb.r + rgb.g + rgb.b) / 3);
      sum += weights.back(), squares += weights.back() * weights.back();
      const auto basis =
          harmonics(sphere_from_square((column + 0.5) / picture->width, (row + 0.5) / picture->height));
      for (std::size_t i = 0; i < basis.size(); ++i) irradiance_[i] += weights.back() * basis[i];
    }
  }
  const auto count = static_cast<double>(weights.size());
  leave_even_part(weights, sum / count);
  const double white_mean = mean_of(radiance_);
  mean_ = white_mean * sum / count;
  if (squares > 0) unevenness_ = 1 - sum * sum / (count * squares);
  for (std::size_t i = 0; i < irradiance_.size(); ++i)
    irradiance_[i] *= white_mean * cosine_of_order[i] * 4 * pi / count;
  sky_ = std::make_shared<const Sky>(
      Sky{picture, SquareDistribution(weights, picture->width, picture->height), std::move(pixels), groups});
}

Lanes Environment::radiance(const Vector3& direction, int group) const {
  const Lanes& white = radiance_[static_cast<std::size_t>(group)];
  if (!sky_) return white;
  double u, v;
  square_from_sphere(normalised(world_from_light_.inverse_direction(direction)), u, v);
  const Sky::Pixel& pixel = sky_->at(u, v);
  Lanes result;
  for (int i = 0; i < lane_count; ++i)
    result[i] =
        white[i] * pixel.scale * static_cast<float>(pixel.shape.at(sky_->groups.wavelength_nm(group, i)));
  return result;
}

double Environment::luminance(Vector3 direction) const {
  if (!sky_) return mean_;
  double u, v;
  square_from_sphere(normalised(world_from_light_.inverse_direction(direction)), u, v);
  return mean_of(radiance_) * sky_->luminance_at(u, v);
}

void Environment::put_behind(Portal portal) {
  // A map as fine as the picture, within reason: an even light needs few cells, and a large one is held
  // thrice.
  constexpr int least = 64, most = 1024;
  const int side = sky_ ? sky_->picture->width : 1;
  std::vector<Vector3> bright;
  for (int row = 0; sky_ && row < side; ++row)
    for (int column = 0; column < side; ++column)
      bright.push_back(normalised(
          world_from_light_.direction(sphere_from_square((column + 0.5) / side, (row + 0.5) / side))));
  portal.rectify(
      std::clamp(side, least, most), [&](Vector3 direction) { return luminance(direction); }, bright);
  portal_ = std::make_shared<const Portal>(std::move(portal));
}

double Environment::importance(const LightReceiver& to) const {
  if (portal_)
    return to.all_around ? portal_->fluence(to.position)
                         : portal_->irradiance(to.position, to.normal, to.both_sides);
  double whole = to.all_around ? fluence() : irradiance(to.normal);
  if (to.both_sides) whole += irradiance(-to.normal);
  // An even sky is found as well by the directions that the surface scatters to: asking for it saves little,
  // where asking for a lamp saves much. 0.1 to 0.4 are alike in a room with a window and on open floors.
  constexpr double of_even_sky = 0.2;
  return whole * (of_even_sky + (1 - of_even_sky) * unevenness());
}

double Environment::fluence() const {
  return 4 * pi * mean_;
}

double Environment::irradiance(Vector3 normal) const {
  const double even = pi * mean_;
  if (!sky_) return even;
  const auto basis = harmonics(normalised(world_from_light_.inverse_direction(normal)));
  double sum = 0;
  for (std::size_t i = 0; i < basis.size(); ++i) sum += irradiance_[i] * basis[i];
  constexpr double at_least = 0.05;  // the series rings, and surfaces see more than a cosine's hemisphere
  return std::max(at_least * even, sum);
}

Environment::Sample Environment::sample(const LightReceiver& to, double u, double v) const {
  if (portal_) {
    const Portal::Sample through = portal_->sample(to.position, u, v);
    return {through.direction, through.pdf};
  }
  if (!sky_ && to.all_around) {
    const Vector3 direction = sphere_from_square(u, v);
    return {direction, pdf(to, direction)};
  }
  if (!sky_) {
    const bool behind = to.both_sides && u < 0.5;
    if (to.both_sides) u = behind ? 2 * u : 2 * u - 1;
    const DiskPoint on = disk_point(u, v);
    const double up = std::sqrt(std::max(0.0, 1 - on.x * on.x - on.y * on.y));
    const Vector3 direction = Frame(to.normal).from_local({on.x, on.y, behind ? -up : up});
    return {direction, pdf(to, direction)};
  }
  const SquareDistribution::Point point = sky_->distribution.sample(u, v);
  return {normalised(world_from_light_.direction(sphere_from_square(point.u, point.v))),
          point.density / (4 * pi)};
}

double Environment::pdf(const LightReceiver& to, Vector3 direction) const {
  if (portal_) return portal_->pdf(to.position, direction);
  if (!sky_ && to.all_around) return 1 / (4 * pi);
  if (!sky_) {
    const double cos = dot(to.normal, direction);
    return to.both_sides ? std::abs(cos) / (2 * pi) : std::max(0.0, cos) / pi;
  }
  double u, v;
  square_from_sphere(normalised(world_from_light_.inverse_direction(direction)), u, v);
  return sky_->distribution.density(u, v) / (4 * pi);
}

}  // namespace petzval::render
