// SPDX-License-Identifier: BSD-3-Clause
// A double Gauss with an element beside its place: the left and right of its pictures differ, as its transfer
// functions there say, in `image` and in `render`.
#include <gtest/gtest.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/analysis/pupil_rays.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>
#include <petzval/optics/build.h>
#include <petzval/wave/sampled_otf.h>

#include <complex>
#include <cstdio>

#include "physics/tilted_board.h"

namespace petzval {
namespace {

constexpr double frequency_cpp = 0.25;

Lens decentred_gauss() {
  Lens lens = read_lens("dgauss-12.5mm").lens;
  lens.groups = {{0, 1, {0.06, 0, 0, 0, 0, 0}, 0}};  // the first element, to the side
  return lens;
}

/// An edge near the row of the picture's middle.
struct SideEdge {
  double x_mm = 0;             ///< of the picture, from its middle
  double normal_x, normal_y;   ///< in the picture
  double contrast, deviation;  ///< at the frequency, photosite included

  double photosite() const { return sinc(frequency_cpp * normal_x) * sinc(frequency_cpp * normal_y); }
};

std::vector<SideEdge> side_edges(const PicturePlanes& picture, const SensorGeometry& sensor) {
  std::vector<SideEdge> edges;
  for (const MeasuredEdge& edge : measure_sfr(picture)) {
    const EdgeLine& line = edge.exact.line;
    const double x = line.centre_x - sensor.columns / 2.0, y = line.centre_y - sensor.rows / 2.0;
    const double c = std::cos(line.normal_rad), s = std::sin(line.normal_rad);
    // Upright edges near the middle row and far from the middle: their normal is along the field.
    if (std::abs(c) < 0.9 || std::abs(y) > 40 || std::abs(x) < 0.25 * sensor.columns) continue;
    if (std::min(-edge.exact.distance_px.front(), edge.exact.distance_px.back()) < 10) continue;
    const std::vector<double>& f = edge.exact.frequencies_cpp;
    const auto at = static_cast<std::size_t>(std::lower_bound(f.begin(), f.end(), frequency_cpp) - f.begin());
    const double t = (frequency_cpp - f[at - 1]) / (f[at] - f[at - 1]);
    edges.push_back({x * sensor.pitch_um * 1e-3, c, s,
                     std::lerp(edge.exact.sfr[at - 1], edge.exact.sfr[at], t), edge.exact.sfr_deviation[at]});
  }
  return edges;
}

/// What the lens does at a place of the picture's middle row, by its fields at 90 degrees (anticlockwise from
/// the top as seen from the film): the image at height h along them stands at column W/2 + h/p.
class RowTransfer {
 public:
  explicit RowTransfer(const Lens& lens) : tracer_(lens, board_nm, {}, 90) {}

  ChiefRay chief_at_mm(double x_mm) {
    double low = -1, high = 1;  // degrees, of heights below and above
    const auto height = [&](double field) { return tracer_.chief_ray(field)->image_height_mm; };
    if (height(low) > height(high)) std::swap(low, high);
    while (height(low) > x_mm) low *= 2;
    while (height(high) < x_mm) high *= 2;
    for (int i = 0; i < 50; ++i) (height(0.5 * (low + high)) < x_mm ? low : high) = 0.5 * (low + high);
    return *tracer_.chief_ray(low);
  }
  /// Frequencies in the picture [cycles/mm], from its left to its right and downwards.
  double by_waves(double x_mm, double fx, double fy) {
    PsfOptions options;
    options.wanted_share = 0.998;
    options.largest_size = 1024;
    return std::abs(SampledOtf(*point_spread(tracer_, chief_at_mm(x_mm), options)).at(fy, fx));
  }
  double by_rays(double x_mm, double fx, double fy) {
    std::complex<double> sum = 0;
    double light = 0;
    for (const PupilRay& ray : light_rays(tracer_, chief_at_mm(x_mm), {40, 256})) {
      EXPECT_FALSE(ray.mirrored);
      light += ray.entrance_measure;
      sum += ray.entrance_measure * std::polar(1.0, -2 * pi * (fy * ray.x_mm + fx * ray.y_mm));
    }
    return std::abs(sum) / light;
  }

 private:
  FieldTracer tracer_;
};

/// Mean contrast, measured and expected, left and right.
struct Sides {
  double measured[2] = {}, expected[2] = {};
  int edges[2] = {};

  template <class Expected>
  Sides(const std::vector<SideEdge>& all, const SensorGeometry& sensor, double extra_tolerance,
        const Expected& expect) {
    const double per_mm = frequency_cpp * 1e3 / sensor.pitch_um;
    for (const SideEdge& edge : all) {
      const double truth =
          expect(edge.x_mm, per_mm * edge.normal_x, per_mm * edge.normal_y) * edge.photosite();
      // Wanted, before anything was measured: 0.01.
      EXPECT_NEAR(edge.contrast, truth, 0.01 + extra_tolerance * edge.deviation) << edge.x_mm << " mm";
      const int side = edge.x_mm > 0 ? 1 : 0;
      measured[side] += edge.contrast, expected[side] += truth, ++edges[side];
    }
    for (int side = 0; side < 2; ++side) {
      EXPECT_GE(edges[side], 1);
      measured[side] /= edges[side], expected[side] /= edges[side];
    }
    std::printf("contrast at %g c/p: left %.4f, expected %.4f; right %.4f, expected %.4f; %d edges\n",
                frequency_cpp, measured[0], expected[0], measured[1], expected[1], edges[0] + edges[1]);
  }
};

TEST(DecentredBoard, ImagesAsItsTransferFunctionsSay) {
  const SensorGeometry sensor{720, 400, 8};
  MountedLens camera(decentred_gauss());
  camera.set_f_number(2.8);
  camera.focus_at_m({});
  TableOptions table_options;
  table_options.wavelengths_nm = {board_nm};
  table_options.max_image_height_mm = sensor.half_diagonal_mm();
  table_options.half_frame_mm = {sensor.width_mm() / 2, sensor.height_mm() / 2};
  const LensDataTable table = build_lens_data_table(camera.lens(), table_options);
  ImagingOptions options;
  options.product.tolerance = 5e-4;
  options.supersample = 4;
  const double focal_length_mm = first_order(camera.lens(), board_nm).efl_mm;
  const SpectralImage image = form_image(board_scene(sensor, focal_length_mm), table, sensor, options);
  RowTransfer transfer(camera.lens());
  const Sides sides(side_edges(picture_of(sensor, image.band(0), 0, 0), sensor), sensor, 0,
                    [&](double x, double fx, double fy) {
                      // What the samples of the scene blur: their own squares and the lines between them.
                      const double samples = 1e3 / sensor.pitch_um * scene_per_px;
                      const double one = sinc(fx / samples) * sinc(fy / samples);
                      return transfer.by_waves(x, fx, fy) * one * one;
                    });
  EXPECT_GT(std::abs(sides.expected[1] - sides.expected[0]), 0.05) << "or nothing is shown";
}

TEST(DecentredBoard, RendersAsItsRaysSay) {
  constexpr double distance_m = 2;
  const SensorGeometry film{480, 320, 10};
  MountedLens camera(decentred_gauss());
  camera.focus_at_m(distance_m);
  const SpectralImage picture = rendered_board(camera.lens(), film, distance_m);
  RowTransfer transfer(camera.lens());
  const Sides sides(side_edges(picture_of(film, picture.band(0), 0, 0), film), film, 4,
                    [&](double x, double fx, double fy) { return transfer.by_rays(x, fx, fy); });
  EXPECT_GT(std::abs(sides.expected[1] - sides.expected[0]), 0.05) << "or nothing is shown";
}

}  // namespace
}  // namespace petzval
