// SPDX-License-Identifier: BSD-3-Clause
// The one place where the bodies of CLI11's virtual functions are compiled.
#include <CLI/CLI.hpp>
