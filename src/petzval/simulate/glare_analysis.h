// SPDX-License-Identifier: BSD-3-Clause
// The analysis of veiling glare.
#pragma once

#include <petzval/simulate/analysis.h>

namespace petzval {

/// Veiling glare by scatter and ghosts, and the glare spread function, by field.
AnalysisResult glare_analysis(const Lens& lens, const AnalysisRequest& request, const Context& context);

}  // namespace petzval
