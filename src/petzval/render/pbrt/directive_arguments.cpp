// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/pbrt/parameter_reader.h>
#include <petzval/render/pbrt/scene_reader.h>

namespace petzval::render {

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
  result.parameters = parameters(tokens, at, defaults);
  return result;
}

Parameters SceneReader::parameters(Tokens& tokens, const Location& at, const char* defaults) {
  Parameters result = read_parameters(tokens, at);
  const auto found = state_.defaults.find(defaults);
  if (found != state_.defaults.end())
    for (const Parameter& parameter : found->second) result.add(parameter);
  return result;
}

}  // namespace petzval::render
