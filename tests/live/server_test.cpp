// SPDX-License-Identifier: BSD-3-Clause
// Who is served, and who is not.
#include <ifaddrs.h>
#include <netinet/in.h>

#include <random>

#include "live_page.h"

namespace petzval {
namespace {

using test::bench_state;
using test::Handshake;
using test::json;
using test::LivePage;
using test::raw_answer;
using test::right_handshake;
using test::RunningServer;
using test::status_of;
using test::upgrade_request;

std::string get(const RunningServer&, const std::string& target, const std::string& host,
                const std::string& more = {}) {
  return "GET " + target + " HTTP/1.1\r\n" + (host.empty() ? "" : "Host: " + host + "\r\n") + more + "\r\n";
}

/// Whether a right page is still answered.
void expect_alive(RunningServer& server) {
  LivePage page(*server);
  page.send(json{{"kind", "hello"}});
  EXPECT_EQ(page.next()["kind"], "welcome");
}

TEST(LiveServer, ServesItsPageAndNothingElse) {
  RunningServer server;
  const std::string host = right_handshake(*server).host;
  for (const char* target : {"/", "/app.js", "/app.css", "/icon.svg"})
    EXPECT_EQ(status_of(raw_answer(server->port(), get(server, target, host))), "200") << target;
  for (const char* target :
       {"/../../etc/passwd", "/%2e%2e/etc/passwd", "//etc/passwd", "/app.js/", "/app.js?x=/etc/passwd",
        "/bench", "http://127.0.0.1/app.js", "*", "/index.html"})
    EXPECT_EQ(status_of(raw_answer(server->port(), get(server, target, host))), "404") << target;
  expect_alive(server);
}

TEST(LiveServer, TellsBrowsersToLoadNothingFromElsewhere) {
  RunningServer server;
  const std::string answer = raw_answer(server->port(), get(server, "/", right_handshake(*server).host));
  EXPECT_NE(answer.find("Content-Security-Policy: default-src 'none'; script-src 'self';"), answer.npos);
  EXPECT_NE(answer.find("frame-ancestors 'none'"), answer.npos);
  EXPECT_NE(answer.find("X-Content-Type-Options: nosniff"), answer.npos);
  EXPECT_EQ(answer.find("unsafe-"), answer.npos);
  EXPECT_EQ(answer.find("Access-Control-Allow"), answer.npos);
  EXPECT_EQ(answer.find(server->token()), answer.npos) << "the secret is not in what anybody may fetch";
}

TEST(LiveServer, RefusesOtherHostsAndOrigins) {
  RunningServer server;
  const std::string host = right_handshake(*server).host, port = std::to_string(server->port());
  for (const std::string& wrong : std::vector<std::string>{
           std::string(), std::string("127.0.0.1"), "evil.example:" + port, "127.0.0.1.evil.example:" + port,
           "127.0.0.1:1", host + ".", " " + host + "0", "127.0.0.2:" + port, "LOCALHOST@evil:" + port})
    EXPECT_EQ(status_of(raw_answer(server->port(), get(server, "/", wrong))), "403") << wrong;
  EXPECT_EQ(status_of(raw_answer(server->port(), get(server, "/", host, "Host: evil.example\r\n"))), "403")
      << "two hosts";
  for (const std::string& origin :
       std::vector<std::string>{std::string("http://evil.example"), "https://" + host, std::string("null"),
                                "http://" + host + "/", host})
    EXPECT_EQ(status_of(raw_answer(server->port(), get(server, "/", host, "Origin: " + origin + "\r\n"))),
              "403")
        << origin;
  EXPECT_EQ(status_of(raw_answer(server->port(), get(server, "/", "localhost:" + port))), "200");
  expect_alive(server);
}

TEST(LiveServer, OpensItsSocketToNobodyElse) {
  RunningServer server;
  const Handshake right = right_handshake(*server);
  EXPECT_EQ(status_of(raw_answer(server->port(), upgrade_request(right))), "101");
  const auto refused = [&](const std::function<void(Handshake&)>& alter) {
    Handshake wrong = right;
    alter(wrong);
    return status_of(raw_answer(server->port(), upgrade_request(wrong)));
  };
  EXPECT_EQ(refused([](Handshake& h) { h.origin = ""; }), "403");
  EXPECT_EQ(refused([](Handshake& h) { h.origin = "http://evil.example"; }), "403");
  EXPECT_EQ(refused([](Handshake& h) { h.origin = "null"; }), "403");
  EXPECT_EQ(refused([](Handshake& h) { h.host = "evil.example"; }), "403");
  EXPECT_EQ(refused([](Handshake& h) { h.protocols = ""; }), "403");
  EXPECT_EQ(refused([](Handshake& h) { h.protocols = "petzval-live.1"; }), "403");
  EXPECT_EQ(refused([](Handshake& h) { h.protocols.back() ^= 1; }), "403");
  EXPECT_EQ(refused([](Handshake& h) { h.protocols += "0"; }), "403");
  EXPECT_EQ(refused([](Handshake& h) { h.protocols.pop_back(); }), "403");
  EXPECT_EQ(refused([](Handshake& h) { h.target = "/other"; }), "404");
  expect_alive(server);
}

TEST(LiveServer, ListensOnLoopbackAlone) {
  RunningServer server;
  ifaddrs* all = nullptr;
  ASSERT_EQ(getifaddrs(&all), 0);
  int tried = 0;
  for (const ifaddrs* each = all; each; each = each->ifa_next) {
    if (!each->ifa_addr || each->ifa_addr->sa_family != AF_INET) continue;
    const auto address = boost::asio::ip::address_v4(
        ntohl(reinterpret_cast<const sockaddr_in*>(each->ifa_addr)->sin_addr.s_addr));
    if (address.is_loopback()) continue;
    ++tried;
    boost::asio::io_context io;
    boost::asio::ip::tcp::socket socket(io);
    boost::system::error_code code;
    socket.connect({address, server->port()}, code);
    EXPECT_TRUE(code) << address;
  }
  freeifaddrs(all);
  if (tried == 0) GTEST_SKIP() << "this machine has no address but loopback";
}

TEST(LiveServer, RefusesOtherMethodsAndBodies) {
  RunningServer server;
  const std::string host = right_handshake(*server).host;
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "TRACE"})
    EXPECT_EQ(status_of(raw_answer(server->port(),
                                   std::string(method) + " / HTTP/1.1\r\nHost: " + host + "\r\n\r\n")),
              "405")
        << method;
  EXPECT_NE(status_of(raw_answer(server->port(), get(server, "/", host, "Content-Length: 99999999\r\n") +
                                                     std::string(100, 'x'))),
            "200");
  EXPECT_NE(status_of(raw_answer(server->port(),
                                 get(server, "/", host, "X: " + std::string(100'000, 'x') + "\r\n"))),
            "200");
  expect_alive(server);
}

TEST(LiveServer, OutlivesBytesThatAreNoRequest) {
  RunningServer server;
  std::mt19937_64 bits(1);
  for (int run = 0; run < 50; ++run) {
    std::string bytes = upgrade_request(right_handshake(*server));
    for (int change = 0; change < 8; ++change) bytes[bits() % bytes.size()] = static_cast<char>(bits());
    boost::asio::io_context io;
    boost::asio::ip::tcp::socket socket(io);
    socket.connect({boost::asio::ip::address_v4::loopback(), server->port()});
    boost::system::error_code code;
    boost::asio::write(socket, boost::asio::buffer(bytes), code);
  }
  expect_alive(server);
}

TEST(LiveServer, ClosesAPageThatSaysTooMuch) {
  RunningServer server;
  {
    LivePage page(*server);
    page.send(std::string(most_message_bytes + 1, ' '));
    EXPECT_TRUE(page.is_closed());
  }
  expect_alive(server);
}

TEST(LiveServer, RefusesWhatIsNoMessageAndGoesOn) {
  RunningServer server;
  LivePage page(*server);
  for (const std::string& wrong : std::vector<std::string>{
           std::string(), std::string("{"), std::string("[]"), std::string("null"), std::string("{}"),
           std::string("{\"kind\":\"quit\"}"), std::string("{\"kind\":\"hello\",\"kind\":\"hello\"}"),
           std::string("{\"kind\":\"hello\",\"more\":1}"),
           std::string("{\"kind\":\"lens\",\"id\":1,\"name\":\"../../etc/passwd\"}"),
           std::string("{\"kind\":\"lens\",\"id\":-1,\"name\":\"tessar\"}"),
           std::string("{\"kind\":\"save\",\"id\":1,\"extension\":\"/../x.png\"}"), std::string(5000, '[')}) {
    page.send(wrong);
    const json answer = page.next();
    EXPECT_EQ(answer["kind"], "refused") << wrong;
    EXPECT_EQ(answer["text"].get<std::string>().find('\n'), std::string::npos);
  }
  page.send_bytes("abc");
  EXPECT_EQ(page.next()["kind"], "refused");
  page.send_bytes(std::string(4, '\xFF'));
  EXPECT_EQ(page.next()["kind"], "refused");
  page.send(json{{"kind", "hello"}});
  EXPECT_EQ(page.next()["kind"], "welcome");
}

TEST(LiveServer, OutlivesAlteredMessages) {
  RunningServer server;
  LivePage page(*server);
  std::mt19937_64 bits(2);
  const std::string whole = bench_state(1).dump();
  for (int run = 0; run < 300; ++run) {
    std::string text = whole;
    for (std::uint64_t change = bits() % 4 + 1; change > 0; --change) {
      const std::size_t at = bits() % text.size();
      if (bits() % 2)
        text[at] = static_cast<char>(' ' + bits() % 95);
      else
        text.erase(at, bits() % 20);
    }
    // Text that is no UTF-8 ends a WebSocket by its own rules: what is sent here is ASCII.
    page.send(text);
  }
  page.send(json{{"kind", "hello"}});
  page.next("welcome");
}

TEST(LiveServer, EndsWithItsLastPageIfAskedTo) {
  RunningServer server([](LiveOptions& options) { options.end_with_page = true; });
  {
    LivePage page(*server), another(*server);
    page.send(json{{"kind", "hello"}});
    page.next("welcome");
    page.close();
    another.send(json{{"kind", "hello"}});
    another.next("welcome");
    another.close();
  }
  server.wait();  // or the test is stopped by its time limit
}

TEST(LiveServer, RefusesAPortThatIsTaken) {
  RunningServer server;
  LiveOptions options;
  options.port = server->port();
  EXPECT_THROW(LiveServer second(options), InputError);
}

TEST(LiveServer, HasALimitOfPages) {
  RunningServer server;
  std::vector<std::unique_ptr<LivePage>> pages;
  for (int i = 0; i < 8; ++i) pages.push_back(std::make_unique<LivePage>(*server));
  EXPECT_EQ(status_of(raw_answer(server->port(), upgrade_request(right_handshake(*server)))), "503");
  pages.clear();
}

}  // namespace
}  // namespace petzval
