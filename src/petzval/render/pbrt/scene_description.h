// SPDX-License-Identifier: BSD-3-Clause
// What a scene file says, in the terms of pbrt-v4, before any of it has been built.
#pragma once

#include <petzval/render/pbrt/parameters.h>
#include <petzval/render/transform.h>

#include <map>
#include <string>
#include <vector>

namespace petzval::render {

struct PictureFile;
struct TriangleMesh;

/// What a scene has and Petzval has not, with its place.
struct Complaint {
  Location at;
  std::string what;
};

/// Where unsupported things are reported to: an error at once, or a list of all of them.
class Unsupported {
 public:
  explicit Unsupported(bool collect = false) : collect_(collect) {}
  /// \throws InputError "<file>:<line>:<column>: <what> is not supported", unless collecting.
  void report(const Location& at, const std::string& what);
  /// Reports every parameter that nobody asked for. \param owner  "Shape \"sphere\"".
  void report_unused(const Parameters& parameters, const std::string& owner);
  const std::vector<Complaint>& list() const { return list_; }

 private:
  bool collect_;
  std::vector<Complaint> list_;
};

struct Entity {
  std::string type;  ///< "perspective", "diffuse", …
  Parameters parameters;

  const Location& location() const { return parameters.location(); }
};

struct TextureDescription {
  std::string name, value_type;  ///< value_type: "float" or "spectrum"
  Entity entity;
  Transform world_from_texture;
  std::shared_ptr<const PictureFile>
      picture{};  ///< of an "imagemap", if it is not a file's name that says it
};

struct LightDescription {
  Entity entity;
  Transform world_from_light;
};

/// What MakeNamedMedium says.
struct MediumDescription {
  std::string name;
  Entity entity;
  Transform world_from_medium;
};

/// The media on the two sides of a surface, or of where the camera stands; into SceneDescription::media, −1:
/// none.
struct MediaDescription {
  int inside = -1, outside = -1;

  bool differ() const { return inside != outside; }
};

struct ShapeDescription {
  Entity entity;
  Transform world_from_object;
  bool reverse_orientation = false;
  int material = 0;                            ///< into SceneDescription::materials
  int area_light = -1;                         ///< into SceneDescription::area_lights; −1: does not shine
  std::shared_ptr<const TriangleMesh> mesh{};  ///< of type "mesh", in the space of the object
  MediaDescription media{};  ///< where both are the same, light stays in the medium that it is in
};

struct InstanceDescription {
  int object = 0;  ///< into SceneDescription::objects
  Transform world_from_instance;
  Location at;
};

struct SceneDescription {
  std::string file;
  std::vector<std::string> files;  ///< this and all that it includes, as they were opened
  std::vector<std::string> notes;  ///< what the reader decided by itself
  Entity film, camera, sampler, integrator, pixel_filter;
  Transform camera_from_world;
  bool moves = false;                        ///< another time would have shown it otherwise
  bool has_camera = true;                    ///< else whoever renders it stands back until it fits
  std::vector<TextureDescription> textures;  ///< a later one of the same name replaces an earlier one
  std::vector<Entity> materials;             ///< the first is pbrt's default, grey diffuse
  std::map<std::string, int> named_materials;
  std::vector<MediumDescription> media;
  int camera_medium = -1;  ///< into media; −1: none
  std::vector<Entity> area_lights;
  std::vector<LightDescription> lights;
  std::vector<ShapeDescription> shapes;
  std::vector<std::vector<ShapeDescription>> objects;
  std::vector<InstanceDescription> instances;
};

/// Reads a scene with everything that it includes. \throws InputError with file, line and column for text
/// that is not a pbrt-v4 scene, a missing or cyclic include, a singular transformation; and through
/// `unsupported`. \param time  in the unit of TransformTimes: what moves (ActiveTransform) stands where it is
/// then.
SceneDescription read_scene_description(const std::string& path, Unsupported& unsupported, double time = 0);
/// The same from text. \param file  for messages, and the folder that relative names start from.
SceneDescription parse_scene_description(const std::string& text, const std::string& file,
                                         Unsupported& unsupported, double time = 0);

/// A file named in a scene: relative to the folder of the file that names it.
std::string resolved_path(const Location& at, const std::string& name);

}  // namespace petzval::render
