// SPDX-License-Identifier: BSD-3-Clause
// The parameters of a pbrt directive: "float fov" 45 and the like.
#pragma once

#include <petzval/render/pbrt/location.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace petzval::render {

/// One parameter as the file has it.
struct Parameter {
  std::string type, name;  ///< "float", "fov"
  Location at;
  std::vector<double> numbers;
  std::vector<std::string> strings;
  std::vector<std::uint8_t> bools;
  mutable bool used = false;

  std::size_t size() const { return numbers.size() + strings.size() + bools.size(); }
};

/// The parameters of one directive. Asking for one marks it as used, so that what nobody asked for can be
/// told.
class Parameters {
 public:
  Parameters() = default;
  explicit Parameters(Location at) : at_(std::move(at)) {}

  void add(Parameter parameter) { list_.push_back(std::move(parameter)); }
  const Location& location() const { return at_; }
  const std::vector<Parameter>& list() const { return list_; }

  /// The parameter of this name if it has one of these types (any, if none are given).
  const Parameter* find(const std::string& name, std::initializer_list<const char*> types = {}) const;

  /// One value, or the default. \throws InputError with file, line and column if the parameter has another
  /// type or not exactly one value, or the number is not finite.
  double number(const std::string& name, double otherwise) const;
  int integer(const std::string& name, int otherwise) const;
  bool boolean(const std::string& name, bool otherwise) const;
  std::string string(const std::string& name, const std::string& otherwise) const;
  /// As string(), and \throws InputError unless it is one of `allowed`.
  std::string choice(const std::string& name, const std::string& otherwise,
                     std::initializer_list<const char*> allowed) const;
  std::optional<std::array<double, 3>> triple(const std::string& name) const;
  /// All values; empty if there is no such parameter. \throws InputError for another type or a number that is
  /// not finite.
  std::vector<double> numbers(const std::string& name, std::initializer_list<const char*> types) const;
  std::vector<int> integers(const std::string& name) const;

  /// Those that nobody asked for.
  std::vector<const Parameter*> unused() const;
  /// Where a parameter stands, or the directive if there is no such parameter.
  const Location& location_of(const std::string& name) const;

 private:
  const Parameter* single(const std::string& name, std::initializer_list<const char*> types) const;

  Location at_;
  std::vector<Parameter> list_;
};

}  // namespace petzval::render
