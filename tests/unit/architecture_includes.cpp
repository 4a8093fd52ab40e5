// A module includes only what it links: reads the modules from CMakeLists.txt and every #include line, and fails on any other arrow.
#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "places.hpp"

namespace {

namespace fs = std::filesystem;

const fs::path root = SUNFLECK_SOURCE_DIR;

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

struct Modules {
  std::vector<std::string> order;                      ///< lowest first
  std::map<std::string, std::set<std::string>> below;  ///< all that a module may include, itself with it
};

Modules modules_of_cmake() {
  Modules modules;
  const std::regex declaration(R"(^sunfleck_module\((\w+)(.*)\))"), link(R"(sunfleck_(\w+))");
  for (const auto& line : lines_of(root / "CMakeLists.txt")) {
    std::smatch match;
    if (!std::regex_search(line, match, declaration)) continue;
    const std::string name = match[1], links = match[2];
    auto& below = modules.below[name];
    below.insert(name);
    for (std::sregex_iterator it(links.begin(), links.end(), link), end; it != end; ++it) {
      const std::string linked = (*it)[1];
      INFO(name << " links " << linked << ", which is not declared above it");
      REQUIRE(modules.below.count(linked) == 1);
      below.insert(modules.below[linked].begin(), modules.below[linked].end());
    }
    modules.order.push_back(name);
  }
  return modules;
}

/// "src/plant/leaf.cpp" or "include/sunfleck/plant/leaf.hpp" -> "plant"; empty for files outside modules such as src/main.cpp.
std::string module_of(const fs::path& file) {
  std::vector<std::string> parts;
  for (const auto& part : fs::relative(file, root)) parts.push_back(part.string());
  if (parts.size() > 2 && parts[0] == "src") return parts[1];
  if (parts.size() > 3 && parts[0] == "include") return parts[2];
  return {};
}

struct Include {
  std::string from_module, to_module, where;
};

std::vector<Include> includes() {
  std::vector<Include> found;
  const std::regex own(R"re(^\s*#\s*include\s*[<"](?:sunfleck/)?(\w+)/[\w./]+[>"])re");
  for (const char* folder : {"src", "include"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (!entry.is_regular_file()) continue;
      const std::string module = module_of(entry.path());
      long number = 0;
      for (const auto& line : lines_of(entry.path())) {
        ++number;
        std::smatch match;
        if (!std::regex_search(line, match, own)) continue;
        found.push_back({module, match[1], fs::relative(entry.path(), root).string() + ":" + std::to_string(number)});
      }
    }
  return found;
}

}  // namespace

TEST_CASE("every module has a folder and every folder is a module", "[architecture]") {
  const Modules modules = modules_of_cmake();
  REQUIRE(modules.order.size() >= 10);
  for (const char* base : {"src", "include/sunfleck"})
    for (const auto& entry : fs::directory_iterator(root / base))
      if (entry.is_directory()) {
        INFO(entry.path() << " is not declared by sunfleck_module() in CMakeLists.txt");
        CHECK(modules.below.count(entry.path().filename().string()) == 1);
      }
}

TEST_CASE("no #include runs against the arrows between modules", "[architecture]") {
  const Modules modules = modules_of_cmake();
  std::size_t checked = 0;
  for (const auto& include : includes()) {
    if (include.from_module.empty() || modules.below.count(include.to_module) == 0) continue;
    INFO(include.where << ": module '" << include.from_module << "' does not link '" << include.to_module << "'");
    CHECK(modules.below.at(include.from_module).count(include.to_module) == 1);
    ++checked;
  }
  CHECK(checked > 20);  // the pattern still finds the includes of this project
}

TEST_CASE("public headers include no private ones", "[architecture]") {
  for (const auto& entry : fs::recursive_directory_iterator(root / "include")) {
    if (!entry.is_regular_file()) continue;
    for (const auto& line : lines_of(entry.path())) {
      INFO(entry.path() << ": " << line);
      CHECK_FALSE(line.rfind("#include \"", 0) == 0);
    }
  }
}
