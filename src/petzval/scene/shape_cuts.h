// SPDX-License-Identifier: BSD-3-Clause
// Closed outlines (the last corner is joined to the first) that overlap, cut so that they do not (Vatti's
// algorithm, the Clipper library).
#pragma once

#include <petzval/scene/shape.h>

#include <polyclipping/clipper.hpp>
#include <span>
#include <vector>

namespace petzval {

/// Corners as Clipper has them: whole numbers, 2^-24 of a sample or pixel apart.
ClipperLib::Paths to_clipper(std::span<const std::vector<Point>> outlines);
std::vector<std::vector<Point>> from_clipper(const ClipperLib::Paths& paths);

/// What lies within any of the outlines, each either way round, as a shape that covers it once.
Shape united(std::span<const std::vector<Point>> outlines);

/// What later shapes leave of each. Shapes that no later one may overlap stay as they are. Where shapes share
/// a border, what they cover of a pixel on it adds up to 1.
std::vector<Shape> uncovered_parts(std::span<const Shape* const> shapes);

}  // namespace petzval
