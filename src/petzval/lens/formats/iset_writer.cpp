// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/number_text.h>
#include <petzval/lens/formats/iset.h>
#include <petzval/lens/formats/row_lens.h>

namespace petzval {

namespace {

std::string matlab_quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

std::string iset_text(const Lens& lens) {
  const std::vector<LensRow> rows = rows_of_lens(lens, "an ISET file");
  std::string text = fmt::format("{{\n  \"name\": {},\n  \"description\": {},\n  \"surfaces\": [\n",
                                 matlab_quoted(lens.name), matlab_quoted(lens.source));
  for (std::size_t i = 0; i < rows.size(); ++i)
    text += fmt::format("    {{\"ior\": {}, \"radius\": {}, \"semi_aperture\": {}, \"thickness\": {}}}{}\n",
                        number_text(rows[i].index_after), row_radius_text(rows[i]),
                        number_text(rows[i].semi_diameter_mm), number_text(rows[i].thickness_mm),
                        i + 1 < rows.size() ? "," : "");
  return text + "  ]\n}\n";
}

}  // namespace petzval
