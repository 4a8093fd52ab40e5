// HTTP on a socket for clients that nobody vouches for: what one may send, for how long, and how many there may be is bounded before
// anything is asked of the viewer.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "view/answer.hpp"

namespace sunfleck {

/// What each connection, and all of them together, may take. A connection more than `connections` takes the place of the one that has
/// waited longest for its client to say or read something, so that slow clients never keep others out.
struct ListenerLimits {
  std::size_t connections = 256;
  std::size_t head_bytes = 16384;                ///< request line and headers; requests have no bodies
  std::chrono::milliseconds head_time{5000};     ///< from the first byte of a request to the end of its headers
  std::chrono::milliseconds idle_time{5000};     ///< between an answer and the next request
  std::chrono::milliseconds answer_time{30000};  ///< to read an answer, of at most some megabytes
  std::chrono::milliseconds parting_time{2000};  ///< what a refused client still sends is read, and forgotten, so that it reads the reason
  std::size_t workers = 16;                      ///< answers that are worked on at once
  std::size_t waiting = 64;                      ///< requests that wait for a worker
  std::size_t answer_bytes = std::size_t{64} << 20;  ///< of all answers that are being read
};

/// Request line and headers; valid for the call that gets it.
struct RequestHead {
  std::string_view method, target;
  std::vector<std::pair<std::string_view, std::string_view>> headers;

  /// How often a header is there, in any case of letters.
  std::size_t count(std::string_view name) const;
  /// Its first value, or "".
  std::string header(std::string_view name) const;
};

/// An answer at once, or the work that finds it on a thread of its own.
using Reply = std::variant<Answer, std::function<Answer()>>;

class ServerListener {
 public:
  /// Opens address and port (0: any that is free). Throws OutputError where they cannot be had, as where another program listens there.
  /// `respond` is called while serving, one request at a time; every answer gets the `headers`.
  ServerListener(const std::string& address, int port, std::vector<std::pair<std::string, std::string>> headers,
                 std::function<Reply(const RequestHead&)> respond, const ListenerLimits& limits = {});
  /// Closes all connections at once; waits for work that has begun.
  ~ServerListener();
  ServerListener(const ServerListener&) = delete;
  ServerListener& operator=(const ServerListener&) = delete;

  int port() const;
  /// Serves all connections for that long.
  void serve(std::chrono::milliseconds time);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sunfleck
