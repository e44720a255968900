// SPDX-License-Identifier: BSD-3-Clause
// The tree of lights by two laws: it chooses with the probabilities that it states, and leaves no light out
// that arrives.
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/render/lights/light_tree.h>

#include <cmath>
#include <random>

#include "scene_text.h"

namespace petzval::render {
namespace {

using Random = std::mt19937;

double number(Random& random, double low, double high) {
  return std::uniform_real_distribution<>(low, high)(random);
}

Vector3 place(Random& random, double size) {
  return {number(random, -size, size), number(random, -size, size), number(random, -size, size)};
}

/// Lamps of all kinds about the origin, as a scene has them.
std::string lamps(Random& random, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    const Vector3 p = place(random, 4), q = place(random, 1), r = place(random, 1);
    const auto v = [](Vector3 a) {
      return std::to_string(a.x) + " " + std::to_string(a.y) + " " + std::to_string(a.z) + " ";
    };
    const std::string strong = std::to_string(std::exp(number(random, -4, 4)));
    text += "AttributeBegin\n";
    if (i % 6 == 0)
      text += "LightSource \"point\" \"float scale\" " + strong + " \"point3 from\" [ " + v(p) + "]\n";
    else if (i % 6 == 1)
      text += "LightSource \"spot\" \"float scale\" " + strong + " \"float coneangle\" " +
              std::to_string(number(random, 5, 170)) + " \"float conedeltaangle\" " +
              std::to_string(number(random, 0, 100)) + " \"point3 from\" [ " + v(p) + "] \"point3 to\" [ " +
              v(p + q) + "]\n";
    else
      text += "AreaLightSource \"diffuse\" \"float scale\" " + strong + " \"bool twosided\" " +
              (number(random, 0, 1) < 0.3 ? "true" : "false") + "\nTranslate " + v(p) + "\nRotate " +
              std::to_string(number(random, 0, 360)) + " " + v(q) + "\n" +
              (i % 6 == 2   ? "Shape \"sphere\" \"float radius\" 0.3\n"
               : i % 6 == 3 ? "Shape \"disk\" \"float radius\" 0.5\n"
               : i % 6 == 4 ? "Shape \"cylinder\" \"float radius\" 0.2\n"
                            : "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 " + v(q) + v(r) +
                                  "] \"integer indices\" [ 0 1 2 ]" +
                                  (number(random, 0, 1) < 0.5
                                       ? "\"normal N\" [ " + v(q) + v(r) + v(place(random, 1)) + "]\n"
                                       : "\n"));
    text += "AttributeEnd\n";
  }
  return text;
}

LightReceiver receiver(Random& random) {
  return {place(random, 5), normalised(place(random, 1)), number(random, 0, 1) < 0.3};
}

void expect_choices_as_often_as_said(int lights, int points, int steps, unsigned seed) {
  Random random(seed);
  std::vector<LightBounds> bounds;
  for (int i = 0; i < lights; ++i) {
    LightBounds each;
    const Vector3 at = place(random, 4), half{0.1, 0.2, 0.1};
    each.box = {at - half, at + half}, each.radius = length(half);
    each.axis = normalised(place(random, 1)), each.reach = pi / 2;
    each.spread = number(random, 0, 1) < 0.5 ? 0 : number(random, 0, pi);
    each.two_sided = number(random, 0, 1) < 0.3;
    each.strength = i % 17 == 0 ? 0 : std::exp(number(random, -4, 4));
    bounds.push_back(each);
  }
  const LightTree tree(bounds);
  for (int point = 0; point < points; ++point) {
    const LightReceiver to = receiver(random);
    LightTree::Weights weights{};
    const double sum = tree.weigh(to, weights);
    ASSERT_GT(sum, 0);
    double all = 0;
    for (std::size_t light = 0; light < bounds.size(); ++light)
      all += tree.probability(to, weights, sum, light);
    // Where the children of a node can do nothing after all, its share goes to lights that are asked in
    // vain.
    EXPECT_NEAR(all, 1, 1e-12);
    // Numbers in even steps meet each light's interval of `choice` to a step.
    std::vector<int> met(bounds.size());
    for (int i = 0; i < steps; ++i) {
      const LightTree::Choice choice = tree.choose(to, weights, sum, (i + 0.5) / steps);
      ++met[choice.light];
      EXPECT_NEAR(choice.probability, tree.probability(to, weights, sum, choice.light),
                  1e-12 * choice.probability);
    }
    for (std::size_t light = 0; light < bounds.size(); ++light)
      EXPECT_NEAR(met[light], steps * tree.probability(to, weights, sum, light), 1.001) << light;
  }
}

TEST(LightTree, ChoosesAsOftenAsItSays) {
  expect_choices_as_often_as_said(200, 50, 20000, 3);
  // Children of children of children.
  expect_choices_as_often_as_said(20000, 2, 20000, 4);
}

TEST(LightTree, LeavesNoLightOutThatArrives) {
  Random random(8);
  int arrived = 0;
  for (int round = 0; round < 20; ++round) {
    const auto world = world_of(lamps(random, 60));
    for (std::size_t area = 0; area < world->lights.areas.size(); ++area) {
      const AreaLight& light = world->lights.areas[area];
      for (int i = 0; i < 100; ++i) {
        const LightReceiver to = receiver(random);
        const SurfacePoint on = sample_primitive(world->geometries[static_cast<std::size_t>(light.geometry)],
                                                 light.primitive, number(random, 0, 1), number(random, 0, 1))
                                    .point;
        const Vector3 way = normalised(on.position - to.position);
        if (world->lights.emitted(area, on, -way, 0).is_black()) continue;
        if (!to.both_sides && dot(way, to.normal) <= 0) continue;
        ++arrived;
        EXPECT_GT(world->lights.area_pdf(world->geometries, area, world->lights.plan(to), on), 0)
            << round << ' ' << area;
      }
    }
  }
  EXPECT_GT(arrived, 10000);
}

/// What a point of a floor gets from point lights, by asking one at random, against the sum over all of them.
TEST(LightTree, GivesTheSumOverAllLamps) {
  Random random(21);
  std::string text;
  const int count = 100;
  for (int i = 0; i < count; ++i) {
    const Vector3 p = place(random, 3);
    text += "LightSource \"point\" \"spectrum I\" [ 300 1 900 1 ] \"point3 from\" [ " + std::to_string(p.x) +
            " " + std::to_string(p.y) + " " + std::to_string(p.z) + " ]\n";
  }
  const auto world = world_of(text);
  const LightReceiver to{{0.1, 0.2, -3.5}, {0, 0, 1}, false};
  double exact = 0;
  for (const SmallLight& light : world->lights.smalls) {
    const Vector3 way = light.position - to.position;
    exact += way.z / std::pow(length(way), 3);
  }
  const LightPlan plan = world->lights.plan(to);
  constexpr int samples = 100000;
  double sum = 0, squares = 0;
  for (int i = 0; i < samples; ++i) {
    const auto light = world->lights.sample(world->geometries, plan, (i + 0.5) / samples, 0.5, 0.5, 0);
    if (!light) continue;
    const double value = static_cast<double>(light->light[0]) * light->direction.z / light->pdf;
    sum += value / samples, squares += value * value / samples;
  }
  // Even steps: each light's share is right to a step of about 1/400 of its probability.
  EXPECT_NEAR(sum, exact, 0.003 * exact);
  // By chance among all, the relative variance is above 1 for lamps that are so unequal; the tree shall leave
  // less than a fifth.
  EXPECT_LT(squares / (sum * sum) - 1, 0.2);
}

/// Irradiance by a lamp that shines to all sides alike, over its intensity.
double irradiance_of_lamp(Vector3 lamp, const LightReceiver& to) {
  const Vector3 way = lamp - to.position;
  return std::max(0.0, dot(way, to.normal)) / std::pow(length(way), 3);
}

LightBounds lamp_at(Vector3 place, double strength) {
  LightBounds bounds;
  bounds.box = {place, place};
  bounds.spread = pi;
  bounds.strength = strength;
  return bounds;
}

/// What a choice among so few finds, over its probability, is the sum over all, whichever lamp it is.
TEST(LightTree, WeighsFewLampsOneByOne) {
  Random random(5);
  std::vector<LightBounds> bounds;
  for (int i = 0; i < 32; ++i) bounds.push_back(lamp_at(place(random, 4), std::exp(number(random, -4, 4))));
  const LightTree tree(bounds);
  const LightReceiver to{{0.3, 0.2, -0.1}, normalised({1, 2, 3}), false};
  double exact = 0;
  for (const LightBounds& each : bounds) exact += each.strength * irradiance_of_lamp(each.box[0], to);
  LightTree::Weights weights;
  const double sum = tree.weigh(to, weights);
  for (int i = 0; i < 1000; ++i) {
    const LightTree::Choice choice = tree.choose(to, weights, sum, (i + 0.5) / 1000);
    const LightBounds& chosen = bounds[choice.light];
    EXPECT_NEAR(chosen.strength * irradiance_of_lamp(chosen.box[0], to) / choice.probability, exact,
                1e-12 * exact);
  }
}

/// Of lamps on a wide ceiling, those overhead are chosen in the ratios of what they do.
TEST(LightTree, WeighsNearLampsOneByOne) {
  Random random(6);
  std::vector<LightBounds> bounds;
  for (int x = -10; x <= 10; ++x)
    for (int y = -10; y <= 10; ++y)
      bounds.push_back(lamp_at({1.0 * x, 1.0 * y, 2}, std::exp(number(random, -2, 2))));
  const LightTree tree(bounds);
  const LightReceiver to{{0.5, 0.4, 0}, {0, 0, 1}, false};
  LightTree::Weights weights;
  const double sum = tree.weigh(to, weights);
  const auto done_over_probability = [&](std::size_t i) {
    return bounds[i].strength * irradiance_of_lamp(bounds[i].box[0], to) /
           tree.probability(to, weights, sum, i);
  };
  const std::size_t overhead = 10 * 21 + 10;
  for (const std::size_t i : {overhead - 20, overhead - 1, overhead + 20, overhead + 41})
    EXPECT_NEAR(done_over_probability(i), done_over_probability(overhead),
                1e-12 * done_over_probability(overhead));
}

}  // namespace
}  // namespace petzval::render
