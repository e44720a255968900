// SPDX-License-Identifier: BSD-3-Clause
// Edges in JPEG files, as libjpeg writes them.
#include <gtest/gtest.h>
#include <jpeg_bytes.h>
#include <petzval/base/error.h>
#include <petzval/colour/display.h>
#include <petzval/image/formats/jpeg.h>
#include <petzval/measure/sfr/measure_edge.h>
#include <petzval/measure/sfr/rounded_blocks.h>
#include <petzval/target/render_target.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace petzval {
namespace {

constexpr int jpeg_columns = 64, jpeg_rows = 80;

JpegImage grey_jpeg(const std::vector<std::uint8_t>& codes, int quality) {
  const auto set = [&](jpeg_compress_struct& jpeg) { jpeg_set_quality(&jpeg, quality, TRUE); };
  return parse_jpeg(test::jpeg_bytes(jpeg_columns, jpeg_rows, 1, codes, set), "edge.jpg");
}

std::vector<double> srgb_levels() {
  std::vector<double> levels;
  for (int code = 0; code < 256; ++code) levels.push_back(srgb_decoded(code / 255.0));
  return levels;
}

Plane light_of(const std::vector<std::uint8_t>& codes, const std::vector<double>& levels) {
  Plane plane{jpeg_columns, jpeg_rows, {}};
  for (const std::uint8_t code : codes) plane.values.push_back(levels[code]);
  return plane;
}

/// At each pixel of the blocks from (1, 1) to (6, 8): the code value after changes, less what libjpeg
/// decodes.
std::vector<std::vector<double>> differences_by_block(const std::vector<std::uint8_t>& codes, int quality) {
  const std::vector<double> levels = srgb_levels();
  const Plane plane = light_of(codes, levels);
  const JpegImage jpeg = grey_jpeg(codes, quality);
  std::vector<std::vector<double>> result;
  for (int top = 8; top < 72; top += 8)
    for (int left = 8; left < 56; left += 8) {
      const std::vector<EdgeSample> samples = samples_in(plane, {left, top, 8, 8});
      std::vector<double> light;
      for (const EdgeSample& sample : samples) light.push_back(sample.value);
      const std::vector<double> changes =
          RoundedBlocks(plane, jpeg.steps, levels).changes(samples, light, {});
      std::vector<double>& block = result.emplace_back();
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto at =
            static_cast<std::size_t>(samples[i].y) * jpeg_columns + static_cast<std::size_t>(samples[i].x);
        block.push_back(255 * srgb_encoded(light[i] + changes[i]) - jpeg.samples[at]);
      }
    }
  return result;
}

// Of a picture full of detail: what libjpeg makes of it, to the whole numbers that it rounds to. Its integers
// put a coefficient that lies half-way between two steps on the other side now and then, which alters a whole
// block.
TEST(RoundedBlocks, ChangePixelsAsLibjpegDoes) {
  std::mt19937 random(1);
  std::vector<std::uint8_t> codes;
  for (int i = 0; i < jpeg_columns * jpeg_rows; ++i)
    codes.push_back(
        static_cast<std::uint8_t>(100 + 60 * std::sin(0.02 * i * i / jpeg_columns) + random() % 16));
  for (const int quality : {50, 90}) {
    const auto blocks = differences_by_block(codes, quality);
    const auto alike = std::ranges::count_if(blocks, [](const std::vector<double>& block) {
      return std::ranges::all_of(block, [](double difference) { return std::abs(difference) < 1; });
    });
    EXPECT_GT(static_cast<double>(alike), 0.5 * static_cast<double>(blocks.size())) << quality;
  }
}

/// A small grey file with one byte of a segment altered: \param offset  from the segment's marker.
JpegImage altered_jpeg(char marker, std::size_t offset, char byte) {
  std::string bytes = test::jpeg_bytes(16, 16, 1, std::vector<std::uint8_t>(256, 90));
  bytes.at(bytes.find(std::string{'\xff', marker}) + offset) = byte;
  return parse_jpeg(bytes, "altered.jpg");
}

// ITU-T T.81, B.2.2: the frame's header names a table from 0 to 3 for each component; B.2.4.1: no step is 0.
TEST(RoundedBlocks, HaveNoStepsWhereTheFilesTableIsNone) {
  constexpr char frame = '\xc0', tables = '\xdb';
  EXPECT_EQ(altered_jpeg(frame, 12, 0).steps, std::vector<int>(64, 1));
  for (const char number : {'\x04', '\x7f', '\xff'})
    EXPECT_THROW(altered_jpeg(frame, 12, number), InputError) << int{number};
  EXPECT_THROW(altered_jpeg(frame, 12, 3), InputError);  // a table that the file does not hold
  EXPECT_TRUE(altered_jpeg(tables, 5 + 20, 0).steps.empty());
}

// Blocks of one grey each have one coefficient, which libjpeg's integers hold exactly.
TEST(RoundedBlocks, MeansOfBlocksAreLibjpegs) {
  std::vector<std::uint8_t> codes;
  for (int row = 0; row < jpeg_rows; ++row)
    for (int column = 0; column < jpeg_columns; ++column)
      codes.push_back(static_cast<std::uint8_t>(20 + (row / 8 * 8 + column / 8) * 83 % 220));
  for (const int quality : {20, 40, 60})
    for (const auto& block : differences_by_block(codes, quality))
      for (const double difference : block) EXPECT_LT(std::abs(difference), 0.51) << quality;
}

// Blocks elsewhere are those of the picture shifted.
TEST(RoundedBlocks, AreWhereTheyAreAskedFor) {
  std::mt19937 random(2);
  std::vector<std::uint8_t> codes(jpeg_columns * jpeg_rows), shifted(codes.size());
  for (std::uint8_t& code : codes) code = static_cast<std::uint8_t>(60 + random() % 120);
  const RoundedBlocks::Offset offset{5, 2};
  for (int row = 0; row + offset.y < jpeg_rows; ++row)
    for (int column = 0; column + offset.x < jpeg_columns; ++column)
      shifted[static_cast<std::size_t>(row * jpeg_columns + column)] =
          codes[static_cast<std::size_t>((row + offset.y) * jpeg_columns + column + offset.x)];
  const std::vector<double> levels = srgb_levels();
  const Plane plane = light_of(codes, levels), other = light_of(shifted, levels);
  const std::vector<int> steps = grey_jpeg(codes, 80).steps;
  const auto changes_in = [&](const Plane& of, const PixelBox& box, const RoundedBlocks::Offset& from) {
    const std::vector<EdgeSample> samples = samples_in(of, box);
    std::vector<double> light;
    for (const EdgeSample& sample : samples) light.push_back(sample.value);
    return RoundedBlocks(of, steps, levels).changes(samples, light, from);
  };
  const std::vector<double> there = changes_in(plane, {8 + offset.x, 16 + offset.y, 40, 40}, offset),
                            here = changes_in(other, {8, 16, 40, 40}, {0, 0});
  for (std::size_t i = 0; i < here.size(); ++i) EXPECT_NEAR(there[i], here[i], 1e-12) << i;
}

// Errors of MTF50 and of the SFR at a quarter of a cycle a pixel over what is stated: between 0.8 and 1.25
// over 100 edges of each quality, with noise of 0.3 to 2.5 code values.
TEST(RoundedBlocks, ErrorsOfEdgesAreAsLargeAsStated) {
  const std::vector<double> levels = srgb_levels();
  constexpr int edges = 100;
  for (const int quality : {75, 85, 92}) {
    double of_mtf50 = 0, of_sfr = 0;
    for (int seed = 0; seed < edges; ++seed) {
      std::mt19937 random(static_cast<unsigned>(1000 * quality + seed));
      std::uniform_real_distribution<double> share(0, 1);
      std::normal_distribution<double> normal(0, 1);
      const double angle = 3 + 10 * share(random), black = 0.02 + 0.1 * share(random),
                   white = 0.5 + 0.4 * share(random), noise = 0.3 + 2.2 * share(random);
      TargetScene scene;
      scene.polygons.push_back(
          {{half_plane({jpeg_columns / 2 + share(random), jpeg_rows / 2 + share(random)}, angle)}, 0, 0});
      const auto otf = radial_pupil_otf({{0, 0}, 0}, 550, 4 + 8 * share(random));
      TargetOptions optics;
      optics.columns = jpeg_columns, optics.rows = jpeg_rows, optics.pitch_um = 4.73;
      std::vector<std::uint8_t> codes;
      const TargetImage image = render_target(scene, *otf, optics);
      for (const double value : image.values())
        codes.push_back(static_cast<std::uint8_t>(std::clamp(
            std::round(255 * srgb_encoded(black + (white - black) * value) + noise * normal(random)), 0.0,
            255.0)));
      const JpegImage jpeg = grey_jpeg(codes, quality);
      const Plane plane = light_of(jpeg.samples, levels);
      const RoundedBlocks blocks(plane, jpeg.steps, levels);
      SfrOptions options;
      options.frequencies_cpp = {0, 0.25};
      options.code_levels = levels, options.blocks = &blocks;
      const EdgeMeasurement m = measure_edge(samples_in(plane, {0, 0, jpeg_columns, jpeg_rows}), 1, options);
      const auto truth = [&](double f) {
        const double c = std::cos(angle * M_PI / 180), s = std::sin(angle * M_PI / 180);
        return std::abs(transfer(*otf, optics, f * c, f * s));
      };
      double low = 0, high = 0.8;
      for (int i = 0; i < 50; ++i) (truth(0.5 * (low + high)) > 0.5 ? low : high) = 0.5 * (low + high);
      of_mtf50 += std::pow((m.mtf50().frequency_cpp - low) / m.mtf50().deviation_cpp, 2) / edges;
      of_sfr += std::pow((m.sfr[1] - truth(0.25)) / m.sfr_deviation[1], 2) / edges;
    }
    for (const double square : {of_mtf50, of_sfr}) {
      EXPECT_GT(std::sqrt(square), 0.8) << quality;
      EXPECT_LT(std::sqrt(square), 1.25) << quality;
    }
  }
}

}  // namespace
}  // namespace petzval
