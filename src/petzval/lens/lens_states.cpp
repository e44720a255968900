// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/lens/formats/native.h>
#include <petzval/lens/formats/native_setting.h>
#include <petzval/lens/lens_states.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace petzval {

namespace {

using nlohmann::json;

/// Entries of the native form that may differ from state to state.
const std::set<std::string> state_entries{"surfaces", "aperture", "object_distance_mm",
                                          "fields",   "groups",   "sensor_pose"};

json state_value(const StateRow& row, std::size_t state) {
  json value = json::parse(row.values[state], nullptr, false);
  if (value.is_discarded())
    throw InputError(fmt::format("{}: \"{}\" is no JSON value", row.path, quotable(row.values[state])));
  return value;
}

/// How a number is counted between two states: some are in proportion as what they are the reciprocal of.
struct StateScale {
  bool reciprocal = false;  ///< null is then infinity

  explicit StateScale(const std::string& path)
      : reciprocal(path.ends_with("radius_mm") || path == "object_distance_mm") {}
  bool holds(const json& value) const {
    return value.is_number() ? !reciprocal || value.get<double>() != 0 : reciprocal && value.is_null();
  }
  json between(const json& a, const json& b, double share) const {
    const auto number = [&](const json& value) {
      if (value.is_null()) return 0.0;
      return reciprocal ? 1 / value.get<double>() : value.get<double>();
    };
    const double value = number(a) + share * (number(b) - number(a));
    if (!reciprocal) return value;
    return value == 0 ? json(nullptr) : json(1 / value);
  }
};

/// Of two neighbours. \throws InputError for what can stand in one of them only.
json between_states(const LensStates& states, const StateRow& row, std::size_t below, double share) {
  const json a = state_value(row, below);
  if (share == 0) return a;
  const json b = state_value(row, below + 1);
  if (a == b) return a;
  const StateScale scale(row.path);
  if (scale.holds(a) && scale.holds(b)) return scale.between(a, b, share);
  const auto all_numbers = [](const json& list) {
    return list.is_array() &&
           std::all_of(list.begin(), list.end(), [](const json& item) { return item.is_number(); });
  };
  if (all_numbers(a) && all_numbers(b) && a.size() == b.size()) {
    json list = json::array();
    for (std::size_t i = 0; i < a.size(); ++i) list.push_back(scale.between(a[i], b[i], share));
    return list;
  }
  throw InputError(
      fmt::format("{} is {} in state \"{}\" and {} in \"{}\"; only numbers can stand between, one of the two "
                  "would be right",
                  row.path, a.dump(), states.names[below], b.dump(), states.names[below + 1]));
}

/// The catalogue that a lens is read with, and the glasses that it has already.
GlassCatalogue glasses_of(const Lens& lens, const LensReadOptions& options) {
  const GlassCatalogue& known = options.glasses ? *options.glasses : GlassCatalogue::bundled();
  std::vector<Glass> own;
  for (const Surface& surface : lens.surfaces)
    if (const auto* glass = std::get_if<std::shared_ptr<const Glass>>(&surface.material.kind()))
      if (!known.contains((*glass)->full_name())) own.push_back(**glass);
  return own.empty() ? known : known.with(std::move(own));
}

std::vector<JsonStep> steps_of(const StateRow& row) {
  const std::vector<JsonStep> steps = parse_json_setting(row.path + "=0", "surfaces[4].thickness_mm").steps;
  if (!state_entries.contains(steps.front().key))
    throw InputError(fmt::format("{}: cannot differ from state to state; {} can", row.path,
                                 fmt::join(state_entries, ", ")));
  return steps;
}

double state_number(const Lens& lens, const std::string& state) {
  const LensStates& states = lens.states;
  if (states.empty())
    throw InputError(fmt::format("state {}: {} has no states; a lens of several zoom or focus positions has",
                                 quotable(state), lens.name));
  const auto named = std::find(states.names.begin(), states.names.end(), state);
  if (named != states.names.end()) return static_cast<double>(named - states.names.begin());
  const auto number = parse_number(state);
  if (number && *number >= 0 && *number <= static_cast<double>(states.size() - 1)) return *number;
  throw InputError(fmt::format("state {}: {} has no such state; {}, or 0 to {}, would be right",
                               quotable(state), lens.name, fmt::join(states.names, ", "), states.size() - 1));
}

/// Finds where the forms of a lens in its states differ.
class StateDifferences {
 public:
  std::vector<StateRow> rows;

  void compare(const std::string& path, const std::vector<json>& values) {
    if (std::all_of(values.begin(), values.end(), [&](const json& each) { return each == values[0]; }))
      return;
    if (same_keys(values)) {
      for (const auto& [key, value] : values[0].items()) {
        std::vector<json> below;
        for (const json& each : values) below.push_back(each[key]);
        compare(member_path(path, key), below);
      }
      return;
    }
    if (values[0].is_array() && (path == "surfaces" || path == "groups")) return compare_items(path, values);
    StateRow row{path, {}};
    for (const json& each : values) row.values.push_back(each.dump());
    rows.push_back(std::move(row));
  }

 private:
  static bool same_keys(const std::vector<json>& values) {
    return std::all_of(values.begin(), values.end(), [&](const json& each) {
      if (!each.is_object() || each.size() != values[0].size()) return false;
      for (const auto& entry : values[0].items())
        if (!each.contains(entry.key())) return false;
      return true;
    });
  }
  /// Entries that one of them lacks are null there.
  void compare_items(const std::string& path, const std::vector<json>& values) {
    for (const json& each : values)
      if (each.size() != values[0].size())
        throw InputError(fmt::format("the states differ in their number of {}", path));
    for (std::size_t i = 0; i < values[0].size(); ++i) {
      std::set<std::string> keys;
      for (const json& each : values)
        for (const auto& entry : each[i].items()) keys.insert(entry.key());
      for (const std::string& key : keys) {
        std::vector<json> below;
        for (const json& each : values) below.push_back(each[i].value(key, json()));
        compare(member_path(item_path(path, i), key), below);
      }
    }
  }
};

}  // namespace

Lens in_state(const Lens& lens, double number, const LensReadOptions& options) {
  const LensStates& states = lens.states;
  if (!(number >= 0 && number <= static_cast<double>(states.size()) - 1))
    throw InputError(fmt::format("state {:g}: {} has {} states", number, lens.name, states.size()));
  const auto below = static_cast<std::size_t>(number);
  const double share = number - static_cast<double>(below);
  const std::string origin =
      share == 0 ? fmt::format("state \"{}\"", states.names[below]) : fmt::format("state {:g}", number);
  Lens single = lens;
  single.states = {};
  JsonDocument document(lens_to_json(single), lens.name);
  try {
    for (const StateRow& row : states.rows) {
      const json value = between_states(states, row, below, share);
      document.replace(altered_native(document.root(), steps_of(row), value), row.path, origin);
    }
  } catch (const InputError& error) {
    throw InputError(origin, error.what());
  }
  LensReadOptions reading;
  reading.glasses = glasses_of(lens, options);
  Lens set = read_native(document, reading);
  set.states = states;
  return set;
}

Lens in_state(const Lens& lens, const std::string& state, const LensReadOptions& options) {
  return in_state(lens, state_number(lens, state), options);
}

std::optional<std::size_t> present_state(const Lens& lens) {
  Lens single = lens;
  single.states = {};
  const json root = json::parse(lens_to_json(single));
  for (std::size_t i = 0; i < lens.states.size(); ++i) {
    json set = root;
    for (const StateRow& row : lens.states.rows)
      set = altered_native(std::move(set), steps_of(row), state_value(row, i));
    if (set == root) return i;
  }
  return {};
}

Lens joined_states(std::vector<std::string> names, const std::vector<Lens>& lenses) {
  if (lenses.empty() || names.size() != lenses.size())
    throw InputError(fmt::format("{} names for {} states of a lens", names.size(), lenses.size()));
  std::vector<json> forms;
  for (Lens single : lenses) {
    single.states = {};
    json form = json::parse(lens_to_json(single));
    for (const char* key : {"name", "source", "wavelengths_nm", "reference_wavelength_nm", "tolerances"})
      form.erase(key);
    if (!form.contains("groups")) form["groups"] = json::array();
    if (!form.contains("sensor_pose")) form["sensor_pose"] = nullptr;
    forms.push_back(std::move(form));
  }
  StateDifferences differences;
  differences.compare("", forms);
  Lens lens = lenses.front();
  // In the order in which a file gives them back.
  std::ranges::sort(differences.rows, {}, &StateRow::path);
  lens.states = {std::move(names), std::move(differences.rows)};
  lens.validate();
  return lens;
}

LensStates states_beside(const Lens& lens, std::vector<std::string> names, std::vector<Lens> lenses) {
  const std::size_t count = lenses.size();
  if (names.size() != count)
    throw InputError(fmt::format("{} names for {} states of a lens", names.size(), count));
  // The lens itself as one more, which is taken away again: what is the same in all states may differ from
  // it.
  constexpr const char* itself = "as written";
  if (count >= LensStates::most)
    throw InputError(fmt::format("{} states; fewer than {} are right", count, LensStates::most));
  names.emplace_back(itself);
  lenses.push_back(lens);
  LensStates states = joined_states(std::move(names), lenses).states;
  states.names.pop_back();
  for (StateRow& row : states.rows) row.values.pop_back();
  return states;
}

Lens in_every_state(const Lens& lens, const std::function<Lens(const Lens&)>& alter) {
  Lens single = lens;
  single.states = {};
  Lens altered = alter(single);
  if (lens.states.empty()) return altered;
  std::vector<Lens> lenses;
  for (std::size_t i = 0; i < lens.states.size(); ++i) {
    Lens state = in_state(lens, static_cast<double>(i));
    state.states = {};
    lenses.push_back(alter(state));
  }
  altered.states = states_beside(altered, lens.states.names, std::move(lenses));
  return altered;
}

}  // namespace petzval
