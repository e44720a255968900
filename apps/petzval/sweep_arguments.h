// SPDX-License-Identifier: BSD-3-Clause
// The command lines of a sweep's points, and whether they are any.
#pragma once

#include "command.h"
#include "sweep_points.h"

#include <algorithm>

namespace petzval::app {

struct SweepCommand {
  std::string command;             ///< image, render or lens
  std::vector<std::string> words;  ///< what goes to it
  std::vector<std::string> vary;
  std::string folder;
  std::string points;                ///< a table of points, or nothing
  std::string irradiance;            ///< exr, npy or nothing
  std::vector<std::string> kept;     ///< extensions of what else is written at each point
  std::string scene_width = "same";  ///< of all points, each as its frame needs, or a length
  std::string plot;                  ///< of the numbers, or nothing
  std::vector<std::string> plot_of;  ///< what it shows; empty: what the command is about
  bool share_paths = false;          ///< all pictures are rendered together
  bool corners = false;              ///< measure the corners of every picture
  std::vector<std::string> accept;   ///< what a good point keeps: COLUMN>=VALUE or COLUMN<=VALUE
  std::string clip;                  ///< a film of the pictures, or nothing
  double frames_per_second = 12;
  std::optional<int> frames;  ///< of ranges that have no step

  bool makes_pictures() const { return command != "lens"; }
  /// What each point writes besides its picture.
  std::vector<std::string> other_files() const {
    std::vector<std::string> extensions = kept;
    if (!irradiance.empty()) extensions.push_back(irradiance);
    std::sort(extensions.begin(), extensions.end());
    extensions.erase(std::unique(extensions.begin(), extensions.end()), extensions.end());
    return extensions;
  }
};

/// The command of this program that is swept, with its options. \throws InputError if there is none.
const CLI::App& swept_app(const CLI::App& program, const SweepCommand& options);

/// Arguments of a point: an option of the command, its LENS, an entry of the sensor, or else a --set of the
/// lens. Without outputs.
std::vector<std::string> arguments_of(const CLI::App& app, const SweepCommand& options,
                                      const SweepPoint& point, const Shared& shared);

/// Tries the command line of every value of every parameter, without doing what it says. \throws InputError
/// for the first that is wrong, and for parameters that cannot be varied.
void check_command_lines(const CLI::App& app, const SweepCommand& options,
                         const std::vector<SweptParameter>& parameters, const Shared& shared);

/// A point's error in the words of the sweep: --vary KEY=VALUE where the point had --set KEY=VALUE.
std::string in_words_of_sweep(std::string error, const SweepPoint& point);

}  // namespace petzval::app
