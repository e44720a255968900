// SPDX-License-Identifier: BSD-3-Clause
// --inset, of every command that writes a picture.
#pragma once

#include <petzval/image/picture_inset.h>

#include <string>
#include <vector>

#include "cli11.h"

namespace petzval::app {

void add_inset_option(CLI::App& command, std::vector<std::string>& insets);

/// \throws InputError for a text that is no inset.
std::vector<PictureInset> parsed_insets(const std::vector<std::string>& texts);

}  // namespace petzval::app
