// SPDX-License-Identifier: BSD-3-Clause
// What an optimiser did to a lens, as tables and a plot.
#pragma once

#include <petzval/optimise/optimise.h>
#include <petzval/report/svg_plot.h>
#include <petzval/report/table.h>

#include <string>
#include <vector>

namespace petzval {

/// "um" of spots, "nm" of wavefronts.
const char* unit_of(OptimiseMerit merit);
/// "RMS spot", "RMS wavefront".
const char* name_of(OptimiseMerit merit);

/// The merit of every field, then of all, before and after.
Table optimised_fields(const OptimiseResult& result, const FieldTableRequest& at, OptimiseMerit merit);
/// Every variable before and after.
Table optimised_numbers(const OptimiseResult& result);
/// Every glass that another has replaced.
Table optimised_glasses(const OptimiseResult& result);
/// The merit over the rounds.
Plot optimise_plot(const std::string& lens, const OptimiseResult& result, OptimiseMerit merit);

}  // namespace petzval
