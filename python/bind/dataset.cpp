// SPDX-License-Identifier: BSD-3-Clause
// Data sets; python/petzval/dataset.py has the words around them.
#include <petzval/dataset/dataset.h>

#include "bind.h"
#include "call.h"

namespace petzval::python {

namespace {

nb::dict made(const std::string& recipe_text, const std::string& name, const std::string& recipe_folder,
              const std::string& folder, std::size_t shard, std::size_t shards, int threads,
              const nb::object& progress) {
  const Recipe recipe = parse_recipe(recipe_text, name, recipe_folder);
  Call call({threads, recipe.seed, progress});
  const DatasetReport report = call([&](const Context& context) {
    return make_dataset(recipe, folder, {shard, shards}, context);
  });
  nb::dict result;
  result["parts"] = report.parts, result["kept"] = report.kept, result["elsewhere"] = report.elsewhere;
  result["items"] = report.items, result["failed"] = report.failed, result["bytes"] = report.bytes;
  return result;
}

nb::dict state_of(const std::string& folder) {
  const DatasetState state = dataset_state(folder);
  nb::dict result;
  result["made_by"] = state.made_by, result["recipe"] = state.recipe.text;
  result["items"] = state.recipe.items, result["parts"] = state.recipe.parts();
  result["parts_done"] = state.parts_done, result["items_done"] = state.items,
  result["failed"] = state.failed;
  result["bytes"] = state.bytes, result["errors"] = state.errors;
  return result;
}

std::vector<std::string> faults(const std::string& folder, int threads, const nb::object& progress) {
  Call call({threads, 1, progress});
  return call([&](const Context& context) { return verify_dataset(folder, context); });
}

nb::dict estimated(const std::string& recipe_text, const std::string& name, const std::string& recipe_folder,
                   std::size_t probes, int threads, const nb::object& progress) {
  const Recipe recipe = parse_recipe(recipe_text, name, recipe_folder);
  Call call({threads, recipe.seed, progress});
  const DatasetEstimate estimate =
      call([&](const Context& context) { return estimate_dataset(recipe, probes, context); });
  nb::dict result;
  result["items"] = recipe.items, result["probed"] = estimate.probed, result["failed"] = estimate.failed;
  result["cpu_s_an_item"] = estimate.cpu_s, result["cpu_error_s"] = estimate.cpu_error_s;
  result["bytes_an_item"] = estimate.bytes, result["threads"] = estimate.threads;
  result["memory_bytes"] = estimate.memory_bytes;
  return result;
}

std::size_t parts_of(const std::string& recipe_text, const std::string& name,
                     const std::string& recipe_folder) {
  return parse_recipe(recipe_text, name, recipe_folder).parts();
}

}  // namespace

void bind_dataset(nb::module_& module) {
  module.def("_make_dataset", made, nb::arg("recipe"), nb::arg("name"), nb::arg("recipe_folder"),
             nb::arg("folder"), nb::arg("shard"), nb::arg("shards"), nb::arg("threads"),
             nb::arg("progress").none());
  module.def("_dataset_state", state_of);
  module.def("_verify_dataset", faults, nb::arg("folder"), nb::arg("threads"), nb::arg("progress").none());
  module.def("_estimate_dataset", estimated, nb::arg("recipe"), nb::arg("name"), nb::arg("recipe_folder"),
             nb::arg("probes"), nb::arg("threads"), nb::arg("progress").none());
  module.def("_dataset_parts", parts_of);
}

}  // namespace petzval::python
