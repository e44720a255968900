// SPDX-License-Identifier: BSD-3-Clause
// What the writer and the reader of DNG files share: tags that libtiff 4.5 does not know, and numbers of
// colours.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace petzval::dng {

inline constexpr std::uint32_t noise_profile_tag = 51041, forward_matrix_1_tag = 50964,
                               forward_matrix_2_tag = 50965, opcode_list_1_tag = 51008,
                               opcode_list_2_tag = 51009, opcode_list_3_tag = 51022;
inline constexpr std::uint16_t linear_raw = 34892, colour_filter_array = 32803;

/// Tells libtiff of those tags, for all files that are opened from then on. They must be known before a
/// directory is read: what is unknown then has whatever type the file gives it, and would be taken for
/// another.
void register_tags();

/// The bytes of DNGPrivateData, and the share in them; absent if they are not ours.
std::string private_data(double shot_noise_share);
std::optional<double> shot_noise_share(const std::string& private_data);

/// The number that CFAPlaneColor has for a channel, and back.
std::optional<std::uint8_t> colour_number(const std::string& channel);
std::string channel_name(std::uint8_t colour_number);

}  // namespace petzval::dng
