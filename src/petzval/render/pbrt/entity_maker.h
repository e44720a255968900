// SPDX-License-Identifier: BSD-3-Clause
// Makes entities as a pbrt file would describe them, for readers of other formats and options.
#pragma once

#include <petzval/render/pbrt/scene_description.h>

#include <array>

namespace petzval::render {

/// An entity whose parameters all stand at one place: EntityMaker("point", at).rgb("I", …).number("scale",
/// 2).made().
class EntityMaker {
 public:
  EntityMaker(std::string type, Location at) : entity_{std::move(type), Parameters(std::move(at))} {}

  EntityMaker& number(const char* name, double value) { return add("float", name, {value}, {}, {}); }
  EntityMaker& whole(const char* name, int value) {
    return add("integer", name, {static_cast<double>(value)}, {}, {});
  }
  EntityMaker& rgb(const char* name, const std::array<double, 3>& value) {
    return add("rgb", name, {value[0], value[1], value[2]}, {}, {});
  }
  EntityMaker& point(const char* name, Vector3 p) { return add("point3", name, {p.x, p.y, p.z}, {}, {}); }
  EntityMaker& flag(const char* name, bool value) { return add("bool", name, {}, {}, {value}); }
  EntityMaker& text(const char* name, std::vector<std::string> values) {
    return add("string", name, {}, std::move(values), {});
  }
  EntityMaker& texture(const char* name, std::string of) {
    return add("texture", name, {}, {std::move(of)}, {});
  }
  Entity made() const { return entity_; }

 private:
  EntityMaker& add(const char* type, const char* name, std::vector<double> numbers,
                   std::vector<std::string> strings, std::vector<std::uint8_t> bools) {
    Parameter parameter{
        type, name, entity_.location(), std::move(numbers), std::move(strings), std::move(bools)};
    entity_.parameters.add(std::move(parameter));
    return *this;
  }

  Entity entity_;
};

}  // namespace petzval::render
