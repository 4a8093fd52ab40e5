#include <catch2/catch.hpp>

#include "view/server_target.hpp"

using namespace sunfleck;

TEST_CASE("a request's target is taken apart and decoded", "[view][server]") {
  const auto plain = parse_target("/api/search?text=leaf+1%2f2&empty=&flag&text=second");
  REQUIRE(plain);
  CHECK(plain->path == "/api/search");
  CHECK(plain->value("text") == "leaf 1/2");
  CHECK(plain->value("empty") == "");
  CHECK(plain->value("flag") == "");
  CHECK_FALSE(plain->value("none"));
  CHECK(parse_target("/")->path == "/");
  CHECK(parse_target("/a+b%20c")->path == "/a+b c");
  CHECK(parse_target("/x?a=1#b")->value("a") == "1");
}

TEST_CASE("targets that make no sense stay what they are, or are none", "[view][server]") {
  for (const char* none : {"", "*", "http://localhost/", "?a=b", "localhost:80"}) CHECK_FALSE(parse_target(none));
  CHECK(parse_target("/%zz%4?%=%&&=&a=%c3%28%")->path == "/%zz%4");
  CHECK(parse_target("/%zz%4?%=%&&=&a=%c3%28%")->value("%") == "%");
  CHECK(parse_target("/%zz%4?%=%&&=&a=%c3%28%")->value("a") == "\xc3\x28%");
  CHECK(parse_target("/?a=%41%4")->value("a") == "A%4");
  CHECK(parse_target("/%-1%+1%0x")->path == "/%-1%+1%0x");
  CHECK(parse_target(std::string("/%00"))->path == std::string("/\0", 2));
}
