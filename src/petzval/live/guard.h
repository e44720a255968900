// SPDX-License-Identifier: BSD-3-Clause
// Who may speak to the live server: exact hosts, exact origins, and a token that nobody can guess.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace petzval {

/// A header of a request: nothing where it is missing. A header that is there twice counts as a wrong one.
using HeaderValue = std::optional<std::string_view>;

/// What a browser on this machine sends, and nothing else. A page of another site that asks 127.0.0.1 sends
/// its own origin; one that has its name answered with 127.0.0.1 (DNS rebinding) sends its own host.
class RequestGuard {
 public:
  RequestGuard(unsigned short port, std::string token);

  /// "127.0.0.1:PORT" or "localhost:PORT".
  bool right_host(HeaderValue host) const;
  /// "http://" and a right host. \param required  of a WebSocket; a page is fetched without one too.
  bool right_origin(HeaderValue origin, bool required) const;
  /// The protocols that a page offers: "petzval-live.1, TOKEN". Compared in a time that does not depend on
  /// where they differ.
  bool right_protocols(HeaderValue offered) const;
  const std::string& token() const { return token_; }

  /// What the page may load and reach: itself and this server's WebSocket, nothing else.
  std::string content_security_policy() const;

  static constexpr std::string_view protocol = "petzval-live.1";

 private:
  std::string hosts_[2];
  std::string token_;
};

/// 32 hexadecimal digits from the system's generator. \throws Failure where it has none.
std::string random_token();

/// The token of a server on a port that the user chose: kept, readable by the user alone, in the folder
/// $XDG_RUNTIME_DIR, which the system empties at logout, so that a page that is open finds a server that was
/// started again. A new one where there is no such folder, or no such file in it that is the user's own.
std::string kept_token(unsigned short port);

}  // namespace petzval
