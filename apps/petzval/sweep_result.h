// SPDX-License-Identifier: BSD-3-Clause
// One point of a sweep: made now, or taken from an earlier run.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sweep_arguments.h"

namespace petzval::app {

/// What became of one point; kept in a file, so that a sweep can go on where it was ended.
struct PointResult {
  SweepPoint point;
  std::vector<std::string> arguments;
  bool done = false;
  int exit_code = 0;
  std::string error, picture;
  std::vector<std::string> outputs;  ///< paths of what the command writes
  nlohmann::ordered_json checksums;  ///< of the files that the arguments name
  nlohmann::ordered_json numbers;
};

/// "point-0007", the name of its files.
std::string name_of_point(std::size_t index);

/// Checksums of the files that arguments name, as they stand or behind '=': a lens that was edited since
/// makes another point. \param outputs  that the point writes begin so.
nlohmann::ordered_json checksums_of_files(const std::vector<std::string>& arguments,
                                          const std::string& outputs);

/// The arguments of a point without its outputs.
std::vector<std::string> words_of_point(const CLI::App& app, const SweepCommand& options,
                                        const SweepPoint& point, const std::string& scene_angle,
                                        const Shared& shared);

/// Takes the point from its record in the folder if that is of the same arguments, program and files, or else
/// makes it. A point whose files are not as they were written is made again, with a note. \param scene_angle
/// the least of it; "": none is given.
PointResult run_point(const CLI::App& app, const SweepCommand& options, const SweepPoint& point,
                      std::size_t index, const std::string& scene_angle, const Shared& shared);

}  // namespace petzval::app
