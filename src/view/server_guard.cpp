#include "view/server_guard.hpp"

#include <algorithm>
#include <cctype>
#include <random>

#include <fmt/format.h>

#include "view/lower_case.hpp"

namespace sunfleck {

namespace {

bool digits(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// "127.x.y.z" and nothing else: "127.0.0.1.example.org" is a name.
bool loopback_address(std::string_view name) {
  int parts = 0;
  for (std::size_t at = 0; at <= name.size(); ++parts) {
    const std::size_t dot = std::min(name.find('.', at), name.size());
    const auto part = name.substr(at, dot - at);
    if (!digits(part) || part.size() > 3 || (parts == 0 && part != "127")) return false;
    at = dot + 1;
  }
  return parts == 4;
}

bool same_secret(std::string_view found, std::string_view expected) {
  unsigned difference = found.size() == expected.size() ? 0 : 1;
  for (std::size_t i = 0; i < expected.size(); ++i)
    difference |= static_cast<unsigned char>(expected[i]) ^ static_cast<unsigned char>(i < found.size() ? found[i] : 0);
  return difference == 0;
}

bool cookie_holds(std::string_view cookies, std::string_view expected) {
  constexpr std::string_view prefix = "sunfleck_";
  for (std::size_t at = 0; at < cookies.size();) {
    const std::size_t end = std::min(cookies.find(';', at), cookies.size());
    auto one = cookies.substr(at, end - at);
    one.remove_prefix(std::min(one.find_first_not_of(' '), one.size()));
    const std::size_t equals = one.find('=');
    if (one.starts_with(prefix) && equals != std::string_view::npos && same_secret(one.substr(equals + 1), expected)) return true;
    at = end + 1;
  }
  return false;
}

}  // namespace

bool is_loopback_host(std::string_view host) {
  if (host.starts_with("[::1]")) {
    host.remove_prefix(5);
    return host.empty() || (host[0] == ':' && digits(host.substr(1)));
  }
  if (const auto colon = host.find(':'); colon != std::string_view::npos) {
    if (!digits(host.substr(colon + 1))) return false;
    host = host.substr(0, colon);
  }
  const std::string name = lower_case(host);
  return name == "localhost" || (name.size() > 10 && name.ends_with(".localhost")) || loopback_address(name);
}

std::string token_cookie(int port) {
  return fmt::format("sunfleck_{}", port);
}

Verdict judge(const GuardedRequest& request, const GuardRule& rule) {
  if (request.host.empty() || (rule.loopback_only && !is_loopback_host(request.host))) return Verdict::foreign_host;
  if (!request.origin.empty() && lower_case(request.origin) != "http://" + lower_case(request.host) &&
      lower_case(request.origin) != "https://" + lower_case(request.host))
    return Verdict::foreign_origin;
  if (!request.fetch_site.empty() && request.fetch_site != "same-origin" && request.fetch_site != "none") return Verdict::foreign_origin;
  for (const char* frame : {"iframe", "frame", "fencedframe", "embed", "object"})
    if (request.fetch_dest == frame) return Verdict::foreign_origin;
  if (!rule.token) return Verdict::allowed;
  if (cookie_holds(request.cookie, *rule.token)) return Verdict::allowed;
  constexpr std::string_view bearer = "Bearer ";
  if (request.authorization.starts_with(bearer) && same_secret(std::string_view(request.authorization).substr(bearer.size()), *rule.token))
    return Verdict::allowed;
  return same_secret(request.token, *rule.token) ? Verdict::allowed_by_address : Verdict::no_token;
}

std::string new_token() {
  std::random_device source;
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", static_cast<std::uint32_t>(source()));
  return token;
}

}  // namespace sunfleck
