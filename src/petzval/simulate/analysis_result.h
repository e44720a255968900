// SPDX-License-Identifier: BSD-3-Clause
// What an analysis hands out.
#pragma once

#include <petzval/simulate/analysis.h>

#include <string>

namespace petzval {

/// A result of one table, to which plots may be added.
AnalysisResult result_of(const Lens& lens, const FieldTableRequest& at, std::string heading, Table table);

}  // namespace petzval
