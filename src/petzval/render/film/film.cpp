// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/stop.h>
#include <petzval/render/film/film.h>

#include <algorithm>
#include <array>

namespace petzval::render {

namespace {

/// 16 GiB of sums.
constexpr double most_values = 1073741824.0;
/// Of a film or a const one.
template <typename AnyFilm>
auto sums_of(AnyFilm& film) {
  return std::array{&film.light, &film.of_sources, &film.half,   &film.half_first, &film.lamps,
                    &film.met,   &film.depth,      &film.normal, &film.albedo};
}

/// Sums of nothing. A large film takes seconds to be laid out: in pieces, so that a stop is heard of.
std::vector<ExactSum> empty_sums(std::size_t count) {
  constexpr std::size_t piece = std::size_t{1} << 22;
  std::vector<ExactSum> sums;
  sums.reserve(count);
  while (sums.size() < count) {
    check_stop();
    sums.resize(std::min(count, sums.size() + piece));
  }
  return sums;
}

/// Row by row, where a tile's sums stand in those of a window that holds it.
template <typename Copy>
void each_row(const PixelWindow& window, const PixelWindow& tile, std::size_t planes, const Copy& copy) {
  const auto columns = static_cast<std::size_t>(tile.columns());
  for (std::size_t plane = 0; plane < planes; ++plane)
    for (int row = tile.top; row < tile.bottom; ++row)
      copy(plane * window.size() + window.index(tile.left, row),
           plane * tile.size() + tile.index(tile.left, row), columns);
}

}  // namespace

Film::Film(const PixelWindow& pixels, int bands, int groups, bool first_surfaces, Half kept_half,
           std::size_t sources)
    : window(pixels), whole(pixels) {
  const double planes = bands * (first_surfaces ? 2.0 : 1.0) + groups + 6;
  const double values = static_cast<double>(pixels.size()) *
                        (planes * (kept_half == Half::all ? 2 : 1) + bands * static_cast<double>(sources));
  if (values > most_values)
    throw InputError(
        fmt::format("a picture of {} x {} pixels and {} bands needs {:.0f} GiB to gather its light in; fewer "
                    "pixels or bands would fit",
                    pixels.columns(), pixels.rows(), bands, values * sizeof(ExactSum) / 1073741824));
  light = empty_sums(pixels.size() * static_cast<std::size_t>(bands));
  of_sources = empty_sums(sources * light.size());
  arriving = empty_sums(static_cast<std::size_t>(bands));
  lamps = empty_sums(pixels.size());
  if (kept_half != Half::none) half = empty_sums(kept_half == Half::all ? light.size() : pixels.size());
  if (!first_surfaces) return;
  met = empty_sums(pixels.size() * static_cast<std::size_t>(groups));
  depth = empty_sums(pixels.size());
  normal = empty_sums(3 * pixels.size());
  albedo = empty_sums(light.size());
  if (kept_half == Half::all)
    half_first = empty_sums(met.size() + depth.size() + normal.size() + albedo.size());
}

Film Film::part(const PixelWindow& tile) const {
  Film result;
  result.window = tile;
  const auto from = sums_of(*this);
  const auto to = sums_of(result);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const std::size_t planes = from[i]->size() / window.size();
    to[i]->resize(planes * tile.size());
    each_row(window, tile, planes, [&](std::size_t here, std::size_t there, std::size_t count) {
      std::copy_n(from[i]->begin() + static_cast<std::ptrdiff_t>(here), count,
                  to[i]->begin() + static_cast<std::ptrdiff_t>(there));
    });
  }
  return result;
}

void Film::put(const Film& tile) {
  const auto from = sums_of(tile);
  const auto to = sums_of(*this);
  for (std::size_t i = 0; i < from.size(); ++i)
    each_row(window, tile.window, from[i]->size() / tile.window.size(),
             [&](std::size_t here, std::size_t there, std::size_t count) {
               std::copy_n(from[i]->begin() + static_cast<std::ptrdiff_t>(there), count,
                           to[i]->begin() + static_cast<std::ptrdiff_t>(here));
             });
}

void Film::add(const Film& piece) {
  const auto from = sums_of(piece);
  const auto to = sums_of(*this);
  for (std::size_t i = 0; i < from.size(); ++i)
    each_row(window, piece.window, from[i]->size() / piece.window.size(),
             [&](std::size_t here, std::size_t there, std::size_t count) {
               for (std::size_t k = 0; k < count; ++k) (*to[i])[here + k] += (*from[i])[there + k];
             });
  for (std::size_t band = 0; band < arriving.size(); ++band) arriving[band] += piece.arriving[band];
  for (const auto& [at, light_there] : piece.outside) {
    const std::size_t pixel = at % whole.size(), plane = at / whole.size();
    const int column = whole.left + static_cast<int>(pixel % static_cast<std::size_t>(whole.columns())),
              row = whole.top + static_cast<int>(pixel / static_cast<std::size_t>(whole.columns()));
    if (window.contains(column, row))
      this->at(plane * window.size() + window.index(column, row)) += light_there;
    else
      outside[at] += light_there;
  }
  rays += piece.rays, passed += piece.passed;
}

}  // namespace petzval::render
