// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/lens/transfer_terms.h>

#include <algorithm>
#include <map>
#include <utility>

namespace petzval {

int output_degree(TransferVariables variables, const TransferPowers& powers) {
  const int sum = powers[0] + powers[1] + powers[2];
  return variables == TransferVariables::invariants ? 2 * sum + 1 : sum;
}

std::vector<TransferPowers> closed(const std::vector<TransferPowers>& terms) {
  std::map<std::pair<int, TransferPowers>, bool> all;
  for (TransferPowers powers : terms) {
    while (true) {
      all[{powers[0] + powers[1] + powers[2], powers}] = true;
      const auto used = std::find_if(powers.begin(), powers.end(), [](int p) { return p > 0; });
      if (used == powers.end()) break;
      --*used;
    }
  }
  all[{0, TransferPowers{0, 0, 0}}] = true;
  std::vector<TransferPowers> list;
  for (const auto& [key, unused] : all) list.push_back(key.second);
  return list;
}

std::size_t outputs_of(const RayTransfer& transfer) {
  const bool ellipses = transfer.bands.front().ellipses.has_value();
  return 4 + (ellipses ? 0 : 2 * transfer.aperture_radii_mm.size());
}

}  // namespace petzval
