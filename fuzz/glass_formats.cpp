// SPDX-License-Identifier: BSD-3-Clause
#include "glass_formats.h"

#include <petzval/glass/byte_reader.h>
#include <petzval/glass/catalogue.h>
#include <petzval/glass/glass_file.h>
#include <petzval/glass/packed_catalogue.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "require.h"

namespace petzval::fuzz {

namespace {

void use(const Glass& glass) {
  require(glass.shortest_nm > 0 && glass.shortest_nm <= glass.longest_nm, "a glass without a range");
  for (const double share : {0.0, 0.3, 1.0}) {
    const double nm =
        std::min(glass.shortest_nm + share * (glass.longest_nm - glass.shortest_nm), glass.longest_nm);
    accepted([&] { require(glass.index(nm) > 0, "an index that is not positive"); });
    const double t = glass.transmittance_10mm(nm);
    require(t >= 0 && t <= 1, "a transmittance that is none");
  }
}

void use_all(const GlassFile& file) {
  for (const Glass& glass : file.glasses) use(glass);
  // A catalogue is made of them, or it says which name cannot be.
  accepted([&] { GlassCatalogue::of(file.glasses); });
}

bool try_catalogue(std::string bytes) {
  return accepted([&] {
    const PackedCatalogue catalogue(std::move(bytes), "fuzz");
    for (std::size_t i = 0; i < catalogue.glass_count(); ++i) use(catalogue.glass(i));
  });
}

}  // namespace

bool try_agf(std::string_view bytes) {
  return accepted([&] { use_all(read_agf(bytes, "fuzz", "FUZZ")); });
}

bool try_glass_yaml(std::string_view bytes) {
  return accepted([&] { use_all(read_glass_yaml(bytes, "fuzz", "FUZZ", "X")); });
}

bool try_packed(std::string_view bytes) {
  constexpr std::size_t checksum_at = 8, checked_from = 12;
  bool good = try_catalogue(std::string(bytes));
  if (bytes.size() < checked_from) return good;
  std::string mended(bytes);
  const std::uint32_t checksum = crc32(bytes.substr(checked_from));
  for (std::size_t i = 0; i < sizeof checksum; ++i)
    mended[checksum_at + i] = static_cast<char>(checksum >> (8 * i) & 0xFF);
  return try_catalogue(std::move(mended)) || good;
}

}  // namespace petzval::fuzz
