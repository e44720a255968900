// SPDX-License-Identifier: BSD-3-Clause
// A page without a browser: what it sends and gets, over a real socket.
#pragma once

#include <gtest/gtest.h>
#include <petzval/lens/lens_file.h>
#include <petzval/live/live_server.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

namespace petzval::test {

using nlohmann::json;

/// A server that runs as long as this lives.
class RunningServer {
 public:
  explicit RunningServer(const std::function<void(LiveOptions&)>& alter = {}) : server_(options(alter)) {
    thread_ = std::thread([this] { server_.run(); });
  }
  ~RunningServer() {
    server_.stop();
    thread_.join();
  }
  LiveServer& operator*() { return server_; }
  LiveServer* operator->() { return &server_; }
  /// Until run() returns by itself.
  void wait() {
    thread_.join();
    thread_ = std::thread([] {});
  }

 private:
  static LiveOptions options(const std::function<void(LiveOptions&)>& alter) {
    LiveOptions options;
    options.start.lens_name = "achromat-50mm";
    options.start.lens_json = lens_to_json(read_lens("achromat-50mm").lens);
    options.start.scene = "slanted-edge";
    options.start.sensor = "third-inch-1280x960";
    if (alter) alter(options);
    return options;
  }

  LiveServer server_;
  std::thread thread_;
};

/// What the server says to bytes that are sent as they are, up to the end of the connection or of the answer.
inline std::string raw_answer(unsigned short port, const std::string& bytes) {
  boost::asio::io_context io;
  boost::asio::ip::tcp::socket socket(io);
  socket.connect({boost::asio::ip::address_v4::loopback(), port});
  boost::system::error_code code;
  boost::asio::write(socket, boost::asio::buffer(bytes), code);
  std::string answer;
  char part[4096];
  while (true) {
    const std::size_t count = socket.read_some(boost::asio::buffer(part), code);
    if (code) return answer;
    answer.append(part, count);
    if (answer.starts_with("HTTP/1.1 101") && answer.ends_with("\r\n\r\n")) return answer;
    const std::size_t end = answer.find("\r\n\r\n"), length = answer.find("Content-Length: ");
    if (end == answer.npos || length == answer.npos || length > end) continue;
    if (answer.size() >= end + 4 + std::stoul(answer.substr(length + 16))) return answer;
  }
}

/// "200", "403".
inline std::string status_of(const std::string& answer) {
  return answer.size() > 12 ? answer.substr(9, 3) : answer;
}

/// What makes a WebSocket's first request.
struct Handshake {
  std::string host, origin, protocols, target = "/bench";
};

inline Handshake right_handshake(const LiveServer& server) {
  const std::string host = "127.0.0.1:" + std::to_string(server.port());
  return {host, "http://" + host, "petzval-live.1, " + server.token()};
}

inline std::string upgrade_request(const Handshake& how) {
  std::string text = "GET " + how.target +
                     " HTTP/1.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                     "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) text.append(name).append(": ").append(value).append("\r\n");
  };
  add("Host", how.host);
  add("Origin", how.origin);
  add("Sec-WebSocket-Protocol", how.protocols);
  return text + "\r\n";
}

class LivePage {
 public:
  explicit LivePage(const LiveServer& server) : socket_(io_) {
    namespace websocket = boost::beast::websocket;
    const Handshake how = right_handshake(server);
    socket_.next_layer().connect({boost::asio::ip::address_v4::loopback(), server.port()});
    socket_.set_option(websocket::stream_base::decorator([how](websocket::request_type& request) {
      request.set(boost::beast::http::field::origin, how.origin);
      request.set(boost::beast::http::field::sec_websocket_protocol, how.protocols);
    }));
    socket_.read_message_max(std::size_t{64} << 20);
    socket_.handshake(how.host, how.target);
  }

  void send(const std::string& text) {
    socket_.text(true);
    socket_.write(boost::asio::buffer(text));
  }
  void send(const json& message) { send(message.dump()); }
  void send_bytes(const std::string& bytes) {
    socket_.binary(true);
    socket_.write(boost::asio::buffer(bytes));
  }
  void upload(const std::string& name, const std::string& bytes, const std::string& companion = {},
              const std::string& companion_bytes = {}) {
    json message{{"kind", "upload"}, {"id", 7}, {"name", name}};
    if (!companion.empty())
      message.update({{"companion", companion}, {"companion_bytes", companion_bytes.size()}});
    const std::string header = message.dump();
    std::string frame;
    for (int shift = 0; shift < 32; shift += 8) frame += static_cast<char>(header.size() >> shift);
    send_bytes(frame + header + bytes + companion_bytes);
  }

  /// The next message; bytes behind its header are kept in `bytes`.
  json next() {
    boost::beast::flat_buffer buffer;
    socket_.read(buffer);
    const std::string frame = boost::beast::buffers_to_string(buffer.data());
    bytes.clear();
    if (!socket_.got_binary()) return json::parse(frame);
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i)
      length |= static_cast<std::size_t>(static_cast<unsigned char>(frame[i])) << (8 * i);
    bytes = frame.substr(4 + length);
    return json::parse(frame.substr(4, length));
  }
  /// The next of a kind; others are passed over.
  json next(const std::string& kind) {
    while (true) {
      json message = next();
      if (message["kind"] == kind) return message;
    }
  }
  /// Whether the server has closed the connection.
  bool is_closed() {
    boost::beast::flat_buffer buffer;
    boost::system::error_code code;
    while (!code) socket_.read(buffer, code);
    return true;
  }
  void close() { socket_.close(boost::beast::websocket::close_code::normal); }

  std::string bytes;

 private:
  boost::asio::io_context io_;
  boost::beast::websocket::stream<boost::asio::ip::tcp::socket> socket_;
};

/// A state of the bench that is quick to show.
inline json bench_state(int id, const std::string& lens = "achromat-50mm") {
  return {{"kind", "state"},
          {"id", id},
          {"lens", json::parse(lens_to_json(read_lens(lens).lens))},
          {"camera",
           {{"f_number", nullptr},
            {"blades", nullptr},
            {"focus", "design"},
            {"distance_m", nullptr},
            {"defocus_mm", 0}}},
          {"coatings", json::array()},
          {"scene", "slanted-edge"},
          {"illuminant", ""},
          {"sensor", "third-inch-1280x960"},
          {"shot",
           {{"exposure", "auto"},
            {"compensation_ev", 0},
            {"noise", true},
            {"denoise", 0},
            {"sharpen", 0},
            {"tone", "none"}}},
          {"stray",
           {{"suns", json::array()},
            {"sun", 0},
            {"threshold", 100},
            {"ghosts", false},
            {"starburst", false},
            {"roughness_nm", 0},
            {"ghost", nullptr}}},
          {"cursor_mm", {0, 0}},
          {"plots", {"distortion"}},
          {"picture", false}};
}

}  // namespace petzval::test
