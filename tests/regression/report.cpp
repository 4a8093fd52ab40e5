// tools/report makes its page and plots, goes on where it was stopped, and finds work that grew.
#include <catch2/catch.hpp>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "places.hpp"
#include "run_program.hpp"

namespace {

const std::string counts = SUNFLECK_SOURCE_DIR "/tests/data/report/counts.json";

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Runs tools/report --quick in a work folder of its own; its messages go to `log`.
struct Report {
  TemporaryFolder folder;

  int run(const std::string& more) const {
    const std::string command = SUNFLECK_SOURCE_DIR "/tools/report --quick --program " SUNFLECK_PROGRAM " --work " + folder.path("work") +
                                " " + more + " 2> " + folder.path("log");
    return std::system(command.c_str());
  }
  std::string log() const { return text_of(folder.path("log")); }
  std::string page() const { return text_of(folder.path("work/error-vs-time.md")); }
  std::vector<std::string> runs() const {
    std::ifstream in(folder.path("work/runs.jsonl"));
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
  }
};

}  // namespace

TEST_CASE("report: a page with plots and tables, resumed where it was stopped, and no more work than recorded", "[report]") {
  if (std::system("/usr/bin/python3 -c 'import h5py, numpy' 2> /dev/null") != 0) {
    WARN("skipped: python3-h5py is not installed");
    return;
  }
  const Report report;
  if (std::getenv("SUNFLECK_RERECORD")) {
    REQUIRE(report.run("--record " + counts) == 0);
    WARN("recorded anew: " << counts);
    return;
  }
  const int status = report.run("--check " + counts);
  INFO(report.log());
  REQUIRE(status == 0);
  const std::string page = report.page();
  for (const char* part : {"## What the figures say", "### Where we lose", "## Draft against direct light alone",
                           "## canopy_5k:", "## wheat_small:", "| clustering | standard |", "| path tracing | 64 |",
                           "sunfleck solve WORK/scenes/canopy_5000.toml -o RESULT.h5"}) {
    INFO(part);
    CHECK(contains(page, part));
  }
  CHECK_FALSE(contains(page, "nan"));
  for (const char* plot : {"report-canopy_5k.svg", "report-wheat_small.svg"}) {
    CHECK(contains(page, std::string("(images/") + plot + ")"));
    const std::string svg = text_of(report.folder.path(std::string("work/images/") + plot));
    CHECK(contains(svg, "</svg>"));
    CHECK(contains(svg, ">clustering</text>"));
    CHECK_FALSE(contains(svg, "nan"));
  }

  // Stopped while it wrote a line, and before two others: these three are run again, no more.
  auto runs = report.runs();
  const std::size_t all = runs.size();
  REQUIRE(all > 5);
  {
    std::ofstream out(report.folder.path("work/runs.jsonl"));
    for (std::size_t i = 0; i + 3 < all; ++i) out << runs[i] << '\n';
    out << runs[all - 3].substr(0, 40) << '\n';
  }
  REQUIRE(report.run("") == 0);
  CHECK(report.runs().size() == all + 1);  // with the broken line

  // A recorded count that is exceeded is named.
  std::string recorded = text_of(counts);
  const std::string name = "\"links\": ";
  const auto at = recorded.find(name, recorded.find("canopy_5k clustering draft"));
  REQUIRE(at != std::string::npos);
  const std::string fewer = report.folder.file("fewer.json", recorded.replace(at, name.size(), name + "1, \"was\": 0, \"then\": "));
  CHECK(report.run("--check " + fewer) != 0);
  CHECK(contains(report.log(), "more work than recorded: canopy_5k clustering draft: links "));
}

TEST_CASE("report: what cannot be is refused", "[report]") {
  const Report report;
  CHECK(report.run("--only nothing") != 0);
  CHECK(contains(report.log(), "--only: found nothing; expected some of canopy_5k, wheat_small, canopy_5k_dim"));
}
