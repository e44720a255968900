// SPDX-License-Identifier: BSD-3-Clause
// Pictures as textures: every kind of file gives the light that its format says, and damaged ones are
// refused.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/render/textures/radiance_picture.h>
#include <petzval/render/textures/texture.h>

#include <cmath>
#include <fstream>
#include <random>

#include "jpeg_bytes.h"
#include "scratch.h"

namespace petzval::render {
namespace {

const std::string head = "#?RADIANCE\n# by hand\nFORMAT=32-bit_rle_rgbe\n";

/// Ward's rule: (mantissa + ½)/256 · 2^(exponent − 128).
double ward(int mantissa, int exponent) {
  return (mantissa + 0.5) / 256 * std::pow(2.0, exponent - 128);
}

TEST(RadiancePicture, HoldsTheLightOfItsBytes) {
  const std::string plain{static_cast<char>(200), 100, 50, static_cast<char>(129), 10, 20, 30,
                          static_cast<char>(120)};
  const PictureFile picture = parse_radiance_picture(head + "\n-Y 2 +X 1\n" + plain, "p.hdr");
  ASSERT_EQ(picture.width, 1);
  ASSERT_EQ(picture.height, 2);
  EXPECT_FLOAT_EQ(picture.pixel(0, 0)[0], static_cast<float>(ward(200, 129)));
  EXPECT_FLOAT_EQ(picture.pixel(0, 0)[2], static_cast<float>(ward(50, 129)));
  EXPECT_FLOAT_EQ(picture.pixel(0, 1)[1], static_cast<float>(ward(20, 120)));
  const PictureFile exposed =
      parse_radiance_picture(head + "EXPOSURE=2\nEXPOSURE= 4\n\n-Y 2 +X 1\n" + plain, "p.hdr");
  EXPECT_FLOAT_EQ(exposed.pixel(0, 0)[0] * 8, picture.pixel(0, 0)[0]);
}

/// Ten pixels, red rising, the others the same: in planes, a run of literals and runs of one value.
std::string with_runs() {
  std::string row{2, 2, 0, 10, 10};
  for (char red = 0; red < 10; ++red) row += red;
  for (const int value : {77, 5, 130})
    row += std::string{static_cast<char>(128 + 10), static_cast<char>(value)};
  return head + "\n-Y 1 +X 10\n" + row;
}

TEST(RadiancePicture, ReadsRuns) {
  const PictureFile picture = parse_radiance_picture(with_runs(), "p.hdr");
  for (int i = 0; i < 10; ++i) {
    EXPECT_FLOAT_EQ(picture.pixel(i, 0)[0], static_cast<float>(ward(i, 130)));
    EXPECT_FLOAT_EQ(picture.pixel(i, 0)[1], static_cast<float>(ward(77, 130)));
  }
  // Runs of the first format: (1, 1, 1, n) repeats the pixel before n times.
  const std::string old{9, 8, 7, static_cast<char>(128), 1, 1, 1, 11};
  const PictureFile repeated = parse_radiance_picture(head + "\n-Y 1 +X 12\n" + old, "p.hdr");
  EXPECT_EQ(repeated.pixel(11, 0)[1], repeated.pixel(0, 0)[1]);
}

TEST(RadiancePicture, RefusesWhatIsNoneWithoutFailing) {
  for (const std::string& bad :
       {std::string(), std::string("P6 1 1"), head, head + "\n-Y 0 +X 1\n", head + "\n+Y 1 +X 1\nabcd",
        head + "\n-Y 1 +X 1\nabc", head + "\n-Y 65536 +X 65536\nabcd",
        std::string("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\nabcd"),
        head + "EXPOSURE=0\n\n-Y 1 +X 1\nabcd"})
    EXPECT_THROW(parse_radiance_picture(bad, "p.hdr"), InputError) << bad;
  std::mt19937 random(3);
  const std::string sound = with_runs();
  int refused = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string bytes = sound;
    for (int k = 0; k < 1 + i % 3; ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
    if (i % 5 == 0) bytes.resize(random() % bytes.size());
    try {
      parse_radiance_picture(bytes, "p.hdr");
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 5000);
}

TEST(PictureFile, ReadsJpegAsSrgb) {
  const test::Scratch scratch;
  std::vector<std::uint8_t> samples;
  for (int i = 0; i < 64; ++i) samples.insert(samples.end(), {128, 128, 128});
  for (const char* name : {"p.jpg", "p.JPEG"}) {
    std::ofstream(scratch.path(name), std::ios::binary) << test::jpeg_bytes(8, 8, 3, samples);
    const PictureFile picture = read_picture_file(scratch.path(name));
    ASSERT_EQ(picture.width, 8);
    // 128/255 of sRGB (IEC 61966-2-1).
    EXPECT_NEAR(picture.pixel(3, 3)[1], std::pow((128 / 255.0 + 0.055) / 1.055, 2.4), 0.01);
    EXPECT_NEAR(read_picture_file(scratch.path(name), PictureEncoding::linear).pixel(3, 3)[1], 128 / 255.0,
                0.01);
  }
}

TEST(TextureMapping, OfASphereAndACylinderAreTheirCoordinates) {
  TextureMapping mapping;
  mapping.texture_from_world = Transform::translation({0, 0, -1});
  for (double theta = 0.1; theta < pi; theta += 0.3)
    for (double phi = 0.05; phi < 2 * pi; phi += 0.4) {
      const TexturePoint point{{3 * std::sin(theta) * std::cos(phi), 3 * std::sin(theta) * std::sin(phi),
                                1 + 3 * std::cos(theta)}};
      double s, t;
      mapping.kind = TextureMapping::Kind::spherical;  // pbrt-v4: (theta/π, phi/2π)
      mapping.coordinates(point, s, t);
      EXPECT_NEAR(s, theta / pi, 1e-12);
      EXPECT_NEAR(t, phi / (2 * pi), 1e-12);
      mapping.kind = TextureMapping::Kind::cylindrical;  // (π + atan2(y, x))/2π and z
      mapping.coordinates(point, s, t);
      EXPECT_NEAR(s, 0.5 + (phi > pi ? phi - 2 * pi : phi) / (2 * pi), 1e-12);
      EXPECT_NEAR(t, 3 * std::cos(theta), 1e-12);
    }
}

}  // namespace
}  // namespace petzval::render
