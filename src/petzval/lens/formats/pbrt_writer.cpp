// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/number_text.h>
#include <petzval/lens/formats/pbrt.h>
#include <petzval/lens/formats/row_lens.h>

#include <algorithm>

namespace petzval {

std::string pbrt_text(const Lens& lens) {
  std::string comment = lens.name;
  std::replace_if(
      comment.begin(), comment.end(), [](unsigned char c) { return c < ' '; }, ' ');
  std::string text =
      fmt::format("# {}\n# radius\tthickness\tindex behind\taperture diameter [mm]\n", comment);
  for (const LensRow& row : rows_of_lens(lens, "a .dat file"))
    text += fmt::format("{}\t{}\t{}\t{}\n", row_radius_text(row), number_text(row.thickness_mm),
                        row.stop ? "0" : fmt::format("{}", row.index_after),
                        number_text(2 * row.semi_diameter_mm));
  return text;
}

}  // namespace petzval
