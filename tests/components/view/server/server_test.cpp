// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/serve/web_server.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "libs/core/error.hpp"
#include "tests/components/view/client/web_client.hpp"

namespace palpate::view {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// Serves one file, and sends back what a WebSocket sends.
class Echo : public WebEndpoint {
 public:
  explicit Echo(WebServer* server) : server_(server) {}

  HttpAnswer Get(std::string_view path) override {
    if (path != "/file") return {};
    return {
        .status = 200, .body = std::make_shared<const std::string>("content"), .etag = "\"tag\""};
  }
  bool IsSocket(std::string_view path) const override { return path == "/live"; }
  std::optional<std::string> Subprotocol(const std::vector<std::string>& offered) const override {
    if (offered.empty()) return std::string();
    return offered[0] == "known" ? std::optional<std::string>("known") : std::nullopt;
  }
  void Opened(ClientId) override { ++open; }
  void Received(ClientId client, std::string_view bytes, bool) override {
    if (bytes == "close") return server_->Close(client, 1008, "asked");
    server_->Send(client, TextMessage("echo", std::string(bytes)));
  }
  void Closed(ClientId) override { --open; }

  std::atomic<int> open = 0;

 private:
  WebServer* server_;
};

class Server : public testing::Test {
 protected:
  void Start(PortSettings settings = {}) {
    port_ = server_->Listen(settings, &echo_);
    server_->Start();
  }
  static PortSettings Impatient() {
    PortSettings settings;
    settings.header_time = 200ms;
    settings.idle_time = 400ms;
    return settings;
  }
  /// A whole exchange on a connection of its own.
  std::string Say(const std::string& bytes) {
    WebClient client(port_);
    client.Send(bytes);
    return client.ReadResponse();
  }
  std::string EchoOf(WebClient* client, const std::string& text) {
    client->SendText(text);
    const auto frame = client->ReadFrame();
    return frame ? frame->payload : "nothing came";
  }
  bool AwaitOpen(int count) {
    const auto end = std::chrono::steady_clock::now() + 10s;
    while (echo_.open != count && std::chrono::steady_clock::now() < end) {
      auto turn = std::make_shared<std::promise<void>>();
      server_->Post([turn] { turn->set_value(); });
      turn->get_future().wait();
    }
    return echo_.open == count;
  }
  /// The server still works for those who keep to the rules.
  void ExpectAlive() {
    EXPECT_THAT(view::Fetch(port_, "/file"), HasSubstr("content"));
    WebClient client(port_);
    EXPECT_THAT(client.Upgrade("/live"), StartsWith("HTTP/1.1 101"));
    EXPECT_EQ(EchoOf(&client, "alive"), "alive");
  }

  std::unique_ptr<WebServer> server_ = std::make_unique<WebServer>();
  Echo echo_{server_.get()};
  int port_ = 0;

  // The server's thread uses the endpoint.
  void TearDown() override { server_.reset(); }
};

TEST_F(Server, AnswersRequestsOfOneConnection) {
  Start();
  WebClient client(port_);
  client.Send(GetRequest("/file"));
  EXPECT_THAT(client.ReadResponse(),
              AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("default-src 'self'"),
                    HasSubstr("nosniff"), HasSubstr("\r\n\r\ncontent")));
  client.Send(GetRequest("/file", "If-None-Match: \"tag\"\r\n"));
  EXPECT_THAT(client.ReadResponse(), StartsWith("HTTP/1.1 304"));
  EXPECT_THAT(view::Fetch(port_, "/file?query=1"), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(view::Fetch(port_, "/other"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(Say("HEAD /file HTTP/1.1\r\nHost: localhost\r\n\r\n"),
              AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("Content-Length: 7"),
                    Not(HasSubstr("content\n"))));
}

TEST_F(Server, SendsBackMessagesOfEverySize) {
  Start();
  WebClient client(port_);
  EXPECT_THAT(client.Upgrade("/live"), StartsWith("HTTP/1.1 101"));
  for (const std::size_t size : {0, 1, 125, 126, 65535, 65536}) {
    EXPECT_EQ(EchoOf(&client, std::string(size, 'x')), std::string(size, 'x')) << size;
  }
}

TEST_F(Server, ClosesWithTheReasonAfterWhatIsQueued) {
  Start();
  auto client = std::make_unique<WebClient>(port_);
  client->Upgrade("/live");
  client->SendText("last");
  client->SendText("close");
  EXPECT_EQ(client->ReadFrame().value().payload, "last");
  const auto close = client->ReadFrame();
  ASSERT_TRUE(close && close->opcode == 8);
  EXPECT_EQ(close->payload,
            "\x03\xf0"
            "asked");
  client->SendFrame(8, close->payload);
  EXPECT_TRUE(client->AwaitEnd());
  client.reset();
  EXPECT_TRUE(AwaitOpen(0));
}

TEST_F(Server, RefusesWhatIsNoRequestForIt) {
  Start();
  const std::string host = "Host: localhost\r\n";
  EXPECT_THAT(Say("POST /file HTTP/1.1\r\n" + host + "\r\n"), StartsWith("HTTP/1.1 405"));
  EXPECT_THAT(Say("GET /file HTTP/1.1\r\n" + host + "Content-Length: 5\r\n\r\n12345"),
              StartsWith("HTTP/1.1 413"));
  EXPECT_THAT(Say("GET /file HTTP/1.1\r\n" + host + "Transfer-Encoding: chunked\r\n\r\n"),
              StartsWith("HTTP/1.1 413"));
  EXPECT_THAT(Say("GET /file HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 421"));
  EXPECT_THAT(Say("hello\r\n\r\n"), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(Say("GET /file HTTP/1.1\r\n" + host + "X: " + std::string(100000, 'x') + "\r\n\r\n"),
              StartsWith("HTTP/1.1 431"));
  EXPECT_THAT(Say("GET /" + std::string(100000, 'x') + " HTTP/1.1\r\n" + host + "\r\n"),
              StartsWith("HTTP/1.1 431"));
  ExpectAlive();
}

TEST_F(Server, RefusesForeignHostsAndOrigins) {
  Start();
  EXPECT_THAT(view::Fetch(port_, "/file", "", "evil.example"), StartsWith("HTTP/1.1 421"));
  EXPECT_THAT(view::Fetch(port_, "/file", "Origin: http://evil.example\r\n"),
              StartsWith("HTTP/1.1 403"));
  WebClient client(port_);
  EXPECT_THAT(client.Upgrade("/live", "Origin: http://evil.example\r\n"),
              StartsWith("HTTP/1.1 403"));
  EXPECT_EQ(echo_.open, 0);
}

TEST_F(Server, MovesTheTokenFromTheAddressToACookie) {
  PortSettings settings;
  settings.rules.token = "0123456789abcdef";
  settings.rules.cookie_name = "name";
  Start(settings);
  EXPECT_THAT(view::Fetch(port_, "/file"), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(view::Fetch(port_, "/?token=0123456789abcdef"),
              AllOf(StartsWith("HTTP/1.1 303"), HasSubstr("Location: /\r\n"),
                    HasSubstr("Set-Cookie: name=0123456789abcdef; Path=/; HttpOnly; "
                              "SameSite=Strict")));
  EXPECT_THAT(view::Fetch(port_, "/file", "Cookie: name=0123456789abcdef\r\n"),
              StartsWith("HTTP/1.1 200"));
  WebClient client(port_);
  EXPECT_THAT(client.Upgrade("/live"), StartsWith("HTTP/1.1 401"));
}

TEST_F(Server, LeadsOutOfItsFilesByNoPath) {
  Start();
  for (const char* path : {"/../file", "/%2e%2e/etc/passwd", "//etc/passwd", "/file/../../etc",
                           "/..%5c..%5cfile", "/file%00", "file", "*", "http://localhost/file"}) {
    EXPECT_THAT(view::Fetch(port_, path), Not(StartsWith("HTTP/1.1 200"))) << path;
  }
  ExpectAlive();
}

TEST_F(Server, TakesNoMoreClientsThanItMay) {
  PortSettings settings;
  settings.max_clients = 2;
  Start(settings);
  std::vector<WebClient> clients;
  for (int i = 0; i < 2; ++i) {
    clients.emplace_back(port_);
    EXPECT_THAT(clients.back().Upgrade("/live"), StartsWith("HTTP/1.1 101"));
  }
  WebClient third(port_);
  EXPECT_THAT(third.Upgrade("/live"), StartsWith("HTTP/1.1 503"));
  clients.pop_back();
  ASSERT_TRUE(AwaitOpen(1));
  WebClient fourth(port_);
  EXPECT_THAT(fourth.Upgrade("/live"), StartsWith("HTTP/1.1 101"));
}

TEST_F(Server, DoesNotWaitForSlowHeaders) {
  Start(Impatient());
  WebClient client(port_);
  client.Send("GET /file HTTP/1.1\r\nHost: ");
  EXPECT_TRUE(client.AwaitEnd());
  ExpectAlive();
}

TEST_F(Server, EndsClientsThatAnswerNoPing) {
  Start(Impatient());
  WebClient client(port_);
  client.Upgrade("/live");
  EXPECT_TRUE(client.AwaitEnd());  // reads pings, and does not answer
  EXPECT_TRUE(AwaitOpen(0));
}

TEST_F(Server, KnowsWebSocketsOfItsPathsAndProtocolsOnly) {
  Start();
  EXPECT_THAT(WebClient(port_).Upgrade("/other"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(WebClient(port_).Upgrade("/live", "Sec-WebSocket-Protocol: other\r\n"),
              StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(WebClient(port_).Upgrade("/live", "Sec-WebSocket-Protocol: known, other\r\n"),
              AllOf(StartsWith("HTTP/1.1 101"), HasSubstr("Sec-WebSocket-Protocol: known")));
}

TEST_F(Server, EndsMalformedWebSockets) {
  PortSettings settings;
  settings.max_message_bytes = 1000;
  Start(settings);
  const std::vector<std::string> frames = {
      std::string("\x81\x02hi", 4),                                     // not masked
      std::string("\x83\x80mask", 6),                                   // an opcode that is none
      std::string("\xC1\x80mask", 6),                                   // reserved bit
      std::string("\x81\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFFmask", 14),  // 2^64 bytes
      std::string("\x89\xFE\x01\x00mask", 8),                           // a ping of 256 bytes
      std::string("\x81\x82mask\x92\x9E", 8),                           // no UTF-8
      std::string("\x80\x80mask", 6),                                   // continues nothing
  };
  for (const std::string& frame : frames) {
    WebClient client(port_);
    ASSERT_THAT(client.Upgrade("/live"), StartsWith("HTTP/1.1 101"));
    client.Send(frame);
    const auto answer = client.ReadFrame();
    EXPECT_TRUE(!answer || answer->opcode == 8) << testing::PrintToString(frame);
  }
  WebClient client(port_);
  client.Upgrade("/live");
  client.SendText(std::string(1001, 'x'));
  const auto close = client.ReadFrame();
  EXPECT_TRUE(!close || close->opcode == 8);
  ExpectAlive();
}

TEST_F(Server, SurvivesBytesThatAreNoProtocol) {
  Start(Impatient());
  std::mt19937 random(7);
  const auto byte = [&] { return static_cast<char>(random() & 0xFF); };
  const std::string request = GetRequest("/file");
  for (int round = 0; round < 150; ++round) {
    WebClient client(port_);
    std::string bytes = request;
    if (round % 3 == 0) bytes.assign(1 + random() % 300, ' ');
    for (char& c : bytes) {
      if (round % 3 == 0 || random() % 20 == 0) c = byte();
    }
    client.Send(bytes);
    if (round % 3 == 1) client.ReadResponse();
  }
  for (int round = 0; round < 50; ++round) {
    WebClient client(port_);
    if (!client.Upgrade("/live").starts_with("HTTP/1.1 101")) continue;
    std::string bytes(1 + random() % 60, ' ');
    for (char& c : bytes) c = byte();
    client.Send(bytes);
  }
  ExpectAlive();
}

TEST_F(Server, TakesAFollowingPortWhereOneIsInUse) {
  Start();
  WebServer second;
  PortSettings settings;
  settings.port = port_;
  EXPECT_THROW(second.Listen(settings, &echo_), RunError);
  settings.further = 50;
  EXPECT_GT(second.Listen(settings, &echo_), port_);
  settings.address = "no address";
  EXPECT_THROW(second.Listen(settings, &echo_), RunError);
}

}  // namespace
}  // namespace palpate::view
