// SPDX-License-Identifier: BSD-3-Clause
#include "lens_formats.h"

#include <petzval/base/text_lines.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/formats/iset.h>
#include <petzval/lens/formats/iset_transfer.h>
#include <petzval/lens/formats/native.h>
#include <petzval/lens/formats/pbrt.h>
#include <petzval/lens/formats/seq.h>
#include <petzval/lens/formats/zmx.h>

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

bool try_lens(std::string_view bytes, Read read, Write write) {
  std::optional<Lens> lens;
  if (!accepted([&] { lens = read(std::string(bytes)); })) return false;
  lens->validate();
  accepted([&] { first_order(*lens); });
  std::string text;
  if (!accepted([&] { text = write(*lens); })) return true;
  const std::string again = write(read(text));
  if (again != text) std::fprintf(stderr, "%s\nbecame\n%s\n", text.c_str(), again.c_str());
  require(again == text, "a written lens that reads back as another");
  return true;
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
bool try_iset_transfer(std::string_view bytes) {
  return try_lens(bytes, read_iset_transfer_text, iset_transfer_text);
}
bool try_iset(std::string_view bytes) {
  return try_lens(bytes, read_iset_text, iset_text);
}

}  // namespace petzval::fuzz
