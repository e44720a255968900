// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/quantities.h>
#include <petzval/base/text_lines.h>
#include <petzval/simulate/focus.h>

#include <cmath>

namespace petzval {

namespace {

constexpr std::string_view by_mtf = "best-mtf@";

}  // namespace

Focus Focus::at_m(double distance_m) {
  if (std::isinf(distance_m) && distance_m > 0) return infinity();
  if (!(distance_m > 0))
    throw InputError(fmt::format("`focus` {:g} m: a distance above 0 would be right", distance_m));
  return {Kind::distance, distance_m};
}

Focus Focus::parse(std::string_view text) {
  if (const std::size_t plus = text.find('+'); plus != text.npos) {
    const Focus object = parse(text.substr(0, plus));
    Focus found = parse(text.substr(plus + 1));
    const std::optional<double> distance_m = asked_distance_m(object);
    if (!distance_m || object.sought() || !found.sought())
      throw InputError(fmt::format(
          "`focus` {}: a distance, and how focus is sought there, as 1.2m+best-spot, would be right",
          quotable(text)));
    found.distance_m = *distance_m;
    return found;
  }
  if (text == "auto") return automatic();
  if (text == "design") return design();
  if (text == "paraxial") return {Kind::paraxial};
  if (text == "best-spot") return {Kind::best_spot};
  if (text.starts_with(by_mtf)) {
    const std::optional<double> frequency = parse_number(text.substr(by_mtf.size()));
    if (!frequency || !(*frequency > 0))
      throw InputError(fmt::format("`focus` {}: a frequency in cycles/mm, as best-mtf@40, would be right",
                                   quotable(text)));
    return {Kind::best_mtf, 0, *frequency};
  }
  if (parse_length_m(text) || parse_number(text)) return at_m(parse_distance_m(text, "focus"));
  throw InputError(
      fmt::format("`focus` {}: auto (the scene), design, infinity, a distance from the sensor (1.2m, "
                  "250mm), paraxial, best-spot or best-mtf@CYCLES_PER_MM would be right",
                  quotable(text)));
}

std::string Focus::text() const {
  if (sought() && distance_m > 0) {
    Focus alone = *this;
    alone.distance_m = 0;
    return fmt::format("{}+{}", std::isinf(distance_m) ? "infinity" : distance_text(distance_m),
                       alone.text());
  }
  switch (kind) {
    case Kind::automatic:
      return "auto";
    case Kind::design:
      return "design";
    case Kind::infinity:
      return "infinity";
    case Kind::distance:
      return distance_text(distance_m);
    case Kind::paraxial:
      return "paraxial";
    case Kind::best_spot:
      return "best-spot";
    case Kind::best_mtf:
      return fmt::format("best-mtf@{:g}", frequency_cpmm);
  }
  return {};
}

std::optional<double> asked_distance_m(const Focus& focus) {
  if (focus.kind == Focus::Kind::infinity) return INFINITY;
  return focus.distance_m > 0 ? std::optional(focus.distance_m) : std::nullopt;
}

}  // namespace petzval
