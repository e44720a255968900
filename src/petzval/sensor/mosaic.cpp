// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/sensor/mosaic.h>

#include <cctype>
#include <set>

namespace petzval {

std::string mosaic_text(const Mosaic& mosaic, const std::vector<std::string>& channels) {
  std::set<char> letters;
  for (const std::string& name : channels) letters.insert(name[0]);
  const bool short_form = letters.size() == channels.size();
  std::string text;
  for (const int cell : mosaic.cells) {
    const std::string& name = channels[static_cast<std::size_t>(cell)];
    if (short_form)
      text += static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
    else
      text += (text.empty() ? "" : "/") + name;
  }
  return text;
}

}  // namespace petzval
