// SPDX-License-Identifier: BSD-3-Clause
// Polygon files (G. Turk's PLY format): vertices and faces in text or binary.
#include <fmt/format.h>
#include <petzval/base/stop.h>
#include <petzval/base/whole_file.h>
#include <petzval/render/pbrt/parameter_reader.h>
#include <petzval/render/shapes/triangle_mesh.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <sstream>

namespace petzval::render {

namespace {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  std::optional<PlyType> count;  ///< of a list
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
};

enum class PlyFormat { ascii, little, big };

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::size_t end = 0;  ///< first byte after the header
  int lines = 0;
};

std::optional<PlyType> ply_type(const std::string& name) {
  if (name == "char" || name == "int8") return PlyType::int8;
  if (name == "uchar" || name == "uint8") return PlyType::uint8;
  if (name == "short" || name == "int16") return PlyType::int16;
  if (name == "ushort" || name == "uint16") return PlyType::uint16;
  if (name == "int" || name == "int32") return PlyType::int32;
  if (name == "uint" || name == "uint32") return PlyType::uint32;
  if (name == "float" || name == "float32") return PlyType::float32;
  if (name == "double" || name == "float64") return PlyType::float64;
  return {};
}

std::size_t bytes_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      return 8;
  }
  return 8;
}

PlyType required_type(const std::string& name, const std::string& path, int line) {
  const std::optional<PlyType> type = ply_type(name);
  if (!type) throw InputError(path, line, fmt::format("\"{}\" is no type of PLY", name.substr(0, 40)));
  return *type;
}

/// One line of the header; returns false at its end.
bool read_header_line(const std::string& text, const std::string& path, PlyHeader& header) {
  std::istringstream words(text);
  std::string word, name, type;
  words >> word;
  if (word == "end_header") return false;
  if (word == "format") {
    words >> name;
    if (name == "binary_little_endian")
      header.format = PlyFormat::little;
    else if (name == "binary_big_endian")
      header.format = PlyFormat::big;
    else if (name != "ascii")
      throw InputError(path, header.lines, fmt::format("the format \"{}\" is not known", name.substr(0, 40)));
  } else if (word == "element") {
    PlyElement element;
    if (!(words >> element.name >> element.count))
      throw InputError(path, header.lines, "element NAME COUNT would be right");
    header.elements.push_back(std::move(element));
  } else if (word == "property") {
    if (header.elements.empty()) throw InputError(path, header.lines, "a property before any element");
    PlyProperty property;
    words >> type;
    if (type == "list") {
      std::string count;
      words >> count >> type;
      property.count = required_type(count, path, header.lines);
    }
    property.type = required_type(type, path, header.lines);
    if (!(words >> property.name)) throw InputError(path, header.lines, "a property without a name");
    header.elements.back().properties.push_back(std::move(property));
  }
  return true;  // comments and obj_info say nothing
}

PlyHeader read_header(std::string_view bytes, const std::string& path) {
  PlyHeader header;
  for (std::size_t at = 0;;) {
    const std::size_t end = bytes.find('\n', at);
    if (end == std::string_view::npos) throw InputError(path, "is no PLY file: its header does not end");
    std::string line(bytes.substr(at, end - at));
    if (!line.empty() && line.back() == '\r') line.pop_back();
    at = end + 1;
    if (++header.lines == 1) {
      if (line != "ply") throw InputError(path, "is no PLY file: it does not begin with \"ply\"");
      continue;
    }
    if (!read_header_line(line, path, header)) {
      header.end = at;
      return header;
    }
  }
}

/// Takes one number after the other from the body of the file.
class PlyBody {
 public:
  PlyBody(std::string_view bytes, const PlyHeader& header, const std::string& path)
      : bytes_(bytes.substr(header.end)), format_(header.format), path_(path), line_(header.lines + 1) {}

  double number(PlyType type) { return format_ == PlyFormat::ascii ? word() : binary(type); }
  std::size_t left() const { return bytes_.size() - at_; }
  /// Whether to go on, now and then.
  static void ask(std::size_t element) {
    if (element % 4096 == 0) check_stop();
  }

 private:
  double word() {
    while (at_ < bytes_.size() && std::isspace(static_cast<unsigned char>(bytes_[at_])))
      if (bytes_[at_++] == '\n') ++line_;
    const std::size_t start = at_;
    while (at_ < bytes_.size() && !std::isspace(static_cast<unsigned char>(bytes_[at_]))) ++at_;
    if (start == at_) throw InputError(path_, line_, "the file ends early");
    const std::optional<double> number = parse_scene_number(bytes_.substr(start, at_ - start));
    if (!number) throw InputError(path_, line_, "a number would be right here");
    return *number;
  }

  template <class T>
  T value() {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes_.data() + at_, sizeof(T));
    if ((format_ == PlyFormat::big) == (std::endian::native == std::endian::little))
      std::reverse(raw.begin(), raw.end());
    at_ += sizeof(T);
    return std::bit_cast<T>(raw);
  }

  double binary(PlyType type) {
    if (left() < bytes_of(type)) throw InputError(path_, "ends early: it is truncated");
    switch (type) {
      case PlyType::int8:
        return value<std::int8_t>();
      case PlyType::uint8:
        return value<std::uint8_t>();
      case PlyType::int16:
        return value<std::int16_t>();
      case PlyType::uint16:
        return value<std::uint16_t>();
      case PlyType::int32:
        return value<std::int32_t>();
      case PlyType::uint32:
        return value<std::uint32_t>();
      case PlyType::float32:
        return static_cast<double>(value<float>());
      case PlyType::float64:
        return value<double>();
    }
    return 0;
  }

  std::string_view bytes_;
  PlyFormat format_;
  std::string path_;
  std::size_t at_ = 0;
  int line_;
};

/// Every element takes at least this many bytes of the file, so that no count is believed before it could be
/// true.
std::size_t least_bytes(const PlyElement& element, PlyFormat format) {
  std::size_t bytes = 0;
  for (const PlyProperty& property : element.properties)
    bytes += format == PlyFormat::ascii ? 2 : bytes_of(property.count ? *property.count : property.type);
  return std::max<std::size_t>(bytes, 1) - (format == PlyFormat::ascii ? 1 : 0);
}

/// Where the value of a vertex property goes: 0-2 position, 3-5 normal, 6-7 texture; −1 nowhere.
int vertex_slot(const std::string& name) {
  static const std::vector<std::vector<std::string>> names{{"x"},
                                                           {"y"},
                                                           {"z"},
                                                           {"nx"},
                                                           {"ny"},
                                                           {"nz"},
                                                           {"u", "s", "texture_u", "texture_s"},
                                                           {"v", "t", "texture_v", "texture_t"}};
  for (std::size_t slot = 0; slot < names.size(); ++slot)
    for (const std::string& each : names[slot])
      if (each == name) return static_cast<int>(slot);
  return -1;
}

void read_vertices(const PlyElement& element, PlyBody& body, const std::string& path, TriangleMesh& mesh) {
  std::array<bool, 8> there{};
  std::vector<int> slots;
  for (const PlyProperty& property : element.properties) {
    slots.push_back(property.count ? -1 : vertex_slot(property.name));
    if (slots.back() >= 0) there[static_cast<std::size_t>(slots.back())] = true;
  }
  if (!there[0] || !there[1] || !there[2]) throw InputError(path, "has vertices without x, y and z");
  const bool normals = there[3] && there[4] && there[5], uvs = there[6] && there[7];
  for (std::size_t i = 0; i < element.count; ++i) {
    body.ask(i);
    std::array<float, 8> values{};
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      const double count = property.count ? body.number(*property.count) : 1;
      for (double k = 0; k < count; ++k) {
        const double value = body.number(property.type);
        if (slots[p] >= 0) values[static_cast<std::size_t>(slots[p])] = static_cast<float>(value);
      }
    }
    mesh.positions.push_back({values[0], values[1], values[2]});
    if (normals) mesh.normals.push_back({values[3], values[4], values[5]});
    if (uvs) mesh.uvs.push_back({values[6], values[7]});
  }
}

void add_face(const std::vector<std::uint32_t>& corners, const std::string& path, std::size_t face,
              TriangleMesh& mesh) {
  if (corners.size() != 3 && corners.size() != 4)
    throw InputError(path,
                     fmt::format("face {} has {} corners; 3 or 4 would be right", face, corners.size()));
  mesh.triangles.push_back({corners[0], corners[1], corners[2]});
  if (corners.size() == 4) mesh.triangles.push_back({corners[0], corners[2], corners[3]});
}

void read_faces(const PlyElement& element, PlyBody& body, const std::string& path, TriangleMesh& mesh) {
  std::vector<std::uint32_t> corners;
  for (std::size_t i = 0; i < element.count; ++i) {
    body.ask(i);
    corners.clear();
    for (const PlyProperty& property : element.properties) {
      if (!property.count) {
        body.number(property.type);
        continue;
      }
      const bool wanted = property.name == "vertex_indices" || property.name == "vertex_index";
      const double count = body.number(*property.count);
      if (!(count >= 0 && count <= 1e6))
        throw InputError(path, fmt::format("face {} has {} corners; 3 or 4 would be right", i, count));
      for (double k = 0; k < count; ++k) {
        const double value = body.number(property.type);
        if (!wanted) continue;
        if (!(value >= 0 && value < 4294967295.0))
          throw InputError(path, fmt::format("face {} names vertex {}", i, value));
        corners.push_back(static_cast<std::uint32_t>(value));
      }
    }
    add_face(corners, path, i, mesh);
  }
}

void skip_element(const PlyElement& element, PlyBody& body) {
  for (std::size_t i = 0; i < element.count; ++i) {
    body.ask(i);
    for (const PlyProperty& property : element.properties) {
      const double count = property.count ? body.number(*property.count) : 1;
      for (double k = 0; k < count; ++k) body.number(property.type);
    }
  }
}

}  // namespace

TriangleMesh read_ply(const std::string& path) {
  return parse_ply(read_whole_file(path), path);
}

TriangleMesh parse_ply(std::string_view bytes, const std::string& path) {
  const PlyHeader header = read_header(bytes, path);
  PlyBody body(bytes, header, path);
  TriangleMesh mesh;
  for (const PlyElement& element : header.elements) {
    if (element.count > 0 &&
        (element.properties.empty() || element.count > body.left() / least_bytes(element, header.format) + 1))
      throw InputError(path, fmt::format("says that it has {} of \"{}\", more than it has room for",
                                         element.count, element.name));
    if (element.name == "vertex")
      read_vertices(element, body, path, mesh);
    else if (element.name == "face")
      read_faces(element, body, path, mesh);
    else
      skip_element(element, body);
  }
  if (mesh.triangles.empty()) throw InputError(path, "has no faces");
  try {
    mesh.validate();
  } catch (const InputError& error) {
    throw InputError(path, error.what());
  }
  return mesh;
}

}  // namespace petzval::render
