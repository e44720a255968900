// SPDX-License-Identifier: BSD-3-Clause
// Lenses whose data follow from textbook formulas, and what tests say about lenses.
#pragma once

#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/lens/lens_file.h>
#include <petzval/lens/surface_shape.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

namespace petzval::testing {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
/// Double precision leaves two or three digits less than its sixteen after a dozen paraxial steps.
inline constexpr double paraxial_precision = 1e-13;

inline Surface surface(double radius_mm, double thickness_mm, double index = 1) {
  Surface result;
  result.curvature_per_mm = radius_mm == 0 || std::isinf(radius_mm) ? 0 : 1 / radius_mm;
  result.thickness_mm = thickness_mm;
  if (index != 1) result.material = Material(Material::Constant{index});
  return result;
}

inline Surface stop_surface(double thickness_mm) {
  Surface result;
  result.thickness_mm = thickness_mm;
  result.stop = true;
  return result;
}

inline Lens lens_of(std::vector<Surface> surfaces, double entrance_pupil_diameter_mm = 1) {
  Lens lens;
  lens.name = "sample";
  lens.aperture = {Aperture::Kind::entrance_pupil_diameter_mm, entrance_pupil_diameter_mm};
  lens.surfaces = std::move(surfaces);
  return lens;
}

/// A thin lens of this focal length, of index 1.5, as two surfaces.
inline std::vector<Surface> thin_lens(double focal_length_mm, double to_next_mm) {
  return {surface(focal_length_mm, 0, 1.5), surface(-focal_length_mm, to_next_mm)};
}

inline std::vector<Surface> joined(std::initializer_list<std::vector<Surface>> parts) {
  std::vector<Surface> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

inline void expect_relative(double value, double expected, double tolerance) {
  EXPECT_LE(std::abs(value - expected), tolerance * std::abs(expected)) << value << " is not " << expected;
}

/// The text with one passage replaced, which must stand in it.
inline std::string with_change(std::string text, const std::string& before, const std::string& after) {
  const std::size_t at = text.find(before);
  EXPECT_NE(at, text.npos) << before;
  return at == text.npos ? text : text.replace(at, before.size(), after);
}

/// The message of the InputError that `work` throws, which must be one line.
inline std::string error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), message.npos) << message;
    return message;
  }
  ADD_FAILURE() << "no InputError";
  return "";
}

inline void expect_mentions(const std::string& text, std::initializer_list<const char*> words) {
  for (const char* word : words)
    EXPECT_NE(text.find(word), text.npos) << "\"" << word << "\" is not in: " << text;
}

inline void expect_same_pose(const Pose& a, const Pose& b) {
  for (const PoseNumber& number : pose_numbers) EXPECT_EQ(a.*number.value, b.*number.value) << number.name;
}

inline void expect_same_surface(const Surface& a, const Surface& b) {
  EXPECT_EQ(a.curvature_per_mm, b.curvature_per_mm);
  EXPECT_EQ(a.thickness_mm, b.thickness_mm);
  EXPECT_EQ(a.material.description(), b.material.description());
  EXPECT_EQ(a.material.kind().index(), b.material.kind().index());
  for (const double wavelength_nm : {486.1327, 587.5618, 656.2725})
    EXPECT_EQ(a.material.index(wavelength_nm), b.material.index(wavelength_nm));
  EXPECT_EQ(a.stop, b.stop);
  EXPECT_EQ(a.semi_diameter_mm, b.semi_diameter_mm);
  EXPECT_EQ(a.conic, b.conic);
  EXPECT_EQ(a.asphere, b.asphere);
  expect_same_pose(a.pose, b.pose);
  ASSERT_EQ(a.shape.has_value(), b.shape.has_value());
  if (!a.shape) return;
  EXPECT_EQ(a.shape->kind, b.shape->kind);
  EXPECT_EQ(a.shape->parameters, b.shape->parameters);
}

/// Bit for bit, in all that traces rays.
inline void expect_same_optics(const Lens& a, const Lens& b) {
  EXPECT_EQ(a.object_distance_mm, b.object_distance_mm);
  EXPECT_EQ(a.aperture.kind, b.aperture.kind);
  EXPECT_EQ(a.aperture.value, b.aperture.value);
  EXPECT_EQ(a.fields.kind, b.fields.kind);
  EXPECT_EQ(a.fields.values, b.fields.values);
  EXPECT_EQ(a.wavelengths_nm, b.wavelengths_nm);
  EXPECT_EQ(a.reference_wavelength_nm, b.reference_wavelength_nm);
  ASSERT_EQ(a.surfaces.size(), b.surfaces.size());
  for (std::size_t i = 0; i < a.surfaces.size(); ++i) {
    SCOPED_TRACE("surface " + std::to_string(i));
    expect_same_surface(a.surfaces[i], b.surfaces[i]);
  }
  ASSERT_EQ(a.groups.size(), b.groups.size());
  for (std::size_t i = 0; i < a.groups.size(); ++i) {
    EXPECT_EQ(a.groups[i].first, b.groups[i].first);
    EXPECT_EQ(a.groups[i].last, b.groups[i].last);
    EXPECT_EQ(a.groups[i].pivot_mm, b.groups[i].pivot_mm);
    expect_same_pose(a.groups[i].pose, b.groups[i].pose);
  }
  expect_same_pose(a.sensor_pose, b.sensor_pose);
}

inline void expect_same_lens(const Lens& a, const Lens& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.source, b.source);
  expect_same_optics(a, b);
  ASSERT_EQ(a.tolerances.size(), b.tolerances.size());
  for (std::size_t i = 0; i < a.tolerances.size(); ++i) {
    EXPECT_EQ(place_of(a.tolerances[i]), place_of(b.tolerances[i]));
    EXPECT_EQ(a.tolerances[i].limit, b.tolerances[i].limit);
  }
}

}  // namespace petzval::testing
