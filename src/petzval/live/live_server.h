// SPDX-License-Identifier: BSD-3-Clause
// The bench in a browser: a server for one person on one machine.
#pragma once

#include <petzval/base/context.h>
#include <petzval/live/bench.h>

#include <memory>
#include <string>

namespace petzval {

struct LiveOptions {
  LiveStart start = {};
  unsigned short port = 0;     ///< 0: one that is free
  std::string token = {};      ///< empty: a new one
  bool end_with_page = false;  ///< ends a few seconds after the last page was closed
};

/// Serves the page and its WebSocket on 127.0.0.1, to browsers of this machine that know the token.
///
///     LiveOptions options;
///     options.start.lens_json = lens_to_json(read_lens("dgauss-50mm").lens);
///     LiveServer server(options);
///     std::cout << server.url() << '\n';  // http://127.0.0.1:PORT/#token=…
///     server.run();
///
/// What a request may do: fetch one of the page's few files; open a WebSocket if Host and Origin are exactly
/// those of this server and the token is right. Every page has a bench and a thread of its own. Method and
/// limits: docs/LIVE.md, "Security".
class LiveServer {
 public:
  /// Listens. \throws InputError for a port that is taken; Failure.
  explicit LiveServer(const LiveOptions& options);
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  unsigned short port() const;
  const std::string& token() const;
  /// With the token in its fragment, which browsers send to nobody.
  std::string url() const;

  /// Serves until stop(), or the last page has gone and that is to be the end. \throws Cancelled when the
  /// context says stop.
  void run(const Context& context = {});
  /// From any thread.
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace petzval
