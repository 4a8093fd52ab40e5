#include <catch2/catch.hpp>

#include <sys/file.h>
#include <sys/stat.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/replaced_file.hpp>

#include "core/partial_name.hpp"
#include "scratch_folder.hpp"

using namespace sunfleck;

namespace fs = std::filesystem;

namespace {

std::string content(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::size_t files_in(const std::string& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

void put(const std::string& file, const std::string& text, ReplacedFile::Links links = ReplacedFile::Links::follow) {
  ReplacedFile out(file, links);
  out.write(text);
  out.commit();
}

}  // namespace

TEST_CASE("two that write one file do not meet: the last to end has it, whole", "[core][replaced]") {
  const ScratchFolder folder;
  const std::string file = folder.path + "/r.h5";
  std::optional<ReplacedFile> first(file), second(file);
  CHECK(first->temporary() != second->temporary());
  first->write("one");
  second->write("two");
  second->commit();
  CHECK(content(file) == "two");
  first->commit();
  CHECK(content(file) == "one");
  first.reset(), second.reset();
  CHECK(files_in(folder.path) == 1);
}

TEST_CASE("a living writer's temporary is not tidied up; a dead one's is", "[core][replaced]") {
  const ScratchFolder folder;
  const std::string file = folder.path + "/r.h5";
  ReplacedFile living(file);
  const std::string dead = folder.path + "/" + partial_name("r.h5"), other = folder.path + "/" + partial_name("q.h5");
  std::ofstream(dead) << "12345";
  std::ofstream(other) << "x";
  const std::string foreign = folder.path + "/.r.h5.partial-deadbeef-0123456789abcdef", earlier = folder.path + "/.r.h5.partial-4711";
  std::ofstream(foreign) << "x";
  std::ofstream(earlier) << "x";
  const auto removed = remove_abandoned(file);
  REQUIRE(removed.size() == 1);
  CHECK(removed[0].path == dead);
  CHECK(removed[0].bytes == 5);
  for (const auto& kept : {living.temporary(), other, foreign, earlier}) CHECK(fs::exists(kept));
  const auto days_ago = [](int days) { return fs::file_time_type::clock::now() - std::chrono::hours(24 * days + 1); };
  fs::last_write_time(foreign, days_ago(6)), fs::last_write_time(earlier, days_ago(1));
  CHECK(remove_abandoned(file).size() == 1);
  CHECK_FALSE(fs::exists(earlier));
  fs::last_write_time(foreign, days_ago(7));
  CHECK(remove_abandoned(file).size() == 1);
  living.commit();
  CHECK(files_in(folder.path) == 2);
}

TEST_CASE("names of temporaries are told from others", "[core][replaced]") {
  using Kind = PartialName::Kind;
  const std::string name(250, 'n');
  const auto kind = [](const std::string& text) { return parse_partial_name(text).kind; };
  CHECK(kind(partial_name("a.h5")) == Kind::this_boot);
  CHECK(parse_partial_name(partial_name("a.h5")).name == "a.h5");
  CHECK(partial_name("a.h5") != partial_name("a.h5"));
  CHECK(partial_name(name).size() < 255);
  CHECK(kind(".a.h5.partial-12") == Kind::process_id);
  for (const std::string text : {"a.h5", ".a.h5.partial-", ".a.h5.partial-mine", "a.h5.partial-12", ".partial-12",
                                 ".a.h5.partial-deadbeef_0123456789abcdef", ".a.h5.partial-deadbeef-0123456789abcdeg", ""})
    CHECK(kind(text) == Kind::none);
}

TEST_CASE("permissions stay; links are followed, or replaced where they mean nothing", "[core][replaced]") {
  const ScratchFolder folder;
  const std::string file = folder.path + "/r", link = folder.path + "/link", dangling = folder.path + "/dangling";
  put(file, "one");
  for (const mode_t mode : {0600, 0664, 0200}) {
    REQUIRE(::chmod(file.c_str(), mode) == 0);
    put(file, "two");
    struct stat status {};
    REQUIRE(::stat(file.c_str(), &status) == 0);
    CHECK((status.st_mode & 0777) == mode);
  }
  ::chmod(file.c_str(), 0600);
  fs::create_symlink("r", link);
  put(link, "three");
  CHECK(content(file) == "three");
  CHECK(fs::is_symlink(link));
  fs::create_symlink("new", dangling);
  put(dangling, "four");
  CHECK(content(folder.path + "/new") == "four");
  put(link, "five", ReplacedFile::Links::replace);
  CHECK_FALSE(fs::is_symlink(link));
  CHECK(content(link) == "five");
  CHECK(content(file) == "three");
  fs::create_symlink("circle", folder.path + "/circle");
  CHECK_THROWS_WITH(put(folder.path + "/circle", ""), folder.path + "/circle: cannot be written: Too many levels of symbolic links");
}

TEST_CASE("a write-protected file is not replaced, nor a link of a stranger in a folder open to all followed", "[core][replaced]") {
  const ScratchFolder folder;
  const std::string file = folder.path + "/r";
  put(file, "mine");
  if (::geteuid() != 0) {
    ::chmod(file.c_str(), 0400);
    CHECK_THROWS_WITH(put(file, "x"), file + ": cannot be written: Permission denied");
    CHECK(content(file) == "mine");
  } else {
    const std::string open = folder.path + "/open", trap = open + "/r";
    fs::create_directory(open);
    ::chmod(open.c_str(), 01777);
    fs::create_symlink(file, trap);
    REQUIRE(::lchown(trap.c_str(), 65534, 65534) == 0);
    CHECK_THROWS_WITH(put(trap, "x"), trap + ": cannot be written: it is a link that someone else made in a folder open to all");
    CHECK(content(file) == "mine");
  }
}

TEST_CASE("files that belong together come together, or none of them", "[core][replaced]") {
  const ScratchFolder folder;
  const std::string a = folder.path + "/a", b = folder.path + "/b";
  const auto both = [&](bool fail) {
    ReplacedFile first(a), second(b);
    first.write("new"), second.write("new");
    if (fail) fs::remove(second.temporary());  // its renaming will fail
    ReplacedFile::commit({&first, &second});
  };
  CHECK_THROWS_AS(both(true), OutputError);
  CHECK(files_in(folder.path) == 0);
  std::ofstream(a) << "old";
  std::ofstream(b) << "old";
  CHECK_THROWS_WITH(both(true), b + ": cannot be written: No such file or directory");
  CHECK(content(a) == "old");
  CHECK(content(b) == "old");
  both(false);
  CHECK(content(a) == "new");
  CHECK(content(b) == "new");
  CHECK(files_in(folder.path) == 2);
}
