// The viewer on a real socket: who is answered, and what garbage does.
#include <catch2/catch.hpp>

#include <atomic>
#include <chrono>
#include <random>
#include <thread>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/view/viewer.hpp>

#include "result_scene.hpp"

using namespace sunfleck;
using namespace sunfleck::test;

namespace {

class Stoppable final : public Progress {
 public:
  std::atomic<bool> stop{false};
  bool cancelled() const override { return stop; }
};

std::string stored(const Folder& folder) {
  const Scene scene = small_scene();
  const FacetScene facets = expand(scene);
  const Values values(facets);
  const PlacedScene placed = place(scene);
  ResultWriter writer(folder / "r.h5", scene, placed, OutputChoice{}, "0.1.0", "flat");
  values.send(writer, 1000);
  writer.finish(small_report());
  return folder / "r.h5";
}

/// A viewer that runs for as long as the test.
struct Running {
  explicit Running(ViewerSettings settings = {})
      : server([&] {
          settings.results = {stored(folder)};
          return settings;
        }()) {
    thread = std::thread([this] { server.run(progress); });
  }
  ~Running() {
    progress.stop = true;
    thread.join();
  }
  Folder folder;
  ViewerServer server;
  Stoppable progress;
  std::thread thread;
};

class Connection {
 public:
  explicit Connection(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET, address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{20, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    REQUIRE(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  }
  ~Connection() { ::close(socket_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  void send(const std::string& text) const { (void)!::send(socket_, text.data(), text.size(), MSG_NOSIGNAL); }
  std::string rest() const {
    std::string all;
    char buffer[4096];
    for (ssize_t n; (n = ::recv(socket_, buffer, sizeof buffer, 0)) > 0;) all.append(buffer, static_cast<std::size_t>(n));
    return all;
  }

 private:
  int socket_;
};

std::string converse(int port, const std::string& text) {
  const Connection c(port);
  c.send(text);
  return c.rest();
}

std::string get(int port, const std::string& target, const std::string& headers) {
  return converse(port, "GET " + target + " HTTP/1.1\r\n" + headers + "Connection: close\r\n\r\n");
}

int status_of(const std::string& reply) {
  return reply.starts_with("HTTP/1.1 ") ? std::stoi(reply.substr(9, 3)) : 0;
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const std::string local = "Host: localhost:1234\r\n";

}  // namespace

TEST_CASE("the viewer answers its own page and refuses others", "[view][viewer][server]") {
  const Running viewer;
  const int port = viewer.server.port();
  CHECK(viewer.server.url() == "http://127.0.0.1:" + std::to_string(port) + "/");
  const std::string page = get(port, "/", local);
  CHECK(status_of(page) == 200);
  CHECK(holds(page, "<title>Sunfleck viewer</title>"));
  CHECK(holds(page, "Content-Security-Policy: default-src 'none'; script-src 'self'"));
  CHECK(holds(page, "X-Content-Type-Options: nosniff"));
  CHECK(holds(page, "Cross-Origin-Resource-Policy: same-origin"));
  CHECK_FALSE(holds(page, "Access-Control-Allow-Origin"));

  CHECK(status_of(get(port, "/", "Host: rebound.example.org\r\n")) == 403);
  CHECK(status_of(get(port, "/", "Host: localhost\r\nHost: example.org\r\n")) == 403);
  CHECK(status_of(get(port, "/", "")) == 403);
  CHECK(status_of(get(port, "/api/status", local + "Origin: http://example.org\r\n")) == 403);
  CHECK(status_of(get(port, "/api/status", local + "Origin: http://localhost:1234\r\n")) == 200);
  CHECK(status_of(get(port, "/api/frame", local + "Sec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: no-cors\r\n")) == 403);
  const std::string reload = "POST /api/reload HTTP/1.1\r\nConnection: close\r\nContent-Length: 0\r\n";
  CHECK(status_of(converse(port, reload + local + "Origin: http://example.org\r\n\r\n")) == 403);
  // The body of a refused request is not taken for a request of its own.
  const std::string inner = "POST /api/reload HTTP/1.1\r\n" + local + "Connection: close\r\n\r\n";
  const std::string smuggled = converse(port, "POST /api/reload HTTP/1.1\r\n" + local + "Origin: http://example.org\r\nContent-Length: " +
                                                  std::to_string(inner.size()) + "\r\n\r\n" + inner);
  CHECK(status_of(smuggled) == 403);
  CHECK(smuggled.find("HTTP/1.1", 1) == std::string::npos);
}

TEST_CASE("a token is needed where one is set, and turns into a cookie", "[view][viewer][server]") {
  const std::string token = "0123456789abcdefXYZ";
  const Running viewer({.results = {}, .listen = "127.0.0.1", .token = token});
  const int port = viewer.server.port();
  const std::string named = "Host: field.example.org\r\n";
  CHECK(holds(viewer.server.url(), "/?token=" + token));
  CHECK(status_of(get(port, "/", named)) == 401);
  CHECK(status_of(get(port, "/api/status?token=wrong", named)) == 401);
  const std::string entry = get(port, "/?token=" + token, named);
  CHECK(status_of(entry) == 303);
  CHECK(holds(entry, "Set-Cookie: sunfleck_" + std::to_string(port) + "=" + token + "; HttpOnly; SameSite=Strict; Path=/"));
  CHECK(holds(entry, "Location: /\r\n"));
  CHECK(status_of(get(port, "/", named + "Cookie: sunfleck_" + std::to_string(port) + "=" + token + "\r\n")) == 200);
  CHECK(status_of(get(port, "/", named + "Authorization: Bearer " + token + "\r\n")) == 200);
}

TEST_CASE("settings that cannot be are refused before anything is served", "[view][viewer][server]") {
  const Folder folder;
  const std::string file = stored(folder);
  CHECK_THROWS_WITH(ViewerServer({.results = {folder / "none.h5"}}), folder / "none.h5" + ": found no such file; expected a result file");
  CHECK_THROWS_WITH(ViewerServer({.results = {file}, .listen = "0.0.0.0"}),
                    "--listen: found no --token; expected one ('--token new' makes one), since others can then reach the viewer");
  CHECK_THROWS_WITH(ViewerServer({.results = {file}, .token = "short"}),
                    "--token: found 5 characters; expected 'new', or 16 to 256 letters, digits, '-' or '_'");
  CHECK_THROWS_WITH(ViewerServer({.results = {file}, .token = "with spaces and more"}),
                    "--token: found 20 characters, some of them others; expected 'new', or 16 to 256 letters, digits, '-' or '_'");
  const ViewerServer first({.results = {file}});
  CHECK_THROWS_AS(ViewerServer({.results = {file}, .listen = "192.0.2.1", .token = "new"}), OutputError);  // not an address of this machine
}

TEST_CASE("garbage and slow clients do not keep the viewer from answering", "[view][viewer][server]") {
  const Running viewer;
  const int port = viewer.server.port();
  std::vector<std::string> garbage{
      "",
      "\r\n\r\n",
      "GET\r\n\r\n",
      "GET / HTTP/9.9\r\n\r\n",
      "BREW /pot HTTP/1.1\r\n" + local + "\r\n",
      "GET /" + std::string(100000, 'a') + " HTTP/1.1\r\n" + local + "\r\n",
      "GET / HTTP/1.1\r\nHost: " + std::string(100000, 'a') + "\r\n\r\n",
      "GET /%00%ff%zz?%=%&&=&a=%c3%28 HTTP/1.1\r\n" + local + "Connection: close\r\n\r\n",
      "GET /api/search?text=%ff%fe%00 HTTP/1.1\r\n" + local + "Connection: close\r\n\r\n",
      "GET /api/frame?width=%2d1 HTTP/1.1\r\n" + local + "Connection: close\r\n\r\n",
      "POST /api/reload HTTP/1.1\r\n" + local + "Content-Length: 99999999999\r\nConnection: close\r\n\r\nx",
      "POST /api/reload HTTP/1.1\r\n" + local + "Content-Length: -5\r\nConnection: close\r\n\r\n",
      "POST /api/reload HTTP/1.1\r\n" + local + "Transfer-Encoding: chunked\r\nConnection: close\r\n\r\nzz\r\n",
      "GET /main.js HTTP/1.1\r\n" + local + "Range: bytes=9-1,-,0-99999999999999999999\r\nConnection: close\r\n\r\n"};
  std::string ranges = "Range: bytes=0-0";
  while (ranges.size() < 8000) ranges += ",0-0";
  garbage.push_back("GET /main.js HTTP/1.1\r\n" + local + ranges + "\r\nConnection: close\r\n\r\n");
  std::string headers;
  for (int i = 0; i < 20000; ++i) headers += "X-" + std::to_string(i) + ": y\r\n";
  garbage.push_back("GET / HTTP/1.1\r\n" + local + headers + "\r\n");
  std::mt19937 random(1);
  for (int k = 0; k < 30; ++k) {
    std::string noise;
    for (int i = 0; i < 400; ++i) noise += static_cast<char>(random() & 0xff);
    garbage.push_back(noise + "\r\n\r\n");
  }
  std::vector<std::unique_ptr<Connection>> open;  // all at once: some are only given up after a while
  for (const auto& text : garbage) {
    open.push_back(std::make_unique<Connection>(port));
    open.back()->send(text);
  }
  std::vector<std::unique_ptr<Connection>> slow;
  for (int k = 0; k < 15; ++k) {
    slow.push_back(std::make_unique<Connection>(port));
    slow.back()->send("GET / HTTP/1.1\r\nHost: local");
  }
  const auto begin = std::chrono::steady_clock::now();
  CHECK(status_of(get(port, "/api/status", local)) == 200);
  // Not one of the slow ones' three seconds is waited for; what is left is room for a busy machine.
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::milliseconds(2500));
  CHECK(status_of(get(port, "/", local)) == 200);
}

TEST_CASE("a stopped viewer ends although clients hang on", "[view][viewer][server]") {
  auto viewer = std::make_unique<Running>();
  const Connection idle(viewer->server.port());
  idle.send("GET /api/status HTTP/1.1\r\n" + local + "\r\nGET / HT");
  const auto begin = std::chrono::steady_clock::now();
  viewer.reset();
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(10));  // three to give the client up, the rest for a busy machine
}
