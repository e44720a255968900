// SPDX-License-Identifier: BSD-3-Clause
// Rays of a lens camera against rays traced one by one in double precision, at every wavelength of a group.
#include <gtest/gtest.h>
#include <petzval/analysis/transfer_fit.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>
#include <petzval/render/camera/lens_camera.h>

#include <cmath>
#include <random>

namespace petzval::render {
namespace {

struct Case {
  const char* lens;
  double half_diagonal_mm;
  bool as_transfer = false;  ///< known by its rays alone
};
void PrintTo(const Case& each, std::ostream* out) {
  *out << each.lens << (each.as_transfer ? " as a ray transfer" : "");
}

/// What a camera does, from the parts that it is made of: scalar traces and scalar densities.
class OneByOne {
 public:
  OneByOne(const Lens& lens, const SensorGeometry& film, const std::vector<double>& wavelengths_nm)
      : film_(film) {
    for (const double nm : wavelengths_nm) tracers.emplace_back(lens, nm);
    const Tracer ends[] = {tracers.front(), tracers[tracers.size() / 2], tracers.back()};
    regions_.emplace(ends, film.half_diagonal_mm() * (1 + 1e-9));
  }

  struct Landing {
    double column, row;
    double density;  ///< 0 off the film
  };
  /// The ray of a camera whose scene unit is 1 mm, at a wavelength; nothing if it does not pass.
  std::optional<Landing> land(const CameraRay& camera_ray, const Tracer& tracer) const {
    const Ray ray =
        tracer.trace({{camera_ray.origin.x, camera_ray.origin.y, tracer.image_z_mm() - camera_ray.origin.z},
                      {-camera_ray.direction.x, -camera_ray.direction.y, camera_ray.direction.z}});
    if (ray.status != RayStatus::ok) return {};
    const double pitch_mm = film_.pitch_um * mm_per_um;
    Landing landing{film_.columns / 2.0 - ray.point_mm[0] / pitch_mm,
                    film_.rows / 2.0 + ray.point_mm[1] / pitch_mm, 0};
    if (landing.column >= 0 && landing.column < film_.columns && landing.row >= 0 && landing.row < film_.rows)
      landing.density =
          regions_->density_per_sr(ray.point_mm[0], ray.point_mm[1], ray.direction[0], ray.direction[1]);
    return landing;
  }

  std::vector<Tracer> tracers;

 private:
  SensorGeometry film_;
  std::optional<ExitPupilRegions> regions_;
};

class LensCameraRays : public testing::TestWithParam<Case> {};

TEST_P(LensCameraRays, LandAndWeighAsRaysTracedOneByOne) {
  const std::vector<double> wavelengths{420, 470, 520, 590, 680};
  Lens lens = read_lens(GetParam().lens).lens;
  if (GetParam().as_transfer)
    lens = fit_transfer(lens, {.wavelengths_nm = {400, 550, 700}, .degree = 3}).lens;
  SensorGeometry film{300, 200, 0};
  film.pitch_um = 2 * GetParam().half_diagonal_mm / std::hypot(300, 200) * um_per_mm;
  LensCameraOptions options;
  options.scene_units_per_mm = 1;
  const LensCamera camera(lens, film, WavelengthGroups(wavelengths), options);
  ASSERT_TRUE(camera.disperses());
  const OneByOne one_by_one(lens, film, wavelengths);

  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<FilmSample> samples(2000);
  for (FilmSample& sample : samples)
    sample = {300 * unit(random),
              200 * unit(random),
              unit(random),
              unit(random),
              0,
              0,
              static_cast<int>(5 * unit(random))};
  std::vector<CameraRay> rays(samples.size());
  camera.trace(0, FilmSampling({0, 0, 300, 200}), samples, rays);

  int passed = 0, parted = 0, at_a_rim = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!rays[i].passes) continue;
    ++passed;
    double sum = 0;
    bool rim = false;
    for (std::size_t lane = 0; lane < wavelengths.size(); ++lane) {
      const auto landing = one_by_one.land(rays[i], one_by_one.tracers[lane]);
      const int at = static_cast<int>(lane);
      if (landing.has_value() != (rays[i].weight[at] > 0)) rim = true;
      if (!landing || rim) continue;
      sum += landing->density;
      // Single precision is worth some 1e-5 mm; a hundredth of a pixel is nothing to a picture.
      const bool hero = samples[i].hero == at;
      const double column = hero ? samples[i].column : static_cast<double>(rays[i].column[lane]);
      const double row = hero ? samples[i].row : static_cast<double>(rays[i].row[lane]);
      EXPECT_NEAR(column, landing->column, 0.01);
      EXPECT_NEAR(row, landing->row, 0.01);
      parted += std::hypot(column - samples[i].column, row - samples[i].row) > 0.02;
    }
    // Balance heuristic; 1e-5 for sums of floats.
    const double weight = static_cast<double>(rays[i].weight[samples[i].hero]);
    at_a_rim += rim || std::abs(weight * sum / static_cast<double>(wavelengths.size()) - 1) > 1e-5;
  }
  EXPECT_GT(passed, 1000);
  EXPECT_GT(parted, 100) << "or dispersion was not there";
  // Rays that a rounding takes over a rim, a zone's border or the film's edge.
  EXPECT_LT(at_a_rim, 10);
}

INSTANTIATE_TEST_SUITE_P(Lenses, LensCameraRays,
                         testing::Values(Case{"double-gauss", 21}, Case{"edmund-54852", 3},
                                         Case{"cooke-triplet", 18}, Case{"us-2532751", 9},
                                         Case{"cooke-triplet", 12, true}));

}  // namespace
}  // namespace petzval::render
