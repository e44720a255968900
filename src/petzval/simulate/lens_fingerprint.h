// SPDX-License-Identifier: BSD-3-Clause
// What a lens does to light, in lines that a checkpoint can keep and compare.
#pragma once

#include <petzval/lens/lens.h>
#include <petzval/trace/losses.h>

#include <string>
#include <vector>

namespace petzval {

/// The lens, and the indices of its glasses: catalogues may change under a lens that names them.
std::string lens_fingerprint(const Lens& lens, const std::vector<double>& wavelengths_nm);

/// Every number of every coating.
std::string losses_fingerprint(const Losses& losses);

}  // namespace petzval
