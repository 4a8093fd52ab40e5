#include <catch2/catch.hpp>

#include "view/server_guard.hpp"

using namespace sunfleck;

namespace {

GuardedRequest from(const char* host) {
  GuardedRequest r;
  r.host = host;
  return r;
}

const std::string secret = "0123456789abcdef";

}  // namespace

TEST_CASE("only names of the loopback are loopback hosts", "[view][server]") {
  for (const char* good : {"localhost", "LOCALHOST:80", "localhost:8600", "viewer.localhost:1", "127.0.0.1", "127.0.0.1:65535",
                           "127.8.9.10", "[::1]", "[::1]:8600"})
    CHECK(is_loopback_host(good));
  for (const char* bad : {"", "example.org", "localhost.example.org", "127.0.0.1.example.org", "127.0.0", "127.0.0.1.1", "128.0.0.1",
                          "127.0.0.1:", "127.0.0.1:80a", "127.0.0.1@example.org", "[::1]x", "[::1]:", "[::2]", "0.0.0.0", "xlocalhost",
                          ".localhost", "127.0.0.0001"})
    CHECK_FALSE(is_loopback_host(bad));
}

TEST_CASE("foreign hosts and pages are told apart from our own", "[view][server]") {
  const GuardRule rule;
  CHECK(judge(from("localhost:8600"), rule) == Verdict::allowed);
  CHECK(judge(from("rebound.example.org:8600"), rule) == Verdict::foreign_host);
  CHECK(judge(from(""), rule) == Verdict::foreign_host);

  auto r = from("localhost:8600");
  r.origin = "http://localhost:8600";
  CHECK(judge(r, rule) == Verdict::allowed);
  for (const char* origin :
       {"http://localhost:3000", "https://example.org", "null", "http://localhost:8600.example.org", "http://127.0.0.1:8600"}) {
    r.origin = origin;
    CHECK(judge(r, rule) == Verdict::foreign_origin);
  }

  r = from("localhost:8600");
  for (const char* site : {"cross-site", "same-site"}) {  // <img>, a frame or a link of another page sends no Origin
    r.fetch_site = site;
    for (const char* dest : {"", "image", "document", "iframe"}) {
      r.fetch_dest = dest;
      CHECK(judge(r, rule) == Verdict::foreign_origin);
    }
  }
  r.fetch_site = "same-origin";
  for (const char* frame : {"iframe", "frame", "fencedframe", "embed", "object"}) {
    r.fetch_dest = frame;
    CHECK(judge(r, rule) == Verdict::foreign_origin);
  }
  r.fetch_dest = "empty";
  CHECK(judge(r, rule) == Verdict::allowed);
  r.fetch_site = "none", r.fetch_dest = "document";  // typed, or a bookmark
  CHECK(judge(r, rule) == Verdict::allowed);
}

TEST_CASE("with a token any host may be named, but each request must bring it", "[view][server]") {
  const GuardRule rule{.loopback_only = false, .token = secret};
  auto r = from("field.example.org:8600");
  CHECK(judge(r, rule) == Verdict::no_token);
  r.token = secret;
  CHECK(judge(r, rule) == Verdict::allowed_by_address);
  r.token = secret + "x";
  CHECK(judge(r, rule) == Verdict::no_token);
  r.token = secret.substr(1);
  CHECK(judge(r, rule) == Verdict::no_token);
  r.token.clear(), r.authorization = "Bearer " + secret;
  CHECK(judge(r, rule) == Verdict::allowed);
  r.authorization = "Bearer", r.cookie = "a=b; sunfleck_8600=" + secret + "; c=d";
  CHECK(judge(r, rule) == Verdict::allowed);
  r.cookie = "sunfleck_8600=" + secret + "0";
  CHECK(judge(r, rule) == Verdict::no_token);
  r.cookie = "other=" + secret;
  CHECK(judge(r, rule) == Verdict::no_token);
  r.cookie = "sunfleck_8600=" + secret, r.origin = "http://example.org";
  CHECK(judge(r, rule) == Verdict::foreign_origin);
  CHECK(judge(from("example.org"), {.loopback_only = true, .token = secret}) == Verdict::foreign_host);
}

TEST_CASE("new tokens are long and differ", "[view][server]") {
  const auto a = new_token(), b = new_token();
  CHECK(a.size() == 32);
  CHECK(a.find_first_not_of("0123456789abcdef") == std::string::npos);
  CHECK(a != b);
}
