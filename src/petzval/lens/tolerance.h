// SPDX-License-Identifier: BSD-3-Clause
// What a lens may be off by when it is built.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace petzval {

struct Lens;

/// One dimension of a lens and the limit that a maker keeps.
struct Tolerance {
  std::string kind;                 ///< the name of a ToleranceKind
  std::size_t first = 0, last = 0;  ///< surfaces; the same one but for kinds of elements
  double limit = 0;                 ///< ±, in the unit of the kind; radial where it has a direction
};

/// What a tolerance can be of.
struct ToleranceKind {
  const char* name;  ///< "radius_fringes"
  const char* unit;
  const char* meaning;
  const char* aliases;  ///< of other programs, with this unit, separated by spaces: "TFRN DLF"
  bool has_direction;   ///< across the axis: errors in x and in y, together within the limit
  bool of_elements;     ///< of surfaces first to last as one, else of one surface
  const char* (*unusable)(const Lens& lens, std::size_t surface);  ///< why not there; null: usable
  void (*apply)(Lens& lens, const Tolerance& tolerance, double x, double y);
};

/// All of them. Who adds one adds it here: files, program and pages take it from there.
std::span<const ToleranceKind> tolerance_kinds();
/// By its name or an alias; null if there is none.
const ToleranceKind* find_tolerance_kind(std::string_view name);

/// The lens with one of its dimensions off: by x in the unit of the kind, or, where that has a direction, by
/// x along x and y along y. \throws InputError as check().
Lens with_error(Lens lens, const Tolerance& tolerance, double x, double y = 0);
/// \throws InputError for a kind that there is not, surfaces that the lens does not have or to which the kind
/// does not apply, and limits that are not positive.
void check(const Lens& lens, const Tolerance& tolerance);

/// "commercial", "precision", "high": what makers offer under such names; docs/TOLERANCES.md has the limits.
std::span<const char* const> tolerance_grades();
/// Tolerances of one grade for all that a lens consists of: of every surface radius and wedge, of every gap
/// its thickness, of every glass nd and Vd, of every element decentre and tilt. \throws InputError for
/// another grade.
std::vector<Tolerance> graded_tolerances(const Lens& lens, std::string_view grade);

/// First and last surfaces of what moves as one: single lenses and cemented groups, front to back.
std::vector<std::pair<std::size_t, std::size_t>> elements_of(const Lens& lens);

/// A tolerance as the command line has it: "element_tilt_deg@2-3=0.05", surfaces counted from 0. \throws
/// InputError saying what is wrong and what would be right.
Tolerance parse_tolerance(std::string_view text);
/// The same, or what a drawing by ISO 10110 says of a surface: "3/2(0.5)@4", power and irregularity in fringe
/// spacings, one of them "-" where it is not stated, and "4/3@4", the tilt of the surface in minutes of arc.
std::vector<Tolerance> parse_tolerances(std::string_view text);
/// "element_tilt_deg@2-3".
std::string place_of(const Tolerance& tolerance);

}  // namespace petzval
