// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/serve/web_server.hpp"

// Boost 1.74 forgets it under C++20.
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <thread>

#include "libs/core/error.hpp"

namespace palpate::view {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Tcp = asio::ip::tcp;
using Error = beast::error_code;

constexpr std::uint32_t kMostHeaderBytes = 8 * 1024;
/// Connections of a port that are no WebSockets: a browser opens six.
constexpr std::size_t kMostRequests = 48;
/// What the kernel may hold for a client is as old as it is long.
constexpr int kSendBufferBytes = 1024 * 1024;
/// How long, and how much, a refused client may go on sending.
constexpr std::chrono::seconds kDrainTime{2};
constexpr std::size_t kMostDrainedBytes = 1024 * 1024;
constexpr const char* kContentSecurity =
    "default-src 'self'; img-src 'self' blob: data:; style-src 'self' 'unsafe-inline'; "
    "connect-src 'self' ws: wss:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'";

using Request = http::request<http::empty_body>;
/// A body that all clients share.
using Response = http::response<http::span_body<const char>>;

std::string_view View(beast::string_view text) { return {text.data(), text.size()}; }

RequestFacts FactsOf(const Request& request) {
  return {.target = View(request.target()),
          .host = View(request[http::field::host]),
          .origin = View(request[http::field::origin]),
          .cookie = View(request[http::field::cookie]),
          .authorization = View(request[http::field::authorization])};
}

std::vector<std::string> OfferedBy(const Request& request) {
  std::vector<std::string> offered;
  for (const auto& protocol : http::token_list(request[http::field::sec_websocket_protocol])) {
    offered.emplace_back(View(protocol));
  }
  return offered;
}

HttpAnswer TextAnswer(int status, std::string text) {
  return {.status = status, .body = std::make_shared<const std::string>(std::move(text) + "\n")};
}

class SocketSession;

/// One listening port.
struct Port {
  Port(asio::io_context& context, PortSettings the_settings, WebEndpoint* the_endpoint)
      : settings(std::move(the_settings)), endpoint(the_endpoint), acceptor(context) {}

  PortSettings settings;
  WebEndpoint* endpoint;
  Tcp::acceptor acceptor;
  std::size_t requests = 0;  ///< connections that are no WebSockets
  int clients = 0;
};

/// All that the server's thread knows.
struct Clients {
  std::map<ClientId, std::shared_ptr<SocketSession>> all;
  ClientId last = 0;
};

/// One WebSocket. Keeps itself alive while something is outstanding.
class SocketSession : public std::enable_shared_from_this<SocketSession> {
 public:
  SocketSession(Tcp::socket&& socket, std::shared_ptr<Port> port, Clients& clients)
      : stream_(std::move(socket)),
        port_(std::move(port)),
        clients_(clients),
        outbox_(port_->settings.outbox) {}

  void Accept(const Request& request, const std::string& subprotocol) {
    auto timeouts = websocket::stream_base::timeout::suggested(beast::role_type::server);
    timeouts.handshake_timeout = port_->settings.header_time;  // of the closing, too
    timeouts.idle_timeout = port_->settings.idle_time;
    stream_.set_option(timeouts);
    stream_.set_option(websocket::stream_base::decorator([subprotocol](auto& response) {
      response.set(http::field::server, "palpate");
      if (!subprotocol.empty()) response.set(http::field::sec_websocket_protocol, subprotocol);
    }));
    stream_.read_message_max(port_->settings.max_message_bytes);
    stream_.auto_fragment(false);
    ++port_->clients;
    stream_.async_accept(request, [self = shared_from_this()](Error error) {
      if (error) {
        --self->port_->clients;
        return;
      }
      self->Open();
    });
  }

  void Send(const OutMessage& message) {
    if (closing_) return;
    outbox_.Push(message);
    Write();
  }

  void Close(std::uint16_t code, const std::string& reason) {
    if (closing_) return;
    closing_ = true;
    // 125 bytes at most, less the code (RFC 6455, 5.5).
    constexpr std::size_t kMostReason = 123;
    reason_ = websocket::close_reason(static_cast<websocket::close_code>(code),
                                      reason.substr(0, kMostReason));
    Write();
  }

  const ClientCounts& counts() const { return outbox_.counts(); }

 private:
  void Open() {
    id_ = ++clients_.last;
    clients_.all[id_] = shared_from_this();
    port_->endpoint->Opened(id_);
    Read();
  }

  void Read() {
    stream_.async_read(buffer_, [self = shared_from_this()](Error error, std::size_t) {
      if (error) return self->End();
      const auto bytes = self->buffer_.data();
      const std::string_view view(static_cast<const char*>(bytes.data()), bytes.size());
      if (!self->closing_)
        self->port_->endpoint->Received(self->id_, view, self->stream_.got_binary());
      self->buffer_.consume(self->buffer_.size());
      self->Read();
    });
  }

  void Write() {
    if (writing_ || ended_) return;
    std::optional<OutMessage> next = outbox_.Pop();
    if (next && closing_ && next->delivery == Delivery::kLatest) next.reset();
    if (!next) {
      if (closing_) StartClosing();
      return;
    }
    writing_ = true;
    current_ = std::move(*next);
    stream_.binary(current_.binary);
    const std::array<asio::const_buffer, 2> parts{
        asio::buffer(*current_.head), asio::buffer(current_.body.data(), current_.body.size())};
    stream_.async_write(parts, [self = shared_from_this()](Error error, std::size_t) {
      self->writing_ = false;
      self->current_ = {};
      if (error) return self->End();
      self->Write();
    });
  }

  void StartClosing() {
    if (std::exchange(close_sent_, true)) return;
    stream_.async_close(reason_, [self = shared_from_this()](Error) { self->End(); });
  }

  /// Once, whichever of reading and writing fails first.
  void End() {
    if (std::exchange(ended_, true)) return;
    Error ignored;
    beast::get_lowest_layer(stream_).socket().close(ignored);
    --port_->clients;
    clients_.all.erase(id_);
    port_->endpoint->Closed(id_);
  }

  websocket::stream<beast::tcp_stream> stream_;
  std::shared_ptr<Port> port_;
  Clients& clients_;
  Outbox outbox_;
  beast::flat_buffer buffer_;
  OutMessage current_;  ///< that is being written
  websocket::close_reason reason_;
  ClientId id_ = 0;
  bool writing_ = false;
  bool closing_ = false;
  bool close_sent_ = false;
  bool ended_ = false;
};

/// The requests of one connection, one after the other, until one becomes a WebSocket.
class RequestSession : public std::enable_shared_from_this<RequestSession> {
 public:
  RequestSession(Tcp::socket&& socket, std::shared_ptr<Port> port, Clients& clients)
      : stream_(std::move(socket)), port_(std::move(port)), clients_(clients) {
    ++port_->requests;
  }
  ~RequestSession() { --port_->requests; }
  RequestSession(const RequestSession&) = delete;
  RequestSession& operator=(const RequestSession&) = delete;

  void Read() {
    parser_.emplace();
    parser_->header_limit(kMostHeaderBytes);
    stream_.expires_after(port_->settings.header_time);
    http::async_read_header(
        stream_, buffer_, *parser_,
        [self = shared_from_this()](Error error, std::size_t) { self->Handle(error); });
  }

 private:
  void Handle(Error error) {
    if (error == http::error::header_limit) return Answer(TextAnswer(431, "too long a header"));
    const bool ended = error == http::error::end_of_stream || error == http::error::partial_message;
    if (!ended && error.category() == make_error_code(http::error::end_of_stream).category()) {
      return Answer(TextAnswer(400, "no HTTP request: " + error.message()));
    }
    if (error) return;  // closed, or too slow
    const Request& request = parser_->get();
    const Verdict verdict = Judge(port_->settings.rules, FactsOf(request));
    if (!verdict.granted()) return Answer(TextAnswer(verdict.status, verdict.reason));
    if (websocket::is_upgrade(request)) return Upgrade(request);
    if (request.method() != http::verb::get && request.method() != http::verb::head) {
      return Answer(TextAnswer(405, "only GET and HEAD"));
    }
    if (request.has_content_length() || request.chunked()) {
      return Answer(TextAnswer(413, "a request has no body here"));
    }
    if (verdict.by_query && PathOf(View(request.target())) == "/") return MoveTokenToCookie();
    AnswerFile(request);
  }

  void AnswerFile(const Request& request) {
    const HttpAnswer answer = port_->endpoint->Get(PathOf(View(request.target())));
    if (answer.gzip && !TakesGzip(request)) {
      return Answer(TextAnswer(406, "this file is sent as gzip only"));
    }
    if (!answer.etag.empty() && View(request[http::field::if_none_match]) == answer.etag) {
      return Answer({.status = 304, .etag = answer.etag});
    }
    Answer(answer, request.keep_alive());
  }

  static bool TakesGzip(const Request& request) {
    for (const auto& coding : http::ext_list(request[http::field::accept_encoding])) {
      if (View(coding.first) == "gzip" || View(coding.first) == "*") return true;
    }
    return false;
  }

  void MoveTokenToCookie() {
    response_.emplace();
    response_->result(http::status::see_other);
    response_->set(http::field::location, "/");
    response_->set(http::field::set_cookie, port_->settings.rules.cookie_name + "=" +
                                                port_->settings.rules.token +
                                                "; Path=/; HttpOnly; SameSite=Strict");
    response_->set(http::field::cache_control, "no-store");
    response_->keep_alive(false);
    Write();
  }

  void Upgrade(const Request& request) {
    if (!port_->endpoint->IsSocket(PathOf(View(request.target())))) {
      return Answer(TextAnswer(404, "no WebSocket here"));
    }
    const auto subprotocol = port_->endpoint->Subprotocol(OfferedBy(request));
    if (!subprotocol) return Answer(TextAnswer(400, "no subprotocol that this server knows"));
    if (port_->clients >= port_->settings.max_clients) {
      return Answer(TextAnswer(
          503, std::to_string(port_->clients) + " clients are connected, and no more may"));
    }
    stream_.expires_never();
    Error ignored;
    stream_.socket().set_option(asio::socket_base::send_buffer_size(kSendBufferBytes), ignored);
    std::make_shared<SocketSession>(stream_.release_socket(), port_, clients_)
        ->Accept(request, *subprotocol);
  }

  void Answer(const HttpAnswer& answer, bool keep_alive = false) {
    body_ = answer.body;
    response_.emplace();
    response_->result(static_cast<unsigned>(answer.status));
    response_->set(http::field::content_type, answer.content_type);
    response_->set("Content-Security-Policy", kContentSecurity);
    response_->set("X-Content-Type-Options", "nosniff");
    response_->set("Referrer-Policy", "no-referrer");
    response_->set(http::field::cache_control, answer.etag.empty() ? "no-store" : "no-cache");
    if (!answer.etag.empty()) response_->set(http::field::etag, answer.etag);
    if (answer.gzip) response_->set(http::field::content_encoding, "gzip");
    if (answer.status == 405) response_->set(http::field::allow, "GET, HEAD");
    if (answer.status == 401) response_->set(http::field::www_authenticate, "Bearer");
    const bool head =
        parser_ && parser_->is_header_done() && parser_->get().method() == http::verb::head;
    const std::size_t size = body_ ? body_->size() : 0;
    if (body_ && !head) response_->body() = {body_->data(), size};
    if (answer.status != 304) response_->content_length(size);
    response_->keep_alive(keep_alive);
    Write();
  }

  void Write() {
    response_->set(http::field::server, "palpate");
    stream_.expires_after(port_->settings.idle_time);
    serializer_.emplace(*response_);
    http::async_write(stream_, *serializer_, [self = shared_from_this()](Error error, std::size_t) {
      if (!error && self->response_->keep_alive()) return self->Read();
      Error ignored;
      self->stream_.socket().shutdown(Tcp::socket::shutdown_send, ignored);
      self->stream_.expires_after(kDrainTime);
      if (!error) self->Drain();
    });
  }

  /// Closing while bytes of a client wait would take the answer from it, too.
  void Drain() {
    buffer_.clear();
    stream_.async_read_some(buffer_.prepare(kMostHeaderBytes),
                            [self = shared_from_this()](Error error, std::size_t size) {
                              self->drained_ += size;
                              if (!error && self->drained_ < kMostDrainedBytes) self->Drain();
                            });
  }

  beast::tcp_stream stream_;
  std::shared_ptr<Port> port_;
  Clients& clients_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::empty_body>> parser_;
  std::shared_ptr<const std::string> body_;  ///< of the response
  std::optional<Response> response_;
  std::optional<http::response_serializer<http::span_body<const char>>> serializer_;
  std::size_t drained_ = 0;
};

/// Calls again and again until the context ends.
void Repeat(asio::steady_timer& timer, std::chrono::milliseconds period,
            const std::function<void()>& work) {
  timer.expires_after(period);
  timer.async_wait([&timer, period, work](Error error) {
    if (error) return;
    work();
    Repeat(timer, period, work);
  });
}

void Bind(Tcp::acceptor& acceptor, const Tcp::endpoint& endpoint, Error* error) {
  acceptor.open(endpoint.protocol(), *error);
  if (!*error) acceptor.set_option(asio::socket_base::reuse_address(true), *error);
  if (!*error) acceptor.bind(endpoint, *error);
  if (!*error) acceptor.listen(asio::socket_base::max_listen_connections, *error);
  Error ignored;
  if (*error) acceptor.close(ignored);
}

}  // namespace

struct WebServer::Impl {
  void Accept(const std::shared_ptr<Port>& port) {
    port->acceptor.async_accept([this, port](Error error, Tcp::socket socket) {
      if (!port->acceptor.is_open()) return;
      if (error) {
        // No file descriptor is left, for example: it may be better in a while.
        retry.expires_after(std::chrono::milliseconds(100));
        retry.async_wait([this, port](Error) { Accept(port); });
        return;
      }
      Error ignored;
      socket.set_option(Tcp::no_delay(true), ignored);
      if (port->requests < kMostRequests) {
        std::make_shared<RequestSession>(std::move(socket), port, clients)->Read();
      }
      Accept(port);
    });
  }

  SocketSession* Find(ClientId client) const {
    const auto found = clients.all.find(client);
    return found == clients.all.end() ? nullptr : found->second.get();
  }

  asio::io_context context{1};  // goes last: its handlers hold sessions, and these their port
  std::vector<std::shared_ptr<Port>> ports;
  Clients clients;
  asio::steady_timer retry{context};
  std::vector<std::unique_ptr<asio::steady_timer>> timers;
  std::thread thread;
};

WebServer::WebServer() : impl_(std::make_unique<Impl>()) {}

WebServer::~WebServer() {
  impl_->context.stop();
  if (impl_->thread.joinable()) impl_->thread.join();
}

int WebServer::Listen(const PortSettings& settings, WebEndpoint* endpoint) {
  Error error;
  const auto address = asio::ip::make_address(settings.address, error);
  if (error) {
    throw RunError("'" + settings.address + "' is no IP address: give one of this machine's");
  }
  auto port = std::make_shared<Port>(impl_->context, settings, endpoint);
  const int last = settings.port == 0 ? 0 : std::min(65535, settings.port + settings.further);
  for (int number = settings.port; number <= last; ++number) {
    error = {};
    Bind(port->acceptor, {address, static_cast<std::uint16_t>(number)}, &error);
    if (error != asio::error::address_in_use) break;
  }
  if (error) {
    throw RunError("cannot listen on " + settings.address + " port " +
                   std::to_string(settings.port) + ": " + error.message());
  }
  port->settings.rules.hosts.insert(port->settings.rules.hosts.end(),
                                    {settings.address, "localhost", "127.0.0.1", "::1"});
  const int number = port->acceptor.local_endpoint().port();
  impl_->ports.push_back(std::move(port));
  return number;
}

void WebServer::Start() {
  for (const auto& port : impl_->ports) impl_->Accept(port);
  impl_->thread = std::thread([this] { impl_->context.run(); });
}

void WebServer::Post(std::function<void()> work) { asio::post(impl_->context, std::move(work)); }

void WebServer::Every(std::chrono::milliseconds period, std::function<void()> work) {
  impl_->timers.push_back(std::make_unique<asio::steady_timer>(impl_->context));
  Repeat(*impl_->timers.back(), period, work);
}

void WebServer::Send(ClientId client, const OutMessage& message) {
  if (SocketSession* session = impl_->Find(client)) session->Send(message);
}

void WebServer::Close(ClientId client, std::uint16_t code, const std::string& reason) {
  if (SocketSession* session = impl_->Find(client)) session->Close(code, reason);
}

ClientCounts WebServer::CountsOf(ClientId client) const {
  const SocketSession* session = impl_->Find(client);
  return session ? session->counts() : ClientCounts{};
}

}  // namespace palpate::view
