// SPDX-License-Identifier: BSD-3-Clause
// What glTF files add to glTF.
#pragma once

#include <petzval/render/gltf/gltf_file.h>
#include <petzval/render/pbrt/scene_description.h>

#include <initializer_list>
#include <optional>

namespace petzval::render {

/// Reports every extension of an entry that is not among the known ones. \param path  of the entry.
void report_gltf_extensions(const GltfFile& file, const tinygltf::ExtensionMap& extensions,
                            const std::string& path, std::initializer_list<const char*> known,
                            Unsupported& unsupported);

/// The members of one extension of one entry. Asking for one marks it as known, so that the rest can be told.
class GltfExtension {
 public:
  /// \param path  of the entry that has the extensions.
  GltfExtension(const GltfFile& file, const tinygltf::ExtensionMap& extensions, const char* name,
                const std::string& path);

  bool is_there() const { return members_ != nullptr; }
  const std::string& path() const { return path_; }
  bool has(const char* member) const { return find(member) != nullptr; }
  /// \throws InputError unless it is a number from `least` to `most`, or absent.
  double number(const char* member, double otherwise, double least, double most);
  int index(const char* member);                                                   ///< −1: absent
  std::vector<double> numbers(const char* member, std::vector<double> otherwise);  ///< as many as these
  tinygltf::TextureInfo texture(const char* member);                               ///< index −1: absent
  /// Reports the members that nobody asked for.
  void report_rest(Unsupported& unsupported) const;

 private:
  const tinygltf::Value* find(const char* member) const;
  const tinygltf::Value* ask(const char* member);

  const GltfFile& file_;
  const tinygltf::Value* members_ = nullptr;
  std::string path_;
  std::vector<std::string> asked_;
};

}  // namespace petzval::render
