// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/live/guard.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

namespace petzval {

namespace {

constexpr std::size_t token_digits = 32;

/// As long as both are of one length, whatever they hold.
bool same_secret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return difference == 0;
}

bool is_token(std::string_view text) {
  return text.size() == token_digits &&
         std::ranges::all_of(text, [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

/// What a file of this user alone holds; nothing if there is none.
std::string private_text(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0) return {};
  struct stat facts {};
  std::array<char, token_digits> digits{};
  const bool ours = ::fstat(file, &facts) == 0 && S_ISREG(facts.st_mode) && facts.st_uid == ::geteuid() &&
                    (facts.st_mode & (S_IRWXG | S_IRWXO)) == 0;
  const ssize_t count = ours ? ::read(file, digits.data(), digits.size()) : -1;
  ::close(file);
  return count == static_cast<ssize_t>(digits.size()) ? std::string(digits.data(), digits.size())
                                                      : std::string();
}

void keep_private_text(const std::string& path, const std::string& text) {
  ::unlink(path.c_str());
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
  if (file < 0) return;  // then the next server has another one
  if (::write(file, text.data(), text.size()) != static_cast<ssize_t>(text.size())) ::unlink(path.c_str());
  ::close(file);
}

}  // namespace

RequestGuard::RequestGuard(unsigned short port, std::string token)
    : hosts_{fmt::format("127.0.0.1:{}", port), fmt::format("localhost:{}", port)},
      token_(std::move(token)) {}

bool RequestGuard::right_host(HeaderValue host) const {
  return host && (*host == hosts_[0] || *host == hosts_[1]);
}

bool RequestGuard::right_origin(HeaderValue origin, bool required) const {
  if (!origin) return !required;
  constexpr std::string_view scheme = "http://";
  return origin->starts_with(scheme) && right_host(origin->substr(scheme.size()));
}

bool RequestGuard::right_protocols(HeaderValue offered) const {
  return offered && same_secret(*offered, fmt::format("{}, {}", protocol, token_));
}

std::string RequestGuard::content_security_policy() const {
  return fmt::format(
      "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
      "connect-src ws://{} ws://{}; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
      hosts_[0], hosts_[1]);
}

std::string random_token() {
  std::array<unsigned char, token_digits / 2> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw Failure("the system gives no random numbers for the token");
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

std::string kept_token(unsigned short port) {
  const char* const folder = std::getenv("XDG_RUNTIME_DIR");
  if (!folder || folder[0] != '/') return random_token();
  const std::string path = fmt::format("{}/petzval-live-{}.token", folder, port);
  std::string token = private_text(path);
  if (is_token(token)) return token;
  token = random_token();
  keep_private_text(path, token);
  return token;
}

}  // namespace petzval
