// SPDX-License-Identifier: BSD-3-Clause
// A plano-convex lens as the Optical Bench and FlareSim keep it.
#pragma once

#include <string>

namespace petzval::testing {

/// With tabs between columns, as such files have them.
inline std::string bench(const std::string& constants, const std::string& rows,
                         const std::string& aspheres = "", const std::string& variables = "Bf\t96.3\n") {
  return "[descriptive data]\ntitle\tSample\n[constants]\n" + constants +
         "[variable distances]\nFocal Length\t100\t80\nAngle of "
         "View\t20\t24\nF-Number\t8\t8\nd0\tInfinity\tInfinity\n" +
         variables + "[lens data]\n" + rows + "[aspherical data]\n" + aspheres;
}

inline const std::string singlet = "1\t51.68\t4\t1.5168\t25\t64.17\n2\tInfinity\t1\t\t25\n3\tAS\tBf\t\t12\n";

inline const std::string flare_rows =
    "name: Sample\nfocal_length: 100\n\nsurfaces:\n# radius thickness ior abbe semi_ap coating\n"
    "51.68 4 1.5168 64.17 12.5 1\n0 1 1.0 0 12.5 0\nstop 96.3 1.0 0 6 0\n";

}  // namespace petzval::testing
