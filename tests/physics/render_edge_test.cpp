// SPDX-License-Identifier: BSD-3-Clause
// Slanted edges that glow, rendered and measured: what the photosite, the low-pass filter and the lens do to
// contrast must be what their transforms say.
#include <gtest/gtest.h>
#include <petzval/analysis/mtf.h>
#include <petzval/base/units.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>
#include <petzval/measure/sfr/measure_edge.h>
#include <petzval/render/camera/lens_camera.h>
#include <petzval/render/camera/perspective_camera.h>
#include <petzval/render/renderer.h>

#include <array>
#include <cmath>

namespace petzval {
namespace {

using namespace render;

constexpr double tilt_deg = 5;

std::unique_ptr<const World> world_of(const std::string& text, const std::vector<double>& wavelengths_nm) {
  Unsupported unsupported;
  return build_world(parse_scene_description("WorldBegin\n" + text, "test.pbrt", unsupported),
                     WavelengthGroups(wavelengths_nm), {true}, unsupported);
}

/// A half-plane of radiance 1 at a distance z, from a point of its edge to the side of a normal that leaves
/// +x by an angle; all in the unit of the scene. 4 units long, which fills every film here.
std::string glowing_half_plane(double x, double y, double z, double normal_deg) {
  const double nx = std::cos(radians(normal_deg)), ny = std::sin(radians(normal_deg)), reach = 4;
  std::string text =
      "AreaLightSource \"diffuse\" \"spectrum L\" [ 200 1 900 1 ] \"bool twosided\" true\n"
      "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 0 2 3 ] \"point3 P\" [";
  for (const auto& [along, across] :
       {std::pair{-reach, 0.0}, {reach, 0.0}, {reach, reach}, {-reach, reach}}) {
    char point[120];
    std::snprintf(point, sizeof point, " %.10g %.10g %.10g", x - along * ny + across * nx,
                  y + along * nx + across * ny, z);
    text += point;
  }
  return text + " ]\n";
}

struct EdgePicture {
  SensorGeometry film;
  PixelWindow window;
  Photosite photosite;
  int samples = 256;
};

/// What is measured in every band at these frequencies. `wall`, if there is one, is what the edge's bright
/// side would look like without it: the picture is divided by it, so that fall-off does not count as an edge.
std::vector<EdgeMeasurement> measured(const World& world, const FilmCamera& camera, const EdgePicture& edge,
                                      const std::vector<double>& frequencies_cpp,
                                      const World* wall = nullptr) {
  RenderOptions options;
  options.samples_per_pixel = edge.samples;
  options.window = edge.window;
  options.photosite = edge.photosite;
  options.path.max_depth = 0;  // the light itself, which scatters nothing that matters
  const Rendering picture = render_picture(world, camera, Transform(), edge.film, options);
  std::optional<Rendering> flat;
  if (wall) flat = render_picture(*wall, camera, Transform(), edge.film, options);
  SfrOptions sfr;
  sfr.frequencies_cpp = frequencies_cpp;
  std::vector<EdgeMeasurement> result;
  for (int band = 0; band < picture.irradiance.bands(); ++band) {
    Plane plane{edge.window.columns(), edge.window.rows(), {}};
    for (std::size_t i = 0; i < picture.irradiance.band_size(); ++i)
      plane.values.push_back(static_cast<double>(picture.irradiance.band(band)[i]) /
                             (flat ? static_cast<double>(flat->irradiance.band(band)[i]) : 1));
    result.push_back(measure_edge(samples_in(plane, {0, 0, plane.columns, plane.rows}), 1, sfr));
  }
  return result;
}

Photosite site_of(Photosite::Shape shape, double width, double height, double dots) {
  Photosite site;
  site.shape = shape, site.width = width, site.height = height;
  site.separation_x = site.separation_y = dots;
  return site;
}

const std::vector<double> frequencies{0.1, 0.2, 0.3, 0.4, 0.5};

/// Through a pinhole there is nothing but the pixel.
TEST(RenderedEdge, HasTheContrastOfPhotositeAndLowPassFilter) {
  const auto world = world_of(glowing_half_plane(0.003, 0.002, 1, tilt_deg), {550});
  EdgePicture edge{{80, 80, 5}, {0, 0, 80, 80}, {}};
  PerspectiveOptions perspective;
  perspective.columns = perspective.rows = 80;
  const PerspectiveCamera camera(perspective, world->groups);
  using Shape = Photosite::Shape;
  for (const Photosite& site :
       {Photosite{}, site_of(Shape::rectangle, 0.7, 0.7, 0), site_of(Shape::rectangle, 1, 1, 0.5),
        site_of(Shape::rectangle, 0.8, 0.6, 0.4), site_of(Shape::ellipse, 0.9, 0.9, 0.8)}) {
    edge.photosite = site;
    const std::vector<double> sfr = measured(*world, camera, edge, frequencies)[0].sfr;
    for (std::size_t i = 0; i < frequencies.size(); ++i) {
      const double f = frequencies[i];
      const double expected =
          std::abs(site.transform(f * std::cos(radians(tilt_deg)), f * std::sin(radians(tilt_deg))));
      // 256 stratified samples place the edge within a pixel to about 256^(-3/4) = 0.016 of the step; 80 rows
      // leave a tenth of it in the SFR. Leaving out or doubling any of the parts makes 0.03 and more.
      EXPECT_NEAR(sfr[i], expected, 0.004) << site.text() << " at " << f;
    }
  }
}

/// Where wavelengths share their paths and land apart, photosite and filter take the same share of contrast
/// from each.
TEST(RenderedEdge, LosesTheSameContrastWhereWavelengthsPart) {
  MountedLens lens(read_lens("edmund-54852").lens);
  lens.set_f_number(4);
  lens.focus_at_m(1.5);
  const std::vector<double> wavelengths{430, 550, 660};
  // 1.2 mm off the axis: lateral colour across the edge.
  const auto world = world_of(glowing_half_plane(0.3, 0, 1.5, tilt_deg), wavelengths);
  EdgePicture edge{{560, 120, 6}, {}, {}, 512};
  const int column = static_cast<int>(280 + 0.3 / 1.5 * 6.0 * 1e3 / 6 * 0.98);
  edge.window = {column - 16, 0, column + 16, 120};
  const LensCamera camera(lens.lens(), edge.film, world->groups);
  const auto whole = measured(*world, camera, edge, frequencies);
  for (const Photosite& site :
       {site_of(Photosite::Shape::rectangle, 0.5, 0.5, 0), site_of(Photosite::Shape::rectangle, 1, 1, 0.8)}) {
    edge.photosite = site;
    const auto part = measured(*world, camera, edge, frequencies);
    for (std::size_t band = 0; band < wavelengths.size(); ++band)
      for (std::size_t i = 0; i < 3; ++i) {
        const double fx = frequencies[i] * std::cos(radians(tilt_deg)),
                     fy = frequencies[i] * std::sin(radians(tilt_deg));
        const double share = std::abs(site.transform(fx, fy) / Photosite{}.transform(fx, fy));
        // Four standard errors of two measurements, as each states its own from the scatter about its fit.
        const double error = std::hypot(part[band].sfr_deviation[i], share * whole[band].sfr_deviation[i]);
        EXPECT_LT(error, 0.02);
        EXPECT_NEAR(part[band].sfr[i], share * whole[band].sfr[i], 4 * error)
            << wavelengths[band] << " nm at " << frequencies[i] << " through " << site.text();
      }
  }
}

/// A uniform surround is g_sensor whatever part of the pixel gathers it; also with dispersion, and in the
/// corner of the film, where the light comes from beyond it.
TEST(RenderedWall, IsTheSameThroughAnyPhotosite) {
  const Lens lens = read_lens("edmund-54852").lens;
  const auto world = world_of("LightSource \"infinite\" \"spectrum L\" [ 200 1 900 1 ]\n", {430, 550, 660});
  const SensorGeometry film{400, 300, 12};
  LensCameraOptions camera_options;
  camera_options.margin_pixels = 0.4;
  const LensCamera camera(lens, film, world->groups, camera_options);
  for (const PixelWindow& window : {PixelWindow{192, 142, 208, 158}, PixelWindow{0, 0, 16, 16}}) {
    std::array<std::vector<double>, 2> means;
    for (std::size_t k = 0; k < 2; ++k) {
      RenderOptions options;
      options.window = window;
      options.samples_per_pixel = 1024;
      if (k == 1) options.photosite = site_of(Photosite::Shape::ellipse, 0.8, 0.8, 0.8);
      const Rendering picture = render_picture(*world, camera, Transform(), film, options);
      for (int band = 0; band < 3; ++band) {
        double sum = 0;
        for (const float value : picture.irradiance.band(band)) sum += static_cast<double>(value) / 256;
        means[k].push_back(sum);
      }
      EXPECT_EQ(picture.irradiance.pixel_aperture(), k == 1 ? PixelAperture::photosite : PixelAperture::box);
      EXPECT_EQ(picture.irradiance.photosite, k == 1 ? options.photosite.text() : "");
    }
    for (std::size_t band = 0; band < 3; ++band)
      EXPECT_NEAR(means[1][band] / means[0][band], 1, 1e-3) << "band " << band << " from " << window.left;
  }
}

/// What an edge at a real image height keeps of contrast, in the direction of its normal, is the geometric
/// MTF of `lens mtf` times that of the pixel.
void expect_geometric_mtf(const Lens& lens, double distance_m, double height_mm, MtfDirection direction) {
  constexpr double nm = 587.5618;
  FieldTableRequest request;
  request.field_kind = Fields::Kind::real_image_height_mm;
  request.fields = {height_mm}, request.wavelengths_nm = {nm};
  const double object_mm = std::abs(distortion_table(lens, request)[0].object_field);
  EdgePicture edge{{120, 2 * static_cast<int>(height_mm * 100) + 120, 10}, {}, {}, 400};
  const int row = edge.film.rows / 2 - static_cast<int>(std::lround(height_mm * 100));
  edge.window = {10, row - 50, 110, row + 50};
  MtfOptions options;
  options.geometric = true;
  for (const double f : frequencies) options.frequencies_cpmm.push_back(f * 100);
  const std::vector<MtfRow> table = mtf_table(lens, request, options);

  const double normal_deg = direction == MtfDirection::tangential ? 90 + tilt_deg : tilt_deg;
  const double y_m = object_mm * 1e-3;
  const auto world = world_of(glowing_half_plane(0, y_m, distance_m, normal_deg), {nm});
  const auto wall = world_of(glowing_half_plane(-2, y_m, distance_m, 0), {nm});
  const LensCamera camera(lens, edge.film, world->groups);
  const std::vector<double> sfr = measured(*world, camera, edge, frequencies, wall.get())[0].sfr;
  for (std::size_t i = 0; i < frequencies.size(); ++i) {
    const double f = frequencies[i], along = f * std::cos(radians(tilt_deg)),
                 across = f * std::sin(radians(tilt_deg));
    const double lens_mtf = direction == MtfDirection::tangential ? table[i].tangential : table[i].sagittal;
    EXPECT_NEAR(sfr[i], lens_mtf * std::abs(Photosite{}.transform(along, across)), 0.01)
        << height_mm << " mm, " << f * 100 << " cycles/mm";
  }
}

/// With diffraction it is the MTF of waves, up to where that ends and beyond.
void expect_wave_mtf(double f_number, double height_mm, MtfDirection direction, double sensor_shift_mm = 0) {
  constexpr double nm = 550, distance_m = 1.5;
  MountedLens camera(read_lens("dgauss-50mm").lens);
  camera.set_f_number(f_number);
  camera.set_focus_wavelength_nm(nm);
  camera.focus_at_m(distance_m);
  camera.move_sensor_mm(sensor_shift_mm);
  FieldTableRequest request;
  request.field_kind = Fields::Kind::real_image_height_mm;
  request.fields = {height_mm}, request.wavelengths_nm = {nm};
  const double object_mm = std::abs(distortion_table(camera.lens(), request)[0].object_field);
  const double cut_off_cpmm = 1 / (nm * mm_per_nm * first_order(camera.lens()).working_f_number);
  const double pitch_mm = 0.6 / cut_off_cpmm;
  const int up = static_cast<int>(std::lround(height_mm / pitch_mm));
  EdgePicture edge{{48, 2 * up + 48, pitch_mm * um_per_mm}, {0, 0, 48, 48}, {}, 64};
  std::vector<double> of_cut_off;
  MtfOptions options;
  for (int i = 1; i <= 11; ++i) of_cut_off.push_back(0.1 * i);
  for (const double f : of_cut_off) options.frequencies_cpmm.push_back(f * cut_off_cpmm);
  const std::vector<MtfRow> table = mtf_table(camera.lens(), request, options);

  const double normal_deg = direction == MtfDirection::tangential ? 90 + tilt_deg : tilt_deg;
  const auto world = world_of(glowing_half_plane(0, object_mm * 1e-3, distance_m, normal_deg), {nm});
  LensCameraOptions waves;
  waves.diffraction = true;
  const LensCamera lens(camera.lens(), edge.film, world->groups, waves);
  std::vector<double> frequencies_cpp;
  for (const double f : of_cut_off) frequencies_cpp.push_back(0.6 * f);
  const std::vector<double> sfr = measured(*world, lens, edge, frequencies_cpp)[0].sfr;
  for (std::size_t i = 0; i < sfr.size(); ++i) {
    const double f = frequencies_cpp[i];
    const double pixel =
        std::abs(Photosite{}.transform(f * std::cos(radians(tilt_deg)), f * std::sin(radians(tilt_deg))));
    const double lens_mtf = direction == MtfDirection::tangential ? table[i].tangential : table[i].sagittal;
    EXPECT_NEAR(sfr[i], lens_mtf * pixel, 0.02)
        << "f/" << f_number << ", " << height_mm << " mm, " << of_cut_off[i] << " of the cut-off";
  }
}

TEST(RenderedEdge, HasTheMtfOfWavesAtF16) {
  expect_wave_mtf(16, 0, MtfDirection::sagittal);
}

TEST(RenderedEdge, HasTheMtfOfWavesOffTheAxis) {
  expect_wave_mtf(16, 5, MtfDirection::tangential);
}

TEST(RenderedEdge, HasTheMtfOfWavesAtF28) {
  // Spherical aberration is least blurred in front of the paraxial focus, where it stands without a shift.
  expect_wave_mtf(2.8, 0, MtfDirection::sagittal, -0.07);
}

TEST(RenderedEdge, HasTheGeometricMtfOfTheLens) {
  MountedLens camera(read_lens("dgauss-50mm").lens);
  camera.focus_at_m(1.5);
  expect_geometric_mtf(camera.lens(), 1.5, 0, MtfDirection::sagittal);
  expect_geometric_mtf(camera.lens(), 1.5, 5, MtfDirection::sagittal);
  expect_geometric_mtf(camera.lens(), 1.5, 5, MtfDirection::tangential);
}

}  // namespace
}  // namespace petzval
