// SPDX-License-Identifier: BSD-3-Clause
// What the files of the binding share. Nothing here or beside it computes: functions of the library are given
// what Python's arguments say, and their results are shown as Python's.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/function.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>
#include <petzval/petzval.h>

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace nb = nanobind;

namespace petzval::python {

using Numbers = std::vector<double>;
/// What may be None.
template <typename T>
using Maybe = std::optional<T>;
template <typename T>
using Array = nb::ndarray<nb::numpy, T>;
/// What functions take for bands of floats: NumPy, or anything with DLPack or the buffer protocol, in
/// whatever order of memory.
using FloatsIn = nb::ndarray<const float, nb::device::cpu>;

/// A view (row, column, band) of bands that lie one after the other.
inline Array<float> bands_view(float* data, int rows, int columns, int bands, nb::handle owner) {
  const std::size_t shape[] = {static_cast<std::size_t>(rows), static_cast<std::size_t>(columns),
                               static_cast<std::size_t>(bands)};
  const std::int64_t strides[] = {columns, 1, static_cast<std::int64_t>(rows) * columns};
  return Array<float>(data, 3, shape, owner, strides);
}

/// The bands of an array (row, column, band), one after the other.
/// \throws InputError, naming the parameter, unless there are as many as wavelengths.
std::vector<float> bands_of(const char* parameter, const FloatsIn& values, const Numbers& wavelengths_nm);

void bind_errors(nb::module_& module);
void bind_glass(nb::module_& module);
void bind_lens(nb::module_& module);
void bind_sensor(nb::module_& module);
void bind_scene(nb::module_& module);
void bind_light(nb::module_& module);
void bind_camera(nb::module_& module);
void bind_flare(nb::module_& module);
void bind_analysis(nb::module_& module);
void bind_design(nb::module_& module);
void bind_dataset(nb::module_& module);
void bind_raw(nb::module_& module);
void bind_target(nb::module_& module);
void bind_edges(nb::module_& module);
void bind_measure(nb::module_& module);

/// A numpy array of these values, which it takes over.
template <typename T>
struct OwnArray {
  Array<T> array;
};
template <typename T>
OwnArray<T> array_of(std::vector<T> values, std::initializer_list<std::size_t> shape) {
  auto* kept = new std::vector<T>(std::move(values));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return {Array<T>(kept->data(), shape.size(), shape.begin(), owner)};
}
inline OwnArray<double> array_of(std::vector<double> values) {
  const std::size_t count = values.size();
  return array_of(std::move(values), {count});
}

/// A tuple: unlike a list it cannot be altered to no effect.
inline nb::tuple tuple_of(const Numbers& values) {
  return nb::tuple(nb::cast(values));
}

/// A dict of what a mapping holds.
inline nb::dict dict_of(const nb::object& mapping) {
  return nb::cast<nb::dict>(nb::borrow(reinterpret_cast<PyObject*>(&PyDict_Type))(mapping));
}

/// The entry of a table of words. \throws InputError that names the parameter and the words there are.
template <typename T>
T choice(const char* parameter, std::string_view word,
         std::initializer_list<std::pair<std::string_view, T>> entries) {
  std::string words;
  for (const auto& [name, value] : entries) {
    if (name == word) return value;
    if (!words.empty()) words += &name == &std::prev(entries.end())->first ? " or " : ", ";
    words += name;
  }
  throw InputError("`" + std::string(parameter) + "` " + std::string(word) + "; " + words +
                   " would be right");
}
template <typename T>
std::string_view word_of(T value, std::initializer_list<std::pair<std::string_view, T>> entries) {
  for (const auto& [name, entry] : entries)
    if (entry == value) return name;
  return {};
}

/// A number as Python writes it.
inline std::string number_repr(double value) {
  return nb::cast<std::string>(nb::repr(nb::float_(value)));
}

/// Calls a function of a module of the package, which is imported when it is first needed.
template <typename... Arguments>
nb::object call_python(const char* module, const char* function, Arguments&&... arguments) {
  return nb::module_::import_(module).attr(function)(std::forward<Arguments>(arguments)...);
}

}  // namespace petzval::python

/// As an ndarray, but a property may give one, too, which would else want it to belong to its object.
template <typename T>
struct nanobind::detail::type_caster<petzval::python::OwnArray<T>> {
  using Caster = type_caster<petzval::python::Array<T>>;
  static constexpr auto Name = Caster::Name;
  static handle from_cpp(const petzval::python::OwnArray<T>& own, rv_policy, cleanup_list* cleanup) {
    return Caster::from_cpp(own.array, rv_policy::automatic, cleanup);
  }
};
