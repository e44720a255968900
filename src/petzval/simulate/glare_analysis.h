// SPDX-License-Identifier: BSD-3-Clause
// What an analysis hands out, and the one of veiling glare.
#pragma once

#include <petzval/simulate/analysis.h>

#include <string>

namespace petzval {

/// A result of one table, to which plots may be added.
AnalysisResult result_of(const Lens& lens, const FieldTableRequest& at, std::string heading, Table table);

/// Veiling glare by scatter and ghosts, and the glare spread function, by field.
AnalysisResult glare_analysis(const Lens& lens, const AnalysisRequest& request, const Context& context);

}  // namespace petzval
