// SPDX-License-Identifier: BSD-3-Clause
// Several output files that belong together: they appear all or none.
#pragma once

#include <map>
#include <string>

namespace petzval {

/// Files of one command, written aside under their own names and then moved into place together:
///
///     StagedFiles files;
///     write_irradiance(files.stage("out.exr"), image);
///     write_picture(files.stage("out.png"), image);   // a full disk here leaves no out.exr
///     files.commit();
///
/// Without commit() nothing is left behind and what was there before is untouched. A killed program leaves a
/// hidden folder beside the outputs, never one output without the others.
class StagedFiles {
 public:
  StagedFiles() = default;
  ~StagedFiles();
  StagedFiles(const StagedFiles&) = delete;
  StagedFiles& operator=(const StagedFiles&) = delete;

  /// \returns where to write the file that shall become `path`: the same name in a folder beside it.
  /// \throws InputError as WholeFile's constructor; Failure when that folder cannot be made.
  std::string stage(const std::string& path);

  /// Moves every staged file into place. \throws Failure when one cannot be moved.
  void commit();

 private:
  std::map<std::string, std::string> folders_;  ///< of outputs -> of their staged files
  std::map<std::string, std::string> files_;    ///< output -> staged file
};

/// A message about a staged file as one about the output that it shall become: "…/.petzval-123-0/out.png" is
/// "…/out.png".
std::string with_final_names(std::string message);

}  // namespace petzval
