#include <catch2/catch.hpp>

#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <sstream>

#include <sunfleck/core/error.hpp>
#include <sunfleck/result/result_reader.hpp>

#include "result_scene.hpp"

using namespace sunfleck;
using namespace sunfleck::test;

namespace {

std::string content(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

/// Files cannot grow beyond `bytes` while this lives: the same system calls fail as on a full disk.
class FileLimit {
 public:
  explicit FileLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limited{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limited);
  }
  ~FileLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  void (*handler_)(int);
  rlimit before_{};
};

}  // namespace

TEST_CASE("A result that is not finished leaves what was there", "[result][complete]") {
  const Folder folder;
  const std::string file = folder / "r.h5";
  std::ofstream(file) << "yesterday's result";
  const Scene scene = small_scene(500);
  const FacetScene facets = expand(scene);
  const PlacedScene placed = place(scene);
  const Values values(facets);

  SECTION("the writer is destroyed half way") {
    {
      ResultWriter writer(file, scene, placed, OutputChoice{}, "0.1.0", "flat");
      writer.rows({0, 1, values.irradiance.data(), nullptr, nullptr});
      CHECK(folder.files() == 2);
    }
    CHECK(content(file) == "yesterday's result");
    CHECK(folder.files() == 1);
  }
  SECTION("rows are missing at the end") {
    {
      ResultWriter writer(file, scene, placed, OutputChoice{}, "0.1.0", "flat");
      writer.rows({0, 1, values.irradiance.data(), nullptr, nullptr});
      CHECK_THROWS_WITH(writer.finish(small_report()), file + ": only 1 of 4016 facets have values");
    }
    CHECK(content(file) == "yesterday's result");
    CHECK(folder.files() == 1);
  }
  SECTION("rows come twice") {
    ResultWriter writer(file, scene, placed, OutputChoice{}, "0.1.0", "flat");
    writer.rows({0, 1, values.irradiance.data(), nullptr, nullptr});
    CHECK_THROWS_WITH(writer.rows({0, 1, values.irradiance.data(), nullptr, nullptr}),
                      file + ": rows 0 to 1 of 4016 facets arrived where row 1 was due");
  }
  SECTION("a value is not finite") {
    auto broken = values.irradiance;
    broken[4 * 7] = std::numeric_limits<float>::quiet_NaN();
    ResultWriter writer(file, scene, placed, OutputChoice{}, "0.1.0", "flat");
    CHECK_THROWS_WITH(writer.rows({0, facets.size(), broken.data(), nullptr, nullptr}), file + ": the irradiance of facet 7 is not finite");
  }
  SECTION("the disk is full, wherever that happens") {
    std::size_t whole = 0;
    {
      ResultWriter writer(folder / "whole.h5", scene, placed, OutputChoice{}, "0.1.0", "flat");
      values.send(writer, 1000);
      writer.finish(small_report());
      whole = content(folder / "whole.h5").size();
      std::filesystem::remove(folder / "whole.h5");
    }
    for (const double part : {0.0, 0.0005, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 0.9999}) {
      INFO("limit of " << part << " of the file");
      std::string message;
      {
        const FileLimit limit(static_cast<rlim_t>(part * static_cast<double>(whole)));
        try {
          ResultWriter writer(file, scene, placed, OutputChoice{}, "0.1.0", "flat");
          values.send(writer, 1000);
          writer.finish(small_report());
        } catch (const OutputError& error) {
          message = error.what();
        }
      }
      CHECK(message == file + ": cannot be written: File too large");
      CHECK(content(file) == "yesterday's result");
      CHECK(folder.files() == 1);
    }
  }
  SECTION("and the next writer works") {
    ResultWriter writer(file, scene, placed, OutputChoice{}, "0.1.0", "flat");
    values.send(writer, 1000);
    writer.finish(small_report());
    CHECK(Result(file).all<float>("facets/irradiance") == values.irradiance);
    CHECK(folder.files() == 1);
  }
}

TEST_CASE("Places where no result can be written are named", "[result][complete]") {
  const Folder folder;
  const Scene scene = small_scene();
  const FacetScene facets = expand(scene);
  const PlacedScene placed = place(scene);
  const auto write = [&](const std::string& file) { ResultWriter(file, scene, placed, OutputChoice{}, "0.1.0", "flat"); };
  const std::string nowhere = folder / "no/such/r.h5", directory = folder / "d.h5";
  CHECK_THROWS_WITH(write(nowhere), nowhere + ": cannot be written: No such file or directory");
  std::filesystem::create_directory(directory);
  CHECK_THROWS_WITH(write(directory), directory + ": cannot be written: Is a directory");
  CHECK_THROWS_WITH(write("/dev/null"), "/dev/null: cannot be written: it is a device or a pipe, no file");
  CHECK_THROWS_AS(write(""), UsageError);
}

TEST_CASE("A link to a result stays a link", "[result][complete]") {
  const Folder folder;
  std::ofstream(folder / "real.h5") << "old";
  std::filesystem::create_symlink(folder / "real.h5", folder / "link.h5");
  const Scene scene = small_scene();
  const FacetScene facets = expand(scene);
  const PlacedScene placed = place(scene);
  ResultWriter writer(folder / "link.h5", scene, placed, OutputChoice{}, "0.1.0", "flat");
  Values(facets).send(writer, 1000);
  writer.finish(small_report());
  CHECK(std::filesystem::is_symlink(folder / "link.h5"));
  CHECK(Result(folder / "real.h5").facet_count() == facets.size());
}
