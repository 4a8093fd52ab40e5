// `sunfleck view` among clients that nobody vouches for: what they send takes no memory, they keep nobody out, and it ends when told to.
#include <catch2/catch.hpp>

#include <chrono>
#include <csignal>
#include <fstream>
#include <memory>
#include <thread>

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "places.hpp"
#include "run_program.hpp"
#include "sanitized.hpp"

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::seconds;

std::string small_result(const TemporaryFolder& folder) {
  const std::string scene = folder.file("scene.toml",
                                        "bands = [\"PAR\"]\n[sun]\ndirection = [0, 0, 1]\nirradiance = { PAR = 100 }\n"
                                        "[ground]\nsize = [1, 1]\ncells = [2, 2]\nreflectance = { PAR = 0.1 }\n");
  const auto run = run_sunfleck({"solve", scene, "-o", folder.path("r.h5"), "--method", "direct", "--no-certificate"});
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  return folder.path("r.h5");
}

/// The built program as a viewer of a small result, from when it has printed its address.
class Viewer {
 public:
  explicit Viewer(const std::string& result) {
    int out[2];
    REQUIRE(pipe(out) == 0);
    child_ = fork();
    REQUIRE(child_ >= 0);
    if (child_ == 0) {
      dup2(out[1], STDOUT_FILENO);
      dup2(open("/dev/null", O_WRONLY), STDERR_FILENO);
      close(out[0]), close(out[1]);
      for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) std::signal(signal, SIG_DFL);  // whatever the tests' runner makes of them
      execl(SUNFLECK_PROGRAM, "sunfleck", "view", result.c_str(), nullptr);
      _exit(127);
    }
    close(out[1]);
    std::string url;
    for (char c; ::read(out[0], &c, 1) == 1 && c != '\n';) url += c;
    close(out[0]);
    const std::string start = "http://127.0.0.1:";
    REQUIRE(url.starts_with(start));
    port_ = std::stoi(url.substr(start.size()));
  }
  ~Viewer() {
    if (child_ > 0) kill(child_, SIGKILL), waitpid(child_, nullptr, 0);
  }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  int port() const { return port_; }
  /// Most memory it has ever had [KiB].
  long peak() const {
    std::ifstream in("/proc/" + std::to_string(child_) + "/status");
    for (std::string word; in >> word;)
      if (long kib = 0; word == "VmHWM:" && in >> kib) return kib;
    FAIL("no /proc of the viewer");
    return 0;
  }
  /// Sends the signal and waits; the exit code, 128 + signal if it was killed.
  int end(int signal) {
    kill(child_, signal);
    int status = 0;
    waitpid(child_, &status, 0);
    child_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  pid_t child_ = -1;
  int port_ = 0;
};

class Client {
 public:
  explicit Client(const Viewer& viewer) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET, address.sin_port = htons(static_cast<std::uint16_t>(viewer.port()));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{10, 0}, sending{1, 0};  // a viewer that takes no more is not waited for
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &sending, sizeof sending);
    REQUIRE(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  }
  ~Client() { ::close(socket_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// False once the other side takes no more.
  bool send(const std::string& text) const {
    return ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
  }
  std::string rest() const {
    std::string all;
    char buffer[4096];
    for (ssize_t n; (n = ::recv(socket_, buffer, sizeof buffer, 0)) > 0;) all.append(buffer, static_cast<std::size_t>(n));
    return all;
  }

 private:
  int socket_;
};

/// 0 where there is no answer.
int status_of(const std::string& reply) {
  return reply.starts_with("HTTP/1.1 ") ? std::stoi(reply.substr(9, 3)) : 0;
}

int honest_status(const Viewer& viewer) {
  const Client client(viewer);
  client.send("GET /api/status HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  return status_of(client.rest());
}

const long allowed = 20 * 1024;  ///< KiB that attacks may add

/// Sends the beginning, then the piece over and over.
void flood(const Viewer& viewer, const std::string& beginning, const std::string& piece, int mib) {
  const Client client(viewer);
  client.send(beginning);
  std::string block;
  while (block.size() < (1u << 20)) block += piece;
  for (int sent = 0; sent < mib && client.send(block);) ++sent;
}

}  // namespace

TEST_CASE("what strangers send without end takes no memory of the viewer", "[cli][viewer]") {
  const TemporaryFolder folder;
  const Viewer viewer(small_result(folder));
  REQUIRE(honest_status(viewer) == 200);
  const long before = viewer.peak();
  const std::string get = "GET / HTTP/1.1\r\n", post = "POST /api/reload HTTP/1.1\r\nHost: localhost\r\n";
  flood(viewer, get + "X: ", "a", 600);
  flood(viewer, get, "X-Name: value\r\n", 30);
  flood(viewer, get, "X: ;\r\n", 20);
  flood(viewer, "GET /", "a", 30);
  flood(viewer, "", "a", 30);
  flood(viewer, "", "\r\n", 20);
  flood(viewer, get + "Host: localhost\r\nRange: bytes=0-0", ",0-0", 20);
  flood(viewer, post + "Content-Length: 999999999999\r\n\r\n", "a", 30);
  flood(viewer, post + "Transfer-Encoding: chunked\r\n\r\n", "8\r\naaaaaaaa\r\n", 20);
  flood(viewer, post + "Transfer-Encoding: chunked\r\n\r\n1;", "name=value;", 20);
  flood(viewer, post + "Transfer-Encoding: chunked\r\n\r\n0\r\n", "X: trailer\r\n", 20);
  flood(viewer, "", get + "Host: localhost\r\n\r\n", 8);  // requests whose answers are not read
  CHECK(honest_status(viewer) == 200);
  if (!sanitized) CHECK(viewer.peak() - before < allowed);
}

TEST_CASE("bodies and long heads are refused with a reason", "[cli][viewer]") {
  const TemporaryFolder folder;
  const Viewer viewer(small_result(folder));
  const auto reply = [&](const std::string& request) {
    const Client client(viewer);
    client.send(request);
    return client.rest();
  };
  const std::string host = "Host: localhost\r\n";
  const std::string longer = reply("GET / HTTP/1.1\r\n" + host + "X: " + std::string(20000, 'a') + "\r\n\r\n");
  CHECK(status_of(longer) == 431);
  CHECK(longer.ends_with("\r\n\r\nthe request's headers are too long\n"));
  CHECK(longer.find("X-Frame-Options: DENY") != std::string::npos);
  const std::string body = reply("POST /api/reload HTTP/1.1\r\n" + host + "Content-Length: 5\r\n\r\nhello");
  CHECK(status_of(body) == 413);
  CHECK(body.ends_with("\r\n\r\nrequests have no body here\n"));
  CHECK(status_of(reply("GET / HTTP/1.1\r\n" + host + "Transfer-Encoding: chunked\r\n\r\n")) == 413);
  CHECK(status_of(reply("nonsense\r\n\r\n")) == 400);
  CHECK(status_of(reply("GET http://localhost/ HTTP/1.1\r\n" + host + "Connection: close\r\n\r\n")) == 400);
  CHECK(status_of(reply("DELETE / HTTP/1.1\r\n" + host + "Connection: close\r\n\r\n")) == 405);
  const std::string head = reply("HEAD / HTTP/1.1\r\n" + host + "Connection: close\r\n\r\n");
  CHECK(status_of(head) == 200);
  CHECK(head.ends_with("\r\n\r\n"));
}

TEST_CASE("slow clients keep nobody out, nor the viewer from ending", "[cli][viewer]") {
  const TemporaryFolder folder;
  Viewer viewer(small_result(folder));
  REQUIRE(honest_status(viewer) == 200);
  const long before = viewer.peak();
  const std::vector<std::string> beginnings{
      "", "G", "GET / HTTP/1.1\r\nX: ", "POST /api/reload HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100\r\n\r\n"};
  std::vector<std::unique_ptr<Client>> slow;
  for (const std::size_t count : {200u, 600u}) {  // the second are more than there may be
    while (slow.size() < count) {
      slow.push_back(std::make_unique<Client>(viewer));
      slow.back()->send(beginnings[slow.size() % beginnings.size()]);
    }
    for (int k = 0; k < 5; ++k) {
      for (const auto& client : slow) client->send("a");
      const auto asked = Clock::now();
      CHECK(honest_status(viewer) == 200);
      CHECK(Clock::now() - asked < seconds(2));
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }
  if (!sanitized) CHECK(viewer.peak() - before < allowed);
  const auto told = Clock::now();
  CHECK(viewer.end(SIGINT) == 0);
  CHECK(Clock::now() - told < seconds(2));
}

TEST_CASE("a viewer on a port that another one has fails", "[cli][viewer]") {
  const TemporaryFolder folder;
  const std::string result = small_result(folder);
  const Viewer first(result);
  const auto second = run_sunfleck({"view", result, "--port", std::to_string(first.port())});
  CHECK(second.exit_code == 1);
  CHECK(second.err == "sunfleck: 127.0.0.1:" + std::to_string(first.port()) +
                          ": the port is in use, perhaps by another viewer; without --port a free one is taken\n");
  CHECK(second.out.empty());
  const auto everywhere =
      run_sunfleck({"view", result, "--port", std::to_string(first.port()), "--listen", "0.0.0.0", "--token", "0123456789abcdef"});
  CHECK(everywhere.exit_code == 1);
  CHECK(honest_status(first) == 200);
}

TEST_CASE("a viewer that gets no thread says so", "[cli][viewer]") {
  if (sanitized) return;  // their shadow memory is larger than the limit
  const TemporaryFolder folder;
  const std::string result = small_result(folder);
  ProgramFate fate;
  fate.no_threads = true;
  const auto run = run_sunfleck({"view", result}, fate);
  CHECK(run.exit_code == 1);
  CHECK(run.err == "sunfleck: the viewer cannot start a thread: Resource temporarily unavailable\n");
}

TEST_CASE("pages of others are answered neither by a link nor in a frame", "[cli][viewer]") {
  const TemporaryFolder folder;
  const Viewer viewer(small_result(folder));
  const auto reply = [&](const std::string& path, const std::string& headers) {
    const Client client(viewer);
    client.send("GET " + path + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n" + headers + "\r\n");
    return client.rest();
  };
  const std::string navigate = "Sec-Fetch-Mode: navigate\r\nSec-Fetch-Dest: ";
  for (const char* path : {"/", "/api/status", "/main.js"}) {
    CHECK(status_of(reply(path, "Sec-Fetch-Site: cross-site\r\n" + navigate + "document\r\n")) == 403);
    CHECK(status_of(reply(path, "Sec-Fetch-Site: same-site\r\n" + navigate + "document\r\n")) == 403);
    CHECK(status_of(reply(path, "Sec-Fetch-Site: cross-site\r\n" + navigate + "iframe\r\n")) == 403);
    CHECK(status_of(reply(path, "Sec-Fetch-Site: same-origin\r\n" + navigate + "iframe\r\n")) == 403);
    CHECK(status_of(reply(path, "sec-fetch-site: cross-site\r\nSec-Fetch-Mode: no-cors\r\n")) == 403);
    const std::string own = reply(path, "Sec-Fetch-Site: none\r\n" + navigate + "document\r\n");
    CHECK(status_of(own) == 200);
    for (const char* header : {"X-Frame-Options: DENY", "frame-ancestors 'none'", "X-Content-Type-Options: nosniff",
                               "Cache-Control: no-store", "Cross-Origin-Resource-Policy: same-origin"})
      CHECK(own.find(header) != std::string::npos);
  }
}
