// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/sensor/lens_facts.h>

#include <cmath>

namespace petzval {

LensFacts lens_facts(const std::string& name, const FirstOrder& lens) {
  const auto finite = [](double value) { return std::isfinite(value) ? value : 0.0; };
  return {name, finite(lens.efl_mm), finite(lens.working_f_number), finite(lens.exit_pupil.position_mm)};
}

}  // namespace petzval
