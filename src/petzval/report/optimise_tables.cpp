// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/report/optimise_tables.h>

namespace petzval {

const char* unit_of(OptimiseMerit merit) {
  return merit == OptimiseMerit::mtf ? "%" : merit == OptimiseMerit::rms_spot ? "um" : "nm";
}

const char* name_of(OptimiseMerit merit) {
  if (merit == OptimiseMerit::mtf) return "RMS loss of MTF";
  return merit == OptimiseMerit::rms_spot ? "RMS spot" : "RMS wavefront";
}

Table optimised_fields(const OptimiseResult& result, const FieldTableRequest& at, OptimiseMerit merit) {
  Table table{{{"field", "", 0, "field"},
               {"before", unit_of(merit), 3, "before"},
               {"after", unit_of(merit), 3, "after"}},
              {}};
  for (std::size_t i = 0; i < at.fields.size(); ++i)
    table.rows.push_back(
        {fmt::format("{:g}", at.fields[i]), result.fields_before[i], result.fields_after[i]});
  table.rows.push_back({std::string("all"), result.before, result.after});
  return table;
}

Table optimised_numbers(const OptimiseResult& result) {
  Table table{{{"number", "", 0, "number"}, {"before", "", 6, "before"}, {"after", "", 6, "after"}}, {}};
  for (const OptimisedNumber& each : result.numbers)
    table.rows.push_back({name_of(each.number), each.before, each.after});
  return table;
}

Table optimised_glasses(const OptimiseResult& result) {
  Table table{{{"surface", "", 0, "surface"}, {"before", "", 0, "glass_before"}, {"after", "", 0, "glass"}},
              {}};
  for (const ChosenGlass& each : result.glasses)
    table.rows.push_back({static_cast<double>(each.surface), each.before, each.after});
  return table;
}

Plot optimise_plot(const std::string& lens, const OptimiseResult& result, OptimiseMerit merit) {
  Plot plot;
  plot.title = lens;
  plot.x = {"round", ""};
  plot.y = {name_of(merit), unit_of(merit)};
  std::vector<double> rounds;
  for (std::size_t i = 0; i < result.by_round.size(); ++i) rounds.push_back(static_cast<double>(i));
  plot.line(name_of(merit), rounds, result.by_round);
  return plot;
}

}  // namespace petzval
