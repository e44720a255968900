// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/date_time.h>
#include <petzval/base/error.h>

#include <cmath>
#include <regex>

namespace petzval {

using namespace std::chrono;

DateTime parse_date_time(const std::string& text) {
  static const std::regex form(R"((\d{4})[-:](\d\d)[-:](\d\d)[ T](\d\d):(\d\d):(\d\d)(?:\.(\d{1,6}))?)");
  std::smatch match;
  const auto number = [&](std::size_t part) { return match[part].matched ? std::stoi(match[part]) : 0; };
  if (std::regex_match(text, match, form)) {
    const year_month_day day{year(number(1)), month(static_cast<unsigned>(number(2))),
                             std::chrono::day(static_cast<unsigned>(number(3)))};
    constexpr std::size_t digits = 6;
    const std::string fraction = match[7].str();
    const int micro = std::stoi("0" + fraction + std::string(digits - fraction.size(), '0'));
    if (day.ok() && number(1) > 0 && number(4) < 24 && number(5) < 60 && number(6) < 60)
      return local_days(day) + hours(number(4)) + minutes(number(5)) + seconds(number(6)) +
             microseconds(micro);
  }
  throw InputError(fmt::format("\"{}\" is no date and time; \"2026-11-26 10:00:00\" would be one", text));
}

std::string exif_date_time(DateTime time) {
  const auto midnight = floor<days>(time);
  const year_month_day day(midnight);
  const hh_mm_ss clock(floor<seconds>(time - midnight));
  return fmt::format("{:04}:{:02}:{:02} {:02}:{:02}:{:02}", static_cast<int>(day.year()),
                     static_cast<unsigned>(day.month()), static_cast<unsigned>(day.day()),
                     clock.hours().count(), clock.minutes().count(), clock.seconds().count());
}

std::string exif_subseconds(DateTime time) {
  const auto rest = (time - floor<seconds>(time)).count();
  return rest == 0 ? std::string() : fmt::format("{:06}", rest);
}

std::string iso_date_time(DateTime time) {
  std::string text = exif_date_time(time), fraction = exif_subseconds(time);
  text[4] = text[7] = '-', text[10] = 'T';
  while (fraction.ends_with('0')) fraction.pop_back();
  return fraction.empty() ? text : text + "." + fraction;
}

DateTime later(DateTime time, double seconds) {
  constexpr double micro = 1e6;
  return time + microseconds(std::llround(seconds * micro));
}

}  // namespace petzval
