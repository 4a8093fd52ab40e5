#include <atomic>
#include <chrono>
#include <exception>
#include <optional>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/timer.hpp>
#include <sunfleck/view/viewer.hpp>

#include "view/server_guard.hpp"
#include "view/server_listener.hpp"
#include "view/server_target.hpp"
#include "view/server_workers.hpp"
#include "view/viewer_service.hpp"

namespace sunfleck {

namespace {

constexpr std::size_t least_token = 16, most_token = 256;
constexpr const char* page_policy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src 'self'; base-uri 'none'; "
    "form-action 'self'; frame-ancestors 'none'";

/// Of every answer, refusals included.
std::vector<std::pair<std::string, std::string>> common_headers() {
  return {{"Content-Security-Policy", page_policy},
          {"X-Content-Type-Options", "nosniff"},
          {"X-Frame-Options", "DENY"},
          {"Referrer-Policy", "no-referrer"},
          {"Cross-Origin-Resource-Policy", "same-origin"},
          {"Cross-Origin-Opener-Policy", "same-origin"},
          {"Cache-Control", "no-store"}};
}

GuardedRequest guarded(const RequestHead& head, const RequestTarget& target) {
  GuardedRequest out;
  if (head.count("Host") == 1) out.host = head.header("Host");
  out.origin = head.header("Origin");
  out.fetch_site = head.header("Sec-Fetch-Site"), out.fetch_dest = head.header("Sec-Fetch-Dest");
  out.cookie = head.header("Cookie"), out.authorization = head.header("Authorization");
  out.token = target.value("token").value_or("");
  return out;
}

Answer refusal(int status, const std::string& text) {
  return {status, "text/plain; charset=utf-8", text + "\n"};
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

  /// Why a request is not answered, or nothing.
  std::optional<Answer> turned_away(const GuardedRequest& request) const {
    switch (judge(request, rule)) {
      case Verdict::allowed:
        return std::nullopt;
      case Verdict::allowed_by_address:
        return Answer{303,
                      "text/plain; charset=utf-8",
                      "",
                      {{"Set-Cookie", fmt::format("{}={}; HttpOnly; SameSite=Strict; Path=/", token_cookie(listener->port()), *rule.token)},
                       {"Location", "/"}}};
      case Verdict::foreign_host:
        return refusal(403, "this viewer answers to localhost only; start it with --listen and --token to use another name");
      case Verdict::foreign_origin:
        return refusal(403, "requests from other pages are not answered, links and frames included; open the address in a tab of its own");
      case Verdict::no_token:
        return refusal(401, "the token is missing or wrong; open the address that sunfleck view printed");
    }
    return refusal(403, "not answered");
  }

  Reply respond(const RequestHead& head) {
    const auto target = parse_target(head.target);
    if (!target) return refusal(400, "this is no address of the viewer");
    if (auto refused = turned_away(guarded(head, *target))) return std::move(*refused);
    const bool post = head.method == "POST";
    if (!post && head.method != "GET" && head.method != "HEAD") return refusal(405, "GET, HEAD or POST is expected");
    return [this, post, target = *target] {
      return service.answer(post, target.path, [&](const std::string& name) { return target.value(name); });
    };
  }

  ViewerService service;
  GuardRule rule;
  std::string address;
  std::optional<ServerListener> listener;  ///< last: its workers use the others
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
  impl_->listener.emplace(impl_->address, settings.port, common_headers(),
                          [this](const RequestHead& head) { return impl_->respond(head); });
}

ViewerServer::~ViewerServer() = default;

int ViewerServer::port() const {
  return impl_->listener->port();
}

std::string ViewerServer::url() const {
  const bool any = impl_->address == "0.0.0.0" || impl_->address == "::";
  const std::string host = any ? "localhost" : impl_->address.find(':') != std::string::npos ? "[" + impl_->address + "]" : impl_->address;
  return fmt::format("http://{}:{}/{}", host, port(), impl_->rule.token ? "?token=" + *impl_->rule.token : "");
}

void ViewerServer::run(Progress& progress) {
  std::atomic<bool> loaded{false};
  std::exception_ptr failure;
  const Stopwatch watch;
  {
    ServerWorkers loader(1, 1);
    loader.take([&] {
      try {
        impl_->service.load();
      } catch (...) {
        failure = std::current_exception();
      }
      loaded = true;
    });
    bool told = false;
    while (!progress.cancelled() && !(loaded && failure)) {
      if (loaded && !told) progress.line(fmt::format("ready after {:.1f} s; Ctrl-C ends the viewer", watch.seconds())), told = true;
      impl_->listener->serve(std::chrono::milliseconds(20));
    }
    impl_->service.stop();
  }
  if (failure && !progress.cancelled()) std::rethrow_exception(failure);
}

}  // namespace sunfleck
