// SPDX-License-Identifier: BSD-3-Clause
// What a tolerance report says, as tables and as a plot.
#pragma once

#include <petzval/report/svg_plot.h>
#include <petzval/report/table.h>
#include <petzval/tolerance/tolerancing.h>

#include <optional>
#include <string>

namespace petzval {

/// Tolerances, those that do most harm first, and what each does at its limit.
Table sensitivity_table(const ToleranceReport& report, const Merit& merit);
/// Point by point: the design, and what so many per cent of the builds keep.
Table build_table(const ToleranceReport& report, const Merit& merit);
/// Every build with its merits and errors, for other programs.
Table all_builds(const ToleranceReport& report, const Merit& merit);
/// The share of builds that are at least as good, over the merit: overall, and at the worst point. `lens` is
/// its name.
Plot yield_plot(const std::string& lens, const ToleranceReport& report, const Merit& merit,
                const std::optional<double>& accept);

}  // namespace petzval
