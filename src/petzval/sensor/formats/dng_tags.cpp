// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/number_text.h>
#include <petzval/sensor/formats/dng_tags.h>
#include <tiffio.h>

#include <algorithm>
#include <array>

namespace petzval::dng {

namespace {

constexpr std::array<const char*, 7> names = {"red", "green", "blue", "cyan", "magenta", "yellow", "white"};

const std::string own_data("Petzval\0shot noise ", 19);

TIFFExtendProc other_tags = nullptr;  // of whoever else extends libtiff in this process

void add_tags(TIFF* handle) {
  static char noise[] = "NoiseProfile", forward_1[] = "ForwardMatrix1", forward_2[] = "ForwardMatrix2",
              opcodes_1[] = "OpcodeList1", opcodes_2[] = "OpcodeList2", opcodes_3[] = "OpcodeList3";
  static const TIFFFieldInfo fields[] = {
      {noise_profile_tag, TIFF_VARIABLE2, TIFF_VARIABLE2, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, noise},
      {forward_matrix_1_tag, TIFF_VARIABLE2, TIFF_VARIABLE2, TIFF_SRATIONAL, FIELD_CUSTOM, 1, 1, forward_1},
      {forward_matrix_2_tag, TIFF_VARIABLE2, TIFF_VARIABLE2, TIFF_SRATIONAL, FIELD_CUSTOM, 1, 1, forward_2},
      {opcode_list_1_tag, TIFF_VARIABLE2, TIFF_VARIABLE2, TIFF_UNDEFINED, FIELD_CUSTOM, 1, 1, opcodes_1},
      {opcode_list_2_tag, TIFF_VARIABLE2, TIFF_VARIABLE2, TIFF_UNDEFINED, FIELD_CUSTOM, 1, 1, opcodes_2},
      {opcode_list_3_tag, TIFF_VARIABLE2, TIFF_VARIABLE2, TIFF_UNDEFINED, FIELD_CUSTOM, 1, 1, opcodes_3}};
  TIFFMergeFieldInfo(handle, fields, static_cast<std::uint32_t>(std::size(fields)));
  if (other_tags) other_tags(handle);
}

}  // namespace

void register_tags() {
  [[maybe_unused]] static const bool once = (other_tags = TIFFSetTagExtender(add_tags), true);
}

std::string private_data(double shot_noise_share) {
  return own_data + fmt::format("{}", shot_noise_share);
}

std::optional<double> shot_noise_share(const std::string& private_data) {
  if (!private_data.starts_with(own_data)) return {};
  return parse_number(private_data.substr(own_data.size()));
}

std::optional<std::uint8_t> colour_number(const std::string& channel) {
  const auto found = std::find(names.begin(), names.end(), channel == "clear" ? "white" : channel);
  if (found == names.end()) return {};
  return static_cast<std::uint8_t>(found - names.begin());
}

std::string channel_name(std::uint8_t colour_number) {
  return colour_number < names.size() ? names[colour_number] : fmt::format("colour {}", colour_number);
}

}  // namespace petzval::dng
