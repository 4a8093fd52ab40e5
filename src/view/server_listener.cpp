#include "view/server_listener.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <limits>
#include <map>
#include <optional>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>

#include "view/server_workers.hpp"

namespace sunfleck {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::system::error_code;

std::string_view view_of(beast::string_view text) {
  return {text.data(), text.size()};
}

Answer plain(int status, const std::string& text) {
  return {status, "text/plain; charset=utf-8", text + "\n"};
}

/// True where the client has gone or its time is over: all but what is wrong with the text of a request.
bool is_gone(const error_code& error) {
  return error && (error.category() != make_error_code(http::error::bad_method).category() || error == http::error::end_of_stream ||
                   error == http::error::partial_message);
}

/// What is wrong with a head that could not be read.
Answer refusal(const error_code& error) {
  if (error == http::error::header_limit || error == http::error::buffer_overflow) return plain(431, "the request's headers are too long");
  return plain(400, "this is no HTTP request");
}

[[noreturn]] void cannot_serve(const std::string& address, int port, const error_code& error) {
  const std::string place = port > 0 ? fmt::format("{}:{}", address, port) : address;
  if (error == asio::error::address_in_use)
    throw OutputError(place + ": the port is in use, perhaps by another viewer; without --port a free one is taken");
  throw OutputError(fmt::format("{}: this address cannot be served: {}", place, error.message()));
}

using Parser = http::request_parser<http::empty_body>;

bool has_body(const Parser& parser) {
  return parser.chunked() || parser.content_length().value_or(0) > 0;
}

bool same_name(std::string_view a, std::string_view b) {
  return beast::iequals({a.data(), a.size()}, {b.data(), b.size()});
}

}  // namespace

std::size_t RequestHead::count(std::string_view name) const {
  return static_cast<std::size_t>(std::count_if(headers.begin(), headers.end(), [&](const auto& h) { return same_name(h.first, name); }));
}

std::string RequestHead::header(std::string_view name) const {
  const auto found = std::find_if(headers.begin(), headers.end(), [&](const auto& h) { return same_name(h.first, name); });
  return found == headers.end() ? "" : std::string(found->second);
}

namespace {

/// What a connection does now; all but the work waits for its client.
enum class Phase { reading, working, writing, parting };

}  // namespace

/// All members but the workers are used by the thread that serves; a worker hands over its answer by the connection's number.
struct ServerListener::Impl {
  struct Connection : std::enable_shared_from_this<Connection> {
    Connection(Impl& all, std::uint64_t number, tcp::socket socket)
        : all_(all), number_(number), stream_(std::move(socket)), buffer_(all.limits.head_bytes) {}

    void read_first();
    void read_head();
    void heard(const error_code& error);
    void send(Answer answer, bool keep);
    void part();
    void forget_rest();
    void close();

    Impl& all_;
    std::uint64_t number_;
    Phase phase_ = Phase::reading;
    std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();  ///< it has been waiting for its client
    bool keep_ = false, head_only_ = false;                                           ///< of the request that is being answered
    beast::tcp_stream stream_;
    beast::flat_buffer buffer_;
    std::optional<Parser> parser_;
    http::response<http::string_body> response_;
    std::size_t counted_bytes_ = 0;  ///< of its answer, within all.answer_bytes
  };

  Impl(const std::string& address, int wanted, std::vector<std::pair<std::string, std::string>> common,
       std::function<Reply(const RequestHead&)> respond_to, const ListenerLimits& bounds)
      : limits(bounds),
        headers(std::move(common)),
        respond(std::move(respond_to)),
        acceptor(io),
        pause(io),
        workers(bounds.workers, bounds.waiting) {
    open(address, wanted);
    accept();
  }
  ~Impl() { connections.clear(); }  // while what they wait on is there

  void open(const std::string& address, int wanted);
  void accept();
  void accepted(const error_code& error, tcp::socket socket);
  bool make_room();
  Reply judged(const Connection& connection) const;

  ListenerLimits limits;
  std::vector<std::pair<std::string, std::string>> headers;
  std::function<Reply(const RequestHead&)> respond;
  std::array<char, 65536> forgotten{};  ///< what refused clients still send goes here, from all of them
  std::size_t answer_bytes = 0;
  std::uint64_t next_number = 0;
  std::map<std::uint64_t, std::shared_ptr<Connection>> connections;
  asio::io_context io{1};
  tcp::acceptor acceptor;
  asio::steady_timer pause;
  ServerWorkers workers;  ///< last: ends first
};

void ServerListener::Impl::open(const std::string& address, int wanted) {
  error_code error;
  const auto found = tcp::resolver(io).resolve(address, std::to_string(wanted), tcp::resolver::passive, error);
  if (error) cannot_serve(address, wanted, error);
  for (const auto& entry : found) {
    acceptor.close(error);
    if (acceptor.open(entry.endpoint().protocol(), error)) continue;
    acceptor.set_option(tcp::acceptor::reuse_address(true), error);  // past connections do not hold the port; another listener does
    if (acceptor.bind(entry.endpoint(), error) || acceptor.listen(asio::socket_base::max_listen_connections, error)) continue;
    return;
  }
  cannot_serve(address, wanted, error);
}

void ServerListener::Impl::accept() {
  acceptor.async_accept([this](const error_code& error, tcp::socket socket) { accepted(error, std::move(socket)); });
}

void ServerListener::Impl::accepted(const error_code& error, tcp::socket socket) {
  if (error == asio::error::operation_aborted) return;
  if (error) {  // as when the system has no more descriptors
    make_room();
    pause.expires_after(std::chrono::milliseconds(20));
    pause.async_wait([this](const error_code&) { accept(); });
    return;
  }
  try {
    if (connections.size() < limits.connections || make_room()) {
      error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      const auto made = std::make_shared<Connection>(*this, next_number++, std::move(socket));
      connections.emplace(made->number_, made);
      made->read_first();
    }
  } catch (const std::bad_alloc&) {  // this one is closed; others are heard
  }
  accept();
}

bool ServerListener::Impl::make_room() {
  std::shared_ptr<Connection> oldest;
  for (const auto& [number, one] : connections)
    if (one->phase_ != Phase::working && (!oldest || one->since_ < oldest->since_)) oldest = one;
  if (oldest) oldest->close();
  return oldest != nullptr;
}

/// Waits for the first byte, so that the time for a head begins with it.
void ServerListener::Impl::Connection::read_first() {
  phase_ = Phase::reading, since_ = std::chrono::steady_clock::now();
  parser_.emplace();
  parser_->header_limit(static_cast<std::uint32_t>(all_.limits.head_bytes));
  parser_->body_limit(std::numeric_limits<std::uint64_t>::max());  // none is ever read
  if (buffer_.size() > 0) return read_head();                      // sent along with the last one
  stream_.expires_after(all_.limits.idle_time);
  stream_.async_read_some(buffer_.prepare(std::min<std::size_t>(all_.limits.head_bytes, 1024)),
                          [self = shared_from_this()](const error_code& error, std::size_t bytes) {
                            if (error) return self->close();
                            self->buffer_.commit(bytes);
                            self->since_ = std::chrono::steady_clock::now();
                            self->read_head();
                          });
}

void ServerListener::Impl::Connection::read_head() {
  stream_.expires_after(all_.limits.head_time);
  http::async_read_header(stream_, buffer_, *parser_, [self = shared_from_this()](const error_code& error, std::size_t) {
    try {
      self->heard(error);
    } catch (const std::bad_alloc&) {
      self->close();
    }
  });
}

/// The answer to a request whose head is there.
Reply ServerListener::Impl::judged(const Connection& connection) const {
  const auto& message = connection.parser_->get();
  RequestHead head;
  head.method = view_of(message.method_string()), head.target = view_of(message.target());
  for (const auto& field : message) head.headers.emplace_back(view_of(field.name_string()), view_of(field.value()));
  Reply reply = respond(head);
  if (has_body(*connection.parser_) && !std::holds_alternative<Answer>(reply)) return plain(413, "requests have no body here");
  return reply;
}

void ServerListener::Impl::Connection::heard(const error_code& error) {
  keep_ = head_only_ = false;
  if (is_gone(error)) return close();
  if (error) return send(refusal(error), false);
  const auto& message = parser_->get();
  keep_ = message.keep_alive() && !has_body(*parser_);  // which would have to be read, or be taken for the next request
  head_only_ = message.method() == http::verb::head;
  Reply reply = all_.judged(*this);
  parser_.reset();
  stream_.expires_never();
  if (auto* answer = std::get_if<Answer>(&reply)) return send(std::move(*answer), keep_);
  phase_ = Phase::working;
  const bool taken = all_.workers.take([&all = all_, number = number_, work = std::get<std::function<Answer()>>(std::move(reply))] {
    auto answer = std::make_shared<Answer>(work());
    asio::post(all.io, [&all, number, answer] {
      if (const auto found = all.connections.find(number); found != all.connections.end())
        found->second->send(std::move(*answer), found->second->keep_);
    });
  });
  if (!taken) send(plain(503, "the viewer is busy"), keep_);
}

void ServerListener::Impl::Connection::send(Answer answer, bool keep) {
  if (all_.answer_bytes > 0 && all_.answer_bytes + answer.body.size() > all_.limits.answer_bytes)
    answer = plain(503, "the viewer is busy: others do not read their answers");
  phase_ = Phase::writing, since_ = std::chrono::steady_clock::now(), keep_ = keep;
  response_ = {};
  response_.version(11);
  response_.result(static_cast<unsigned>(answer.status));
  for (const auto& [name, value] : all_.headers) response_.insert({name.data(), name.size()}, value);
  for (const auto& [name, value] : answer.headers) response_.insert({name.data(), name.size()}, value);
  response_.set(http::field::content_type, answer.type);
  response_.keep_alive(keep);
  response_.content_length(answer.body.size());
  if (!head_only_) response_.body() = std::move(answer.body);
  counted_bytes_ = response_.body().size();
  all_.answer_bytes += counted_bytes_;
  stream_.expires_after(all_.limits.answer_time);
  http::async_write(stream_, response_, [self = shared_from_this()](const error_code& error, std::size_t) {
    self->all_.answer_bytes -= std::exchange(self->counted_bytes_, 0);
    self->response_ = {};
    if (error) return self->close();
    if (!self->keep_) return self->part();
    self->read_first();
  });
}

/// Ends the answer; a client that still sends would not see it if the connection were closed on it.
void ServerListener::Impl::Connection::part() {
  phase_ = Phase::parting, since_ = std::chrono::steady_clock::now();
  error_code ignored;
  stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
  stream_.expires_after(all_.limits.parting_time);
  buffer_ = beast::flat_buffer(0);
  forget_rest();
}

void ServerListener::Impl::Connection::forget_rest() {
  stream_.async_read_some(asio::buffer(all_.forgotten), [self = shared_from_this()](const error_code& error, std::size_t) {
    if (error) return self->close();
    self->forget_rest();
  });
}

void ServerListener::Impl::Connection::close() {
  stream_.close();
  all_.connections.erase(number_);
}

ServerListener::ServerListener(const std::string& address, int port, std::vector<std::pair<std::string, std::string>> headers,
                               std::function<Reply(const RequestHead&)> respond, const ListenerLimits& limits)
    : impl_(std::make_unique<Impl>(address, port, std::move(headers), std::move(respond), limits)) {}

ServerListener::~ServerListener() = default;

int ServerListener::port() const {
  boost::system::error_code error;
  return impl_->acceptor.local_endpoint(error).port();
}

void ServerListener::serve(std::chrono::milliseconds time) {
  const auto end = std::chrono::steady_clock::now() + time;
  while (std::chrono::steady_clock::now() < end) {
    try {
      impl_->io.run_until(end);
    } catch (const std::bad_alloc&) {  // of one connection, which then gives way to others
    }
  }
}

}  // namespace sunfleck
