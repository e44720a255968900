// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/report/tolerance_tables.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
/// So many per cent of the builds are at least as good as the numbers of their columns.
constexpr int shares_percent[] = {10, 50, 80, 90, 98};

int decimals_of(const Merit& merit) {
  return merit.kind == Merit::Kind::mtf ? 4 : 3;
}

/// From the best to the worst.
std::vector<double> ordered(std::vector<double> values, const Merit& merit) {
  std::ranges::sort(values);
  if (merit.more_is_better()) std::ranges::reverse(values);
  return values;
}

double kept_by(const std::vector<double>& from_best, int share_percent) {
  if (from_best.empty()) return none;
  const double place = share_percent / 100.0 * static_cast<double>(from_best.size());
  const auto at = static_cast<std::size_t>(std::max(0.0, std::ceil(place) - 1));
  return from_best[std::min(at, from_best.size() - 1)];
}

template <class Value>
std::vector<double> of_builds(const ToleranceReport& report, const Value& value) {
  std::vector<double> values;
  for (const Build& build : report.builds) values.push_back(value(build.judgement));
  return values;
}

std::string point_name(const FieldPoint& point) {
  return point.field == 0 ? "0" : fmt::format("{:g} @ {:g}", point.field, point.azimuth_deg);
}

}  // namespace

Table sensitivity_table(const ToleranceReport& report, const Merit& merit) {
  const int decimals = decimals_of(merit);
  const bool inverse = std::ranges::any_of(
      report.sensitivities, [](const Sensitivity& row) { return row.inverse_limit.has_value(); });
  Table table{{{"tolerance", "", 0, "tolerance"},
               {"limit", "+-", 4, "limit"},
               {"unit", "", 0, "unit"},
               {"at worst", merit.unit(), decimals, "worst_change"},
               {"at best", merit.unit(), decimals, "best_change"},
               {"on average", merit.unit(), decimals, "mean_change"}},
              {}};
  if (inverse) table.columns.push_back({"allowed", "+-", 4, "inverse_limit"});
  for (const Sensitivity& row : report.sensitivities) {
    table.rows.push_back({place_of(row.tolerance), row.tolerance.limit,
                          std::string(find_tolerance_kind(row.tolerance.kind)->unit), row.worst_change,
                          row.best_change, row.mean_change});
    if (inverse) table.rows.back().emplace_back(row.inverse_limit.value_or(none));
  }
  return table;
}

Table build_table(const ToleranceReport& report, const Merit& merit) {
  const int decimals = decimals_of(merit);
  Table table{{{"where", "", 0, "where"}, {"designed", merit.unit(), decimals, "designed"}}, {}};
  for (const int share : shares_percent)
    table.columns.push_back(
        {fmt::format("{} % keep", share), merit.unit(), decimals, fmt::format("kept_by_{}", share)});
  const auto add = [&](const std::string& name, double designed, const auto& value) {
    const std::vector<double> values = ordered(of_builds(report, value), merit);
    std::vector<TableCell> row{name, designed};
    for (const int share : shares_percent) row.emplace_back(kept_by(values, share));
    table.rows.push_back(std::move(row));
  };
  for (std::size_t i = 0; i < report.points.size(); ++i)
    add(point_name(report.points[i]), report.designed.at_points[i],
        [i](const Judgement& judgement) { return judgement.at_points[i]; });
  add("overall", report.designed.overall, [](const Judgement& judgement) { return judgement.overall; });
  add("worst point", report.designed.worst, [](const Judgement& judgement) { return judgement.worst; });
  return table;
}

Table all_builds(const ToleranceReport& report, const Merit& merit) {
  Table table{{{"build", "", 0, "build"},
               {"overall", merit.unit(), 4, "overall"},
               {"worst point", merit.unit(), 4, "worst"},
               {"refocus", "mm", 6, "refocus_mm"}},
              {}};
  for (const FieldPoint& point : report.points)
    table.columns.push_back({fmt::format("{} at {}", merit.name(), point_name(point)), merit.unit(), 4});
  for (const Tolerance& tolerance : report.tolerances) {
    const ToleranceKind& kind = *find_tolerance_kind(tolerance.kind);
    const std::string name = place_of(tolerance);
    table.columns.push_back({kind.has_direction ? name + " x" : name, kind.unit, 6});
    if (kind.has_direction) table.columns.push_back({name + " y", kind.unit, 6});
  }
  for (std::size_t b = 0; b < report.builds.size(); ++b) {
    const Build& build = report.builds[b];
    std::vector<TableCell> row{static_cast<double>(b), build.judgement.overall, build.judgement.worst,
                               build.judgement.refocus_mm};
    for (const double value : build.judgement.at_points) row.emplace_back(value);
    for (std::size_t i = 0; i < report.tolerances.size(); ++i) {
      row.emplace_back(build.errors_x[i]);
      if (find_tolerance_kind(report.tolerances[i].kind)->has_direction) row.emplace_back(build.errors_y[i]);
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Plot yield_plot(const std::string& lens, const ToleranceReport& report, const Merit& merit,
                const std::optional<double>& accept) {
  Plot plot;
  plot.title = fmt::format("{}: {} builds", lens, report.builds.size());
  plot.x = {merit.name(), merit.unit()};
  plot.y = {merit.more_is_better() ? "builds with at least so much" : "builds with at most so much", "%",
            PlotScale::linear, 0.0, 100.0};
  const auto add = [&](const char* name, double designed, const auto& value) {
    const std::vector<double> values = ordered(of_builds(report, value), merit);
    std::vector<double> shares;
    for (std::size_t i = 0; i < values.size(); ++i)
      shares.push_back(100 * static_cast<double>(i + 1) / static_cast<double>(values.size()));
    plot.line(name, values, shares);
    plot.guides.push_back({PlotGuide::At::x, designed, "designed"});
  };
  add("overall", report.designed.overall, [](const Judgement& judgement) { return judgement.overall; });
  add("worst point", report.designed.worst, [](const Judgement& judgement) { return judgement.worst; });
  if (accept) plot.guides.push_back({PlotGuide::At::x, *accept, "accepted"});
  return plot;
}

}  // namespace petzval
