// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/lens/formats/json_document.h>
#include <petzval/lens/formats/json_locator.h>

#include <algorithm>

namespace petzval {

namespace {

using nlohmann::json;

bool is_at_or_below(const std::string& path, const std::string& ancestor) {
  if (path.compare(0, ancestor.size(), ancestor) != 0) return false;
  return path.size() == ancestor.size() || ancestor.empty() || path[ancestor.size()] == '.' ||
         path[ancestor.size()] == '[';
}

std::string enclosing(const std::string& path) {
  const std::size_t cut = path.find_last_of(".[");
  return cut == std::string::npos ? std::string() : path.substr(0, cut);
}

const char* type_name(const json& value) {
  switch (value.type()) {
    case json::value_t::null:
      return "null";
    case json::value_t::boolean:
      return "true or false";
    case json::value_t::string:
      return "a text";
    case json::value_t::array:
      return "a list";
    case json::value_t::object:
      return "an object";
    default:
      return "a number";
  }
}

}  // namespace

std::string member_path(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

std::string item_path(const std::string& path, std::size_t index) {
  return fmt::format("{}[{}]", path, index);
}

JsonDocument::JsonDocument(const std::string& text, std::string file) : file_(std::move(file)) {
  LocatedJson located = parse_located_json(text, file_);
  root_ = std::move(located.root);
  lines_ = std::move(located.lines);
  long_numbers_ = std::move(located.long_numbers);
}

void JsonDocument::replace(json root, const std::string& altered_path, std::string origin) {
  root_ = std::move(root);
  file_ = std::move(origin);
  lines_.clear();
  std::erase_if(long_numbers_, [&](const auto& entry) { return is_at_or_below(entry.first, altered_path); });
}

std::optional<std::string> JsonDocument::long_number(const std::string& path) const {
  const auto found = long_numbers_.find(path);
  return found == long_numbers_.end() ? std::nullopt : std::optional(found->second);
}

void JsonDocument::fail(const std::string& path, const std::string& message) const {
  const std::string full = path.empty() ? message : quotable(path) + " " + message;
  if (lines_.empty()) throw InputError(file_, full);
  std::string place = path;
  while (!place.empty() && !lines_.count(place)) place = enclosing(place);
  throw InputError(file_, lines_.at(place), full);
}

void JsonEntry::fail_type(const char* meaning) const {
  fail(fmt::format("must be {}, not {}", meaning, type_name(*value_)));
}

JsonEntry JsonEntry::member(const std::string& key, const json& value) const {
  return JsonEntry(*document_, value, member_path(path_, key));
}

double JsonEntry::number(const char* meaning) const {
  if (!value_->is_number()) fail_type(meaning);
  return value_->get<double>();
}

std::string JsonEntry::text(const char* meaning) const {
  if (!value_->is_string()) fail_type(meaning);
  return value_->get<std::string>();
}

bool JsonEntry::truth() const {
  if (!value_->is_boolean()) fail_type("true or false");
  return value_->get<bool>();
}

std::vector<JsonEntry> JsonEntry::items(const char* meaning) const {
  if (!value_->is_array()) fail_type(meaning);
  std::vector<JsonEntry> entries;
  for (const json& item : *value_)
    entries.push_back(JsonEntry(*document_, item, item_path(path_, entries.size())));
  return entries;
}

std::vector<std::pair<std::string, JsonEntry>> JsonEntry::members(const char* meaning) const {
  if (!value_->is_object()) fail_type(meaning);
  std::vector<std::pair<std::string, JsonEntry>> entries;
  for (const auto& [key, value] : value_->items()) entries.emplace_back(key, member(key, value));
  return entries;
}

std::optional<JsonEntry> JsonEntry::find(const char* key) const {
  if (!value_->is_object()) fail_type("an object");
  const auto found = value_->find(key);
  return found == value_->end() ? std::nullopt : std::optional(member(key, *found));
}

JsonEntry JsonEntry::at(const char* key) const {
  const auto found = find(key);
  if (!found) fail(fmt::format("has no \"{}\", which must be there", key));
  return *found;
}

void JsonEntry::allow_only(const std::vector<const char*>& keys) const {
  if (!value_->is_object()) fail_type("an object");
  for (const auto& [key, value] : value_->items()) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    std::string known = fmt::format("{}", fmt::join(keys, ", "));
    member(key, value).fail("is not a key that belongs here; these do: " + known);
  }
}

}  // namespace petzval
