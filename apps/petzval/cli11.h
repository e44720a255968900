// SPDX-License-Identifier: BSD-3-Clause
// CLI11 without the bodies of its help texts and configuration files (cli11.cpp has them): they are virtual,
// and would be compiled anew, two seconds each time, into every file that includes <CLI/CLI.hpp>.
#pragma once

#include <CLI/App.hpp>
