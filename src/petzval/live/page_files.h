// SPDX-License-Identifier: BSD-3-Clause
// The page, compiled into the library.
#pragma once

#include <span>
#include <string_view>

namespace petzval {

/// A file of the page.
struct PageFile {
  std::string_view path;  ///< "/app.js", as requests name it
  std::string_view type;  ///< "text/javascript; charset=utf-8"
  std::string_view bytes;
};

/// All of them; made of `web/` at build time.
std::span<const PageFile> page_files();

}  // namespace petzval
