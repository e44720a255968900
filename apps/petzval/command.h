// SPDX-License-Identifier: BSD-3-Clause
// What all subcommands share: the options of the whole program, and the way a lens is named.
#pragma once

#include <petzval/base/context.h>
#include <petzval/glass/catalogue.h>
#include <petzval/lens/lens.h>
#include <petzval/simulate/render_session.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cli11.h"

namespace petzval::app {

class SweepFrames;

/// Options that every subcommand takes.
struct Shared {
  int threads = 0;  ///< 0: as many as the machine has
  std::uint64_t seed = 1;
  bool quiet = false;  ///< no notes, no progress
  bool json = false;
  RenderSession* renders = nullptr;  ///< of a command that runs many others; null: none
  SweepFrames* frames = nullptr;     ///< of a sweep whose pictures share their paths; null: none
  bool parse_only = false;           ///< the command line is checked, and nothing is done
};

/// The context of a command: its notes go to stderr, its progress to a bar there, and Ctrl-C stops it.
Context context_of(const Shared& shared);

/// From now on SIGINT and SIGTERM end a command by Cancelled: what it has begun to write is taken away.
void stop_on_signals();

/// Adds a subcommand with --threads, --seed, --quiet (and --json if it prints numbers), an example for the
/// help text, and the work to do once the command line has been parsed.
CLI::App* add_command(CLI::App& parent, Shared& shared, const std::string& name,
                      const std::string& description, const std::string& example, bool prints_numbers,
                      std::function<void()> work);

/// \throws InputError when the words of a command line name a command or an option that does not exist, with
/// the nearest that do, and when a list has an empty word.
void refuse_unknown_words(const CLI::App& program, const std::vector<std::string>& words);

/// What a word of an option has to be: "a number", "a whole number", "a value".
std::string right_word(const CLI::Option& option);

/// The user's own glass catalogues: --glass-catalogue, and the variable PETZVAL_GLASS_CATALOGUES, which holds
/// paths parted by colons. Searched in this order, then the bundled ones.
struct GlassChoice {
  std::vector<std::string> paths;

  void add_to(CLI::App& command);
  /// \throws InputError with file and line.
  GlassCatalogue read(const Shared& shared) const;
};

/// A lens on the command line: LENS, --state, --set, --substitute, --glass-catalogue.
struct LensChoice {
  std::string path_or_name;
  GlassChoice glasses;
  std::string state;  ///< empty: as the file has it
  std::vector<std::string> settings;
  std::vector<std::string> substitutions;
  bool offers_builds = true;
  std::optional<std::size_t> build;
  std::string grade = "precision";
  /// Of several lenses that are read by turns: what has been substituted in any of them.
  std::shared_ptr<std::set<std::string>> substituted = {};

  /// Adds the positional LENS (or `--lens` when `positional` is false), --state, --set, --substitute and
  /// --build.
  void add_to(CLI::App& command, bool positional = true, bool required = true);
  /// Reads one of several lenses.
  LensChoice for_lens(const std::string& name) const;
  /// \throws InputError if none of them had a glass that was to be substituted.
  void require_all_substituted() const;
  /// Adds --state, --set, --substitute and --build alone.
  void add_settings_to(CLI::App& command);
  /// Of the options that alter a lens, those that were given.
  std::vector<std::string> given_settings() const;
  /// Reads the lens, sets it to its state, applies the settings and builds it; the reader's notes go to
  /// stderr unless quiet.
  Lens read(const Shared& shared) const;
};

// Checks of options, whose messages say what would be right.
CLI::Validator positive_number();
CLI::Validator number_not_negative();
CLI::Validator finite_number();
CLI::Validator whole_number();

/// Prints a note on stderr, unless --quiet: "petzval: note: …".
void note(const Shared& shared, const std::string& message);

/// \throws InputError unless the path ends in one of the extensions (".svg"), whatever their case.
void require_extension(const std::string& path, const std::vector<std::string>& extensions,
                       const std::string& what);

// One function a subcommand, each in its own file.
void add_lens_commands(CLI::App& app, Shared& shared);
void add_glass_commands(CLI::App& app, Shared& shared);
void add_scene_commands(CLI::App& app, Shared& shared);
void add_optics_commands(CLI::App& app, Shared& shared);
void add_image_command(CLI::App& app, Shared& shared);
void add_render_command(CLI::App& app, Shared& shared);
void add_shoot_command(CLI::App& app, Shared& shared);
void add_focus_command(CLI::App& app, Shared& shared);
void add_compare_command(CLI::App& app, Shared& shared);
void add_target_command(CLI::App& app, Shared& shared);
void add_sfr_command(CLI::App& app, Shared& shared);
void add_sense_command(CLI::App& app, Shared& shared);
void add_sensor_commands(CLI::App& app, Shared& shared);
void add_develop_command(CLI::App& app, Shared& shared);
void add_measure_command(CLI::App& app, Shared& shared);
void add_sweep_command(CLI::App& app, Shared& shared);
void add_demo_command(CLI::App& app, Shared& shared);
void add_handout_command(CLI::App& app, Shared& shared);
void add_merge_command(CLI::App& app, Shared& shared);
void add_live_command(CLI::App& app, Shared& shared);
void add_dataset_commands(CLI::App& app, Shared& shared);

}  // namespace petzval::app
