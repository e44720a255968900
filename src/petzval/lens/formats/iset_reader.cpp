// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/lens/formats/iset.h>
#include <petzval/lens/formats/row_lens.h>

namespace petzval {

namespace {

LensRow read_row(const JsonEntry& entry) {
  entry.allow_only({"ior", "radius", "semi_aperture", "thickness"});
  LensRow row;
  const JsonEntry radius = entry.at("radius");
  const double radius_mm = radius.number("a radius in mm, 0 for the stop");
  row.stop = radius_mm == 0;
  if (!row.stop)
    row.curvature_per_mm =
        radius.long_number() ? curvature_from_radius(*radius.long_number()) : 1 / radius_mm;
  row.thickness_mm = entry.at("thickness").number("a distance in mm");
  const JsonEntry ior = entry.at("ior");
  row.index_after = ior.number("a refractive index, 0 at the stop");
  row.semi_diameter_mm = entry.at("semi_aperture").number("a semi-diameter in mm");
  if (!(row.index_after >= 1) && !(row.stop && row.index_after == 0))
    ior.fail("must be at least 1; 1 is air, 0 stands at the stop only");
  return row;
}

std::string text_or(const JsonEntry& top, const char* key, const std::string& otherwise) {
  const auto entry = top.find(key);
  return entry ? trimmed(entry->text("a text")) : otherwise;
}

}  // namespace

bool is_iset(const JsonDocument& document) {
  const auto& root = document.root();
  if (!root.is_object() || root.contains("format") || !root.contains("surfaces")) return false;
  const auto& surfaces = root["surfaces"];
  return surfaces.is_array() && !surfaces.empty() && surfaces[0].is_object() && surfaces[0].contains("ior");
}

LensFile read_iset(const JsonDocument& document) {
  const JsonEntry top(document);
  top.allow_only({"description", "name", "surfaces", "metadata"});
  std::vector<LensRow> rows;
  bool has_stop = false;
  for (const JsonEntry& surface : top.at("surfaces").items("a list of surfaces, front to back")) {
    rows.push_back(read_row(surface));
    if (!rows.back().stop) continue;
    if (has_stop) surface.fail("is a second stop (radius 0); give a flat surface a large radius");
    has_stop = true;
  }
  if (!has_stop) top.at("surfaces").fail("has no stop; the stop is the surface with radius 0 and ior 0");
  LensFile file;
  try {
    file = lens_from_rows(rows);
  } catch (const InputError& error) {
    document.fail("", error.what());
  }
  file.lens.name = text_or(top, "name", "");
  file.lens.source = text_or(top, "description", "");
  return file;
}

}  // namespace petzval
