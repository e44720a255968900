// SPDX-License-Identifier: BSD-3-Clause
#include "raw_levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace petzval::app {

namespace {

/// Of one channel, in linear values less the black level.
struct ChannelLevel {
  std::string name;
  double mean = 0, clipped = 0;  ///< clipped: share of its pixels at the white level
};

std::vector<ChannelLevel> channel_levels(const RawImage& raw) {
  std::vector<ChannelLevel> levels(raw.channels.size());
  std::vector<double> counts(raw.channels.size());
  for (int row = 0; row < raw.rows; ++row)
    for (int column = 0; column < raw.columns; ++column) {
      const auto channel = static_cast<std::size_t>(raw.mosaic.channel(row, column));
      const double value = raw.pixel(row, column);
      levels[channel].mean += value - raw.black_level;
      levels[channel].clipped += value >= raw.white_level;
      ++counts[channel];
    }
  for (std::size_t i = 0; i < levels.size(); ++i) {
    levels[i].name = raw.channels[i];
    levels[i].mean /= std::max(1.0, counts[i]);
    levels[i].clipped /= std::max(1.0, counts[i]);
  }
  return levels;
}

}  // namespace

nlohmann::ordered_json levels_json(const RawImage& raw) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const ChannelLevel& level : channel_levels(raw))
    rows.push_back({{"channel", level.name},
                    {"mean_dn", level.mean},
                    {"mean_e", level.mean / raw.dn_per_e},
                    {"clipped_percent", 100 * level.clipped}});
  return rows;
}

void print_levels(const RawImage& raw) {
  for (const ChannelLevel& level : channel_levels(raw))
    fmt::print("  {:<11} mean {:.5g} DN above black, {:.4g} e, {:.2f} % clipped\n", level.name, level.mean,
               level.mean / raw.dn_per_e, 100 * level.clipped);
}

}  // namespace petzval::app
