// SPDX-License-Identifier: BSD-3-Clause
// The extension module petzval._petzval.
#include "bind.h"

NB_MODULE(_petzval, module) {
  using namespace petzval::python;
  module.doc() = "Petzval's library, bound to Python; `import petzval` has all of it.";
  bind_errors(module);
  bind_glass(module);
  bind_lens(module);
  bind_sensor(module);
  bind_scene(module);
  bind_light(module);
  bind_flare(module);
  bind_camera(module);
  bind_analysis(module);
  bind_design(module);
  bind_raw(module);
  bind_target(module);
  bind_edges(module);
  bind_measure(module);
  bind_dataset(module);
}
