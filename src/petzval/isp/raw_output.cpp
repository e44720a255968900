// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/file_extension.h>
#include <petzval/base/whole_file.h>
#include <petzval/isp/develop.h>
#include <petzval/isp/linear_picture.h>
#include <petzval/isp/raw_output.h>
#include <petzval/sensor/formats/dng.h>
#include <petzval/sensor/formats/original_raw.h>
#include <petzval/sensor/raw_file.h>

namespace petzval {

void write_raw_output(const std::string& path, const RawImage& raw) {
  constexpr std::size_t colours = 3;
  if (extension_of(path) != ".dng" || mosaic_note(raw).empty() || raw.channels.size() < colours ||
      raw.calibrations.empty())
    return write_raw(path, raw);
  const std::string original = dng_bytes(raw, path);
  // What is developed is what one would read.
  const LinearPicture picture = linear_picture(develop_planes(parse_dng(original, path)), DisplaySpace::srgb,
                                               raw.provenance, camera_facts(raw));
  write_whole_file(path, with_original_raw(linear_dng_bytes(picture, path), original));
}

}  // namespace petzval
