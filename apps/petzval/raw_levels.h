// SPDX-License-Identifier: BSD-3-Clause
// What a raw image holds, channel by channel.
#pragma once

#include <petzval/sensor/raw_image.h>

#include <nlohmann/json.hpp>

namespace petzval::app {

/// An array of channel, mean_dn above black, mean_e and clipped_percent.
nlohmann::ordered_json levels_json(const RawImage& raw);
/// The same, a line a channel.
void print_levels(const RawImage& raw);

}  // namespace petzval::app
