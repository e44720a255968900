// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/optics/formats/psf_grid.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace petzval {

namespace {

/// A PSF whose samples sum to 1 to this is left as it is: a sum of floats is no closer.
constexpr double sum_rounding = 1e-6;

constexpr std::array<const char*, 4> away_names = {"up", "down", "left", "right"};

/// A step on the page: rows count downwards.
struct Step {
  int row, column;
};

Step step_of(PsfAway away) {
  switch (away) {
    case PsfAway::up:
      return {-1, 0};
    case PsfAway::down:
      return {1, 0};
    case PsfAway::left:
      return {0, -1};
    default:
      return {0, 1};
  }
}

Step clockwise_of(Step step) {
  return {step.column, -step.row};
}

void require_good(const NumberGrid& grid, const PsfFrame& frame) {
  if (grid.rows < 1 || grid.columns < 1) throw InputError("a PSF has no samples");
  if (frame.centre_row < 0 || frame.centre_row >= grid.rows || frame.centre_column < 0 ||
      frame.centre_column >= grid.columns)
    throw InputError(fmt::format("the chief ray is said to be in row {}, column {} of {} x {} samples",
                                 frame.centre_row + 1, frame.centre_column + 1, grid.rows, grid.columns));
  for (std::size_t i = 0; i < grid.values.size(); ++i)
    if (!(std::isfinite(grid.values[i]) && grid.values[i] >= 0))
      throw InputError(fmt::format("row {}, column {} of the PSF is {}; light is finite and not negative",
                                   i / static_cast<std::size_t>(grid.columns) + 1,
                                   i % static_cast<std::size_t>(grid.columns) + 1, grid.values[i]));
}

/// The least size whose sample [size/2] has so many samples on either side.
int size_for(int before, int behind) {
  return std::max(2 * before, 2 * behind + 1);
}

/// How far the grids are from their mirror images about row or column `centre`, of all their light.
double asymmetry(std::span<const NumberGrid> grids, bool upright, int centre) {
  double difference = 0, light = 0;
  for (const NumberGrid& grid : grids)
    for (int i = 0; i < grid.rows; ++i)
      for (int j = 0; j < grid.columns; ++j) {
        const int row = upright ? i : 2 * centre - i, column = upright ? 2 * centre - j : j;
        const bool inside = row >= 0 && row < grid.rows && column >= 0 && column < grid.columns;
        difference += std::abs(grid.at(i, j) - (inside ? grid.at(row, column) : 0));
        light += std::abs(grid.at(i, j));
      }
  return light > 0 ? difference / light : 2;
}

}  // namespace

PsfAway parse_away(const std::string& text) {
  for (std::size_t i = 0; i < away_names.size(); ++i)
    if (text == away_names[i]) return static_cast<PsfAway>(i);
  throw InputError(fmt::format("there is no direction \"{}\": up, down, left or right would be right", text));
}

std::string away_text(PsfAway away) {
  return away_names[static_cast<std::size_t>(away)];
}

Psf psf_of_grid(const NumberGrid& grid, const PsfFrame& frame, double spacing_um) {
  require_good(grid, frame);
  const Step t_step = step_of(frame.away), s_step = clockwise_of(t_step);
  // t or s of an edge of the grid; both axes must fit.
  int before = 0, behind = 0;
  for (const int row : {0, grid.rows - 1})
    for (const int column : {0, grid.columns - 1}) {
      const int down = row - frame.centre_row, right = column - frame.centre_column;
      for (const int reach :
           {down * t_step.row + right * t_step.column, down * s_step.row + right * s_step.column}) {
        before = std::max(before, -reach);
        behind = std::max(behind, reach);
      }
    }
  Psf psf;
  psf.size = size_for(before, behind);
  psf.spacing_um = spacing_um;
  psf.values.assign(static_cast<std::size_t>(psf.size) * static_cast<std::size_t>(psf.size), 0.0F);
  // By the brightest sample first: units may be so large or small that the sum could not be divided by.
  const double brightest = *std::max_element(grid.values.begin(), grid.values.end());
  if (!(brightest > 0)) throw InputError("a PSF is dark throughout");
  double sum = 0;
  for (const double value : grid.values) sum += value / brightest;
  const bool normalised = std::abs(sum * brightest - 1) <= sum_rounding;
  for (int i = 0; i < grid.rows; ++i)
    for (int j = 0; j < grid.columns; ++j) {
      const int down = i - frame.centre_row, right = j - frame.centre_column;
      const int t = down * t_step.row + right * t_step.column, s = down * s_step.row + right * s_step.column;
      psf.values[static_cast<std::size_t>((t + psf.size / 2) * psf.size + s + psf.size / 2)] =
          static_cast<float>(normalised ? grid.at(i, j) : grid.at(i, j) / brightest / sum);
    }
  return psf;
}

NumberGrid grid_of_psf(const Psf& psf, const PsfFrame& frame, int size) {
  const Step t_step = step_of(frame.away), s_step = clockwise_of(t_step);
  NumberGrid grid{size, size,
                  std::vector<double>(static_cast<std::size_t>(size) * static_cast<std::size_t>(size))};
  for (int i = 0; i < psf.size; ++i)
    for (int j = 0; j < psf.size; ++j) {
      const int t = i - psf.size / 2, s = j - psf.size / 2;
      const int row = frame.centre_row + t * t_step.row + s * s_step.row;
      const int column = frame.centre_column + t * t_step.column + s * s_step.column;
      if (row >= 0 && row < size && column >= 0 && column < size)
        grid.values[static_cast<std::size_t>(row * size + column)] = static_cast<double>(psf.at(i, j));
      else if (psf.at(i, j) != 0)
        throw InputError(
            fmt::format("a PSF of {0} x {0} samples does not fit into {1} x {1}", psf.size, size));
    }
  return grid;
}

std::optional<PsfMirror> find_mirror(std::span<const NumberGrid> grids) {
  constexpr double near = 0.02, clearly = 10;
  if (grids.empty() || grids.front().rows != grids.front().columns || grids.front().rows < 3) return {};
  double best[2] = {2, 2};
  PsfMirror mirror[2];
  const int half = grids.front().rows / 2;
  for (const bool upright : {false, true})
    for (const int centre : {half - 1, half}) {
      const double here = asymmetry(grids, upright, centre);
      if (here >= best[upright]) continue;
      best[upright] = here;
      mirror[upright] = {upright, centre};
    }
  const bool upright = best[1] < best[0];
  if (best[upright] > near || best[!upright] < clearly * best[upright]) return {};
  return mirror[upright];
}

}  // namespace petzval
