// SPDX-License-Identifier: BSD-3-Clause
#include "lens_formats.h"

#include <petzval/analysis/transfer_fit.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/formats/flaresim.h>
#include <petzval/lens/formats/iset.h>
#include <petzval/lens/formats/iset_transfer.h>
#include <petzval/lens/formats/native.h>
#include <petzval/lens/formats/optical_bench.h>
#include <petzval/lens/formats/pbrt.h>
#include <petzval/lens/formats/seq.h>
#include <petzval/lens/formats/zmx.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "require.h"

namespace petzval::fuzz {

namespace {

/// Three glasses are quickly searched, and their nearest names quickly found.
const LensReadOptions& options() {
  static const LensReadOptions few = [] {
    std::vector<Glass> glasses;
    for (const char* name : {"N-BK7", "F2", "N-SK16"})
      glasses.push_back(*GlassCatalogue::bundled().find(name, {"SCHOTT"}));
    LensReadOptions with;
    with.glasses = GlassCatalogue::of(std::move(glasses));
    return with;
  }();
  return few;
}

using Read = Lens (*)(const std::string& text);
using Write = std::string (*)(const Lens& lens);

/// Files that turn the axis say places in another way, with the rounding of some turns.
bool require_same_places(const Lens& lens, const Lens& back) {
  const std::vector<Frame> one = frames_of(lens), other = frames_of(back);
  require(one.size() == other.size(), "a written lens with other surfaces");
  double size_mm = 1, gaps_mm = 0, other_gaps_mm = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    for (const double mm : one[i].offset_mm) size_mm = std::max(size_mm, std::abs(mm) + std::abs(gaps_mm));
    for (std::size_t k = 0; k < 3; ++k) {
      const double apart =
          one[i].offset_mm[k] - other[i].offset_mm[k] + (k == 2 ? gaps_mm - other_gaps_mm : 0);
      require(std::abs(apart) <= 1e-9 * size_mm, "a written lens that stands elsewhere");
      for (std::size_t j = 0; j < 3; ++j)
        require(std::abs(one[i].rows[k][j] - other[i].rows[k][j]) <= 1e-9, "a written lens that is turned");
    }
    if (i < lens.surfaces.size())
      gaps_mm += lens.surfaces[i].thickness_mm, other_gaps_mm += back.surfaces[i].thickness_mm;
  }
  return true;
}

bool try_lens(std::string_view bytes, Read read, Write write) {
  std::optional<Lens> lens;
  if (!accepted([&] { lens = read(std::string(bytes)); })) return false;
  lens->validate();
  accepted([&] { first_order(*lens); });
  std::string text;
  if (!accepted([&] { text = write(*lens); })) return true;
  const Lens back = read(text);
  if (has_poses(*lens) && write != lens_to_json) return require_same_places(*lens, back);
  const std::string again = write(back);
  if (again != text) std::fprintf(stderr, "%s\nbecame\n%s\n", text.c_str(), again.c_str());
  require(again == text, "a written lens that reads back as another");
  return true;
}

Lens read_optical_bench_text(const std::string& bytes) {
  return read_optical_bench(decoded_text(bytes), "fuzz", options()).lens;
}
Lens read_flaresim_text(const std::string& bytes) {
  return read_flaresim(decoded_text(bytes), "fuzz").lens;
}

Lens read_native_text(const std::string& text) {
  return read_native(JsonDocument(text, "fuzz"), options());
}
Lens read_zmx_text(const std::string& bytes) {
  return read_zmx(decoded_text(bytes), "fuzz", options()).lens;
}
Lens read_seq_text(const std::string& bytes) {
  return read_seq(decoded_text(bytes), "fuzz", options()).lens;
}
Lens read_pbrt_text(const std::string& bytes) {
  return read_pbrt(decoded_text(bytes), "fuzz").lens;
}
Lens read_iset_text(const std::string& text) {
  return read_iset(JsonDocument(text, "fuzz")).lens;
}

Lens read_iset_transfer_text(const std::string& text) {
  return read_iset_transfer(JsonDocument(text, "fuzz")).lens;
}

/// Of formats that are only read: the lens must survive its native form.
template <typename Read>
bool try_read_only(std::string_view bytes, Read read) {
  std::optional<Lens> lens;
  if (!accepted([&] { lens = read(std::string(bytes)); })) return false;
  lens->validate();
  accepted([&] { first_order(*lens); });
  const std::string text = lens_to_json(*lens);
  const std::string again = lens_to_json(read_native_text(text));
  if (again != text) std::fprintf(stderr, "%s\nbecame\n%s\n", text.c_str(), again.c_str());
  require(again == text, "a lens that its native form does not hold");
  return true;
}

}  // namespace

bool try_native(std::string_view bytes) {
  return try_lens(bytes, read_native_text, lens_to_json);
}
bool try_zmx(std::string_view bytes) {
  return try_lens(bytes, read_zmx_text, zmx_text);
}
bool try_seq(std::string_view bytes) {
  return try_lens(bytes, read_seq_text, seq_text);
}
bool try_pbrt(std::string_view bytes) {
  return try_lens(bytes, read_pbrt_text, pbrt_text);
}
bool try_optical_bench(std::string_view bytes) {
  return try_read_only(bytes, read_optical_bench_text);
}
bool try_flaresim(std::string_view bytes) {
  return try_read_only(bytes, read_flaresim_text);
}
bool try_iset_transfer(std::string_view bytes) {
  return try_lens(bytes, read_iset_transfer_text, iset_transfer_text);
}
bool try_ray_table(std::string_view bytes) {
  try {
    const RayTable table = ray_table_of(bytes, "rays.csv");
    const std::string text = ray_table_text(table);
    require(ray_table_text(ray_table_of(text, "rays.csv")) == text,
            "a written table of rays that reads otherwise");
    fit_transfer(table, {.tolerance_mm = 1, .degree = 1}).lens.validate();
    return true;
  } catch (const InputError& error) {
    require(std::string_view(error.what()).find('\n') == std::string_view::npos,
            "a refusal of more than one line");
    return false;
  }
}
bool try_iset(std::string_view bytes) {
  return try_lens(bytes, read_iset_text, iset_text);
}

}  // namespace petzval::fuzz
