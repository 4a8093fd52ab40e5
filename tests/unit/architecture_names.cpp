// One name, one thing: no type of the library shares its name with another, in headers and sources alike. Two classes of one name in one
// program are undefined behaviour that no linker reports. Types of anonymous namespaces are of their file alone, and may repeat each
// other, but not what a header calls something else. That all public headers compile together is shown by all_headers.cpp, which the
// build writes beside this test.
#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "places.hpp"

namespace {

namespace fs = std::filesystem;

/// Without comments, texts and characters.
std::string bare(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text.compare(i, 2, "//") == 0) {
      while (i < text.size() && text[i] != '\n') ++i;
      out += '\n';
    } else if (text.compare(i, 2, "/*") == 0) {
      i = std::min(text.find("*/", i + 2), text.size() - 2) + 1;
    } else if (text.compare(i, 2, "R\"") == 0) {
      const auto open = text.find('(', i);
      const std::string end = ')' + text.substr(i + 2, open - i - 2) + '"';
      i = std::min(text.find(end, open), text.size() - end.size()) + end.size() - 1;
    } else if (text[i] == '"' || (text[i] == '\'' && (i == 0 || !std::isalnum(static_cast<unsigned char>(text[i - 1]))))) {
      const char quote = text[i];
      for (++i; i < text.size() && text[i] != quote; ++i)
        if (text[i] == '\\') ++i;
    } else {
      out += text[i];
    }
  }
  return out;
}

struct Definition {
  std::string name;
  bool of_its_file = false;  ///< in an anonymous namespace
};

/// Types that a file defines in namespaces; those inside other types and functions are not counted.
std::vector<Definition> types_defined(const std::string& text) {
  static const std::regex token(
      R"(\bnamespace\b\s*([\w:]*)\s*\{|\b(?:struct|class|union|enum)\s+(?:class\s+)?(\w+)(?:\s+final)?\s*(?::(?!:)[^;{}()]*)?\{|\busing\s+(\w+)\s*=|\{|\})");
  enum class Opened { space, hidden_space, other };
  std::vector<Opened> open;
  std::vector<Definition> found;
  const std::string code = bare(text);
  for (std::sregex_iterator it(code.begin(), code.end(), token), end; it != end; ++it) {
    const std::string all = it->str(), name = (*it)[2].matched ? (*it)[2].str() : (*it)[3].str();
    if (!name.empty() && std::find(open.begin(), open.end(), Opened::other) == open.end())
      found.push_back({name, std::find(open.begin(), open.end(), Opened::hidden_space) != open.end()});
    if (all == "}") {
      if (!open.empty()) open.pop_back();
    } else if (all.back() == '{') {
      if (all.compare(0, 9, "namespace") == 0)
        open.push_back((*it)[1].length() ? Opened::space : Opened::hidden_space);
      else
        open.push_back(Opened::other);
    }
  }
  return found;
}

/// Names that an anonymous namespace of a source defines: types, constants, and functions with their parameters (overloads live beside each
/// other), as "name" or "name(parameters)".
std::vector<std::string> private_names(const std::string& text) {
  static const std::regex token(
      R"(\bnamespace\b\s*([\w:]*)\s*\{|\b(?:struct|class|union|enum)\s+(?:class\s+)?(\w+)(?:\s+final)?\s*(?::(?!:)[^;{}()]*)?\{|\n(?:const|constexpr)\s[^;(){}=]*?(\w+)(?:\s*=|\{)|\n[\w:][\w:<>,&* \t]*?[\s&*](\w+\([^{};]*\))(?:\s*noexcept)?\s*\{|\{|\})");
  enum class Opened { space, hidden_space, other };
  std::vector<Opened> open;
  std::vector<std::string> found;
  const std::string code = bare(text);
  for (std::sregex_iterator it(code.begin(), code.end(), token), end; it != end; ++it) {
    const std::string all = it->str();
    if (!open.empty() && open.back() == Opened::hidden_space)
      for (int group : {2, 3, 4})
        if ((*it)[group].matched) found.push_back(std::regex_replace((*it)[group].str(), std::regex("\\s+"), " "));
    if (all == "}") {
      if (!open.empty()) open.pop_back();
    } else if (all.back() == '{') {
      if (all.compare(0, 9, "namespace") == 0)
        open.push_back((*it)[1].length() ? Opened::space : Opened::hidden_space);
      else
        open.push_back(Opened::other);
    }
  }
  return found;
}

/// [name] where it is defined, of names that more than one thing has.
std::map<std::string, std::vector<std::string>> shared_names(const std::map<std::string, std::string>& texts) {
  std::map<std::string, std::vector<std::string>> places, shared;
  std::map<std::string, bool> of_all;
  for (const auto& [file, text] : texts)
    for (const auto& type : types_defined(text)) {
      places[type.name].push_back(file);
      of_all[type.name] |= !type.of_its_file;
    }
  for (const auto& [name, files] : places)
    if (of_all[name] && files.size() > 1) shared[name] = files;
  return shared;
}

}  // namespace

TEST_CASE("No two types of the library share a name", "[architecture]") {
  const fs::path root = SUNFLECK_SOURCE_DIR;
  std::map<std::string, std::string> texts;
  for (const char* folder : {"src", "include"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const auto suffix = entry.path().extension();
      if (suffix != ".hpp" && suffix != ".cpp") continue;
      std::ifstream in(entry.path());
      texts[fs::relative(entry.path(), root).string()] = {std::istreambuf_iterator<char>(in), {}};
    }
  REQUIRE(texts.size() > 200);
  REQUIRE(types_defined(texts.at("include/sunfleck/scene/scene.hpp")).size() > 4);
  for (const auto& [name, files] : shared_names(texts)) {
    std::string list;
    for (const auto& file : files) list += " " + file;
    FAIL_CHECK(name << " is defined in" << list);
  }
}

// The release build compiles the sources of a module together (CMAKE_UNITY_BUILD), which takes a third of the time.
TEST_CASE("No two sources of a module give one private name to two things", "[architecture]") {
  const fs::path root = fs::path(SUNFLECK_SOURCE_DIR) / "src";
  std::size_t names = 0;
  for (const auto& module : fs::directory_iterator(root)) {
    if (!module.is_directory()) continue;
    std::map<std::string, std::string> first;
    for (const auto& entry : fs::recursive_directory_iterator(module.path())) {
      if (entry.path().extension() != ".cpp") continue;
      std::ifstream in(entry.path());
      const std::string file = fs::relative(entry.path(), root).string();
      for (const auto& name : private_names({std::istreambuf_iterator<char>(in), {}})) {
        ++names;
        const auto [it, is_new] = first.emplace(name, file);
        if (!is_new) FAIL_CHECK(name << " is in " << it->second << " and in " << file);
      }
    }
  }
  REQUIRE(names > 500);
}

TEST_CASE("Private names are found wherever they are written", "[architecture]") {
  const auto names = [](const std::string& code) {
    return private_names("namespace sunfleck {\nnamespace {\n" + code + "\n}\nconstexpr int open = 1;\n}");
  };
  REQUIRE(names("constexpr double ring = 1.0, bow = 2.0;") == std::vector<std::string>{"ring"});
  REQUIRE(names("const std::vector<int> ring{1, 2};") == std::vector<std::string>{"ring"});
  REQUIRE(names("struct Ring {\n  const int inner = 1;\n};") == std::vector<std::string>{"Ring"});
  REQUIRE(names("std::string ring(std::string_view text,\n    int n) {\n  const int inner = 1;\n}") ==
          std::vector<std::string>{"ring(std::string_view text, int n)"});
  REQUIRE(names("using std::numbers::pi;").empty());
}

TEST_CASE("Types that share a name are found wherever they are written", "[architecture]") {
  const std::string space = "namespace sunfleck {\n";
  const auto shared = [&](const std::string& a, const std::string& b) {
    return shared_names({{"a.hpp", space + a + "}"}, {"b.cpp", space + b + "}"}}).size();
  };
  REQUIRE(shared("class Ring {};", "struct Ring final : Base { int i; };") == 1);
  REQUIRE(shared("enum class Ring : int { a };", "using Ring = int;") == 1);
  REQUIRE(shared("class Ring {};", "namespace { struct Ring { int i; }; }") == 1);  // a reader of b.cpp would take it for a's
  REQUIRE(shared("class Ring {};", "namespace inner { struct Ring { int i; }; }") == 1);
  REQUIRE(shared("namespace { class Ring {}; }", "namespace { struct Ring { int i; }; }") == 0);
  REQUIRE(shared("class Ring {};", "class Ring; // class Ring {\n const char* t = \"class Ring {\"; struct Ring::Impl { int i; };") == 0);
  REQUIRE(shared("class Ring {};", "struct Other { struct Ring { int i; }; };") == 0);
}
