// SPDX-License-Identifier: BSD-3-Clause
#include "bind.h"

namespace petzval::python {

namespace {

void raise(const nb::object& exception) {
  PyErr_SetObject(exception.type().ptr(), exception.ptr());
}

void raise(const char* name, const Error& error) {
  raise(call_python("petzval._errors", name, error.what()));
}

void translate(const std::exception_ptr& thrown, void*) {
  try {
    std::rethrow_exception(thrown);
  } catch (const InputError& error) {
    const ErrorParts& parts = error.parts();
    raise(call_python("petzval._errors", "_input_error", parts.file, parts.line, parts.column, parts.problem,
                      parts.remedy, parts.parameter));
  } catch (const Cancelled& error) {
    raise("Cancelled", error);
  } catch (const Failure& error) {
    raise("Failure", error);
  } catch (const Error& error) {
    raise("Error", error);
  }
}

}  // namespace

void bind_errors(nb::module_& module) {
  nb::register_exception_translator(translate);
  module.def("_version", &version);
  module.def("set_data_directory", &set_data_directory, nb::arg("path"),
             "Takes bundled lenses, glasses, sensors and scenes from another folder, before any is read.");
  module.def("data_directory", &data_directory, "The folder of the bundled data.");
  module.def("_set_default_data_directory", &set_default_data_directory);
  module.def(
      "bundled_names",
      [](const std::string& kind) { return bundled_names(kind, kind == "scenes" ? ".pbrt" : ".json"); },
      nb::arg("kind"),
      "Names of the bundled \"lenses\", \"lenses/patents\", \"sensors\" or (three-dimensional) \"scenes\".");
}

}  // namespace petzval::python
