// SPDX-License-Identifier: BSD-3-Clause
// petzval handout: one exercise on one sheet of paper, made of the commands that it shows.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/progress.h>
#include <petzval/base/scratch_folder.h>
#include <petzval/base/version.h>
#include <petzval/base/whole_file.h>
#include <petzval/report/html.h>

#include <algorithm>
#include <memory>
#include <sstream>

#include "command.h"
#include "exercises.h"
#include "output_option.h"
#include "run_command.h"

namespace petzval::app {

namespace {

struct HandoutCommand {
  std::string exercise, output;
};

/// The words of a command line as they run: what steps write lies in the folder.
std::vector<std::string> words_to_run(const Exercise& exercise, std::size_t step, const ScratchFolder& folder,
                                      const Shared& shared) {
  std::istringstream line(command_line(exercise, step));
  std::vector<std::string> words;
  line.ignore(std::string("petzval ").size());
  for (std::string word; line >> word;) {
    for (std::size_t made = 0; made <= step; ++made)
      if (word == output_of(exercise, made)) word = folder.path() + "/" + word;
    words.push_back(word);
  }
  words.emplace_back("--quiet");
  if (exercise.steps[step].makes == ExerciseStep::Makes::drawing ||
      exercise.steps[step].makes == ExerciseStep::Makes::lens)
    return words;
  words.insert(words.end(), {"--json", "--threads", std::to_string(shared.threads)});
  return words;
}

html::Block step_block(const ExerciseStep& step, const std::string& path) {
  const std::string bytes = read_whole_file(path);
  if (step.makes != ExerciseStep::Makes::picture) return html::figure(html::drawing(bytes), step.caption);
  html::Image image = html::embedded_image(bytes, step.caption);
  // Small pictures are shown as large as a column, pixel by pixel.
  image.pixelated = true;
  constexpr int width = 480;
  image.rows = image.rows * width / image.columns, image.columns = width;
  return html::figure(html::picture(image), step.caption);
}

std::string handout_html(const Exercise& exercise, const Shared& shared) {
  const ScratchFolder folder;
  ProgressBar bar(!shared.quiet);
  std::vector<html::Block> drawings, pictures;
  std::string commands;
  for (std::size_t i = 0; i < exercise.steps.size(); ++i) {
    bar.update(static_cast<double>(i) / static_cast<double>(exercise.steps.size()), exercise.name);
    const CommandOutcome outcome = run_command(words_to_run(exercise, i, folder, shared));
    if (outcome.exit_code != 0)
      throw Failure(fmt::format("{}: {}", command_line(exercise, i), outcome.error));
    commands += command_line(exercise, i) + "\n";
    const ExerciseStep& step = exercise.steps[i];
    if (step.makes == ExerciseStep::Makes::lens) continue;
    (step.makes == ExerciseStep::Makes::picture ? pictures : drawings)
        .push_back(step_block(step, folder.path() + "/" + output_of(exercise, i)));
  }
  html::Page page(exercise.title);
  page.one_sheet();
  page.section("Question").add(html::paragraph(exercise.question));
  page.section("The lens").add(html::side_by_side(drawings));
  page.section("What it does").add(html::side_by_side(pictures));
  page.section("The commands").add(html::listing(commands));
  page.footer(fmt::format("petzval {}, handout {}", version(), exercise.name));
  return page.html();
}

void handout(const HandoutCommand& options, const Shared& shared) {
  if (options.exercise.empty()) {
    for (const Exercise& each : exercises()) fmt::print("{:<22}{}\n", each.name, each.title);
    return;
  }
  const Exercise& chosen = exercise(options.exercise);
  const std::string output = options.output.empty() ? chosen.name + ".html" : options.output;
  require_extension(output, {".html", ".htm"}, "a handout");
  write_whole_file(output, handout_html(chosen, shared));
  if (!shared.quiet) fmt::print("{}: {}\n", output, chosen.title);
}

}  // namespace

void add_handout_command(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<HandoutCommand>();
  CLI::App* command = add_command(app, shared, "handout", "An exercise for a class, on one sheet to print",
                                  "petzval handout distortion -o distortion.html", false,
                                  [=, &shared] { handout(*options, shared); });
  command->add_option("exercise", options->exercise, "Its name; without one, all are listed");
  command->add_option("-o,--output", options->output, "HTML file to write; default: EXERCISE.html")
      ->check(output_file());
}

}  // namespace petzval::app
