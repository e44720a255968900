// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/glass/yaml_document.h>
#include <yaml.h>

#include <memory>

namespace petzval {

namespace {

class YamlReader {
 public:
  YamlReader(std::string_view text, const std::string& file) : file_(file) {
    if (!yaml_parser_initialize(&parser_)) throw Failure("no memory for a YAML parser");
    yaml_parser_set_input_string(&parser_, reinterpret_cast<const unsigned char*>(text.data()), text.size());
  }
  ~YamlReader() { yaml_parser_delete(&parser_); }
  YamlReader(const YamlReader&) = delete;
  YamlReader& operator=(const YamlReader&) = delete;

  YamlNode document() {
    YamlNode root;
    for (Event event = next(); event->type != YAML_STREAM_END_EVENT; event = next()) {
      if (event->type == YAML_STREAM_START_EVENT || event->type == YAML_DOCUMENT_END_EVENT) continue;
      if (event->type != YAML_DOCUMENT_START_EVENT) fail(*event, "a stray piece of YAML");
      if (seen_) fail(*event, "a second document; a glass file has one");
      seen_ = true;
      const Event content = next();
      root = node(*content, 0);
    }
    return root;
  }

 private:
  struct Delete {
    void operator()(yaml_event_t* event) const {
      yaml_event_delete(event);
      delete event;
    }
  };
  using Event = std::unique_ptr<yaml_event_t, Delete>;

  Event next() {
    auto event = std::make_unique<yaml_event_t>();
    if (!yaml_parser_parse(&parser_, event.get()))
      throw InputError(file_, static_cast<int>(parser_.problem_mark.line) + 1,
                       std::string("is not YAML: ") + (parser_.problem ? parser_.problem : "unreadable"));
    return Event(event.release());
  }
  [[noreturn]] void fail(const yaml_event_t& event, const char* what) const {
    throw InputError(file_, line(event), what);
  }
  static int line(const yaml_event_t& event) { return static_cast<int>(event.start_mark.line) + 1; }
  static std::string scalar(const yaml_event_t& event) {
    return {reinterpret_cast<const char*>(event.data.scalar.value), event.data.scalar.length};
  }

  YamlNode node(const yaml_event_t& event, int depth) {
    constexpr int deepest = 16;
    if (depth > deepest) fail(event, "YAML nested more deeply than any glass file");
    YamlNode result;
    result.line = line(event);
    switch (event.type) {
      case YAML_SCALAR_EVENT:
        result.text = scalar(event);
        return result;
      case YAML_SEQUENCE_START_EVENT:
        result.kind = YamlNode::Kind::list;
        for (Event item = next(); item->type != YAML_SEQUENCE_END_EVENT; item = next())
          result.items.push_back(node(*item, depth + 1));
        return result;
      case YAML_MAPPING_START_EVENT:
        result.kind = YamlNode::Kind::mapping;
        for (Event key = next(); key->type != YAML_MAPPING_END_EVENT; key = next()) {
          if (key->type != YAML_SCALAR_EVENT) fail(*key, "a key that is no plain text");
          const Event value = next();
          result.keys.push_back(scalar(*key));
          result.items.push_back(node(*value, depth + 1));
        }
        return result;
      default:
        fail(event, "a YAML alias; glass files have none");
    }
  }

  yaml_parser_t parser_{};
  const std::string& file_;
  bool seen_ = false;
};

}  // namespace

const YamlNode* YamlNode::find(std::string_view key) const {
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (keys[i] == key) return &items[i];
  return nullptr;
}

YamlNode parse_yaml(std::string_view text, const std::string& file) {
  return YamlReader(text, file).document();
}

}  // namespace petzval
