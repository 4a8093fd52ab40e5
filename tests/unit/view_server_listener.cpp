// The listener alone, with limits so small that a test meets them.
#include <catch2/catch.hpp>

#include <atomic>
#include <chrono>
#include <thread>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <sunfleck/core/error.hpp>

#include "view/server_listener.hpp"

using namespace sunfleck;
using namespace std::chrono_literals;

namespace {

using Clock = std::chrono::steady_clock;

/// Answers "/now" at once and all else from a worker: "/slow" once it is released, "/big" with more than a socket holds.
struct Running {
  explicit Running(const ListenerLimits& limits)
      : listener(
            "127.0.0.1", 0, {{"X-Common", "1"}}, [this](const RequestHead& head) { return respond(head); }, limits),
        thread([this] {
          while (!stop) listener.serve(10ms);
        }) {}
  ~Running() {
    released = stop = true;
    thread.join();
  }
  Reply respond(const RequestHead& head) {
    const std::string target(head.target);
    if (target == "/now") return Answer{200, "text/plain", "now"};
    return [this, target] {
      while (target == "/slow" && !released) std::this_thread::sleep_for(1ms);
      return Answer{200, "text/plain", target == "/big" ? std::string(16000000, 'b') : target};
    };
  }

  std::atomic<bool> stop{false}, released{false};
  ServerListener listener;
  std::thread thread;
};

class Client {
 public:
  explicit Client(const Running& server, int receive_bytes = 0) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    const timeval patience{10, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    if (receive_bytes > 0) ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_bytes, sizeof receive_bytes);
    sockaddr_in address{};
    address.sin_family = AF_INET, address.sin_port = htons(static_cast<std::uint16_t>(server.listener.port()));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    REQUIRE(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  }
  ~Client() { ::close(socket_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  bool send(const std::string& text) const {
    return ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
  }
  void get(const std::string& target, const std::string& headers = "") const { send("GET " + target + " HTTP/1.1\r\n" + headers + "\r\n"); }
  /// Until the answer holds the text, or the connection ends.
  std::string until(const std::string& text) const {
    std::string all;
    char buffer[4096];
    for (ssize_t n; (text.empty() || all.find(text) == std::string::npos) && (n = ::recv(socket_, buffer, sizeof buffer, 0)) > 0;)
      all.append(buffer, static_cast<std::size_t>(n));
    return all;
  }
  std::string rest() const { return until(""); }

 private:
  int socket_;
};

}  // namespace

TEST_CASE("one connection carries one request after the other", "[view][server]") {
  const Running server({});
  const Client client(server);
  client.get("/now");
  const std::string first = client.until("now");
  CHECK(first.starts_with("HTTP/1.1 200 OK\r\n"));
  CHECK(first.find("X-Common: 1\r\n") != std::string::npos);
  client.send("GET /a HTTP/1.1\r\n\r\nGET /b HTTP/1.1\r\n\r\nHEAD /c HTTP/1.1\r\nConnection: close\r\n\r\n");  // all at once
  const std::string all = client.rest();
  CHECK(all.find("/a") < all.find("/b"));
  CHECK(all.ends_with("\r\n\r\n"));  // of HEAD, the length alone
  CHECK(all.find("/c") == std::string::npos);
}

TEST_CASE("a request has a time by which its head must be there, however it drips", "[view][server]") {
  ListenerLimits limits;
  limits.head_time = 300ms, limits.idle_time = 200ms;
  const Running server(limits);
  const Client drip(server), idle(server), used(server);
  const auto begun = Clock::now();
  bool open = drip.send("GET / HTTP/1.1\r\nX: ");
  while (open && Clock::now() - begun < 5s) {
    open = drip.send("a");
    std::this_thread::sleep_for(20ms);
  }
  CHECK_FALSE(open);
  CHECK(idle.rest().empty());  // closed without a word
  used.get("/now");
  CHECK(used.until("now").empty());  // it has been idle too
  CHECK(Clock::now() - begun < 3s);
}

TEST_CASE("a connection too many takes the place of the one that waited longest", "[view][server]") {
  ListenerLimits limits;
  limits.connections = 3;
  const Running server(limits);
  const Client working(server);
  working.get("/slow");
  std::this_thread::sleep_for(50ms);
  const Client second(server), third(server);
  second.send("GET"), third.send("GET");
  std::this_thread::sleep_for(50ms);
  const Client fourth(server);
  fourth.get("/now", "Connection: close\r\n");
  CHECK(fourth.rest().ends_with("now"));
  CHECK(second.rest().empty());
  third.send(" /now HTTP/1.1\r\n\r\n");
  CHECK(third.until("now").ends_with("now"));
}

TEST_CASE("work beyond the workers waits, and what would wait too long is refused", "[view][server]") {
  ListenerLimits limits;
  limits.workers = 1, limits.waiting = 1;
  Running server(limits);
  const Client a(server), b(server), c(server);
  a.get("/slow");
  std::this_thread::sleep_for(50ms);
  b.get("/b");
  std::this_thread::sleep_for(50ms);
  c.get("/c", "Connection: close\r\n");
  CHECK(c.rest().starts_with("HTTP/1.1 503"));
  server.released = true;
  CHECK(a.until("/slow").ends_with("/slow"));
  CHECK(b.until("/b").ends_with("/b"));
}

TEST_CASE("answers that nobody reads are given up, and take no more memory than they may", "[view][server]") {
  ListenerLimits limits;
  limits.answer_bytes = 20000000, limits.answer_time = 1000ms;
  const Running server(limits);
  // Two of 16 MB do not fit into what all may have; a socket's own buffers hold less than one.
  const Client a(server, 4096), b(server, 4096);
  a.get("/big");
  std::this_thread::sleep_for(100ms);
  b.get("/big", "Connection: close\r\n");
  const std::string refused = b.rest();
  CHECK(refused.starts_with("HTTP/1.1 503"));
  std::this_thread::sleep_for(1500ms);
  const Client c(server);
  c.get("/big", "Connection: close\r\n");
  CHECK(c.rest().size() > 16000000);
  CHECK(a.rest().size() < 16000000);
}

TEST_CASE("a port is had by one listener", "[view][server]") {
  const auto nothing = [](const RequestHead&) -> Reply { return Answer{}; };
  const ServerListener first("127.0.0.1", 0, {}, nothing);
  const std::string port = std::to_string(first.port());
  CHECK_THROWS_WITH(ServerListener("127.0.0.1", first.port(), {}, nothing),
                    "127.0.0.1:" + port + ": the port is in use, perhaps by another viewer; without --port a free one is taken");
  CHECK_THROWS_AS(ServerListener("0.0.0.0", first.port(), {}, nothing), OutputError);
  CHECK_THROWS_WITH(ServerListener("192.0.2.1", 0, {}, nothing),
                    "192.0.2.1: this address cannot be served: Cannot assign requested address");
}
