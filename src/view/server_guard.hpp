// Who may talk to the viewer: this machine's own pages, or holders of the token.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace sunfleck {

/// What decides about a request; a header that is absent is empty.
struct GuardedRequest {
  std::string host;           ///< Host
  std::string origin;         ///< Origin
  std::string fetch_site;     ///< Sec-Fetch-Site
  std::string fetch_dest;     ///< Sec-Fetch-Dest
  std::string cookie;         ///< Cookie
  std::string authorization;  ///< Authorization
  std::string token;          ///< ?token= of the address
};

struct GuardRule {
  bool loopback_only = true;  ///< Host must name this machine's loopback: a foreign name that resolves to it is refused (DNS rebinding)
  std::optional<std::string> token;  ///< where set, requests must bring it
};

enum class Verdict {
  allowed,
  allowed_by_address,  ///< the token came with the address: hand it over as a cookie and hide it
  foreign_host,
  foreign_origin,
  no_token
};

/// The checks, in this order: Host; then Origin, Sec-Fetch-Site and Sec-Fetch-Dest (a page of another origin, be it of another port of
/// this machine, may neither read, embed nor link here, and nothing is answered into a frame); then the token, compared in a time that
/// does not depend on where it differs.
Verdict judge(const GuardedRequest& request, const GuardRule& rule);

/// True for localhost, *.localhost, 127.x.y.z and [::1], each with or without a port (any port: tunnels change it).
bool is_loopback_host(std::string_view host);

/// Name of the cookie that carries the token. Cookies do not tell ports apart, so each port has its own.
std::string token_cookie(int port);

/// A random token of 128 bits in hexadecimal digits, from the system's source.
std::string new_token();

}  // namespace sunfleck
