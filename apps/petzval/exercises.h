// SPDX-License-Identifier: BSD-3-Clause
// Exercises for a course in optics: a question, and commands of this program that show the answer.
#pragma once

#include <string>
#include <vector>

namespace petzval::app {

/// A command, and what it makes.
struct ExerciseStep {
  enum class Makes { drawing, plot, picture, lens };
  Makes makes = Makes::picture;
  std::string words;    ///< without "petzval", the output and --quiet
  std::string caption;  ///< what to see; may be empty
};

struct Exercise {
  std::string name, title, question;
  std::vector<ExerciseStep> steps;  ///< a drawing, a plot, two to four pictures, and lenses that they need
};

/// All of them, in the order of a course.
const std::vector<Exercise>& exercises();

/// By its name. \throws InputError for a name that there is not, naming those that there are.
const Exercise& exercise(const std::string& name);

/// "coma-2.png": what the step before the n-th writes.
std::string output_of(const Exercise& exercise, std::size_t step);

/// The command line of a step, as somebody would type it.
std::string command_line(const Exercise& exercise, std::size_t step);

}  // namespace petzval::app
