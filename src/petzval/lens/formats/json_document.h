// SPDX-License-Identifier: BSD-3-Clause
// A JSON text whose entries know their line, for readers that forgive nothing.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace petzval {

/// A parsed JSON text. Entries are named by paths such as "surfaces[4].thickness_mm"; "" is the whole.
/// Duplicate keys, nesting deeper than any lens has, and absurdly many entries are refused.
class JsonDocument {
 public:
  /// \param file  for error messages. \throws InputError with file and line.
  JsonDocument(const std::string& text, std::string file);

  const nlohmann::json& root() const { return root_; }
  /// Exchanges the contents for an altered copy whose entries at and below `altered_path` are new. From then
  /// on errors name `origin` in place of a file and lines.
  void replace(nlohmann::json root, const std::string& altered_path, std::string origin);

  /// The text of a number as it stands in the file, if it has more digits than a double can hold.
  std::optional<std::string> long_number(const std::string& path) const;

  /// \throws InputError "<file>:<line>: <path> <message>", the line that of the entry or of what encloses it.
  [[noreturn]] void fail(const std::string& path, const std::string& message) const;

 private:
  std::string file_;
  nlohmann::json root_;
  std::map<std::string, int> lines_;
  std::map<std::string, std::string> long_numbers_;
};

/// One entry of a document; valid as long as the document is.
class JsonEntry {
 public:
  explicit JsonEntry(const JsonDocument& document) : JsonEntry(document, document.root(), "") {}

  const std::string& path() const { return path_; }
  bool is_null() const { return value_->is_null(); }
  bool is_text() const { return value_->is_string(); }
  bool is_number() const { return value_->is_number(); }
  bool is_list() const { return value_->is_array(); }
  bool is_object() const { return value_->is_object(); }

  // Each throws InputError if the entry is of another type. `meaning` completes "must be …".
  double number(const char* meaning) const;
  std::string text(const char* meaning) const;
  bool truth() const;
  std::vector<JsonEntry> items(const char* meaning) const;
  std::vector<std::pair<std::string, JsonEntry>> members(const char* meaning) const;

  /// The member `key`, which must be there.
  JsonEntry at(const char* key) const;
  std::optional<JsonEntry> find(const char* key) const;
  /// \throws InputError if there is a key that is not among these.
  void allow_only(const std::vector<const char*>& keys) const;

  /// As it is, in one line.
  std::string dump() const { return value_->dump(); }
  std::optional<std::string> long_number() const { return document_->long_number(path_); }
  [[noreturn]] void fail(const std::string& message) const { document_->fail(path_, message); }

 private:
  JsonEntry(const JsonDocument& document, const nlohmann::json& value, std::string path)
      : document_(&document), value_(&value), path_(std::move(path)) {}
  JsonEntry member(const std::string& key, const nlohmann::json& value) const;
  [[noreturn]] void fail_type(const char* meaning) const;

  const JsonDocument* document_;
  const nlohmann::json* value_;
  std::string path_;
};

/// "path.key", or "key" at the top.
std::string member_path(const std::string& path, const std::string& key);
std::string item_path(const std::string& path, std::size_t index);

}  // namespace petzval
