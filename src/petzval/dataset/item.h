// SPDX-License-Identifier: BSD-3-Clause
// One item of a data set: a picture with the truth beside it.
#pragma once

#include <petzval/base/context.h>
#include <petzval/dataset/recipe.h>
#include <petzval/simulate/render.h>

#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace petzval {

struct ItemFile {
  std::string extension;  ///< "png", "sharp.png", "psf.npy"
  std::string bytes;
};

struct Item {
  nlohmann::json facts;  ///< what was drawn, the camera, the exposure; what is in the item's .json
  std::vector<ItemFile> files;
};

/// Makes the items of one recipe, from any thread.
class ItemMaker {
 public:
  explicit ItemMaker(const Recipe& recipe) : recipe_(recipe) {}

  /// "0000017".
  static std::string key(std::size_t item);
  /// A function of recipe and number alone. \throws InputError for what the draw cannot be made of (a lens
  /// that does not open so far, a scene that does not cover the field); Failure; Cancelled.
  Item make(std::size_t item);

 private:
  PreparedScene prepared(const RenderRequest& request, const Context& context);

  const Recipe& recipe_;
  std::mutex mutex_;
  std::map<std::string, PreparedScene> worlds_;  ///< by file: built once
};

}  // namespace petzval
