// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/gltf/gltf_extensions.h>

#include <algorithm>
#include <limits>

namespace petzval::render {

void report_gltf_extensions(const GltfFile& file, const tinygltf::ExtensionMap& extensions,
                            const std::string& path, std::initializer_list<const char*> known,
                            Unsupported& unsupported) {
  for (const auto& [name, value] : extensions)
    if (std::find(known.begin(), known.end(), name) == known.end())
      unsupported.report(file.at(fmt::format("{}.extensions.{}", path, name)), "this extension");
}

GltfExtension::GltfExtension(const GltfFile& file, const tinygltf::ExtensionMap& extensions, const char* name,
                             const std::string& path)
    : file_(file), path_(fmt::format("{}.extensions.{}", path, name)) {
  const auto found = extensions.find(name);
  if (found == extensions.end()) return;
  if (!found->second.IsObject()) throw scene_error(file_.at(path_), "is no object; { … } would be right");
  members_ = &found->second;
}

const tinygltf::Value* GltfExtension::find(const char* member) const {
  return members_ && members_->Has(member) ? &members_->Get(member) : nullptr;
}

const tinygltf::Value* GltfExtension::ask(const char* member) {
  asked_.emplace_back(member);
  return find(member);
}

double GltfExtension::number(const char* member, double otherwise, double least, double most) {
  const tinygltf::Value* value = ask(member);
  if (!value) return otherwise;
  const double number =
      value->IsNumber() ? value->GetNumberAsDouble() : std::numeric_limits<double>::quiet_NaN();
  if (!(number >= least && number <= most))
    throw scene_error(file_.at(path_ + "." + member),
                      fmt::format("a number from {:g} to {:g} would be right", least, most));
  return number;
}

int GltfExtension::index(const char* member) {
  const tinygltf::Value* value = ask(member);
  if (!value) return -1;
  if (!value->IsInt() || value->GetNumberAsInt() < 0)
    throw scene_error(file_.at(path_ + "." + member), "a whole number, 0 or more, would be right");
  return value->GetNumberAsInt();
}

std::vector<double> GltfExtension::numbers(const char* member, std::vector<double> otherwise) {
  const tinygltf::Value* value = ask(member);
  if (!value) return otherwise;
  std::vector<double> result;
  if (value->IsArray())
    for (std::size_t i = 0; i < value->ArrayLen(); ++i)
      if (value->Get(i).IsNumber()) result.push_back(value->Get(i).GetNumberAsDouble());
  if (result.size() != otherwise.size())
    throw scene_error(file_.at(path_ + "." + member),
                      fmt::format("{} numbers would be right", otherwise.size()));
  return result;
}

tinygltf::TextureInfo GltfExtension::texture(const char* member) {
  tinygltf::TextureInfo result;
  const tinygltf::Value* value = ask(member);
  if (!value) return result;
  const auto whole = [&](const char* name, int otherwise) {
    if (!value->IsObject() || (!value->Has(name) && otherwise < 0))
      throw scene_error(file_.at(path_ + "." + member), "an object with an index would be right");
    if (!value->Has(name)) return otherwise;
    const tinygltf::Value& number = value->Get(name);
    if (!number.IsInt() || number.GetNumberAsInt() < 0)
      throw scene_error(file_.at(fmt::format("{}.{}.{}", path_, member, name)),
                        "a whole number, 0 or more, would be right");
    return number.GetNumberAsInt();
  };
  result.index = whole("index", -1), result.texCoord = whole("texCoord", 0);
  if (value->Has("extensions") && value->Get("extensions").IsObject())
    result.extensions = value->Get("extensions").Get<tinygltf::Value::Object>();
  return result;
}

void GltfExtension::report_rest(Unsupported& unsupported) const {
  if (!members_) return;
  for (const std::string& key : members_->Keys())
    if (key != "extras" && std::find(asked_.begin(), asked_.end(), key) == asked_.end())
      unsupported.report(file_.at(path_ + "." + key), "this entry");
}

}  // namespace petzval::render
