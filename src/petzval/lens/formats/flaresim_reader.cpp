// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/lens/formats/bench_lens.h>
#include <petzval/lens/formats/flaresim.h>

#include <algorithm>
#include <array>

namespace petzval {

namespace {

constexpr std::size_t most_listed = 1000;
constexpr const char* row_form = "radius, thickness, index, Abbe number, semi-aperture, coating";

/// What a .lens file holds, before it is a lens.
struct FlareTable {
  LensFile made;
  std::vector<std::size_t> no_dispersion;
  bool diameters = false;  ///< where semi-apertures should stand
};

[[noreturn]] void fail(const std::string& file, const TextLine& line, const std::string& what) {
  throw InputError(file, line.number, what);
}

Surface surface_of(const TextLine& line, const std::string& file, FlareTable& table) {
  if (line.words.size() < 5)
    fail(file, line, fmt::format("a surface has {}, not {} numbers", row_form, line.words.size()));
  std::array<double, 5> numbers{};
  Surface surface;
  const std::string& radius = line.words[0];
  surface.stop = radius == "stop" || radius == "STOP";
  const bool flat = surface.stop || radius == "inf" || radius == "INF";
  for (std::size_t i = flat ? 1 : 0; i < numbers.size(); ++i) {
    const std::optional<double> number = parse_number(line.words[i]);
    if (!number) fail(file, line, fmt::format("'{}' is no number", quotable(line.words[i])));
    numbers[i] = *number;
  }
  const auto [curved, thickness, nd, vd, aperture] = numbers;
  if (!flat && curved != 0) surface.curvature_per_mm = curvature_from_radius(radius);
  surface.thickness_mm = thickness;
  if (!(nd >= 1)) fail(file, line, fmt::format("the index {} is below 1, that of air", nd));
  surface.material = bench_material(nd, vd, table.made.lens.surfaces.size(), table.no_dispersion);
  if (!(aperture > 0)) fail(file, line, fmt::format("the semi-aperture {} must be positive", aperture));
  surface.semi_diameter_mm = table.diameters ? aperture / 2 : aperture;
  return surface;
}

void take_heading(const std::string& text, FlareTable& table) {
  if (text.starts_with("name:")) table.made.lens.name = trimmed(text.substr(5));
  if (text.starts_with("# Patent:")) table.made.lens.source = trimmed(text.substr(9));
  if (text.find("Converted from photonstophotos.net") != text.npos) table.diameters = true;
}

FlareTable read_table(const std::string& text, const std::string& file) {
  FlareTable table;
  bool surfaces = false;
  for (const TextLine& line : text_lines(text)) {
    const std::string all = trimmed(line.text);
    if (!surfaces) take_heading(all, table);
    if (all.empty() || all[0] == '#') continue;
    if (!surfaces) {
      surfaces = all.starts_with("surfaces:");
      continue;
    }
    if (table.made.lens.surfaces.size() >= most_listed)
      fail(file, line, fmt::format("is surface {}; a lens has {} at most", most_listed + 1, most_listed));
    table.made.lens.surfaces.push_back(surface_of(line, file, table));
  }
  return table;
}

}  // namespace

LensFile read_flaresim(const std::string& text, const std::string& file) {
  FlareTable table = read_table(text, file);
  Lens& lens = table.made.lens;
  if (lens.surfaces.empty())
    throw InputError(file,
                     fmt::format("has no surfaces; rows of {} below \"surfaces:\" would be right", row_form));
  if (std::ranges::none_of(lens.surfaces, &Surface::stop))
    throw InputError(file, "has no stop; a surface with \"stop\" in place of a radius would be right");
  if (table.diameters)
    table.made.notes.push_back(
        fmt::format("{}: was converted from the Optical Bench, with diameters in place of semi-apertures and "
                    "without aspheres",
                    file));
  complete_bench_lens(table.made, {}, table.no_dispersion, file);
  return std::move(table.made);
}

}  // namespace petzval
