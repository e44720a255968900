// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/context.h>
#include <petzval/base/whole_file.h>
#include <petzval/render/gltf/gltf_file.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

// TinyGLTF 2.7 trusts what it reads in a few places. Those are looked at before it is called: chunks of a
// binary file that reach beyond its end, and JSON so deeply nested that its recursion would not end well. It
// looks for files in the working folder, too, and takes pictures from buffer views without a look at their
// length: its files and pictures come from here.

namespace petzval::render {

namespace {

namespace fs = std::filesystem;

constexpr int deepest_json = 100;
constexpr std::size_t binary_header = 12, chunk_header = 8;

/// Reads files for TinyGLTF, but none outside of a folder.
struct Files {
  fs::path folder;
  std::vector<std::string> read;
  std::string refusal;  ///< the first
};

/// Why a name is not read; empty if it may be.
std::string refusal_of(const std::string& name) {
  if (name.find(':') != name.npos)
    return fmt::format("\"{}\" is not read; a file in the folder of the scene or base64 data would be right",
                       name.substr(0, 80));
  const fs::path path(name);
  const bool climbs =
      std::any_of(path.begin(), path.end(), [](const fs::path& part) { return part == ".."; });
  if (path.is_absolute() || climbs || name.find('\\') != name.npos)
    return fmt::format("\"{}\" lies outside of the scene's folder, where nothing is read", name);
  return "";
}

bool file_exists(const std::string& path, void* user) {
  Files& files = *static_cast<Files*>(user);
  const std::string folder = files.folder.string() + "/";
  if (path.rfind(folder, 0) != 0) return false;  // TinyGLTF tries the working folder after this one
  const std::string name = path.substr(folder.size());
  std::string refusal = refusal_of(name);
  std::error_code none;
  const bool found = refusal.empty() && fs::is_regular_file(path, none);
  if (refusal.empty() && !found) refusal = fmt::format("there is no file \"{}\" beside the scene", name);
  if (!found && files.refusal.empty()) files.refusal = refusal;
  return found;
}

std::string same_path(const std::string& path, void*) {
  return path;
}

bool read_file(std::vector<unsigned char>* out, std::string* error, const std::string& path, void* user) {
  Files& files = *static_cast<Files*>(user);
  try {
    const std::string bytes = read_whole_file(path);
    out->assign(bytes.begin(), bytes.end());
    files.read.push_back(path);
    return true;
  } catch (const InputError& refused) {
    *error = refused.what();
    if (files.refusal.empty()) files.refusal = refused.what();
    return false;
  }
}

/// Keeps a picture as it is. Those in buffer views are fetched later, when their bounds have been checked.
bool keep_picture(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*) {
  if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
  image->as_is = true;
  return true;
}

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// The JSON of a binary glTF. \throws InputError if its chunks do not fit.
std::string_view json_of_binary(std::string_view bytes, const std::string& path) {
  const auto damaged = [&](const std::string& what) -> InputError {
    return {path, "is no sound binary glTF: " + what};
  };
  if (bytes.size() < binary_header + chunk_header) throw damaged("it ends within its header");
  const std::uint32_t version = little_endian(bytes, 4), length = little_endian(bytes, 8);
  if (version != 2) throw damaged(fmt::format("its version is {}; 2 would be right", version));
  if (length > bytes.size())
    throw damaged(fmt::format("it has {} bytes, and says that it has {}", bytes.size(), length));
  std::string_view json;
  for (std::size_t at = binary_header; at + chunk_header <= length;) {
    const std::size_t size = little_endian(bytes, at);
    if (size > length - at - chunk_header) throw damaged(fmt::format("the chunk at byte {} is cut off", at));
    if (at == binary_header) json = bytes.substr(at + chunk_header, size);
    at += chunk_header + size;
  }
  return json;
}

void check_depth(std::string_view json, const std::string& path) {
  int depth = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_text) {
      if (c == '\\')
        ++i;
      else if (c == '"')
        in_text = false;
      continue;
    }
    if (c == '"') in_text = true;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > deepest_json)
      throw InputError(path, fmt::format("nests its JSON more than {} deep", deepest_json));
  }
}

/// The first line, without what only a programmer wants to know.
std::string first_line(std::string text) {
  text = text.substr(0, text.find('\n'));
  const std::size_t end = text.find("] ");
  if (text.rfind("[json.exception", 0) == 0 && end != text.npos) text = text.substr(end + 2);
  return text.empty() ? "it cannot be read" : text;
}

}  // namespace

Location GltfFile::at(std::string path) const {
  return {name, 0, 0, std::make_shared<const std::string>(std::move(path))};
}

void GltfFile::refuse_index(const char* what, int index, std::size_t count, const std::string& path) const {
  throw scene_error(at(path), fmt::format("names {}[{}]; there are {}, counted from 0", what, index, count));
}

std::span<const unsigned char> GltfFile::view(int index, const std::string& path) const {
  const tinygltf::BufferView& view = entry(model.bufferViews, index, "bufferViews", path);
  const std::string place = fmt::format("bufferViews[{}]", index);
  const std::span<const unsigned char> data = entry(model.buffers, view.buffer, "buffers", place).data;
  if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
    throw scene_error(at(place), fmt::format("{} bytes from byte {} are more than the {} of buffers[{}]",
                                             view.byteLength, view.byteOffset, data.size(), view.buffer));
  return data.subspan(view.byteOffset, view.byteLength);
}

GltfFile parse_gltf(const std::string& bytes, const std::string& path) {
  GltfFile file;
  file.name = std::make_shared<const std::string>(path);
  const bool binary = bytes.rfind("glTF", 0) == 0;
  check_depth(binary ? json_of_binary(bytes, path) : std::string_view(bytes), path);
  if (bytes.size() > std::numeric_limits<unsigned>::max()) throw InputError(path, "has more than 4 GiB");

  std::error_code none;
  Files files{fs::absolute(fs::path(path), none).parent_path().lexically_normal(), {}, ""};
  tinygltf::TinyGLTF reader;
  reader.SetFsCallbacks({file_exists, same_path, read_file, nullptr, &files});
  reader.SetImageLoader(keep_picture, nullptr);
  std::string error, warning;
  const auto size = static_cast<unsigned>(bytes.size());
  bool sound = false;
  try {
    sound = binary ? reader.LoadBinaryFromMemory(&file.model, &error, &warning,
                                                 reinterpret_cast<const unsigned char*>(bytes.data()), size,
                                                 files.folder.string())
                   : reader.LoadASCIIFromString(&file.model, &error, &warning, bytes.data(), size,
                                                files.folder.string());
  } catch (const Cancelled&) {
    throw;
  } catch (const std::exception& thrown) {
    error = thrown.what();
  }
  if (!sound && !files.refusal.empty())
    throw scene_error(file.at(fmt::format("buffers[{}].uri", file.model.buffers.size())), files.refusal);
  if (!sound || !error.empty()) throw scene_error(file.at(""), "is no sound glTF: " + first_line(error));
  file.files = std::move(files.read);
  return file;
}

}  // namespace petzval::render
