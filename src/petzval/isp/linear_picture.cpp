// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/isp/linear_picture.h>

#include <algorithm>

namespace petzval {

LinearPicture linear_picture(const Planes& planes, DisplaySpace space, const std::string& provenance,
                             const CameraFacts& facts) {
  LinearPicture picture{planes.columns, planes.rows, {}, {}, facts, provenance};
  const ColourMatrix matrix = display_from_xyz(space);
  for (std::size_t i = 0; i < 9; ++i) picture.rgb_from_xyz[i] = matrix[i / 3][i % 3];
  const std::size_t columns = static_cast<std::size_t>(planes.columns), channels = planes.values.size();
  picture.samples.resize(planes.values[0].size() * channels);
  parallel_for(static_cast<std::size_t>(planes.rows), [&](std::size_t row) {
    constexpr float white = 65535;
    for (std::size_t at = row * columns; at < (row + 1) * columns; ++at)
      for (std::size_t k = 0; k < channels; ++k)
        picture.samples[at * channels + k] =
            static_cast<std::uint16_t>(white * std::clamp(planes.values[k][at], 0.0f, 1.0f) + 0.5f);
  });
  return picture;
}

}  // namespace petzval
