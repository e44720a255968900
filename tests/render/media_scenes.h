// SPDX-License-Identifier: BSD-3-Clause
// Scenes with media, and what is seen of them.
#pragma once

#include <petzval/render/path_tracer.h>

#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "scene_text.h"

namespace petzval::render {

struct Estimate {
  std::array<double, 3> mean{}, deviation{};  ///< of the mean; by wavelength
};

/// Radiance along rays, each wavelength leading in turn.
inline Estimate seen(const World& world, const std::function<std::array<Vector3, 2>(double, double)>& ray,
                     int samples, PathOptions::Lights lights = PathOptions::Lights::both,
                     int max_depth = 1000) {
  PathOptions options;
  options.max_depth = max_depth;
  options.lights = lights;
  const PathTracer tracer(world, options);
  std::array<double, 3> sum{}, squares{};
  for (int i = 0; i < samples; ++i) {
    SobolSample sample(31, static_cast<std::uint32_t>(i));
    const auto [u, v] = sample.next2();
    const auto [from, along] = ray(u, v);
    const int hero = i % 3;
    const PathLight light = tracer.trace(from, normalised(along), 0, hero, sample);
    for (int lane = 0; lane < 3; ++lane) {
      double value = static_cast<double>(light.shared[lane]);
      if (lane == hero) value += 3 * static_cast<double>(light.alone);
      const auto at = static_cast<std::size_t>(lane);
      sum[at] += value, squares[at] += value * value;
    }
  }
  Estimate result;
  for (std::size_t i = 0; i < 3; ++i) {
    result.mean[i] = sum[i] / samples;
    result.deviation[i] =
        std::sqrt(std::max(0.0, squares[i] / samples - result.mean[i] * result.mean[i]) / samples);
  }
  return result;
}

inline Estimate seen(const World& world, Vector3 from, Vector3 along, int samples,
                     PathOptions::Lights lights = PathOptions::Lights::both, int max_depth = 1000) {
  return seen(
      world,
      [&](double, double) {
        return std::array{from, along};
      },
      samples, lights, max_depth);
}

inline std::string flat(const char* name, double value) {
  return "\"spectrum " + std::string(name) + "\" [ 300 " + std::to_string(value) + " 900 " +
         std::to_string(value) + " ] ";
}

/// A coefficient that differs from wavelength to wavelength.
inline std::string coloured(const char* name, double blue, double green, double red) {
  return "\"spectrum " + std::string(name) + "\" [ 450 " + std::to_string(blue) + " 550 " +
         std::to_string(green) + " 650 " + std::to_string(red) + " ] ";
}

inline std::string medium(const std::string& coefficients, double g = 0) {
  return "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"float g\" " + std::to_string(g) + " " +
         coefficients + "\n";
}

/// The same through every call: what is inside of the shapes that follow.
inline constexpr const char* fog_inside = "MediumInterface \"fog\" \"\"\nMaterial \"interface\"\n";
inline constexpr const char* glass_about_fog =
    "MediumInterface \"fog\" \"\"\nMaterial \"dielectric\" \"float eta\" 1.5\n";

/// Two planes that look away from each other, z from −depth to 0.
inline std::string slab(double depth) {
  const std::string disk = "Shape \"disk\" \"float radius\" 10000 ";
  return disk + "\n" + "ReverseOrientation\n" + disk + "\"float height\" " + std::to_string(-depth) +
         "\nReverseOrientation\n";
}

/// A grid of n samples an edge, 1 within; as wide as it must be to be even in the box from −half to half.
inline std::string grid(
    int n, double half, const std::string& coefficients, double g,
    const std::function<double(int, int, int)>& density = [](int, int, int) { return 1.0; }) {
  const double edge = half * n / (n - 1);  // to half a cell beyond the outermost samples
  std::string text = "MakeNamedMedium \"fog\" \"string type\" \"uniformgrid\" \"float g\" " +
                     std::to_string(g) + " " + coefficients + "\"float density\" [";
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) text += " " + std::to_string(density(x, y, z));
  text += " ]";
  for (const char* name : {" \"integer nx\" ", " \"integer ny\" ", " \"integer nz\" "})
    text += name + std::to_string(n);
  for (const auto& [name, at] : {std::pair{" \"point3 p0\" [", -edge}, {" \"point3 p1\" [", edge}}) {
    text += name;
    for (int i = 0; i < 3; ++i) text += " " + std::to_string(at);
    text += " ]";
  }
  return text + "\n";
}

inline std::string media_message(const std::string& text) {
  try {
    world_of(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing";
}

}  // namespace petzval::render
