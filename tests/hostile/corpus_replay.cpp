// What fuzzers have found, and where they start: every file of the corpus ends in a plant, a scene, or an InputError.
#include <catch2/catch.hpp>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include <fuzz/formats.hpp>

#include "places.hpp"

using namespace sunfleck;

TEST_CASE("The corpus of every parser is read or refused, quickly", "[hostile][corpus]") {
  const std::filesystem::path corpus = std::string(SUNFLECK_SOURCE_DIR) + "/tests/hostile/corpus";
  for (const auto& format : fuzz::formats()) {
    std::set<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(corpus / format)) files.insert(entry.path());
    std::size_t accepted = 0;
    for (const auto& file : files) {
      std::ifstream in(file, std::ios::binary);
      const std::vector<std::uint8_t> bytes((std::istreambuf_iterator<char>(in)), {});
      INFO(file.string());
      const auto start = std::chrono::steady_clock::now();
      CHECK_NOTHROW(accepted += fuzz::feed(format, bytes));
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
      CHECK(seconds.count() < 5);  // no hang: the slowest takes some ms
    }
    INFO(format);
    CHECK(files.size() >= 5);
    CHECK(accepted >= 1);
    CHECK(accepted < files.size());
  }
}

TEST_CASE("Every folder of the corpus has its parser", "[hostile][corpus]") {
  for (const auto& entry : std::filesystem::directory_iterator(std::string(SUNFLECK_SOURCE_DIR) + "/tests/hostile/corpus")) {
    INFO(entry.path());
    const auto& known = fuzz::formats();
    CHECK(std::find(known.begin(), known.end(), entry.path().filename().string()) != known.end());
  }
}
