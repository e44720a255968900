// SPDX-License-Identifier: BSD-3-Clause
#include "inset_option.h"

namespace petzval::app {

void add_inset_option(CLI::App& command, std::vector<std::string>& insets) {
  command
      .add_option(
          "--inset", insets,
          "X,Y[,FACTOR]: enlarge what is about this pixel, beside the picture (FACTOR: 4); or centre, top, "
          "right, bottom-left and the like in the place of X,Y; repeatable")
      ->take_all()
      ->allow_extra_args(false);
}

std::vector<PictureInset> parsed_insets(const std::vector<std::string>& texts) {
  std::vector<PictureInset> insets;
  for (const std::string& text : texts) insets.push_back(PictureInset::parse(text));
  return insets;
}

}  // namespace petzval::app
