// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/whole_file.h>
#include <petzval/render/pbrt/parameter_reader.h>
#include <petzval/render/pbrt/scene_description.h>

#include <algorithm>
#include <filesystem>
#include <functional>

namespace petzval::render {

namespace {

constexpr std::size_t deepest_include = 64;

/// What AttributeBegin saves and AttributeEnd brings back.
struct GraphicsState {
  Transform world_from_object;  ///< pbrt's current transformation matrix
  bool reverse_orientation = false;
  int material = 0, area_light = -1;
  std::map<std::string, std::vector<Parameter>> defaults;  ///< of Attribute "shape" …, by target
};

/// Follows the directives of a scene file and writes down what they say.
class SceneReader {
 public:
  SceneReader(SceneDescription& scene, Unsupported& unsupported) : scene_(scene), unsupported_(unsupported) {}

  void read_file(const std::string& path, const Location* included_from);
  void read_text(const std::string& text, const std::string& file);
  void finish();

 private:
  struct Saved {
    GraphicsState state;
    const char* ended_by;  ///< "AttributeEnd"
    Location at;
  };
  using Handler = std::function<void(Tokens&, const Location&)>;

  void follow(Tokens& tokens);
  bool follow_transform(const std::string& word, Tokens& tokens, const Location& at);
  bool follow_block(const std::string& word, Tokens& tokens, const Location& at);
  bool follow_option(const std::string& word, Tokens& tokens, const Location& at);
  bool follow_world(const std::string& word, Tokens& tokens, const Location& at);
  [[noreturn]] void refuse_unknown(const std::string& word, const Location& at);

  void include(Tokens& tokens, const Location& at);
  void camera(Tokens& tokens, const Location& at);
  void begin_object(Tokens& tokens, const Location& at);
  void place_object(Tokens& tokens, const Location& at);
  void texture(Tokens& tokens, const Location& at);
  void named_material(Tokens& tokens, const Location& at);
  void shape(Tokens& tokens, const Location& at);
  void attribute(Tokens& tokens, const Location& at);
  void save(const char* ended_by, const Location& at) { saved_.push_back({state_, ended_by, at}); }
  void restore(const std::string& word, const Location& at);

  std::string quoted(Tokens& tokens, const Location& at, const char* what);
  std::vector<double> numbers(Tokens& tokens, const Location& at, std::size_t count);
  Entity entity(Tokens& tokens, const Location& at, const char* what, const char* defaults = "");
  void transform(const Location& at, const std::function<Transform()>& make);
  void set(const Location& at, const std::function<Transform()>& make);

  SceneDescription& scene_;
  Unsupported& unsupported_;
  GraphicsState state_;
  std::vector<Saved> saved_;
  std::vector<std::string> open_files_;
  std::map<std::string, Transform> coordinate_systems_;  ///< world (or camera) from the named system
  std::map<std::string, int> objects_;
  int open_object_ = -1;
  Location object_at_;
  bool in_world_ = false;
};

void SceneReader::read_file(const std::string& path, const Location* included_from) {
  std::error_code none;
  const std::string canonical = std::filesystem::weakly_canonical(path, none).string();
  if (std::find(open_files_.begin(), open_files_.end(), canonical) != open_files_.end())
    throw scene_error(*included_from,
                      fmt::format("{} includes itself: {}", path, fmt::join(open_files_, " → ")));
  if (open_files_.size() >= deepest_include)
    throw scene_error(*included_from, fmt::format("files are included more than {} deep", deepest_include));
  std::string text;
  try {
    text = read_whole_file(path);
  } catch (const InputError& error) {
    if (included_from) throw scene_error(*included_from, error.what());
    throw;
  }
  open_files_.push_back(canonical);
  scene_.files.push_back(path);
  read_text(text, path);
  open_files_.pop_back();
}

void SceneReader::read_text(const std::string& text, const std::string& file) {
  Tokens tokens(text, std::make_shared<const std::string>(file));
  follow(tokens);
}

void SceneReader::follow(Tokens& tokens) {
  while (const std::optional<Token> token = tokens.next()) {
    const Location at = tokens.location(*token);
    if (token->kind != Token::Kind::word)
      throw scene_error(at, fmt::format("{} stands where a directive would be right", token->text));
    const std::string word(token->text);
    if (!follow_transform(word, tokens, at) && !follow_block(word, tokens, at) &&
        !follow_option(word, tokens, at) && !follow_world(word, tokens, at))
      refuse_unknown(word, at);
  }
}

bool SceneReader::follow_transform(const std::string& word, Tokens& tokens, const Location& at) {
  if (word == "Identity") {
    state_.world_from_object = Transform();
  } else if (word == "Translate") {
    const auto v = numbers(tokens, at, 3);
    transform(at, [&] { return Transform::translation({v[0], v[1], v[2]}); });
  } else if (word == "Scale") {
    const auto v = numbers(tokens, at, 3);
    transform(at, [&] { return Transform::scaling({v[0], v[1], v[2]}); });
  } else if (word == "Rotate") {
    const auto v = numbers(tokens, at, 4);
    transform(at, [&] { return Transform::rotation(v[0], {v[1], v[2], v[3]}); });
  } else if (word == "LookAt") {
    const auto v = numbers(tokens, at, 9);
    transform(at, [&] {
      return Transform::look_at({v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]});
    });
  } else if (word == "Transform" || word == "ConcatTransform") {
    const auto v = numbers(tokens, at, 16);
    Matrix4 m;
    for (std::size_t i = 0; i < 16; ++i) m[i % 4][i / 4] = v[i];  // columns first in the file
    if (word == "Transform")
      set(at, [&] { return Transform(m); });
    else
      transform(at, [&] { return Transform(m); });
  } else if (word == "CoordinateSystem") {
    coordinate_systems_[quoted(tokens, at, "name")] = state_.world_from_object;
  } else if (word == "CoordSysTransform") {
    const std::string name = quoted(tokens, at, "name");
    const auto found = coordinate_systems_.find(name);
    if (found == coordinate_systems_.end())
      throw scene_error(
          at, fmt::format("there is no coordinate system \"{}\"; CoordinateSystem names one", name));
    state_.world_from_object = found->second;
  } else {
    return false;
  }
  return true;
}

bool SceneReader::follow_block(const std::string& word, Tokens& tokens, const Location& at) {
  if (word == "AttributeBegin")
    save("AttributeEnd", at);
  else if (word == "TransformBegin")
    save("TransformEnd", at);
  else if (word == "AttributeEnd" || word == "TransformEnd")
    restore(word, at);
  else if (word == "ObjectBegin")
    begin_object(tokens, at);
  else if (word == "ObjectEnd") {
    if (open_object_ < 0) throw scene_error(at, "ObjectEnd without ObjectBegin");
    restore(word, at);
    open_object_ = -1;
  } else if (word == "ObjectInstance")
    place_object(tokens, at);
  else if (word == "Include" || word == "Import")
    include(tokens, at);
  else if (word == "WorldBegin") {
    if (in_world_) throw scene_error(at, "a second WorldBegin");
    in_world_ = true;
    state_.world_from_object = Transform();
    coordinate_systems_["world"] = Transform();
  } else
    return false;
  return true;
}

bool SceneReader::follow_option(const std::string& word, Tokens& tokens, const Location& at) {
  if (word == "Camera")
    camera(tokens, at);
  else if (word == "Film")
    scene_.film = entity(tokens, at, "film");
  else if (word == "Sampler")
    scene_.sampler = entity(tokens, at, "sampler");
  else if (word == "Integrator")
    scene_.integrator = entity(tokens, at, "integrator");
  else if (word == "PixelFilter")
    scene_.pixel_filter = entity(tokens, at, "filter");
  else if (word == "Accelerator")
    entity(tokens, at, "accelerator");  // rays meet what they meet, whatever finds it
  else if (word == "ColorSpace") {
    const std::string name = quoted(tokens, at, "colour space");
    if (name != "srgb") unsupported_.report(at, fmt::format("ColorSpace \"{}\"", name));
  } else if (word == "Option") {
    const Parameters parameters = read_parameters(tokens, at);
    for (const Parameter* parameter : parameters.unused())
      if (parameter->name != "seed" && parameter->name != "disablewavelengthjitter")
        unsupported_.report(parameter->at, fmt::format("Option \"{}\"", parameter->name));
  } else
    return false;
  return true;
}

bool SceneReader::follow_world(const std::string& word, Tokens& tokens, const Location& at) {
  if (word == "Shape")
    shape(tokens, at);
  else if (word == "Material") {
    scene_.materials.push_back(entity(tokens, at, "material", "material"));
    state_.material = static_cast<int>(scene_.materials.size()) - 1;
  } else if (word == "MakeNamedMaterial") {
    named_material(tokens, at);
  } else if (word == "NamedMaterial") {
    const std::string name = quoted(tokens, at, "material");
    const auto found = scene_.named_materials.find(name);
    if (found == scene_.named_materials.end())
      throw scene_error(at, fmt::format("there is no material \"{}\"; MakeNamedMaterial makes one", name));
    state_.material = found->second;
  } else if (word == "Texture")
    texture(tokens, at);
  else if (word == "LightSource")
    scene_.lights.push_back({entity(tokens, at, "light", "light"), state_.world_from_object});
  else if (word == "AreaLightSource") {
    scene_.area_lights.push_back(entity(tokens, at, "area light", "light"));
    state_.area_light = static_cast<int>(scene_.area_lights.size()) - 1;
  } else if (word == "ReverseOrientation")
    state_.reverse_orientation = !state_.reverse_orientation;
  else if (word == "Attribute")
    attribute(tokens, at);
  else if (word == "MakeNamedMedium") {
    quoted(tokens, at, "medium");
    read_parameters(tokens, at);
    unsupported_.report(at, "a participating medium");
  } else if (word == "MediumInterface") {
    std::string inside = quoted(tokens, at, "medium"), outside;
    if (tokens.peek() && tokens.peek()->kind == Token::Kind::quoted) outside = quoted(tokens, at, "medium");
    if (!inside.empty() || !outside.empty()) unsupported_.report(at, "a participating medium");
  } else if (word == "ActiveTransform" || word == "TransformTimes") {
    while (tokens.peek() && tokens.peek()->kind == Token::Kind::word &&
           (parse_scene_number(tokens.peek()->text) || tokens.peek()->text.ends_with("Time") ||
            tokens.peek()->text == "All"))
      tokens.next();
    unsupported_.report(at, "motion");
  } else
    return false;
  return true;
}

void SceneReader::refuse_unknown(const std::string& word, const Location& at) {
  static const std::vector<std::string> known{"Identity",
                                              "Translate",
                                              "Scale",
                                              "Rotate",
                                              "LookAt",
                                              "Transform",
                                              "CoordinateSystem",
                                              "CoordSysTransform",
                                              "ConcatTransform",
                                              "AttributeBegin",
                                              "AttributeEnd",
                                              "ObjectBegin",
                                              "ObjectEnd",
                                              "ObjectInstance",
                                              "Include",
                                              "Import",
                                              "WorldBegin",
                                              "Camera",
                                              "Film",
                                              "Sampler",
                                              "Integrator",
                                              "PixelFilter",
                                              "Accelerator",
                                              "ColorSpace",
                                              "Option",
                                              "Shape",
                                              "Material",
                                              "MakeNamedMaterial",
                                              "NamedMaterial",
                                              "Texture",
                                              "LightSource",
                                              "AreaLightSource",
                                              "ReverseOrientation",
                                              "Attribute",
                                              "MakeNamedMedium"};
  throw scene_error(at,
                    fmt::format("\"{}\" is no directive of pbrt-v4; the nearest are {}", word.substr(0, 80),
                                fmt::join(nearest_names(word.substr(0, 80), known), ", ")));
}

std::string SceneReader::quoted(Tokens& tokens, const Location& at, const char* what) {
  const std::optional<Token> token = tokens.next();
  if (!token || token->kind != Token::Kind::quoted)
    throw scene_error(token ? tokens.location(*token) : at,
                      fmt::format("the {} in quotes would be right here", what));
  return std::string(token->text);
}

std::vector<double> SceneReader::numbers(Tokens& tokens, const Location& at, std::size_t count) {
  std::vector<double> result;
  const bool bracketed = tokens.peek() && tokens.peek()->kind == Token::Kind::open;
  if (bracketed) tokens.next();
  while (result.size() < count) {
    const std::optional<Token> token = tokens.next();
    const std::optional<double> number =
        token && token->kind == Token::Kind::word ? parse_scene_number(token->text) : std::nullopt;
    if (!number)
      throw scene_error(token ? tokens.location(*token) : at,
                        fmt::format("{} numbers would be right here, found {}", count, result.size()));
    result.push_back(*number);
  }
  if (bracketed) {
    const std::optional<Token> token = tokens.next();
    if (!token || token->kind != Token::Kind::close)
      throw scene_error(token ? tokens.location(*token) : at,
                        fmt::format("a ] after {} numbers would be right", count));
  }
  return result;
}

Entity SceneReader::entity(Tokens& tokens, const Location& at, const char* what, const char* defaults) {
  Entity result;
  result.type = quoted(tokens, at, what);
  result.parameters = read_parameters(tokens, at);
  const auto found = state_.defaults.find(defaults);
  if (found != state_.defaults.end())
    for (const Parameter& parameter : found->second) result.parameters.add(parameter);
  return result;
}

void SceneReader::transform(const Location& at, const std::function<Transform()>& make) {
  set(at, [&] { return state_.world_from_object * make(); });
}

void SceneReader::set(const Location& at, const std::function<Transform()>& make) {
  try {
    state_.world_from_object = make();
  } catch (const InputError& error) {
    throw scene_error(at, error.what());
  }
}

void SceneReader::restore(const std::string& word, const Location& at) {
  if (saved_.empty()) throw scene_error(at, fmt::format("{} without a beginning", word));
  if (word != saved_.back().ended_by)
    throw scene_error(at, fmt::format("{} where {} would be right, for the block begun at {}", word,
                                      saved_.back().ended_by, saved_.back().at.text()));
  if (word == "TransformEnd")
    state_.world_from_object = saved_.back().state.world_from_object;
  else
    state_ = std::move(saved_.back().state);
  saved_.pop_back();
}

void SceneReader::include(Tokens& tokens, const Location& at) {
  const std::string path = resolved_path(at, quoted(tokens, at, "file"));
  read_file(path, &at);
}

void SceneReader::camera(Tokens& tokens, const Location& at) {
  scene_.camera = entity(tokens, at, "camera");
  scene_.camera_from_world = state_.world_from_object;
  coordinate_systems_["camera"] = state_.world_from_object.inverse();
}

void SceneReader::begin_object(Tokens& tokens, const Location& at) {
  if (open_object_ >= 0)
    throw scene_error(at, fmt::format("ObjectBegin inside of the object begun at {}", object_at_.text()));
  const std::string name = quoted(tokens, at, "object's name");
  if (objects_.count(name)) throw scene_error(at, fmt::format("there is an object \"{}\" already", name));
  open_object_ = static_cast<int>(scene_.objects.size());
  objects_[name] = open_object_;
  object_at_ = at;
  scene_.objects.emplace_back();
  save("ObjectEnd", at);
}

void SceneReader::place_object(Tokens& tokens, const Location& at) {
  const std::string name = quoted(tokens, at, "object's name");
  const auto found = objects_.find(name);
  if (found == objects_.end())
    throw scene_error(at, fmt::format("there is no object \"{}\"; ObjectBegin makes one", name));
  if (open_object_ >= 0) throw scene_error(at, "ObjectInstance inside of an object");
  scene_.instances.push_back({found->second, state_.world_from_object, at});
}

void SceneReader::texture(Tokens& tokens, const Location& at) {
  TextureDescription texture;
  texture.name = quoted(tokens, at, "texture's name");
  texture.value_type = quoted(tokens, at, "texture's type, float or spectrum,");
  if (texture.value_type != "float" && texture.value_type != "spectrum")
    throw scene_error(at, fmt::format("a texture holds float or spectrum, not \"{}\"", texture.value_type));
  texture.entity = entity(tokens, at, "texture's class", "texture");
  texture.world_from_texture = state_.world_from_object;
  scene_.textures.push_back(std::move(texture));
}

void SceneReader::named_material(Tokens& tokens, const Location& at) {
  const std::string name = quoted(tokens, at, "material's name");
  Entity material;
  material.parameters = read_parameters(tokens, at);
  material.type = material.parameters.string("type", "");
  if (material.type.empty())
    throw scene_error(at, fmt::format("material \"{}\" has no \"string type\"", name));
  scene_.materials.push_back(std::move(material));
  scene_.named_materials[name] = static_cast<int>(scene_.materials.size()) - 1;
}

void SceneReader::shape(Tokens& tokens, const Location& at) {
  if (!in_world_) throw scene_error(at, "a Shape before WorldBegin");
  ShapeDescription shape{entity(tokens, at, "shape", "shape"), state_.world_from_object,
                         state_.reverse_orientation, state_.material, state_.area_light};
  if (open_object_ < 0) return scene_.shapes.push_back(std::move(shape));
  if (shape.area_light >= 0) {
    unsupported_.report(at, "a light in an object that is placed with ObjectInstance");
    shape.area_light = -1;
  }
  scene_.objects[static_cast<std::size_t>(open_object_)].push_back(std::move(shape));
}

void SceneReader::attribute(Tokens& tokens, const Location& at) {
  const std::string target = quoted(tokens, at, "target (shape, light, material, texture)");
  std::vector<Parameter>& defaults = state_.defaults[target];
  const Parameters given = read_parameters(tokens, at);
  for (Parameter parameter : given.list()) {
    parameter.used = true;  // what it does not apply to is no fault
    defaults.insert(defaults.begin(), std::move(parameter));
  }
}

void SceneReader::finish() {
  if (!saved_.empty())
    throw scene_error(saved_.back().at, fmt::format("this block is not ended by {}", saved_.back().ended_by));
  if (!in_world_) throw InputError(scene_.file, "has no WorldBegin; what the scene holds stands after it");
}

}  // namespace

void Unsupported::report(const Location& at, const std::string& what) {
  if (!collect_) throw scene_error(at, what + " is not supported (--list-unsupported shows all such things)");
  list_.push_back({at, what});
}

void Unsupported::report_unused(const Parameters& parameters, const std::string& owner) {
  for (const Parameter* parameter : parameters.unused())
    report(parameter->at,
           fmt::format("the parameter \"{} {}\" of {}", parameter->type, parameter->name, owner));
}

SceneDescription read_scene_description(const std::string& path, Unsupported& unsupported) {
  SceneDescription scene;
  scene.file = path;
  scene.materials.push_back({"diffuse", {}});
  SceneReader reader(scene, unsupported);
  reader.read_file(path, nullptr);
  reader.finish();
  return scene;
}

SceneDescription parse_scene_description(const std::string& text, const std::string& file,
                                         Unsupported& unsupported) {
  SceneDescription scene;
  scene.file = file;
  scene.materials.push_back({"diffuse", {}});
  SceneReader reader(scene, unsupported);
  reader.read_text(text, file);
  reader.finish();
  return scene;
}

std::string resolved_path(const Location& at, const std::string& name) {
  const std::filesystem::path path(name);
  if (path.is_absolute() || !at.file) return name;
  return (std::filesystem::path(*at.file).parent_path() / path).string();
}

}  // namespace petzval::render
