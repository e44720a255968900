// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/render/pbrt/parameters.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval::render {

namespace {

bool is_one_of(const std::string& text, std::initializer_list<const char*> list) {
  return std::any_of(list.begin(), list.end(), [&](const char* each) { return text == each; });
}

double finite(const Parameter& parameter, double value) {
  if (!std::isfinite(value))
    throw scene_error(parameter.at, fmt::format("\"{}\" has the value {}; a finite number would be right",
                                                parameter.name, value));
  return value;
}

int whole(const Parameter& parameter, double value) {
  if (finite(parameter, value) != std::floor(value) || std::abs(value) > std::numeric_limits<int>::max())
    throw scene_error(parameter.at, fmt::format("\"{}\" has the value {}; a whole number would be right",
                                                parameter.name, value));
  return static_cast<int>(value);
}

}  // namespace

const Parameter* Parameters::find(const std::string& name, std::initializer_list<const char*> types) const {
  for (const Parameter& parameter : list_) {
    if (parameter.name != name || (types.size() > 0 && !is_one_of(parameter.type, types))) continue;
    parameter.used = true;
    return &parameter;
  }
  return nullptr;
}

const Parameter* Parameters::single(const std::string& name, std::initializer_list<const char*> types) const {
  const Parameter* parameter = find(name);
  if (!parameter) return nullptr;
  if (!is_one_of(parameter->type, types))
    throw scene_error(parameter->at, fmt::format("\"{}\" is given as {}; {} would be right", name,
                                                 parameter->type, fmt::join(types, " or ")));
  if (parameter->size() != 1)
    throw scene_error(parameter->at,
                      fmt::format("\"{}\" has {} values; one would be right", name, parameter->size()));
  return parameter;
}

double Parameters::number(const std::string& name, double otherwise) const {
  const Parameter* parameter = single(name, {"float", "integer"});
  return parameter ? finite(*parameter, parameter->numbers[0]) : otherwise;
}

int Parameters::integer(const std::string& name, int otherwise) const {
  const Parameter* parameter = single(name, {"integer"});
  return parameter ? whole(*parameter, parameter->numbers[0]) : otherwise;
}

bool Parameters::boolean(const std::string& name, bool otherwise) const {
  const Parameter* parameter = single(name, {"bool"});
  return parameter ? parameter->bools[0] != 0 : otherwise;
}

std::string Parameters::string(const std::string& name, const std::string& otherwise) const {
  const Parameter* parameter = single(name, {"string", "texture"});
  return parameter ? parameter->strings[0] : otherwise;
}

std::string Parameters::choice(const std::string& name, const std::string& otherwise,
                               std::initializer_list<const char*> allowed) const {
  const std::string value = string(name, otherwise);
  if (!is_one_of(value, allowed))
    throw scene_error(location_of(name), fmt::format("\"{}\" cannot be \"{}\"; {} would be right", name,
                                                     value, fmt::join(allowed, ", ")));
  return value;
}

std::optional<std::array<double, 3>> Parameters::triple(const std::string& name) const {
  const Parameter* parameter = find(name);
  if (!parameter) return {};
  if (!is_one_of(parameter->type, {"point3", "point", "vector3", "vector", "normal", "normal3"}) ||
      parameter->numbers.size() != 3)
    throw scene_error(parameter->at,
                      fmt::format("\"{}\" has {} values of type {}; three of type point3 or vector3 "
                                  "would be right",
                                  name, parameter->size(), parameter->type));
  return std::array<double, 3>{finite(*parameter, parameter->numbers[0]),
                               finite(*parameter, parameter->numbers[1]),
                               finite(*parameter, parameter->numbers[2])};
}

std::vector<double> Parameters::numbers(const std::string& name,
                                        std::initializer_list<const char*> types) const {
  const Parameter* parameter = find(name);
  if (!parameter) return {};
  if (!is_one_of(parameter->type, types))
    throw scene_error(parameter->at, fmt::format("\"{}\" is given as {}; {} would be right", name,
                                                 parameter->type, fmt::join(types, " or ")));
  for (const double value : parameter->numbers) finite(*parameter, value);
  return parameter->numbers;
}

std::vector<int> Parameters::integers(const std::string& name) const {
  const Parameter* parameter = find(name);
  std::vector<int> result;
  if (!parameter) return result;
  if (parameter->type != "integer")
    throw scene_error(parameter->at,
                      fmt::format("\"{}\" is given as {}; integer would be right", name, parameter->type));
  result.reserve(parameter->numbers.size());
  for (const double value : parameter->numbers) result.push_back(whole(*parameter, value));
  return result;
}

std::vector<const Parameter*> Parameters::unused() const {
  std::vector<const Parameter*> result;
  for (const Parameter& parameter : list_)
    if (!parameter.used) result.push_back(&parameter);
  return result;
}

const Location& Parameters::location_of(const std::string& name) const {
  for (const Parameter& parameter : list_)
    if (parameter.name == name) return parameter.at;
  return at_;
}

}  // namespace petzval::render
