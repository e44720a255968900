// SPDX-License-Identifier: BSD-3-Clause
// Opens a page in the user's browser.
#pragma once

#include <petzval/base/scratch_folder.h>

#include <string>

namespace petzval::app {

/// Opens a page by xdg-open. Other users of a machine can read the words of a command, and the address holds
/// a secret: what is opened is a file that this user alone can read, and it leads there.
class PageOpener {
 public:
  /// \returns false where there is no display or no xdg-open. The file stays as long as this object.
  bool open(const std::string& url);

 private:
  ScratchFolder folder_;
};

}  // namespace petzval::app
