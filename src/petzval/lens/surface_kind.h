// SPDX-License-Identifier: BSD-3-Clause
// The kinds of surface beside conics and powers of r, with their names in files.
//
// A kind is one file in lens/shapes/ and is listed in lens/shapes/added_kinds-inl.h. What it looks like:
//
//   struct Qcon {
//     static constexpr const char* name = "qcon";                    // "shape": {"kind": "qcon", …}
//     static constexpr bool is_round = true;                         // about the axis
//     static constexpr ShapeParameter parameters[] = {…};            // the other keys of "shape"
//     static std::vector<double> prepare(const Surface& surface);    // what at() needs, as ShapeData::terms
//     template <class V, class T>                                    // sag and slopes; NaN where there is
//     none static HWY_INLINE SurfacePoint<V> at(const ShapeData<T>& shape, V x, V y);
//   };
//
// at() is compiled for vectors of rays, for a single ray, and for numbers with a derivative, from which
// curvatures come. The conic of c and k is where rays begin to look for the surface.
#pragma once

#include <petzval/lens/lens.h>

#include <span>
#include <string_view>

namespace petzval {

/// One key of a kind: a number, or a list of them.
struct ShapeParameter {
  const char* name;       ///< with its unit: "normalisation_radius_mm"
  const char* meaning;    ///< completes "must be …"
  int length_power;       ///< its unit is mm to this power: how it grows with the lens
  std::size_t most = 1;   ///< numbers that a list may have; 1: not a list
  bool positive = false;  ///< and required
};

struct SurfaceKind {
  const char* name;
  bool is_round;
  std::span<const ShapeParameter> parameters;
  std::vector<double> (*prepare)(const Surface& surface);
};

/// In the order of their numbers, ShapeData::added.
std::span<const SurfaceKind> surface_kinds();
/// Null for a name that is none.
const SurfaceKind* find_surface_kind(std::string_view name);
/// "qcon, biconic", for messages.
std::string surface_kind_names();
/// \throws InputError that names the kinds there are.
const SurfaceKind& surface_kind(std::string_view name);

/// The numbers of one key; none if it was left out.
std::vector<double> shape_numbers(const Surface& surface, const char* parameter);

}  // namespace petzval
