// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/imaging/lens_corrections.h>
#include <petzval/sensor/formats/dng_opcodes.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace petzval {
namespace {

/// A lens of 10 mm with distortion of the third order and light as cos⁴, by its formulas; the frame's corner
/// is 5 mm off the axis.
LensDataTable formula_table(double third_order) {
  LensDataTable table;
  table.first_order.wavelength_nm = 550;
  table.wavelengths_nm = {550};
  for (double degrees = 0; degrees <= 36; degrees += 2) {
    const double tangent = std::tan(degrees * 3.14159265358979 / 180);
    table.fields.push_back(degrees);
    table.real_image_height_mm.push_back(10 * tangent * (1 + third_order * tangent * tangent));
    table.g_sensor_sr.push_back(0.2 / std::pow(1 + tangent * tangent, 2));
  }
  return table;
}

constexpr SensorGeometry corrected_frame{1600, 1200, 5};

double even_sum(const std::vector<double>& terms, double r) {
  double sum = 0;
  for (std::size_t i = 0; i < terms.size(); ++i) sum += terms[i] * std::pow(r, 2 * static_cast<double>(i));
  return sum;
}

TEST(LensCorrections, UndoDistortionAndFallOff) {
  for (const double third_order : {-0.3, 0.0, 0.2}) {
    LensFacts facts;
    add_corrections(facts, formula_table(third_order), corrected_frame);
    ASSERT_EQ(facts.warp.size(), 4u) << third_order;
    ASSERT_EQ(facts.vignetting.size(), 5u) << third_order;
    // A point of the straight picture at r has the tangent r · 5/(10 · scale), and lies on the sensor where
    // the lens puts it. Pincushion distortion is shown so large that the corner stays where it is.
    const double scale = third_order > 0 ? 1 / facts.warp[0] : 1;
    for (double r = 0.05; r <= 1; r += 0.05) {
      const double tangent = r / 2 / scale, real = 2 * tangent * (1 + third_order * tangent * tangent);
      constexpr double tenth_of_a_pixel = 0.1 * 0.005 / 5;
      EXPECT_NEAR(even_sum(facts.warp, r) * r, real, tenth_of_a_pixel) << third_order << " at " << r;
      const double light = 1 / std::pow(1 + tangent * tangent, 2);
      std::vector<double> gain{1};
      gain.insert(gain.end(), facts.vignetting.begin(), facts.vignetting.end());
      EXPECT_NEAR(light * even_sum(gain, real), 1, 0.001) << third_order << " at " << r;
    }
    if (third_order > 0) {
      EXPECT_NEAR(even_sum(facts.warp, 1), 1, 1e-3);
    }
  }
}

TEST(LensCorrections, AreLeftOutWhereTheyDoNotFit) {
  LensFacts facts;
  add_corrections(facts, formula_table(-0.3), {4800, 3600, 5});  // fields end before the corner
  EXPECT_TRUE(facts.warp.empty());
  EXPECT_TRUE(facts.vignetting.empty());
  EXPECT_TRUE(facts.fisheye_warp.empty());
  EXPECT_TRUE(facts.gain_map.gains.empty());
}

/// What follows an opcode's head in a list, read by the letter of DNG 1.4, chapter 7.
struct Parameters {
  std::string bytes;
  std::uint64_t whole(std::size_t count = 4) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value = value << 8 | static_cast<std::uint8_t>(bytes[i]);
    bytes.erase(0, count);
    return value;
  }
  double real() { return std::bit_cast<double>(whole(8)); }
  float narrow() { return std::bit_cast<float>(static_cast<std::uint32_t>(whole())); }
};
std::map<std::uint64_t, Parameters> opcodes(const std::string& list) {
  std::map<std::uint64_t, Parameters> found;
  Parameters rest{list};
  for (std::uint64_t left = rest.whole(); left > 0; --left) {
    const std::uint64_t number = rest.whole();
    EXPECT_EQ(rest.whole(), 0x01030000u) << "since DNG 1.3";
    rest.whole();  // flags
    const std::size_t size = rest.whole();
    found[number].bytes = rest.bytes.substr(0, size);
    rest.bytes.erase(0, size);
  }
  EXPECT_TRUE(rest.bytes.empty());
  return found;
}

/// Of 2 mm, image heights as the angle; the corner of the frame is at 86 degrees. Its light falls as cos⁰·⁵,
/// and as a step of vignetting to half between 2.4 and 2.5 mm, which no polynomial follows.
LensDataTable equidistant_table() {
  LensDataTable table;
  table.first_order.wavelength_nm = 550;
  table.wavelengths_nm = {550};
  for (double degrees = 0; degrees <= 88; ++degrees) {
    const double angle = degrees * 3.14159265358979 / 180, real = 2 * angle;
    table.fields.push_back(degrees);
    table.real_image_height_mm.push_back(real);
    table.g_sensor_sr.push_back(0.2 * std::sqrt(std::cos(angle)) * (real < 2.45 ? 1 : 0.5));
  }
  return table;
}

// What the opcode says, by DNG's formula, against the lens's own: a point of the straight picture at r (1 in
// its corner) is seen under the tangent r · corner / focal length. The fit is held to 0.2 pixels at the chief
// rays of whole degrees; the bound between them is 0.25.
TEST(LensCorrections, StraightenFisheyes) {
  constexpr SensorGeometry frame{960, 720, 5};  // corner at 3 mm
  LensFacts facts;
  add_corrections(facts, equidistant_table(), frame);
  EXPECT_TRUE(facts.warp.empty());
  ASSERT_EQ(facts.fisheye_warp.size(), 4u);
  Parameters warp = opcodes(dng::opcodes_of_picture(facts)).at(2);
  EXPECT_EQ(warp.whole(), 1u);  // planes
  std::vector<double> k(4);
  for (double& term : k) term = warp.real();
  EXPECT_EQ(warp.real(), 0.5);
  EXPECT_EQ(warp.real(), 0.5);
  double worst = 0;
  for (double r = 0.01; r <= 1; r += 0.01) {
    const double theta = std::atan(r), f = k[0] * theta + k[1] * std::pow(theta, 3) +
                                           k[2] * std::pow(theta, 5) + k[3] * std::pow(theta, 7);
    const double real_mm = 2 * std::atan(r * 3 / 2);
    worst = std::max(worst, std::abs(f * 3 - real_mm) / 0.005);
  }
  EXPECT_LT(worst, 0.25) << "pixels";
}

// Bilinear between the points of the map, as the DNG specification places them; the light at a pixel over the
// gain is that of the middle to 1 %, but within a step of the map (0.15 mm) of the edge of the vignetting.
TEST(LensCorrections, MapsOfGainsFollowWhatPolynomialsDoNot) {
  constexpr SensorGeometry frame{960, 720, 5};
  RawImage raw;
  raw.columns = 960, raw.rows = 720;
  raw.channels = {"grey"};
  add_corrections(raw.lens, equidistant_table(), frame);
  EXPECT_TRUE(raw.lens.vignetting.empty());
  const auto check_map = [&](const auto& light, const auto& is_smooth) {
    Parameters map = opcodes(dng::opcodes_of_values(raw)).at(9);
    for (const std::uint64_t expected : {0, 0, 720, 960, 0, 1, 1, 1}) EXPECT_EQ(map.whole(), expected);
    const std::size_t rows = map.whole(), columns = map.whole();
    const double step_v = map.real(), step_h = map.real();
    EXPECT_EQ(map.real(), 0);
    EXPECT_EQ(map.real(), 0);
    EXPECT_EQ(map.whole(), 1u);
    std::vector<double> gains(rows * columns);
    for (double& gain : gains) gain = static_cast<double>(map.narrow());
    EXPECT_TRUE(map.bytes.empty());
    for (int row = 0; row < 720; row += 7)
      for (int column = 0; column < 960; column += 7) {
        const double x_mm = (480 - column - 0.5) * 0.005, y_mm = (row + 0.5 - 360) * 0.005;
        if (!is_smooth(x_mm, y_mm)) continue;
        const double v = (row + 0.5) / 720 / step_v, h = (column + 0.5) / 960 / step_h;
        const auto i = static_cast<std::size_t>(v), j = static_cast<std::size_t>(h);
        const auto across = [&](std::size_t line) {
          return std::lerp(gains[line * columns + j], gains[line * columns + j + 1],
                           h - static_cast<double>(j));
        };
        const double gain = std::lerp(across(i), across(i + 1), v - static_cast<double>(i));
        ASSERT_NEAR(gain * light(x_mm, y_mm) / light(0, 0), 1, 0.01) << row << ", " << column;
      }
  };
  check_map(
      [](double x, double y) {
        const double real = std::hypot(x, y);
        return std::sqrt(std::cos(real / 2)) * (real < 2.45 ? 1 : 0.5);
      },
      [](double x, double y) {
        const double real = std::hypot(x, y);
        return std::abs(real - 2.45) > 0.16 && real < 2.8;
      });

  // A lens that is brighter on one side: its table lies over the frame.
  const auto lopsided = [](double x, double y) { return 1 + 0.1 * x - 0.05 * y - 0.02 * x * x; };
  LensDataTable table;
  table.wavelengths_nm = {550};
  table.frame.emplace();
  for (double x = -2.5; x < 2.6; x += 0.25) table.frame->x_mm.push_back(x);
  for (double y = -2; y < 2.1; y += 0.25) table.frame->y_mm.push_back(y);
  for (const double y : table.frame->y_mm)
    for (const double x : table.frame->x_mm) table.g_sensor_sr.push_back(0.3 * lopsided(x, y));
  raw.lens = {};
  add_corrections(raw.lens, table, frame);
  EXPECT_TRUE(raw.lens.vignetting.empty());
  check_map(lopsided, [](double, double) { return true; });
}

}  // namespace
}  // namespace petzval
