// SPDX-License-Identifier: BSD-3-Clause
#include "output_option.h"

#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/scene/scene_file.h>

#include <filesystem>

namespace petzval::app {

namespace fs = std::filesystem;

namespace {

// Names of the marks; they are seen nowhere.
constexpr const char *file_mark = "output file", *entry_mark = "output entry", *folder_mark = "output folder",
                     *either_mark = "output file or folder";

CLI::Validator mark(const char* name, const char* right) {
  const auto complaint = [right](const std::string& word) {
    return word.empty() ? fmt::format("an empty name; {} would be right", right) : std::string();
  };
  return CLI::Validator(complaint, "", name);
}

bool is_file(const std::string& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

/// Whether a path is that of a bundled file of this name.
bool is_bundled(const std::string& path, const std::string& name) {
  if (!is_file(path) || fs::path(path).stem() != name) return false;
  std::error_code ignored;
  const fs::path folder = fs::weakly_canonical(fs::path(path), ignored).parent_path().parent_path();
  try {
    return fs::equivalent(folder, data_directory(), ignored);
  } catch (const InputError&) {  // there are no bundled files
    return false;
  }
}

/// The mark of an option, or nothing.
std::string mark_of(CLI::Option& option) {
  for (const char* name : {file_mark, entry_mark, folder_mark, either_mark}) {
    try {
      option.get_validator(name);
      return name;
    } catch (const CLI::OptionNotFound&) {
    }
  }
  return {};
}

std::string behind_equals(const std::string& word) {
  return word.substr(word.find('=') + 1);
}

bool same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  if (fs::equivalent(a, b, ignored)) return true;
  // Of files that are yet to be made, the names tell.
  const fs::path path_a = fs::weakly_canonical(fs::absolute(a, ignored), ignored),
                 path_b = fs::weakly_canonical(fs::absolute(b, ignored), ignored);
  return !path_a.empty() && path_a == path_b;
}

}  // namespace

CLI::Validator output_file() {
  return mark(file_mark, "the name of a file to write");
}
CLI::Validator output_entry() {
  return mark(entry_mark, "NAME=FILE");
}
CLI::Validator output_folder() {
  return mark(folder_mark, "the name of a folder to write");
}
CLI::Validator output_file_or_folder() {
  return mark(either_mark, "the name of what to write");
}

void refuse_same_files(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const auto& [option, path] = outputs[i];
    for (const NamedFile& input : inputs)
      if ((is_file(path) && is_file(input.path) && same_file(path, input.path)) ||
          is_bundled(path, input.path))
        throw InputError(fmt::format(
            "{} {}: this would overwrite {}, which the command reads; another name would be right", option,
            path, input.path));
    for (std::size_t j = 0; j < i; ++j)
      if (same_file(path, outputs[j].path))
        throw InputError(fmt::format("{} {}: the same file as {} {}; each output needs a name of its own",
                                     option, path, outputs[j].option, outputs[j].path));
  }
}

void require_folder(const std::string& path) {
  std::error_code ignored;
  fs::path at = fs::path(path).lexically_normal();
  if (!at.has_filename()) at = at.parent_path();
  while (!fs::exists(at, ignored) && at.has_parent_path() && at != at.parent_path()) at = at.parent_path();
  if (!fs::exists(at, ignored)) at = ".";
  if (!fs::is_directory(at, ignored))
    throw InputError(path, at == fs::path(path) ? "is no folder; the name of one would be right"
                                                : fmt::format("{} is no folder", at.string()));
  try {
    require_writable((at / fmt::format(".petzval-{}", fs::path(path).filename().string())).string());
  } catch (const Failure&) {
    throw Failure(fmt::format("{}: cannot be made: the folder {} takes no files", path, at.string()));
  }
}

std::vector<std::string> output_options(const CLI::App& command) {
  std::vector<std::string> names;
  for (CLI::Option* option : const_cast<CLI::App&>(command).get_options({}))
    if (option->count() > 0 && !mark_of(*option).empty()) names.push_back(option->get_name());
  return names;
}

namespace {

/// Adds a word that may name a file, and what is read with that.
void add_input(const std::string& option, const std::string& word, std::vector<NamedFile>& inputs) {
  inputs.push_back({option, word});
  const std::string companion = scene_companion(word);
  if (!companion.empty()) inputs.push_back({option, companion});
}

}  // namespace

void check_outputs(const CLI::App& command) {
  std::vector<NamedFile> outputs, inputs;
  std::vector<std::string> files, folders;
  // CLI11 gives validators of options that may be altered only.
  for (CLI::Option* option : const_cast<CLI::App&>(command).get_options({})) {
    const std::string marked = mark_of(*option);
    for (const std::string& word : option->results()) {
      const std::string name = marked == entry_mark ? behind_equals(word) : word;
      if (marked.empty()) {
        add_input(option->get_name(), word, inputs);
        if (word.find('=') != word.npos) add_input(option->get_name(), behind_equals(word), inputs);
      } else if (marked == folder_mark) {
        folders.push_back(name);
      } else {
        outputs.push_back({option->get_name(), name});
        if (marked != either_mark && !name.empty()) files.push_back(name);
      }
    }
  }
  refuse_same_files(outputs, inputs);
  for (const std::string& path : files) require_writable(path);
  for (const std::string& path : folders) require_folder(path);
}

}  // namespace petzval::app
