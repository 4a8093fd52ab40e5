#include <sunfleck/core/utf8.hpp>

#include <catch2/catch.hpp>

#include <sunfleck/core/names.hpp>

using namespace sunfleck;

TEST_CASE("Bytes that are no UTF-8 are letters of Windows-1252", "[core]") {
  CHECK(as_utf8("été 红 \xF0\x9F\x8C\xB3") == "été 红 \xF0\x9F\x8C\xB3");
  CHECK(as_utf8("bl\xE9") == "blé");
  CHECK(as_utf8("\x9Cuvre \x80") == "œuvre €");
  CHECK(is_utf8(from_windows_1252("\x81\x8D\x8F\x90\x9D")));  // bytes that mean nothing there
  CHECK_FALSE(is_utf8("\xC0\xAF"));                           // over-long
  CHECK_FALSE(is_utf8("\xED\xA0\x80"));                       // half of a surrogate pair
  CHECK_FALSE(is_utf8("\xF4\x90\x80\x80"));                   // above U+10FFFF
  CHECK_FALSE(is_utf8("eight ascii\xE9"));
}

TEST_CASE("Control characters in names are found and become blanks", "[core]") {
  CHECK_FALSE(has_control_character("feuille été 红"));
  for (const std::string& text : {std::string("a\nb"), std::string("a\0b", 3), std::string("a\x7F"), std::string("a\xC2\x85")}) {
    CHECK(has_control_character(text));
    CHECK_FALSE(has_control_character(clean_name(text)));
  }
  CHECK(clean_name("a\nb\xC2\x85"
                   "c") == "a b c");
  CHECK(clean_name("a\xE9\n") == "aé ");
}

TEST_CASE("Names that cleaning makes alike are kept apart; those that stay as they are keep theirs", "[core]") {
  const auto clean = [](const std::string& text) {
    std::string out = text;
    for (auto& c : out)
      if (c == '<' || c == '>' || c == ' ') c = '_';
    return out;
  };
  using Names = std::vector<std::string>;
  CHECK(distinct_names(Names{"<700", ">700", "_700"}, clean) == Names{"_700_2", "_700_3", "_700"});
  CHECK(distinct_names(Names{"a b", "a_b", "a_b_2"}, clean) == Names{"a_b_3", "a_b", "a_b_2"});
  CHECK(distinct_names(Names{"a", "a"}, clean) == Names{"a", "a_2"});
  CHECK(distinct_names(Names{"a b", "c"}, clean, {"a_b"}) == Names{"a_b_2", "c"});
}
