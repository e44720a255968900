// SPDX-License-Identifier: BSD-3-Clause
// What pixels see, by the scene's own order.
#include <gtest/gtest.h>
#include <petzval/lens/lens_file.h>
#include <petzval/simulate/scene_depth.h>
#include <petzval/simulate/scene_segments.h>
#include <scratch.h>

#include <cmath>

namespace petzval {
namespace {

/// Left half a wall at z = 2 behind a pane that is no boundary; right of it an object placed twice, the
/// second time above; nothing elsewhere.
constexpr const char* three_things =
    "LookAt 0 0 -1  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 60\n"
    "Film \"rgb\" \"integer xresolution\" 80 \"integer yresolution\" 60 \"float diagonal\" 40\nWorldBegin\n"
    "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n"
    "AttributeBegin\nMaterial \"interface\"\nShape \"bilinearmesh\" \"point3 P\" [ -2 -2 1  0 -2 1  -2 2 1  "
    "0 2 1 ]\nAttributeEnd\n"
    "AttributeBegin\nMaterial \"diffuse\"\nShape \"bilinearmesh\" \"point3 P\" [ -4 -4 2  0 -4 2  -4 4 2  0 "
    "4 2 ]\nAttributeEnd\n"
    "ObjectBegin \"o\"\nShape \"sphere\" \"float radius\" 0.3\nObjectEnd\n"
    "AttributeBegin\nTranslate 0.8 -0.5 2\nObjectInstance \"o\"\nAttributeEnd\n"
    "AttributeBegin\nTranslate 0.8 0.5 2\nObjectInstance \"o\"\nAttributeEnd\n";

TEST(SceneSegments, NameWhatEachPixelSees) {
  const test::Scratch scratch;
  RenderRequest request{.scene = scratch.with("s.pbrt", three_things)};
  for (const bool through_lens : {false, true}) {
    if (through_lens) {
      request.camera.lens = read_lens("dgauss-50mm").lens;
      request.camera.focus = Focus::at_m(3);
    }
    const PreparedScene scene = prepare_scene(request);
    const SceneSegments seen = segments_seen(scene);
    ASSERT_EQ(seen.columns * seen.rows, 80 * 60);
    const std::vector<double> depth = depths_seen_m(scene, {0, 0, 80, 60});
    int wall = 0, lower = 0, upper = 0, edges = 0;
    for (std::size_t i = 0; i < seen.shape.size(); ++i) {
      edges +=
          std::isfinite(depth[i]) != (seen.shape[i] >= 0);  // a random place of the pixel sees past an edge
      if (seen.shape[i] == 1) {
        ++wall;
        EXPECT_EQ(seen.material[i], 2);
        EXPECT_EQ(seen.instance[i], -1);
        EXPECT_LT(i % 80, 40u);
      } else if (seen.shape[i] == 2) {
        EXPECT_EQ(seen.material[i], 0);
        (seen.instance[i] == 0 ? lower : upper) += 1;
        EXPECT_EQ(seen.instance[i] == 1, i / 80 < 30);
      } else {
        EXPECT_EQ(seen.shape[i], -1);
      }
    }
    EXPECT_GT(wall, through_lens ? 500 : 1500);
    EXPECT_GT(lower, 10);
    EXPECT_NEAR(lower, upper, 4);
    // An outline of radius r passes through at most 8 r pixels; the spheres have 5 pixels, through the
    // lens 12.5.
    EXPECT_LT(edges, 2 * 8 * (through_lens ? 12.5 : 5.2));
  }
}

}  // namespace
}  // namespace petzval
