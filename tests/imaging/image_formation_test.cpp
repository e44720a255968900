// SPDX-License-Identifier: BSD-3-Clause
#include "imaging/synthetic_table.h"

#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/imaging/image_formation.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace petzval {
namespace {

using namespace testing;

const SensorGeometry sensor{120, 90, 10};  // half-diagonal 0.75 mm; 6 tan 20° = 2.18 mm

Scene wall(float radiance, std::vector<double> wavelengths_nm = {550}, double angle_deg = 30) {
  Scene scene(200, 160, std::move(wavelengths_nm), angle_deg, std::nullopt);
  for (int band = 0; band < scene.bands(); ++band)
    std::fill(scene.band(band).begin(), scene.band(band).end(), radiance);
  return scene;
}

ImagingOptions with_method(BlurMethod method, int section = 16) {
  ImagingOptions options;
  options.method = method;
  options.sections.section = section;
  return options;
}

CellPlane plane_of(const SpectralImage& image, int band = 0) {
  CellPlane plane({image.columns(), image.rows(), image.pitch_um()});
  std::copy(image.band(band).begin(), image.band(band).end(), plane.values.begin());
  return plane;
}

/// \return the message of the InputError that the call throws.
template <typename Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was refused";
}

// A kernel has sum 1 and a wall is the same everywhere: g·L by every method, up to the frame's edges, since
// light comes in from outside.
TEST(FormImage, UniformWallBecomesGTimesRadiance) {
  const LensDataTable table = make_table({});
  for (const BlurMethod method : {BlurMethod::none, BlurMethod::sections, BlurMethod::exact}) {
    const SpectralImage image = form_image(wall(3), table, sensor, with_method(method));
    // A constant PSF that is rotated differs by how cells cut its samples, a quarter of a cell wide: (1/4)²/8
    // of its slope.
    for (const float value : image.values()) EXPECT_NEAR(value, 0.75, 0.75 * 2e-3);
  }
}

// Where the PSF moves light outwards more and more, a wall thins by the divergence of the shift, (1/r)
// d(r·shift)/dr: this is why g_source and g_sensor are two functions. Between the first two fields the PSF is
// interpolated linearly, so that the shift is slope·r and the divergence 2·slope.
TEST(FormImage, UniformWallThinsByTheDivergenceOfTheCentroid) {
  const LensDataTable table = make_table(comatic_recipe());
  const Psf& psf = table.psf[1];
  double shift_mm = 0;
  for (int i = 0; i < psf.size; ++i)
    for (int j = 0; j < psf.size; ++j)
      shift_mm += double(psf.at(i, j)) * (i - psf.size / 2) * psf.spacing_um * mm_per_um;
  const double slope = shift_mm / table.real_image_height_mm[1];
  ASSERT_GT(slope, 1e-3);
  const SensorGeometry fine{80, 60, 2.5};  // cells that resolve the PSF
  const CellPlane image = plane_of(form_image(wall(3), table, fine, with_method(BlurMethod::exact)));
  const double mean = sum_of(image) / double(image.values.size());
  EXPECT_NEAR(1 - mean / 0.75, 2 * slope, 0.05 * 2 * slope);
}

TEST(FormImage, AppliesGSourceBeforeTheBlur) {
  TableRecipe recipe;
  recipe.g_source_sr = [](double field) { return 0.25 * std::pow(std::cos(radians(field)), 4); };
  recipe.fields.clear();
  for (int field = 0; field <= 20; ++field) recipe.fields.push_back(field);
  const LensDataTable table = make_table(recipe);
  const SpectralImage image = form_image(wall(1), table, sensor, with_method(BlurMethod::none));
  for (const auto& [column, row] : {std::pair{60, 45}, {0, 45}, {60, 0}, {119, 89}}) {
    const double height = std::hypot(sensor.x_mm(column + 0.5), sensor.y_mm(row + 0.5));
    // The curve between fields 1° apart; sums of floats.
    EXPECT_NEAR(image.at(0, row, column), 0.25 * std::pow(std::cos(std::atan(height / 6)), 4), 5e-7);
  }
}

// The whole way, from the scene to the picture: the image of a star stands where the star stands, upright,
// and its comatic tail points away from the middle, at eight azimuths; and a tail that leans to one side
// leans to the same side of the radius all around.
TEST(FormImage, TailsOfStarsPointAwayFromTheMiddleAtEightAzimuths) {
  constexpr double lean = 0.5;
  const LensDataTable table = make_table(comatic_recipe(lean));
  const SensorGeometry wide{400, 400, 3};  // cells that resolve the PSF
  for (int eighth = 0; eighth < 8; ++eighth) {
    const double azimuth = radians(45.0 * eighth);
    Scene scene(601, 601, {550}, 2 * degrees(std::atan(0.135)), std::nullopt);
    const int column = static_cast<int>(std::lround(300 + 200 * std::cos(azimuth)));
    const int row = static_cast<int>(std::lround(300 + 200 * std::sin(azimuth)));
    add_star(scene, 0, column, row, 3);  // smooth, so that cells find its centre
    // The chief ray lands at 6 mm × tangent (the table's formula), on cells of 3 µm about the middle at 200.
    const double cells_per_sample = scene.tangent_per_sample() * 6 / 3e-3;
    const Centroid before{200 + (column - 300) * cells_per_sample, 200 + (row - 300) * cells_per_sample};
    const double radius = std::hypot(before.column - 200, before.row - 200);
    const double right = std::cos(azimuth), down = std::sin(azimuth);
    EXPECT_NEAR((before.column - 200) / radius, right, 5e-3) << eighth;
    EXPECT_NEAR((before.row - 200) / radius, down, 5e-3) << eighth;
    for (const BlurMethod method : {BlurMethod::sections, BlurMethod::exact}) {
      const Centroid after = centroid(plane_of(form_image(scene, table, wide, with_method(method, 1))));
      const double outwards = (after.column - before.column) * right + (after.row - before.row) * down;
      const double aside = -(after.column - before.column) * down + (after.row - before.row) * right;
      EXPECT_GT(outwards, 0.3) << eighth;
      // The blobs of comatic_psf() lie at s = lean·t.
      EXPECT_NEAR(aside / outwards, lean, 0.01) << eighth;
    }
  }
}

TEST(FormImage, KeepsTheEnergyOfLightAwayFromTheEdge) {
  const LensDataTable table = make_table(comatic_recipe());
  Scene scene(300, 240, {550}, 30, std::nullopt);
  for (int row = 110; row < 130; ++row)
    for (int column = 140; column < 170; ++column)
      scene.band(0)[static_cast<std::size_t>(row * 300 + column)] = float(1 + (row * column) % 7);
  const auto energy = [&](BlurMethod method, int section, int supersample) {
    ImagingOptions options = with_method(method, section);
    options.supersample = supersample;
    return sum_of(plane_of(form_image(scene, table, sensor, options)));
  };
  for (const int supersample : {1, 2, 4}) {
    const double before = energy(BlurMethod::none, 16, supersample);
    for (const int section : {32, 16, 8, 1})
      EXPECT_NEAR(energy(BlurMethod::sections, section, supersample) / before, 1, 1e-6) << section;
  }
  EXPECT_NEAR(energy(BlurMethod::exact, 16, 1) / energy(BlurMethod::none, 16, 1), 1, 1e-6);
}

// Source cells of a half and a quarter pixel: the finer, the nearer to the truth, which no grid of cells
// quantises. Each has the filter that suits it best, so that one step may gain less than the other. Every
// cell has its own PSF, so that nothing else errs.
TEST(FormImage, SupersamplingConverges) {
  const LensDataTable table = make_table(comatic_recipe());
  Scene scene(60, 48, {550}, 30, std::nullopt);
  for (std::size_t i = 0; i < scene.band_size(); ++i)
    scene.band(0)[i] = (i % 60 / 3 + i / 180) % 2 == 0 ? 1.0F : 0.1F;
  const SensorGeometry small{40, 30, 20};
  const auto at = [&](int supersample) {
    ImagingOptions options = with_method(BlurMethod::exact);
    options.supersample = supersample;
    return plane_of(form_image(scene, table, small, options));
  };
  const CellPlane finest = at(8);
  const double error_1 = relative_l2(at(1), finest), error_2 = relative_l2(at(2), finest),
               error_4 = relative_l2(at(4), finest);
  EXPECT_LT(error_2, error_1);
  EXPECT_LT(error_4, error_2);
  EXPECT_LT(error_4, error_1 / 4);
}

TEST(FormImage, GivesTheSameBytesForAnyNumberOfThreads) {
  const LensDataTable table = make_table(comatic_recipe(0.3));
  Scene scene = wall(1);
  for (std::size_t i = 0; i < scene.band_size(); i += 7) scene.band(0)[i] = 9;
  const auto bytes = [&](int threads, BlurMethod method) {
    const ThreadLimit limit(threads);
    const SpectralImage image = form_image(scene, table, sensor, with_method(method, 8));
    return std::vector<float>(image.values().begin(), image.values().end());
  };
  EXPECT_EQ(bytes(1, BlurMethod::sections), bytes(2, BlurMethod::sections));
  EXPECT_EQ(bytes(1, BlurMethod::exact), bytes(2, BlurMethod::exact));
}

// Bands are formed side by side where there are threads for them.
TEST(FormImage, HandsOverTheBandsOfTheSameImageInOrder) {
  TableRecipe recipe;
  recipe.wavelengths_nm = {450, 650};
  const LensDataTable table = make_table(recipe);
  Scene scene = wall(1, {450, 550, 650});
  add_star(scene, 1, 90, 70, 3);
  const ImagingOptions options = with_method(BlurMethod::product);
  ImagingReport whole_says, says;
  const SpectralImage whole = form_image(scene, table, sensor, options, {}, &whole_says);
  std::vector<float> values;
  const auto take = [&](std::span<const float> pixels) {
    values.insert(values.end(), pixels.begin(), pixels.end());
  };
  form_bands(scene, table, sensor, options, take, {}, &says);
  ASSERT_EQ(values.size(), whole.values().size());
  EXPECT_TRUE(std::equal(values.begin(), values.end(), whole.values().begin()));
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  EXPECT_EQ(says.darkest, double(*low));
  EXPECT_EQ(says.brightest, double(*high));
  EXPECT_EQ(says.notes, whole_says.notes);
  EXPECT_THROW(form_bands(scene, table, {0, 90, 10}, options, take), InputError);
}

TEST(FormImage, SaysTheSameOfManyBandsForAnyNumberOfThreads) {
  TableRecipe recipe = comatic_recipe(0.3);
  recipe.wavelengths_nm = {500, 600};
  const LensDataTable table = make_table(recipe);
  Scene scene = wall(1, {500, 520, 540, 560, 600});
  for (int band = 0; band < scene.bands(); ++band)
    for (std::size_t i = 0; i < scene.band_size(); i += static_cast<std::size_t>(5 + band))
      scene.band(band)[i] = static_cast<float>(3 + band);
  struct Formed {
    std::vector<float> values;
    ImagingReport report;
    double furthest = 0;
  };
  const auto formed = [&](int threads, BlurMethod method) {
    const ThreadLimit limit(threads);
    Formed result;
    const auto progress = [&](double fraction, const std::string&) {
      EXPECT_GE(fraction, result.furthest);
      result.furthest = fraction;
    };
    const SpectralImage image =
        form_image(scene, table, sensor, with_method(method, 8), progress, &result.report);
    result.values.assign(image.values().begin(), image.values().end());
    return result;
  };
  for (const BlurMethod method : {BlurMethod::product, BlurMethod::blended, BlurMethod::none}) {
    const Formed one = formed(1, method);
    EXPECT_NEAR(one.furthest, 1, 1e-12);
    for (const int threads : {2, 4}) {
      const Formed many = formed(threads, method);
      EXPECT_EQ(many.values, one.values);
      EXPECT_EQ(many.report.notes, one.report.notes);
      EXPECT_EQ(many.report.margin_cells, one.report.margin_cells);
      EXPECT_EQ(many.report.product.tile, one.report.product.tile);
      EXPECT_EQ(many.report.product.estimated_error, one.report.product.estimated_error);
      EXPECT_EQ(many.report.transform_size, one.report.transform_size);
      EXPECT_EQ(many.report.brightest, one.report.brightest);
      EXPECT_EQ(many.report.darkest, one.report.darkest);
      EXPECT_NEAR(many.furthest, 1, 1e-12);
    }
  }
}

TEST(FormImage, TakesEachBandAtItsOwnWavelength) {
  TableRecipe recipe;
  recipe.wavelengths_nm = {500, 600};
  recipe.height_mm = [](double field, double nm) {
    return 6 * std::tan(radians(field)) * (nm == 600 ? 1.02 : 1.0);
  };
  const LensDataTable table = make_table(recipe);
  Scene scene(601, 601, {500, 550, 600}, 30, std::nullopt);
  for (int band = 0; band < 3; ++band) add_star(scene, band, 450, 300, 4);  // to the right
  const SpectralImage image = form_image(scene, table, {200, 100, 10}, with_method(BlurMethod::sections, 4));
  const double blue = centroid(plane_of(image, 0)).column - 100,
               red = centroid(plane_of(image, 2)).column - 100;
  // Half-way between the wavelengths the magnification is half-way too.
  EXPECT_NEAR(red / blue, 1.02, 1e-3);
  EXPECT_NEAR((centroid(plane_of(image, 1)).column - 100) / blue, 1.01, 1e-3);
}

TEST(FormImage, SaysByHowManyDegreesASceneIsTooSmall) {
  const LensDataTable table = make_table({});
  // The frame sees 2 atan(0.6/6) = 11.42° and the margin of the PSF some more.
  const std::string text =
      refusal([&] { form_image(wall(1, {550}, 10), table, sensor, with_method(BlurMethod::sections)); });
  EXPECT_NE(text.find("covers 10.00° × "), std::string::npos) << text;
  EXPECT_NE(text.find("`surround` zero or extend"), std::string::npos) << text;
  const std::size_t at = text.find("falls short by ");
  ASSERT_NE(at, std::string::npos) << text;
  const double short_by = std::stod(text.substr(at + 15));
  EXPECT_GT(short_by, 1.42);
  EXPECT_LT(short_by, 3.5);
  ImagingOptions options = with_method(BlurMethod::sections);
  options.surround = Surround::extend;
  ImagingReport report;
  const SpectralImage image = form_image(wall(1, {550}, 10), table, sensor, options, {}, &report);
  EXPECT_NEAR(image.at(0, 0, 0), 0.25, 0.25 * 1e-3);
  EXPECT_NE(report.notes.front().find("`surround` extend"), std::string::npos);
}

TEST(FormImage, RefusesWhatDoesNotFitTogether) {
  const LensDataTable table = make_table({});
  const auto message = [&](const Scene& scene, const ImagingOptions& options = {}) {
    return refusal([&] { form_image(scene, table, sensor, options); });
  };
  Scene broken = wall(1);
  broken.band(0)[1234] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(message(broken).find("nan"), std::string::npos) << message(broken);
  EXPECT_NE(message(wall(1, {700})).find("700"), std::string::npos);
  Scene near = wall(1);
  near.set_distance_m(2);
  EXPECT_NE(message(near).find("2 m"), std::string::npos) << message(near);
  ImagingOptions options;
  options.method = BlurMethod::sections;
  options.sections.transform = 17;
  EXPECT_NE(message(wall(1), options).find("transforms of 17"), std::string::npos);
  options = {};
  options.supersample = 17;
  EXPECT_NE(message(wall(1), options).find("1 to 16"), std::string::npos);
  options = {};
  options.fit.polynomial_order = 6;
  EXPECT_NE(message(wall(1), options), "nothing was refused") << "five fields are too few for order 6";

  TableRecipe finite;
  finite.object_distance_mm = 490;
  finite.fields = {0, 100, 200, 300};
  finite.height_mm = [](double field, double) { return field / 100; };
  const LensDataTable near_table = make_table(finite);  // 0.5 m from the sensor
  near.set_distance_m(0.5004);
  EXPECT_NO_THROW(form_image(near, near_table, sensor, {}));
  near.set_distance_m(0.502);
  EXPECT_THROW(form_image(near, near_table, sensor, {}), InputError);
}

TEST(FormImage, LeavesCornersDarkThatNoChiefRayReaches) {
  TableRecipe recipe;
  recipe.fields = {0, 2, 4, 6};  // 0.63 mm, of 0.75 mm
  const LensDataTable table = make_table(recipe);
  ImagingReport report;
  const SpectralImage image =
      form_image(wall(1), table, sensor, with_method(BlurMethod::sections), {}, &report);
  EXPECT_NEAR(image.at(0, 0, 0), 0, 1e-6);
  EXPECT_NEAR(image.at(0, 45, 60), 0.25, 0.25 * 1e-3);
  EXPECT_NE(report.notes.front().find("0.6306 mm"), std::string::npos) << report.notes.front();
}

TEST(FormImage, ReportsWhatItDid) {
  TableRecipe recipe;
  recipe.psf = [](double, double) {
    Psf psf = psf_of_spots({{0, 0, 2, 2, 1}}, 65, 0.5);
    psf.captured = 0.95;
    return psf;
  };
  ImagingReport report;
  ImagingOptions options = with_method(BlurMethod::sections);
  options.supersample = 1;
  form_image(wall(1), make_table(recipe), sensor, options, {}, &report);
  EXPECT_EQ(report.margin_cells, 6);  // ⌈(16 µm·√2 + 0.25 µm)/10 µm⌉ and 3 of the window
  EXPECT_EQ(report.transform_size, 30);
  EXPECT_EQ(report.cells_per_pixel, 1);
  EXPECT_EQ(report.scene_points_per_cell, 1);
  EXPECT_EQ(report.least_captured, 0.95);
  EXPECT_NEAR(report.brightest, 0.25, 1e-3);
  bool captured = false;
  for (const std::string& note : report.notes)
    captured = captured || note.find("95.00 %") != std::string::npos;
  EXPECT_TRUE(captured);
}

}  // namespace
}  // namespace petzval
