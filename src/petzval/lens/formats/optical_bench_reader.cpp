// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/glass/dispersion.h>
#include <petzval/lens/formats/bench_lens.h>
#include <petzval/lens/formats/glass_lookup.h>
#include <petzval/lens/formats/optical_bench.h>
#include <petzval/lens/lens_states.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr std::size_t most_bench_surfaces = 1000;
constexpr int most_odd_powers = 20;
/// A catalogue's glass stands for that of a row if it has its nd and Vd: patents give five digits and four.
constexpr double same_nd = 1e-4, same_vd = 0.15;

using Cells = std::vector<std::string>;

Cells cells_of(const TextLine& line) {
  if (line.text.find('\t') == line.text.npos) return line.words;
  Cells cells = split_at(line.text, '\t');
  for (std::string& cell : cells) cell = trimmed(cell);
  return cells;
}

/// A value that nobody knows is left empty, or is the word for it.
bool is_blank(const std::string& cell) {
  return cell.empty() || cell == "undefined";
}

struct NamedRow {
  int line;
  Cells values;
};

class BenchReader {
 public:
  BenchReader(std::string file, const LensReadOptions& options)
      : file_(std::move(file)), glasses_(options, file_, made_.notes), options_(options) {}

  LensFile read(const std::string& text) {
    for (const TextLine& line : text_lines(text)) {
      line_ = line.number;
      const std::string all = trimmed(line.text);
      if (all.empty() || all[0] == '#') continue;
      if (all[0] == '[')
        section_ = all.substr(0, all.find(']') + 1);
      else
        take(cells_of(line));
    }
    return finished();
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InputError(file_, line_, what); }

  double number(const std::string& cell, const char* what) const {
    const std::optional<double> value = parse_number(cell);
    if (!value) fail(fmt::format("'{}' is no {}", quotable(cell), what));
    return *value;
  }

  void take(const Cells& cells) {
    if (section_ == "[descriptive data]" && cells[0] == "title" && cells.size() > 1) {
      made_.lens.name = cells[1];
    } else if (section_ == "[constants]") {
      if (cells[0] == "AsphericalA2") first_power_ = 2;
      if (cells[0] == "AsphericalOddCount") take_odd_powers(cells);
    } else if (section_ == "[variable distances]") {
      variables_[cells[0]] = {line_, {cells.begin() + 1, cells.end()}};
    } else if (section_ == "[lens data]") {
      take_surface(cells);
    } else if (section_ == "[aspherical data]") {
      take_asphere(cells);
    } else if (section_ == "[patent info]" && cells.size() > 1) {
      if (cells[0] == "number") patent_ = cells[1];
    }
  }

  void take_odd_powers(const Cells& cells) {
    const std::optional<int> count = cells.size() > 1 ? parse_integer(cells[1]) : 1;
    if (!count || *count < 1 || *count > most_odd_powers)
      fail(fmt::format("AsphericalOddCount is the number of odd powers, 1 to {}", most_odd_powers));
    first_power_ = 3, odd_powers_ = *count;
  }

  /// At a setting, counted from 0.
  std::optional<double> variable(const std::string& name, std::size_t setting) {
    const auto found = variables_.find(name);
    if (found == variables_.end()) return {};
    const auto& [line, values] = found->second;
    if (setting >= values.size() || is_blank(values[setting])) return {};
    if (values[setting] == "Infinity") return std::numeric_limits<double>::infinity();
    line_ = line;
    return number(values[setting], "number");
  }
  /// The same; where a later setting does not say it, as at the first.
  std::optional<double> usual(const std::string& name, std::size_t setting) {
    const std::optional<double> own = variable(name, setting);
    return own ? own : variable(name, 0);
  }

  void take_surface(const Cells& cells) {
    if (cells.size() < 3)
      fail(
          "has too few columns; a row of [lens data] has name, radius, thickness, index, diameter, Abbe "
          "number");
    if (made_.lens.surfaces.size() >= most_bench_surfaces)
      fail(fmt::format("is surface {}; a lens has {} at most", most_bench_surfaces + 1, most_bench_surfaces));
    const auto cell = [&](std::size_t i) { return i < cells.size() ? cells[i] : std::string(); };
    Surface surface;
    surface.stop = cells[1] == "AS";
    const bool flat = surface.stop || cells[1] == "FS" || cells[1] == "CG" || cells[1].ends_with("Infinity");
    if (!flat) {
      if (const double radius = number(cells[1], "radius in mm, Infinity, AS (stop), FS or CG"); radius != 0)
        surface.curvature_per_mm = curvature_from_radius(cells[1]);
    }
    if (!is_blank(cell(4)))
      if (const double diameter = number(cell(4), "diameter in mm"); diameter > 0)
        surface.semi_diameter_mm = diameter / 2;
    surface.material = material(cell(3), cell(5), cell(6));
    names_.push_back(cells[0]), gaps_.push_back({line_, {cells[2]}});
    made_.lens.surfaces.push_back(std::move(surface));
  }

  Material material(const std::string& nd_cell, const std::string& vd_cell, const std::string& glass) {
    if (is_blank(nd_cell)) return {};
    const double nd = number(nd_cell, "refractive index");
    const double vd = is_blank(vd_cell) ? 0 : number(vd_cell, "Abbe number");
    if (!glass.empty()) {
      if (glasses_.is_substituted(glass)) return glasses_.find(glass);
      if (const std::optional<Material> named = catalogue_glass(glass, nd, vd)) return *named;
    }
    try {
      return bench_material(nd, vd, names_.size(), no_dispersion_);
    } catch (const InputError& error) {
      fail(error.what());
    }
  }

  std::optional<Material> catalogue_glass(const std::string& name, double nd, double vd) {
    try {
      const Material found = GlassLookup(LensReadOptions{{}, {}, options_.glasses}).find(name);
      const double d = found.index(spectral_line::d_nm);
      const double abbe = (d - 1) / (found.index(spectral_line::f_nm) - found.index(spectral_line::c_nm));
      if (std::abs(d - nd) <= same_nd && std::abs(abbe - vd) <= same_vd) return found;
    } catch (const InputError&) {
      // The row says nd and Vd.
    }
    return {};
  }

  void take_asphere(const Cells& cells) {
    const auto found = std::ranges::find(names_, cells[0]);
    if (found == names_.end())
      fail(fmt::format("[lens data] has no surface '{}' that these coefficients could belong to",
                       quotable(cells[0])));
    Surface& surface = made_.lens.surfaces[static_cast<std::size_t>(found - names_.begin())];
    if (cells.size() > 2 && !is_blank(cells[2])) surface.conic = number(cells[2], "conic constant");
    int power = first_power_;
    for (std::size_t i = 3; i < cells.size(); ++i, power = next_power(power)) {
      if (is_blank(cells[i])) continue;
      if (const double value = number(cells[i], "coefficient"); value != 0) surface.asphere[power] = value;
    }
  }

  /// 4, 6, 8 …; with n odd powers 3, 4, 5 … to the n-th of them, then even ones alone.
  int next_power(int power) const {
    return power % 2 == 1 || power + 1 <= 1 + 2 * odd_powers_ ? power + 1 : power + 2;
  }

  /// Nothing where a setting lacks a gap that others give.
  std::optional<double> gap(std::size_t surface, std::size_t setting) {
    const std::string& text = gaps_[surface].values[0];
    if (const std::optional<double> number = parse_number(text)) return number;
    return is_blank(text) ? std::nullopt : variable(text, setting);
  }

  void close_gaps(Lens& lens, std::size_t setting, bool& unfocused) {
    for (std::size_t i = 0; i < gaps_.size(); ++i) {
      const std::optional<double> distance = gap(i, setting);
      line_ = gaps_[i].line;
      if (!distance && i + 1 < gaps_.size())
        fail(fmt::format("the thickness '{}' is neither a number nor given in [variable distances]",
                         quotable(gaps_[i].values[0])));
      if (distance && !std::isfinite(*distance)) fail("the thickness is infinite");
      if (distance)
        lens.surfaces[i].thickness_mm = *distance;
      else
        unfocused = true;
    }
  }

  LensFile at(std::size_t setting) {
    LensFile file{made_.lens, {}};
    Lens& lens = file.lens;
    BenchFacts facts;
    close_gaps(lens, setting, facts.unfocused);
    if (const std::optional<double> object = variable("d0", setting); object && std::isfinite(*object))
      lens.object_distance_mm = *object;
    if (const std::optional<double> wide = usual("Aperture Diameter", setting); wide && *wide > 0)
      lens.surfaces[lens.stop_index()].semi_diameter_mm = *wide / 2;
    facts.f_number = usual("F-Number", setting);
    facts.full_angle_deg = usual("Angle of View", setting);
    facts.image_circle_mm = usual("Image Height", setting);
    complete_bench_lens(file, facts, setting == 0 ? no_dispersion_ : std::vector<std::size_t>{}, file_);
    return file;
  }

  /// Settings that give all of their gaps; where there is but one, no back focus is needed.
  std::vector<std::size_t> settings() {
    std::size_t columns = 1;
    for (const auto& [name, row] : variables_) columns = std::max(columns, row.values.size());
    std::vector<std::size_t> whole{0};
    const bool focused = gap(gaps_.size() - 1, 0).has_value();
    for (std::size_t setting = 1; focused && setting < columns; ++setting) {
      bool all = variable("d0", setting) || variable("Focal Length", setting);
      for (std::size_t i = 0; all && i < gaps_.size(); ++i) all = gap(i, setting).has_value();
      if (all) whole.push_back(setting);
    }
    return whole;
  }

  LensFile finished() {
    if (made_.lens.surfaces.empty())
      throw InputError(file_, "[lens data] is empty; it should have a row a surface");
    if (std::ranges::none_of(made_.lens.surfaces, &Surface::stop))
      throw InputError(file_,
                       "has no stop; a row of [lens data] with AS in place of a radius would be right");
    if (!patent_.empty()) made_.lens.source = fmt::format("{} (Optical Bench)", patent_);
    std::vector<std::string> names;
    std::vector<Lens> lenses;
    for (const std::size_t setting : settings()) {
      LensFile file = at(setting);
      if (setting == 0) made_.notes.insert(made_.notes.end(), file.notes.begin(), file.notes.end());
      names.push_back(fmt::format("setting-{}", setting + 1));
      lenses.push_back(std::move(file.lens));
    }
    try {
      made_.lens = lenses.size() == 1 ? lenses[0] : joined_states(std::move(names), lenses);
      glasses_.require_all_used();
    } catch (const InputError& error) {
      throw InputError(file_, error.what());
    }
    return std::move(made_);
  }

  std::string file_;
  LensFile made_ = {Lens(), {}};
  GlassLookup glasses_;
  const LensReadOptions& options_;
  std::string section_, patent_;
  int line_ = 0, first_power_ = 4, odd_powers_ = 0;
  std::map<std::string, NamedRow> variables_;
  std::vector<std::string> names_;
  std::vector<NamedRow> gaps_;
  std::vector<std::size_t> no_dispersion_;
};

}  // namespace

bool is_optical_bench(const std::string& text) {
  return text.find("[lens data]") != text.npos;
}

LensFile read_optical_bench(const std::string& text, const std::string& file,
                            const LensReadOptions& options) {
  BenchReader reader(file, options);
  return reader.read(text);
}

}  // namespace petzval
