// SPDX-License-Identifier: BSD-3-Clause
// A developed picture as Python wants it: channels interleaved.
#pragma once

#include <string>
#include <vector>

#include "bind.h"

namespace petzval::python {

struct PictureInPython {
  PictureInPython() = default;
  explicit PictureInPython(Picture picture);
  Picture picture() const;

  int columns = 0, rows = 0;
  std::size_t channels = 0;
  std::vector<float> values = {};  ///< [row][column][channel], linear
  DisplaySpace space = DisplaySpace::srgb;
  DevelopReport report = {};
  std::string provenance = {};
  CameraFacts facts = {};
};

}  // namespace petzval::python
