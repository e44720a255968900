// SPDX-License-Identifier: BSD-3-Clause
// Date and time by a camera's clock, as EXIF writes them.
#pragma once

#include <chrono>
#include <string>

namespace petzval {

/// A camera's clock knows no time zone.
using DateTime = std::chrono::local_time<std::chrono::microseconds>;

/// "2026-11-26 10:00:00", with a fraction of the second if there is one (up to six digits), with T in place
/// of the space, or with colons in the date as in EXIF. \throws InputError for anything else, and for days
/// that there are not.
DateTime parse_date_time(const std::string& text);
/// "2026:11:26 10:00:00" (EXIF's DateTime).
std::string exif_date_time(DateTime time);
/// "2026-11-26T10:00:00.25" (ISO 8601).
std::string iso_date_time(DateTime time);
/// "250000": the microseconds (EXIF's SubSecTime); empty for whole seconds.
std::string exif_subseconds(DateTime time);
/// `seconds` later, to the nearest microsecond.
DateTime later(DateTime time, double seconds);

}  // namespace petzval
