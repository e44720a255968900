// SPDX-License-Identifier: BSD-3-Clause
// The reader of pbrt scene files, directive by directive: transform_, block_, option_ and
// world_directives.cpp.
#pragma once

#include <petzval/render/pbrt/scene_description.h>
#include <petzval/render/pbrt/tokens.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace petzval::render {

/// pbrt's current transformation matrix, at the two times of TransformTimes.
struct MovingTransform {
  Transform start, end;
};

/// What AttributeBegin saves and AttributeEnd brings back.
struct GraphicsState {
  MovingTransform world_from_object;
  bool start_active = true, end_active = true;  ///< ActiveTransform: which of the two directives alter
  bool reverse_orientation = false;
  int material = 0, area_light = -1;
  MediaDescription media;
  std::map<std::string, std::vector<Parameter>> defaults;  ///< of Attribute "shape" …, by target
};

/// Follows the directives of a scene file and writes down what they say.
class SceneReader {
 public:
  SceneReader(SceneDescription& scene, Unsupported& unsupported, double time)
      : scene_(scene), unsupported_(unsupported), time_(time) {}

  void read_file(const std::string& path, const Location* included_from);
  void read_text(const std::string& text, const std::string& file);
  void finish();

 private:
  struct Saved {
    GraphicsState state;
    const char* ended_by;  ///< "AttributeEnd"
    Location at;
  };

  void follow(Tokens& tokens);
  void active_transform(Tokens& tokens, const Location& at);
  /// The transformation at the time of the scene.
  Transform world_from_object(const Location& at);
  bool follow_transform(const std::string& word, Tokens& tokens, const Location& at);
  bool follow_block(const std::string& word, Tokens& tokens, const Location& at);
  bool follow_option(const std::string& word, Tokens& tokens, const Location& at);
  bool follow_world(const std::string& word, Tokens& tokens, const Location& at);
  /// Directives of pbrt before version 4: what they are now.
  bool follow_old(const std::string& word, Tokens& tokens, const Location& at);
  [[noreturn]] void refuse_unknown(const std::string& word, const Location& at);

  void include(Tokens& tokens, const Location& at);
  void camera(Tokens& tokens, const Location& at);
  void begin_object(Tokens& tokens, const Location& at);
  void place_object(Tokens& tokens, const Location& at);
  void texture(Tokens& tokens, const Location& at);
  void named_material(Tokens& tokens, const Location& at);
  void named_medium(Tokens& tokens, const Location& at);
  /// By name; it may be made later. \param name  empty: none.
  int medium_called(const std::string& name, const Location& at);
  void check_media() const;
  void shape(Tokens& tokens, const Location& at);
  void attribute(Tokens& tokens, const Location& at);
  void save(const char* ended_by, const Location& at) { saved_.push_back({state_, ended_by, at}); }
  void restore(const std::string& word, const Location& at);

  std::string quoted(Tokens& tokens, const Location& at, const char* what);
  std::vector<double> numbers(Tokens& tokens, const Location& at, std::size_t count);
  Entity entity(Tokens& tokens, const Location& at, const char* what, const char* defaults = "");
  Parameters parameters(Tokens& tokens, const Location& at, const char* defaults);
  void transform(const Location& at, const std::function<Transform()>& make);
  void set(const Location& at, const std::function<Transform()>& make);

  SceneDescription& scene_;
  Unsupported& unsupported_;
  GraphicsState state_;
  std::vector<Saved> saved_;
  std::vector<std::string> open_files_;
  std::map<std::string, MovingTransform> coordinate_systems_;  ///< world (or camera) from the named system
  std::map<std::string, int> objects_;
  struct NamedMedium {
    int index;  ///< into SceneDescription::media
    Location at;
    bool made;
  };
  std::map<std::string, NamedMedium> media_;
  int open_object_ = -1;
  Location object_at_;
  double time_, start_time_ = 0, end_time_ = 1;
  bool in_world_ = false;
  bool is_old_ = false;  ///< of pbrt before version 4
};

}  // namespace petzval::render
