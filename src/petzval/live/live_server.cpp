// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/stop.h>
#include <petzval/live/bench_worker.h>
#include <petzval/live/guard.h>
#include <petzval/live/live_server.h>
#include <petzval/live/page_files.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <deque>
#include <list>
#include <optional>
#include <set>
#include <utility>

namespace petzval {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using Code = beast::error_code;
using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;

constexpr std::size_t most_header_bytes = 8192, most_connections = 64, most_pages = 8;
/// A page that reads nothing is not to fill the memory.
constexpr std::size_t most_unsent_bytes = std::size_t{64} << 20;
constexpr std::chrono::seconds request_time{10};
/// A page that is loaded anew is gone for a moment.
constexpr std::chrono::seconds time_to_come_back{3};
constexpr std::chrono::milliseconds between_stop_questions{100};

std::string_view view(boost::string_view text) {
  return {text.data(), text.size()};
}

/// Nothing if there is none; a text that nothing equals if there are several.
HeaderValue header_of(const Request& request, http::field field) {
  const auto [first, last] = request.equal_range(field);
  if (first == last) return {};
  if (std::next(first) != last) return std::string_view("several");
  return view(first->value());
}

/// What connections have of their server.
struct Shared {
  explicit Shared(RequestGuard g) : guard(std::move(g)) {}
  RequestGuard guard;
  LiveStart start = {};
  int threads = 0;
  std::size_t connections = 0, pages = 0;
  bool had_page = false;
  std::chrono::steady_clock::time_point last_page_left = {};
  /// Of pages that have gone: their threads end by themselves and are joined from time to time.
  std::list<std::unique_ptr<BenchWorker>> workers = {};
};

Response answer(const Shared& shared, const Request& request, http::status status, std::string_view type,
                std::string_view body) {
  Response response(status, request.version());
  response.set(http::field::content_type, boost::string_view(type.data(), type.size()));
  response.set(http::field::cache_control, "no-store");
  response.set("Content-Security-Policy", shared.guard.content_security_policy());
  response.set("X-Content-Type-Options", "nosniff");
  response.set("X-Frame-Options", "DENY");
  response.set("Referrer-Policy", "no-referrer");
  response.set("Cross-Origin-Opener-Policy", "same-origin");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  response.keep_alive(status == http::status::ok && request.keep_alive());
  if (request.method() != http::verb::head) response.body().assign(body.data(), body.size());
  response.prepare_payload();
  return response;
}

Response refused(const Shared& shared, const Request& request, http::status status, std::string_view why) {
  return answer(shared, request, status, "text/plain; charset=utf-8", fmt::format("{}\n", why));
}

/// One page over its WebSocket.
class PageConnection : public std::enable_shared_from_this<PageConnection> {
 public:
  PageConnection(beast::tcp_stream&& stream, Shared& shared, asio::io_context& io)
      : stream_(std::move(stream)), shared_(shared), io_(io) {
    ++shared_.pages;
    shared_.had_page = true;
  }
  ~PageConnection() {
    --shared_.pages;
    shared_.last_page_left = std::chrono::steady_clock::now();
    if (worker_) worker_->end();
    if (worker_) shared_.workers.push_back(std::move(worker_));
  }

  void begin(const Request& request) {
    stream_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    stream_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol,
                   boost::string_view(RequestGuard::protocol.data(), RequestGuard::protocol.size()));
    }));
    constexpr std::size_t header = 4096 + 4;
    stream_.read_message_max(most_upload_bytes + header);
    stream_.auto_fragment(false);
    stream_.async_accept(request, [self = shared_from_this()](Code code) {
      if (!code) self->opened();
    });
  }

  /// The server ends.
  void close() {
    Code ignored;
    beast::get_lowest_layer(stream_).socket().close(ignored);
  }

 private:
  void opened() {
    worker_ = std::make_unique<BenchWorker>(shared_.start, shared_.threads,
                                            [weak = weak_from_this(), &io = io_](LiveReply reply) {
                                              asio::post(io, [weak, reply = std::move(reply)]() mutable {
                                                if (const auto self = weak.lock())
                                                  self->enqueue(std::move(reply));
                                              });
                                            });
    read();
  }

  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](Code code, std::size_t) {
      if (!code) self->took();
    });
  }

  void took() {
    const bool binary = stream_.got_binary();
    if (!binary && buffer_.size() > most_message_bytes) return end(websocket::close_code::too_big);
    std::string message = beast::buffers_to_string(buffer_.data());
    buffer_.consume(buffer_.size());
    if (!worker_->take(std::move(message), binary)) return end(websocket::close_code::policy_error);
    read();
  }

  void end(websocket::close_code why) {
    stream_.async_close(why, [self = shared_from_this()](Code) {});
  }

  void enqueue(LiveReply reply) {
    std::string frame;
    if (reply.with_bytes) {
      constexpr int length_bytes = 4;
      for (int i = 0; i < length_bytes; ++i)
        frame += static_cast<char>(static_cast<unsigned char>(reply.json.size() >> (8 * i)));
      frame += reply.json;
      frame.append(reply.bytes.begin(), reply.bytes.end());
    } else {
      frame = std::move(reply.json);
    }
    unsent_bytes_ += frame.size();
    if (unsent_bytes_ > most_unsent_bytes) return close();
    unsent_.emplace_back(std::move(frame), reply.with_bytes);
    if (unsent_.size() == 1) write();
  }

  void write() {
    stream_.binary(unsent_.front().second);
    stream_.async_write(asio::buffer(unsent_.front().first),
                        [self = shared_from_this()](Code code, std::size_t) {
                          if (code) return;
                          self->unsent_bytes_ -= self->unsent_.front().first.size();
                          self->unsent_.pop_front();
                          if (!self->unsent_.empty()) self->write();
                        });
  }

  websocket::stream<beast::tcp_stream> stream_;
  Shared& shared_;
  asio::io_context& io_;
  beast::flat_buffer buffer_;
  std::unique_ptr<BenchWorker> worker_;
  std::deque<std::pair<std::string, bool>> unsent_;
  std::size_t unsent_bytes_ = 0;
};

/// One connection that asks for files, or to become a WebSocket.
class FileConnection : public std::enable_shared_from_this<FileConnection> {
 public:
  FileConnection(tcp::socket&& socket, Shared& shared, asio::io_context& io,
                 std::set<std::weak_ptr<PageConnection>, std::owner_less<>>& pages)
      : stream_(std::move(socket)), shared_(shared), io_(io), pages_(pages) {
    ++shared_.connections;
  }
  ~FileConnection() { --shared_.connections; }

  void read() {
    parser_.emplace();
    parser_->header_limit(most_header_bytes);
    parser_->body_limit(1);  // requests of ours have none
    stream_.expires_after(request_time);
    http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](Code code, std::size_t) {
      if (!code) self->took();
    });
  }

 private:
  void took() {
    const Request& request = parser_->get();
    if (websocket::is_upgrade(request)) {
      if (const auto refusal = refuse_page(request)) return write(*refusal);
      stream_.expires_never();
      const auto page = std::make_shared<PageConnection>(std::move(stream_), shared_, io_);
      pages_.insert(page);
      return page->begin(parser_->release());
    }
    write(file_answer(request));
  }

  std::optional<Response> refuse_page(const Request& request) const {
    const RequestGuard& guard = shared_.guard;
    const auto no = [&](http::status status, std::string_view why) {
      return refused(shared_, request, status, why);
    };
    if (!guard.right_host(header_of(request, http::field::host)))
      return no(http::status::forbidden, "this host is not served");
    if (!guard.right_origin(header_of(request, http::field::origin), true))
      return no(http::status::forbidden, "pages of another origin are not served");
    if (view(request.target()) != "/bench") return no(http::status::not_found, "there is no such file");
    if (!guard.right_protocols(header_of(request, http::field::sec_websocket_protocol)))
      return no(http::status::forbidden,
                "the token is missing or wrong; open the address that petzval live printed");
    if (shared_.pages >= most_pages) return no(http::status::service_unavailable, "too many pages are open");
    return {};
  }

  Response file_answer(const Request& request) const {
    const RequestGuard& guard = shared_.guard;
    if (!guard.right_host(header_of(request, http::field::host)))
      return refused(shared_, request, http::status::forbidden, "this host is not served");
    if (!guard.right_origin(header_of(request, http::field::origin), false))
      return refused(shared_, request, http::status::forbidden, "pages of another origin are not served");
    if (request.method() != http::verb::get && request.method() != http::verb::head)
      return refused(shared_, request, http::status::method_not_allowed, "GET would be right");
    for (const PageFile& file : page_files())
      if (file.path == view(request.target()))
        return answer(shared_, request, http::status::ok, file.type, file.bytes);
    return refused(shared_, request, http::status::not_found, "there is no such file");
  }

  void write(Response response) {
    response_.emplace(std::move(response));
    http::async_write(stream_, *response_, [self = shared_from_this()](Code code, std::size_t) {
      if (code) return;
      if (self->response_->need_eof()) {
        Code ignored;
        self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
        return;
      }
      self->read();
    });
  }

  beast::tcp_stream stream_;
  Shared& shared_;
  asio::io_context& io_;
  std::set<std::weak_ptr<PageConnection>, std::owner_less<>>& pages_;
  beast::flat_buffer buffer_{most_header_bytes * 2};
  std::optional<http::request_parser<http::string_body>> parser_;
  std::optional<Response> response_;
};

}  // namespace

struct LiveServer::Impl {
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  asio::steady_timer timer{io};
  bool end_with_page = false;
  std::optional<Shared> shared = {};
  std::set<std::weak_ptr<PageConnection>, std::owner_less<>> pages = {};
  std::exception_ptr stopped_by = {};

  void listen(unsigned short port) {
    const tcp::endpoint here(asio::ip::address_v4::loopback(), port);
    Code code;
    acceptor.open(here.protocol(), code);
    if (!code) acceptor.set_option(asio::socket_base::reuse_address(true), code);
    if (!code) acceptor.bind(here, code);
    if (!code) acceptor.listen(asio::socket_base::max_listen_connections, code);
    if (code)
      throw InputError(
          fmt::format("`port` {} cannot be had: {}; another one, or 0 for one that is free, would be right",
                      port, code.message()));
  }

  void accept() {
    acceptor.async_accept([this](Code code, tcp::socket socket) {
      if (code == asio::error::operation_aborted) return;
      if (!code && shared->connections + shared->pages < most_connections) {
        Code ignored;
        socket.set_option(tcp::no_delay(true), ignored);
        std::make_shared<FileConnection>(std::move(socket), *shared, io, pages)->read();
      }
      accept();
    });
  }

  bool last_page_gone() const {
    return end_with_page && shared->had_page && shared->pages == 0 &&
           std::chrono::steady_clock::now() - shared->last_page_left > time_to_come_back;
  }

  /// Looks from time to time whether it is to end, and clears away what pages have left.
  void look_around() {
    timer.expires_after(between_stop_questions);
    timer.async_wait([this](Code code) {
      if (code) return;
      shared->workers.clear();
      std::erase_if(pages, [](const auto& page) { return page.expired(); });
      try {
        check_stop();
      } catch (const Cancelled&) {
        stopped_by = std::current_exception();
        return io.stop();
      }
      if (last_page_gone()) return io.stop();
      look_around();
    });
  }
};

LiveServer::LiveServer(const LiveOptions& options) : impl_(std::make_unique<Impl>()) {
  impl_->listen(options.port);
  impl_->end_with_page = options.end_with_page;
  impl_->shared.emplace(RequestGuard(port(), options.token.empty() ? random_token() : options.token));
  impl_->shared->start = options.start;
  impl_->accept();
}

LiveServer::~LiveServer() {
  // Handlers hold the connections: they go before what they share.
  for (const auto& each : impl_->pages)
    if (const auto page = each.lock()) page->close();
  impl_->acceptor.close();
  impl_->timer.cancel();
  impl_->io.restart();
  impl_->io.poll();
  impl_->shared->workers.clear();
}

unsigned short LiveServer::port() const {
  return impl_->acceptor.local_endpoint().port();
}

const std::string& LiveServer::token() const {
  return impl_->shared->guard.token();
}

std::string LiveServer::url() const {
  return fmt::format("http://127.0.0.1:{}/#token={}", port(), token());
}

void LiveServer::run(const Context& context) {
  impl_->shared->threads = context.threads;
  run_within(Context{.progress = context.progress}, [&](const ProgressCallback&) {
    impl_->look_around();
    impl_->io.run();
  });
  if (impl_->stopped_by) std::rethrow_exception(impl_->stopped_by);
}

void LiveServer::stop() {
  impl_->io.stop();
}

}  // namespace petzval
