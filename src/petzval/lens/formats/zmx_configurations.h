// SPDX-License-Identifier: BSD-3-Clause
// The configurations of a .zmx file (MNUM and the operands behind it), each as a file of its own.
#pragma once

#include <petzval/lens/formats/zmx_records.h>

#include <string>
#include <vector>

namespace petzval {

/// How many configurations a file has; 1 where it does not say.
std::size_t zmx_configuration_count(const ZmxFile& file);

/// What of the configurations is not modelled, as words of a note; "" if each can be read.
std::string zmx_configurations_fault(const ZmxFile& file);

/// The file with the values of one configuration, counted from 1, written into its header and surfaces.
/// \throws InputError for an operand that misses the value, or whose surface or field is not there.
ZmxFile zmx_configuration(const ZmxFile& file, std::size_t number);

/// Whether the last gap is to be solved for the paraxial image in every configuration.
bool zmx_solves_image(const ZmxFile& file);

}  // namespace petzval
