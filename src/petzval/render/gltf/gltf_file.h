// SPDX-License-Identifier: BSD-3-Clause
// A glTF file with its buffers, as the library TinyGLTF reads it.
#pragma once

#include <petzval/render/pbrt/location.h>

// Only the structures: what writes and decodes pictures stays out.
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

#include <span>
#include <string>
#include <vector>

namespace petzval::render {

struct GltfFile {
  tinygltf::Model model;
  std::shared_ptr<const std::string> name;
  std::vector<std::string> files;  ///< this and those that it names, as they were read

  /// The place of an entry. \param path  "materials[2].normalTexture"; empty: the file.
  Location at(std::string path) const;
  /// The bytes of a buffer view. \param path  of the entry that names it. \throws InputError if there is no
  /// such view, or it reaches beyond its buffer.
  std::span<const unsigned char> view(int index, const std::string& path) const;
  /// An entry of a list. \param what  "materials". \throws InputError if it is not there.
  template <class Entry>
  const Entry& entry(const std::vector<Entry>& list, int index, const char* what,
                     const std::string& path) const {
    if (index < 0 || static_cast<std::size_t>(index) >= list.size())
      refuse_index(what, index, list.size(), path);
    return list[static_cast<std::size_t>(index)];
  }

 private:
  [[noreturn]] void refuse_index(const char* what, int index, std::size_t count,
                                 const std::string& path) const;
};

/// Reads JSON or a binary glTF. Buffers are data: URIs, the binary part, or files in the folder of `path`;
/// pictures stay encoded in Image::image, or in their buffer views. \throws InputError.
GltfFile parse_gltf(const std::string& bytes, const std::string& path);

}  // namespace petzval::render
