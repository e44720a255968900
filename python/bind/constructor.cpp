// SPDX-License-Identifier: BSD-3-Clause
#include "constructor.h"

#include "bind.h"

namespace petzval::python {

namespace {

/// The positional arguments of a call, with its class in front or without.
nb::object tuple_of_arguments(nb::handle first, PyObject* const* arguments, std::size_t count) {
  nb::list all;
  if (first.is_valid()) all.append(first);
  for (std::size_t i = 0; i < count; ++i) all.append(nb::handle(arguments[i]));
  return nb::tuple(all);
}

/// What stands in the place of the exception that is set, which it is unless it tells of a misfit.
void explain(nb::handle type, const nb::object& arguments, const nb::dict& keywords) {
  PyObject *kind = nullptr, *value = nullptr, *trace = nullptr;
  PyErr_Fetch(&kind, &value, &trace);
  PyErr_NormalizeException(&kind, &value, &trace);
  const nb::object error = nb::borrow(value);
  const nb::object better =
      call_python("petzval._keywords", "of_constructor", nb::borrow(type), arguments, keywords, error);
  if (better.is(error)) return PyErr_Restore(kind, value, trace);
  Py_XDECREF(kind), Py_XDECREF(value), Py_XDECREF(trace);
  PyErr_SetObject(better.type().ptr(), better.ptr());
}

/// As nanobind calls a class: __new__ with the class in front.
PyObject* construct(PyObject* type, PyObject* const* arguments, std::size_t count_and_flag,
                    PyObject* names) noexcept {
  constexpr std::size_t flag = std::size_t(1) << (8 * sizeof(std::size_t) - 1);
  const std::size_t count = count_and_flag & ~flag;
  try {
    nb::dict keywords;
    if (names)
      for (std::size_t i = 0; i < nb::len(nb::handle(names)); ++i)
        keywords[nb::handle(names)[i]] = nb::handle(arguments[count + i]);
    const nb::object make = nb::handle(type).attr("__new__");
    PyObject* made =
        PyObject_Call(make.ptr(), tuple_of_arguments(type, arguments, count).ptr(), keywords.ptr());
    if (!made && PyErr_ExceptionMatches(PyExc_TypeError))
      explain(type, tuple_of_arguments({}, arguments, count), keywords);
    return made;
  } catch (nb::python_error& error) {
    error.restore();
  } catch (const std::exception& error) {
    PyErr_SetString(PyExc_RuntimeError, error.what());
  }
  return nullptr;
}

constexpr int tp_vectorcall = 82;  // Py_tp_vectorcall, which Python 3.14 names

}  // namespace

const PyType_Slot explained_constructor[] = {{tp_vectorcall, reinterpret_cast<void*>(construct)},
                                             {0, nullptr}};

}  // namespace petzval::python
