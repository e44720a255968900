// SPDX-License-Identifier: BSD-3-Clause
// Light that lands as waves do: Airy's disc in focus, rays where nothing is, all of the light in both.
#include <gtest/gtest.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>
#include <petzval/numeric/sobol.h>
#include <petzval/render/camera/lens_camera.h>
#include <petzval/render/film/checkpoint.h>

#include <cmath>

#include "scene_text.h"
#include "scratch.h"

namespace petzval::render {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr std::uint32_t draws = 1 << 16;

/// On a film of 1 µm pixels 2 mm wide; camera space in mm, from the film.
struct Waves {
  explicit Waves(double f_number, std::optional<double> focus_m, std::vector<double> nm = {550},
                 const StopBlades& blades = {}, const char* name = "dgauss-50mm")
      : camera(read_lens(name).lens) {
    camera.set_f_number(f_number);
    camera.set_blades(blades);
    camera.focus_at_m(focus_m);
    image.emplace(camera.lens(), film, nm, WaveImage::Options{1, camera.lens().total_track_mm(), {}});
    lambda_n_px = nm[0] * 1e-3 * first_order(camera.lens()).working_f_number;
  }

  /// Landings of a point [pixels], from where its chief ray lands.
  std::vector<std::array<double, 2>> spread_of(const SeenPoint& point, double column, double row) const {
    std::vector<std::array<double, 2>> result;
    for (std::uint32_t i = 0; i < draws; ++i) {
      const auto [u, v, lot, turn] = SobolSample(3, i).next4();
      const WaveImage::Spread spread = image->spread_of(0, point, {lot, turn});
      EXPECT_EQ(spread.share, 1);
      const auto [at_column, at_row] = spread.place(u, v);
      result.push_back({at_column - column, at_row - row});
    }
    return result;
  }

  MountedLens camera;
  SensorGeometry film{2000, 2000, 1};
  std::optional<WaveImage> image;
  double lambda_n_px = 0;
};

double within(const std::vector<std::array<double, 2>>& landings, double radius) {
  std::size_t inside = 0;
  for (const auto& [x, y] : landings) inside += std::hypot(x, y) < radius ? 1 : 0;
  return static_cast<double>(inside) / static_cast<double>(landings.size());
}

/// Lord Rayleigh's, radius in λN.
double airy_within(double radius) {
  const double j0 = std::cyl_bessel_j(0, pi * radius), j1 = std::cyl_bessel_j(1, pi * radius);
  return 1 - j0 * j0 - j1 * j1;
}

double airy_contrast(double s) {
  return 2 / pi * (std::acos(s) - s * std::sqrt(1 - s * s));
}

TEST(WaveImage, OfADistantLampIsAirysDisc) {
  const Waves waves(22, {});
  const auto landings = waves.spread_of({{}, {0, 0, 1}, infinite}, 1000, 1000);
  // 0.02 of the light: the window of a PSF leaves out 1 %, 65,536 draws at random 0.004.
  for (const double radius : {0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0})
    EXPECT_NEAR(within(landings, radius * waves.lambda_n_px), airy_within(radius), 0.02) << radius;
  for (int i = 1; i <= 12; ++i) {
    double sum = 0;
    for (const auto& [x, y] : landings) sum += std::cos(2 * pi * 0.1 * i * x / waves.lambda_n_px);
    EXPECT_NEAR(sum / draws, i < 10 ? airy_contrast(0.1 * i) : 0, 0.02) << i;
  }
}

/// The middle of the light of a point off the axis is about where a tracer that knows nothing of curves sends
/// its chief ray, at any distance and in the right quarter of the picture; and rays that see it say the same.
TEST(WaveImage, LandsAboutTheChiefRay) {
  const Waves waves(16, 1.5);
  const double film_z = waves.camera.lens().total_track_mm();
  for (const double distance_mm : {1450.0, 1500.0, 1560.0}) {
    Lens lens = waves.camera.lens();
    lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, stop_radius_mm(lens)};
    lens.object_distance_mm = distance_mm - film_z;
    FieldTracer tracer(lens, 550);
    const std::optional<ChiefRay> chief = tracer.chief_ray(20);
    ASSERT_TRUE(chief);
    // To the right and below: 20 mm from the axis.
    const SeenPoint point{{}, {16, -12, distance_mm}, 1};
    const double h = std::abs(chief->image_height_mm) * 1e3;
    const auto landings = waves.spread_of(point, 1000 + 0.8 * h, 1000 + 0.6 * h);
    double x = 0, y = 0;
    for (const auto& [dx, dy] : landings) x += dx / draws, y += dy / draws;
    // The light's own width by the root of the draws, and what the middle of a PSF is off: a twentieth of λN.
    EXPECT_NEAR(x, 0, 0.05 * waves.lambda_n_px) << distance_mm;
    EXPECT_NEAR(y, 0, 0.05 * waves.lambda_n_px) << distance_mm;
  }
}

/// A round pupil W waves out of focus has spots of q = 2√2 W, and W = (a²/2)(1/s − 1/s₀)/λ to first order.
TEST(WaveImage, LeavesWhatIsOutOfFocusToRays) {
  const Waves waves(8, 1.5);
  const FirstOrder optics = first_order(waves.camera.lens());
  const double a = optics.entrance_pupil.diameter_mm / 2;
  const double pupil_z = optics.entrance_pupil.position_mm, film_z = waves.camera.lens().total_track_mm();
  const auto share_at = [&](double waves_out) {
    const double in_focus = 1 / (1500 - film_z + pupil_z);
    const double s = 1 / (in_focus + waves_out * 2 * 550e-6 / (a * a));
    return waves.image->spread_of(0, {{}, {0, 0, s + film_z - pupil_z}, 1}, {0.5, 0.5}).share;
  };
  const double per_wave = 2 * std::sqrt(2.0);
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_EQ(share_at(sign * 5.5 / per_wave), 1);
    EXPECT_EQ(share_at(sign * 12.5 / per_wave), 0);
  }
  // Where spots are least is not quite the paraxial focus: the mean of both sides.
  EXPECT_NEAR((share_at(9 / per_wave) + share_at(-9 / per_wave)) / 2, 0.5, 0.05);
}

/// Blades turn with the camera, not with the field.
TEST(WaveImage, SpreadsAcrossTheBlades) {
  const auto in_cross = [](const StopBlades& blades, double turned, double x, double y) {
    const Waves waves(22, {}, {550}, blades);
    const WaveImage::Spread middle = waves.image->spread_of(0, {{}, {x, y, 1}, infinite}, {0.5, 0.5});
    double arms = 0, all = 0;
    for (const auto& [dx, dy] : waves.spread_of({{}, {x, y, 1}, infinite}, middle.column, middle.row)) {
      if (std::hypot(dx, dy) < 4 * waves.lambda_n_px) continue;
      ++all;
      if (std::abs(std::remainder(std::atan2(dy, dx) - turned, pi / 2)) < pi / 16) ++arms;
    }
    return arms / all;
  };
  // Corners at the top and the sides; turned by 45 degrees the edges face them. A quarter of all azimuths.
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, {0.01, 0.007}}) {
    EXPECT_GT(in_cross({4, 45}, 0, x, y), 0.6);
    EXPECT_LT(in_cross({4, 45}, pi / 4, x, y), 0.15);
    EXPECT_GT(in_cross({4, 0}, pi / 4, x, y), 0.6);
  }
}

TEST(WaveImage, GrowsWithTheWavelengthWhereBandsShareTheirPsfs) {
  std::vector<double> nm;
  for (int i = 0; i < 31; ++i) nm.push_back(400 + 10 * i);
  const Waves waves(22, {}, nm);
  for (const int band : {1, 14, 29}) {
    std::vector<std::array<double, 2>> landings;
    for (std::uint32_t i = 0; i < draws / 4; ++i) {
      const auto [u, v, lot, turn] = SobolSample(3, i).next4();
      const auto [x, y] = waves.image->spread_of(band, {{}, {0, 0, 1}, infinite}, {lot, turn}).place(u, v);
      landings.push_back({x - 1000, y - 1000});
    }
    const double lambda_n_px = waves.lambda_n_px * nm[static_cast<std::size_t>(band)] / nm[0];
    for (const double radius : {0.5, 1.0, 2.0})
      EXPECT_NEAR(within(landings, radius * lambda_n_px), airy_within(radius), 0.02) << band << " " << radius;
  }
}

TEST(WaveImage, RefusesLensesThatAreNotCentred) {
  Lens lens = read_lens("dgauss-50mm").lens;
  lens.surfaces[2].pose.tilt_x_deg = 0.1;
  EXPECT_THROW(WaveImage(lens, {10, 10, 5}, {550}, {}), InputError);
}

/// Light is seen behind a mirror as far away as it is.
TEST(PathTracer, CountsDistancesThroughMirrors) {
  const auto world = world_of(
      "Material \"conductor\" \"float roughness\" 0\n"
      "Shape \"bilinearmesh\" \"point3 P\" [ -1 -1 1  1 -1 1  -1 1 1  1 1 1 ]\n"
      "Material \"diffuse\"\nShape \"bilinearmesh\" \"point3 P\" [ -1 -1 -.5  1 -1 -.5  -1 1 -.5  1 1 -.5 "
      "]\n" +
      std::string(white_furnace));
  const PathTracer tracer(*world, {});
  SobolSample sample(1, 0);
  EXPECT_NEAR(tracer.trace({0, 0, 0}, {0, 0, 1}, 0, 0, sample).distance, 2.5, 1e-5);
  EXPECT_NEAR(tracer.trace({0, 0, 0}, {0, 0, -1}, 0, 0, sample).distance, 0.5, 1e-5);
  EXPECT_EQ(tracer.trace({0, 0, 0}, {0, 1, 0}, 0, 0, sample).distance, infinite);
}

/// A checkered wall at a distance from the lens, through f/16 focused at 1.5 m.
struct WallPicture {
  explicit WallPicture(const char* distance, const char* lens_name = "dgauss-50mm",
                       std::vector<double> nm = {450, 550, 650})
      : world(world_of(
            std::string("AreaLightSource \"diffuse\" \"spectrum L\" [ 200 1 900 1 ] \"bool twosided\" "
                        "true\nTranslate 0 0 ") +
                distance + "\nShape \"bilinearmesh\" \"point3 P\" [ 0 -9 0  9 -9 0  0 9 0  9 9 0 ]\n",
            std::move(nm))),
        camera(read_lens(lens_name).lens) {
    camera.set_f_number(16);
    camera.focus_at_m(1.5);
  }
  /// Directions are drawn for the same film radii with and without diffraction.
  Rendering render(bool diffraction, RenderOptions options = {}) const {
    LensCameraOptions camera_options;
    camera_options.diffraction = diffraction;
    if (!diffraction)
      camera_options.margin_pixels =
          WaveImage(camera.lens(), film, world->groups.wavelengths_nm(), {}).margin_pixels();
    const LensCamera lens(camera.lens(), film, world->groups, camera_options);
    options.samples_per_pixel = 12;
    return render_picture(*world, lens, Transform(), film, options);
  }

  std::unique_ptr<const World> world;
  MountedLens camera;
  SensorGeometry film{24, 20, 20};
};

std::vector<float> light_of(const Rendering& rendering) {
  return {rendering.irradiance.values().begin(), rendering.irradiance.values().end()};
}

TEST(Diffraction, LeavesABlurredForegroundAsRaysHaveIt) {
  const WallPicture blurred("0.3"), sharp("1.5");
  EXPECT_EQ(light_of(blurred.render(true)), light_of(blurred.render(false)));
  EXPECT_NE(light_of(sharp.render(true)), light_of(sharp.render(false)));
}

TEST(Diffraction, GivesTheSameBytesOnAnyNumberOfThreadsAndInPieces) {
  const WallPicture wall("1.5", "edmund-54852");
  std::vector<float> one, two;
  for (auto& [threads, into] : {std::pair{1, &one}, {2, &two}}) {
    const ThreadLimit limit(threads);
    *into = light_of(wall.render(true));
  }
  EXPECT_EQ(one, two);
  const test::Scratch scratch;
  RenderOptions options;
  const std::array<PixelWindow, 2> regions{PixelWindow{0, 0, 9, 20}, PixelWindow{9, 0, 24, 20}};
  std::vector<std::string> pieces;
  for (const PixelWindow& region : regions) {
    options.piece.region = region;
    options.checkpoint = scratch.path("piece" + std::to_string(region.left));
    wall.render(true, options);
    pieces.push_back(options.checkpoint);
  }
  options.piece = {}, options.checkpoint = scratch.path("whole");
  merge_checkpoints(pieces, options.checkpoint, {});
  EXPECT_EQ(light_of(wall.render(true, options)), one);
}

/// A uniform surround is as bright as without diffraction, also at the borders of the frame and through
/// photosites with gaps and a low-pass filter.
TEST(Diffraction, LosesNoLight) {
  WallPicture picture("1.5");
  picture.world = world_of(
      "AreaLightSource \"diffuse\" \"spectrum L\" [ 200 1 900 1 ] \"bool twosided\" true\nTranslate 0 0 1.5\n"
      "Shape \"bilinearmesh\" \"point3 P\" [ -9 -9 0  9 -9 0  -9 9 0  9 9 0 ]\n");
  RenderOptions gaps;
  gaps.photosite.shape = Photosite::Shape::ellipse;
  gaps.photosite.width = 0.8, gaps.photosite.height = 0.7;
  gaps.photosite.separation_x = 0.5;
  for (const RenderOptions& options : {RenderOptions(), gaps}) {
    const Rendering waves = picture.render(true, options), rays = picture.render(false, options);
    for (int band = 0; band < 3; ++band) {
      double all = 0, border = 0, all_rays = 0, border_rays = 0;
      for (int row = 0; row < 20; ++row)
        for (int column = 0; column < 24; ++column) {
          const bool outer = row == 0 || column == 0 || row == 19 || column == 23;
          const double by_waves = static_cast<double>(waves.irradiance.at(band, row, column)),
                       by_rays = static_cast<double>(rays.irradiance.at(band, row, column));
          all += by_waves, all_rays += by_rays;
          if (outer) border += by_waves, border_rays += by_rays;
        }
      // 480 pixels of 12 samples, 84 of them at the border, where numbers of samples are Poisson's at worst:
      // three standard errors are 0.04 and 0.09; stratified samples are steadier by far.
      EXPECT_NEAR(all / all_rays, 1, 0.02) << band;
      EXPECT_NEAR(border / border_rays, 1, 0.05) << band;
    }
  }
}

}  // namespace
}  // namespace petzval::render
