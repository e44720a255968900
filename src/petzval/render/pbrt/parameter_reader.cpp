// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/pbrt/parameter_reader.h>

#include <algorithm>
#include <charconv>

namespace petzval::render {

namespace {

constexpr std::array<std::string_view, 18> number_types{
    "integer", "float", "point2", "vector2",  "point3",    "vector3", "normal",  "normal3", "rgb",
    "xyz",     "point", "vector", "spectrum", "blackbody", "color",   "vector4", "point4",  "matrix"};
constexpr std::array<std::string_view, 2> string_types{"string", "texture"};

template <std::size_t Count>
bool contains(const std::array<std::string_view, Count>& list, std::string_view text) {
  return std::find(list.begin(), list.end(), text) != list.end();
}

/// Splits "type name"; both must be there.
Parameter declared(const Token& token, const Location& at) {
  std::string_view text = token.text;
  const auto trim = [](std::string_view part) {
    while (!part.empty() && (part.front() == ' ' || part.front() == '\t')) part.remove_prefix(1);
    while (!part.empty() && (part.back() == ' ' || part.back() == '\t')) part.remove_suffix(1);
    return part;
  };
  text = trim(text);
  const std::size_t gap = text.find_first_of(" \t");
  if (gap == std::string_view::npos)
    throw scene_error(
        at, fmt::format("\"{}\" is no parameter; \"type name\" would be right, as \"float radius\"", text));
  Parameter parameter;
  parameter.type = text.substr(0, gap);
  parameter.name = trim(text.substr(gap));
  // Versions 1 to 3.
  if (parameter.type == "color") parameter.type = "rgb";
  if (parameter.type == "point") parameter.type = "point3";
  if (parameter.type == "vector") parameter.type = "vector3";
  parameter.at = at;
  if (!contains(number_types, parameter.type) && !contains(string_types, parameter.type) &&
      parameter.type != "bool")
    throw scene_error(at,
                      fmt::format("\"{}\" is no type of pbrt; float, integer, point3, rgb, spectrum, string, "
                                  "texture, bool … would be right",
                                  parameter.type));
  return parameter;
}

void add_value(Parameter& parameter, const Token& token, const Location& at) {
  if (parameter.type == "bool") {
    if (token.text != "true" && token.text != "false")
      throw scene_error(
          at, fmt::format("\"{}\" is {}; true or false would be right", parameter.name, token.text));
    parameter.bools.push_back(token.text == "true");
  } else if (token.kind == Token::Kind::quoted) {
    if (!contains(string_types, parameter.type) && parameter.type != "spectrum")
      throw scene_error(
          at, fmt::format("\"{}\" has the text \"{}\"; numbers would be right", parameter.name, token.text));
    parameter.strings.emplace_back(token.text);
  } else {
    const std::optional<double> number = parse_scene_number(token.text);
    if (!number || contains(string_types, parameter.type))
      throw scene_error(
          at, fmt::format("\"{}\" has the value {}; a {} would be right", parameter.name, token.text,
                          contains(string_types, parameter.type) ? "string in quotes" : "number"));
    parameter.numbers.push_back(*number);
  }
}

void read_values(Tokens& tokens, Parameter& parameter) {
  const std::optional<Token> first = tokens.next();
  if (!first)
    throw scene_error(parameter.at, fmt::format("\"{}\" has no value before the file ends", parameter.name));
  if (first->kind == Token::Kind::close) throw scene_error(tokens.location(*first), "a ] without [");
  if (first->kind != Token::Kind::open) return add_value(parameter, *first, tokens.location(*first));
  for (;;) {
    const std::optional<Token> token = tokens.next();
    if (!token) throw scene_error(tokens.location(*first), "this [ is not closed before the file ends");
    if (token->kind == Token::Kind::close) break;
    if (token->kind == Token::Kind::open) throw scene_error(tokens.location(*token), "a [ inside of [ ]");
    add_value(parameter, *token, tokens.location(*token));
  }
  if (parameter.size() == 0)
    throw scene_error(parameter.at, fmt::format("\"{}\" has no value", parameter.name));
}

}  // namespace

std::optional<double> parse_scene_number(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

Parameters read_parameters(Tokens& tokens, const Location& directive) {
  Parameters parameters(directive);
  while (tokens.peek() && tokens.peek()->kind == Token::Kind::quoted) {
    const Token declaration = *tokens.next();
    Parameter parameter = declared(declaration, tokens.location(declaration));
    read_values(tokens, parameter);
    for (const Parameter& other : parameters.list())
      if (other.name == parameter.name)
        throw scene_error(parameter.at,
                          fmt::format("\"{}\" is given twice, first at {}", parameter.name, other.at.text()));
    parameters.add(std::move(parameter));
  }
  return parameters;
}

}  // namespace petzval::render
