// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/stop.h>
#include <petzval/render/pbrt/tokens.h>

namespace petzval::render {

namespace {

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v';
}

}  // namespace

Tokens::Tokens(std::string_view text, std::shared_ptr<const std::string> file)
    : text_(text), file_(std::move(file)) {
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  if (text_.substr(0, byte_order_mark.size()) == byte_order_mark) at_ = line_start_ = byte_order_mark.size();
}

void Tokens::skip_space() {
  while (at_ < text_.size()) {
    if (text_[at_] == '#') {
      while (at_ < text_.size() && text_[at_] != '\n') ++at_;
    } else if (text_[at_] == '\n') {
      ++at_, ++line_;
      line_start_ = at_;
    } else if (is_space(text_[at_])) {
      ++at_;
    } else {
      return;
    }
  }
}

std::optional<Token> Tokens::read() {
  skip_space();
  if (at_ >= text_.size()) return {};
  constexpr std::size_t between_questions = 4096;
  if (++tokens_ % between_questions == 0) check_stop();
  Token token;
  token.line = line_, token.column = column();
  const std::size_t start = at_;
  const char first = text_[at_++];
  if (first == '[' || first == ']') {
    token.kind = first == '[' ? Token::Kind::open : Token::Kind::close;
  } else if (first == '"') {
    token.kind = Token::Kind::quoted;
    while (at_ < text_.size() && text_[at_] != '"' && text_[at_] != '\n') ++at_;
    if (at_ >= text_.size() || text_[at_] != '"')
      throw scene_error(location(token), "this string does not end on its line; a closing \" is missing");
    token.text = text_.substr(start + 1, at_++ - start - 1);
    return token;
  } else {
    while (at_ < text_.size() && !is_space(text_[at_]) && text_[at_] != '"' && text_[at_] != '[' &&
           text_[at_] != ']' && text_[at_] != '#')
      ++at_;
  }
  token.text = text_.substr(start, at_ - start);
  return token;
}

std::optional<Token> Tokens::next() {
  if (has_peeked_) {
    has_peeked_ = false;
    return peeked_;
  }
  return read();
}

const std::optional<Token>& Tokens::peek() {
  if (!has_peeked_) {
    peeked_ = read();
    has_peeked_ = true;
  }
  return peeked_;
}

}  // namespace petzval::render
