// Tables on disk: found again, told apart, checked, bounded, shared.
#include <catch2/catch.hpp>

#include <sys/stat.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <scratch_folder.hpp>
#include <sunfleck/original/cache.hpp>

#include "original/entry.hpp"

using namespace sunfleck;

namespace {

namespace fs = std::filesystem;

OriginalGeometry leaf(double size = 1.0, float reflectance = 0.3f) {
  return {{{Vec3{0, 0, 0}, Vec3{size, 0, 0}, Vec3{0, 1, 0}}}, {0}, {{"leaf", {reflectance}, {0.2f}, {0.4f}}}, 1};
}

MeasureSettings coarse() {
  MeasureSettings s;
  s.tables.error = 0.1;
  s.fit = false;
  return s;
}

class Heard : public Progress {
 public:
  void line(std::string_view text) override { lines.emplace_back(text); }
  std::vector<std::string> lines;
};

std::vector<std::string> entries(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& e : fs::directory_iterator(folder)) names.push_back(e.path().string());
  return names;
}

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("A second run measures nothing and has the same bits", "[original][cache]") {
  const ScratchFolder folder;
  CacheState state;
  const auto first = OriginalCache(folder.path, 1u << 20, silent()).tables(leaf(), coarse(), state);
  CHECK(state == CacheState::stored);
  OriginalCache again(folder.path, 1u << 20, silent());
  const auto second = again.tables(leaf(), coarse(), state);
  CHECK(state == CacheState::found);
  CHECK(second.phase == first.phase);
  CHECK(second.absorbed == first.absorbed);
  CHECK(second.sigma == first.sigma);
  CHECK(second.samples == first.samples);
  CHECK(second.hull.size() == first.hull.size());
  CHECK(second.errors[0].sampling == first.errors[0].sampling);
  CHECK(entries(folder.path).size() == 1);
}

TEST_CASE("The key follows geometry, optics and settings, and nothing else", "[original][cache]") {
  const auto key = original_key(leaf(), coarse());
  CHECK(key.size() == 64);
  auto renamed = leaf();
  renamed.materials[0].name = "other";
  CHECK(original_key(renamed, coarse()) == key);
  CHECK(original_key(leaf(1.0 + 1e-15), coarse()) != key);
  CHECK(original_key(leaf(1.0, 0.31f), coarse()) != key);
  auto finer = coarse();
  finer.tables.order = 4;
  CHECK(original_key(leaf(), finer) != key);
  finer = coarse();
  finer.tables.field_pixels = 1;  // no part of the tables
  CHECK(original_key(leaf(), finer) == key);
}

TEST_CASE("Damaged and foreign entries are noticed and rebuilt", "[original][cache]") {
  const ScratchFolder folder;
  OriginalCache cache(folder.path, 1u << 20, silent());
  CacheState state;
  cache.tables(leaf(), coarse(), state);
  const std::string path = entries(folder.path).at(0), sound = bytes_of(path);
  std::vector<std::string> broken{sound.substr(0, sound.size() / 2), sound.substr(0, sound.size() - 1), sound + "x", "",
                                  "sunfleck-original 0\n"};
  for (const std::size_t at : {std::size_t{3}, std::size_t{40}, std::size_t{120}, sound.size() / 2, sound.size() - 1}) {
    broken.push_back(sound);
    broken.back()[at] = static_cast<char>(broken.back()[at] ^ 1);
  }
  for (const auto& bytes : broken) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
    cache.tables(leaf(), coarse(), state);
    CHECK(state == CacheState::rebuilt);
    CHECK(bytes_of(path) == sound);
  }
  // Another original's entry under this name.
  cache.tables(leaf(2.0), coarse(), state);
  for (const auto& other : entries(folder.path))
    if (other != path) fs::copy_file(other, path, fs::copy_options::overwrite_existing);
  cache.tables(leaf(), coarse(), state);
  CHECK(state == CacheState::rebuilt);
}

TEST_CASE("An entry whose numbers do not belong together is none, though its checksum holds", "[original][cache]") {
  const std::string key(64, 'a');
  OriginalTables sound;
  sound.order = 1;
  sound.sigma.assign(49, 0.1), sound.intercepted.assign(4, 0.1), sound.absorbed.assign(4, 0.1), sound.phase.assign(16, 0.1);
  sound.errors.resize(1);
  CHECK(from_entry(to_entry(sound, key), key));
  std::vector<OriginalTables> broken(6, sound);
  broken[0].order = 7;  // beyond the highest, in sizes that fit
  broken[0].intercepted.resize(64), broken[0].absorbed.resize(64), broken[0].phase.resize(64 * 64);
  broken[1].basis = static_cast<TableSettings::Basis>(7);
  broken[2].bands = 2;
  broken[3].bands = 0, broken[3].errors.clear(), broken[3].absorbed.clear(), broken[3].phase.clear();
  broken[4].phase[3] = std::nan("");
  broken[5].hull = {{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, std::nan(""), 0}}};
  for (std::size_t i = 0; i < broken.size(); ++i) {
    INFO(i);
    CHECK_FALSE(from_entry(to_entry(broken[i], key), key));
  }
}

TEST_CASE("The cache is bounded: what was not used for longest goes", "[original][cache]") {
  const ScratchFolder folder;
  CacheState state;
  OriginalCache wide(folder.path, 1u << 20, silent());
  wide.tables(leaf(1), coarse(), state);
  const auto size = fs::file_size(entries(folder.path).at(0));
  const auto pause = [] { std::this_thread::sleep_for(std::chrono::milliseconds(20)); };  // times of files are that fine
  pause();
  wide.tables(leaf(2), coarse(), state);
  pause();
  wide.tables(leaf(1), coarse(), state);  // used again
  CHECK(state == CacheState::found);
  pause();
  OriginalCache narrow(folder.path, 2 * size + size / 2, silent());
  narrow.tables(leaf(3), coarse(), state);
  CHECK(state == CacheState::stored);
  CHECK(entries(folder.path).size() == 2);
  bool damaged = false;
  CHECK(narrow.find(original_key(leaf(1), coarse()), damaged));
  CHECK_FALSE(narrow.find(original_key(leaf(2), coarse()), damaged));
  CHECK_FALSE(damaged);
  // Temporary files of processes that were killed go after a day.
  const fs::path left = fs::path(folder.path) / ".abc.original.partial-1", fresh = fs::path(folder.path) / ".abc.original.partial-2";
  std::ofstream(left) << "x";
  std::ofstream(fresh) << "x";
  fs::last_write_time(left, fs::file_time_type::clock::now() - std::chrono::hours(25));
  narrow.tables(leaf(4), coarse(), state);
  CHECK_FALSE(fs::exists(left));
  CHECK(fs::exists(fresh));
}

TEST_CASE("What is no file in the place of an entry blocks nothing and is not followed; other files of the folder stay",
          "[original][cache]") {
  const ScratchFolder folder;
  Heard heard;
  CacheState state;
  const std::string path = folder.path + "/" + original_key(leaf(), coarse()) + ".original";
  const std::string mine = folder.path + "/mine", other = folder.path + "/picture.original";
  std::ofstream(mine) << "mine";
  std::ofstream(other) << std::string(4096, 'x');
  REQUIRE(::mkfifo(path.c_str(), 0600) == 0);
  OriginalCache(folder.path, 1u << 20, heard).tables(leaf(), coarse(), state);
  CHECK(state == CacheState::unsaved);
  REQUIRE(heard.lines.size() == 1);
  CHECK(heard.lines[0].find("cannot be written: it is a device or a pipe, no file") != std::string::npos);
  fs::remove(path);
  fs::create_symlink("mine", path);
  OriginalCache(folder.path, 1024, silent()).tables(leaf(), coarse(), state);
  CHECK(state == CacheState::unsaved);  // it is larger than that
  OriginalCache(folder.path, 1u << 20, silent()).tables(leaf(), coarse(), state);
  CHECK(state == CacheState::rebuilt);
  CHECK(fs::is_regular_file(fs::symlink_status(path)));
  CHECK(bytes_of(mine) == "mine");
  OriginalCache(folder.path, fs::file_size(path), silent()).tables(leaf(2), coarse(), state);
  CHECK_FALSE(fs::exists(path));
  CHECK(fs::exists(other));  // not an entry by its name
}

TEST_CASE("A folder that cannot be used is a message, once", "[original][cache]") {
  const ScratchFolder folder;
  const std::string file = folder.path + "/file";
  std::ofstream(file) << "x";
  Heard heard;
  OriginalCache cache(file + "/cache", 1u << 20, heard);
  CacheState state;
  const auto t = cache.tables(leaf(), coarse(), state);
  CHECK(state == CacheState::unsaved);
  CHECK(t.area_m2 == Approx(0.5));
  cache.tables(leaf(2), coarse(), state);
  CHECK(state == CacheState::unsaved);
  REQUIRE(heard.lines.size() == 1);
  CHECK(heard.lines[0] == "note: cache folder " + file + "/cache cannot be made: Not a directory; originals are measured without it");
  OriginalCache none("", 1u << 20, heard);
  none.tables(leaf(), coarse(), state);
  CHECK(state == CacheState::off);
  CHECK(heard.lines.size() == 1);
}
