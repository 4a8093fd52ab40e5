#include <atomic>
#include <chrono>
#include <exception>
#include <optional>
#include <thread>

#include <httplib.h>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/timer.hpp>
#include <sunfleck/view/viewer.hpp>

#include "view/server_guard.hpp"
#include "view/viewer_service.hpp"

namespace sunfleck {

namespace {

constexpr std::size_t connections_at_once = 64;  ///< a slow client holds one for as long as it sends
constexpr std::size_t least_token = 16, most_token = 256;
constexpr const char* page_policy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src 'self'; base-uri 'none'; "
    "form-action 'self'; frame-ancestors 'none'";

std::string header(const httplib::Request& request, const char* name) {
  return request.get_header_value(name);
}

GuardedRequest guarded(const httplib::Request& request) {
  GuardedRequest out;
  if (request.get_header_value_count("Host") == 1) out.host = header(request, "Host");
  out.origin = header(request, "Origin");
  out.fetch_site = header(request, "Sec-Fetch-Site"), out.fetch_mode = header(request, "Sec-Fetch-Mode");
  out.cookie = header(request, "Cookie"), out.authorization = header(request, "Authorization");
  if (request.has_param("token")) out.token = request.get_param_value("token");
  return out;
}

void refuse(httplib::Response& response, int status, const std::string& text) {
  response.status = status;
  response.set_content(text + "\n", "text/plain; charset=utf-8");
}

void check_token(const std::string& token) {
  const bool plain = token.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_") == std::string::npos;
  if (!plain || token.size() < least_token || token.size() > most_token)
    throw UsageError(fmt::format("--token: found {} characters{}; expected 'new', or {} to {} letters, digits, '-' or '_'", token.size(),
                                 plain ? "" : ", some of them others", least_token, most_token));
}

}  // namespace

struct ViewerServer::Impl {
  explicit Impl(const ViewerSettings& settings) : service(settings.results) {}

  /// Lets a request pass, or answers why not.
  bool admit(const httplib::Request& request, httplib::Response& response) const {
    switch (judge(guarded(request), rule)) {
      case Verdict::allowed:
        return true;
      case Verdict::allowed_by_address:
        response.set_header("Set-Cookie", fmt::format("{}={}; HttpOnly; SameSite=Strict; Path=/", token_cookie(port), *rule.token));
        response.set_redirect("/", 303);
        return false;
      case Verdict::foreign_host:
        refuse(response, 403, "this viewer answers to localhost only; start it with --listen and --token to use another name");
        return false;
      case Verdict::foreign_origin:
        refuse(response, 403, "requests from other pages are not answered");
        return false;
      case Verdict::no_token:
        refuse(response, 401, "the token is missing or wrong; open the address that sunfleck view printed");
        return false;
    }
    return false;
  }

  void reply(const httplib::Request& request, httplib::Response& response) {
    const Parameters parameters = [&](const std::string& name) -> std::optional<std::string> {
      const auto found = request.params.find(name);
      return found == request.params.end() ? std::nullopt : std::optional(found->second);
    };
    Answer answer = service.answer(request.method == "POST", request.path, parameters);
    response.status = answer.status;
    for (const auto& [name, value] : answer.headers) response.set_header(name, value);
    response.body = std::move(answer.body);
    response.set_header("Content-Type", answer.type);
  }

  void set_up() {
    server.new_task_queue = [] { return new httplib::ThreadPool(connections_at_once); };
    server.set_keep_alive_max_count(1000);
    server.set_keep_alive_timeout(2);
    server.set_read_timeout(3);
    server.set_write_timeout(10);
    server.set_payload_max_length(4096);
    server.set_tcp_nodelay(true);
    server.set_default_headers({{"Content-Security-Policy", page_policy},
                                {"X-Content-Type-Options", "nosniff"},
                                {"X-Frame-Options", "DENY"},
                                {"Referrer-Policy", "no-referrer"},
                                {"Cross-Origin-Resource-Policy", "same-origin"},
                                {"Cross-Origin-Opener-Policy", "same-origin"},
                                {"Cache-Control", "no-store"}});
    // Before routing, so that no pattern is ever matched against what a client sends. Requests with a body go on to be read first: what
    // is left in the connection would be taken for the next request.
    server.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      if (request.method != "GET" && request.method != "HEAD") return httplib::Server::HandlerResponse::Unhandled;
      if (admit(request, response)) reply(request, response);
      return httplib::Server::HandlerResponse::Handled;
    });
    server.Post("/api/reload", [this](const httplib::Request& request, httplib::Response& response) {
      if (admit(request, response)) reply(request, response);
    });
    server.set_exception_handler([](const httplib::Request&, httplib::Response& response, std::exception_ptr) {
      refuse(response, 500, "an error inside the viewer");
    });
  }

  ViewerService service;
  GuardRule rule;
  std::string address;
  int port = 0;
  httplib::Server server;
};

ViewerServer::ViewerServer(const ViewerSettings& settings) : impl_(std::make_unique<Impl>(settings)) {
  if (settings.results.empty() || settings.results.size() > 2)
    throw UsageError(fmt::format("view: found {} result files; expected one, or two to compare", settings.results.size()));
  for (const auto& file : settings.results) Result{file};  // what is no result is said at once
  if (settings.token) impl_->rule.token = *settings.token == "new" ? new_token() : *settings.token;
  if (impl_->rule.token) check_token(*impl_->rule.token);
  if (settings.listen && !impl_->rule.token)
    throw UsageError("--listen: found no --token; expected one ('--token new' makes one), since others can then reach the viewer");
  impl_->rule.loopback_only = !settings.listen;
  impl_->address = settings.listen.value_or("127.0.0.1");
  impl_->set_up();
  impl_->port = settings.port > 0 ? (impl_->server.bind_to_port(impl_->address, settings.port) ? settings.port : -1)
                                  : impl_->server.bind_to_any_port(impl_->address);
  if (impl_->port <= 0)
    throw OutputError(fmt::format("{}{}: this address cannot be served; is the port in use? Without --port a free one is taken",
                                  impl_->address, settings.port > 0 ? fmt::format(":{}", settings.port) : ""));
}

ViewerServer::~ViewerServer() = default;

int ViewerServer::port() const {
  return impl_->port;
}

std::string ViewerServer::url() const {
  const bool any = impl_->address == "0.0.0.0" || impl_->address == "::";
  const std::string host = any ? "localhost" : impl_->address.find(':') != std::string::npos ? "[" + impl_->address + "]" : impl_->address;
  return fmt::format("http://{}:{}/{}", host, impl_->port, impl_->rule.token ? "?token=" + *impl_->rule.token : "");
}

void ViewerServer::run(Progress& progress) {
  std::atomic<bool> ended{false};
  std::thread listening([&] {
    impl_->server.listen_after_bind();
    ended = true;
  });
  std::atomic<bool> loaded{false};
  std::exception_ptr failure;
  std::thread loading([&] {
    try {
      impl_->service.load();
    } catch (...) {
      failure = std::current_exception();
    }
    loaded = true;
  });
  const Stopwatch watch;
  bool told = false;
  while (!progress.cancelled() && !(loaded && failure)) {
    if (loaded && !told) progress.line(fmt::format("ready after {:.1f} s; Ctrl-C ends the viewer", watch.seconds())), told = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  // A stop that comes before the listening has begun would be lost, and one that comes twice meets an assertion of the library.
  while (!impl_->server.is_running() && !ended) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  if (!ended) impl_->server.stop();
  listening.join();
  loading.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace sunfleck
