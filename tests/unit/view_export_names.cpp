// Bands and states whose names no format takes as they are: every export keeps them apart.
#include <catch2/catch.hpp>

#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

#include <pugixml.hpp>

#include <sunfleck/core/h5.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/format/read_plant.hpp>
#include <sunfleck/view/copy_values.hpp>
#include <sunfleck/view/export.hpp>

#include "result_scene.hpp"

using namespace sunfleck;
using namespace sunfleck::test;

namespace {

std::string text_in(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// All that the pattern's group finds.
std::vector<std::string> found(const std::string& text, const std::string& pattern) {
  std::vector<std::string> out;
  const std::regex expression(pattern);
  for (std::sregex_iterator it(text.begin(), text.end(), expression), end; it != end; ++it) out.push_back((*it)[1]);
  return out;
}

void all_different(const std::vector<std::string>& names, std::size_t count) {
  CHECK(names.size() == count);
  CHECK(std::set<std::string>(names.begin(), names.end()).size() == count);
}

struct NamedResult {
  NamedResult(const std::vector<std::string>& bands, const std::vector<std::string>& states, bool photons = false) {
    Scene scene = small_scene();
    scene.bands = bands;
    for (std::size_t s = 0; s < states.size(); ++s) scene.states[s].name = states[s];
    if (photons) scene.band_units = {"umol m^-2 s^-1", "umol m^-2 s^-1"};
    scene.optics[1].name = "le af";
    scene.optics[0].name = "le_af";
    const FacetScene facets = expand(scene);
    const PlacedScene placed = place(scene);
    ResultWriter writer(folder / "r.h5", scene, placed, OutputChoice{}, "0.1.0", "flat");
    Values(facets).send(writer, 1000);
    writer.finish(small_report());
  }
  std::string operator/(const std::string& name) const { return folder / name; }
  Folder folder;
};

}  // namespace

TEST_CASE("Bands and states that clean to the same text stay apart in every export", "[view][export][names]") {
  const std::vector<std::vector<std::string>> cases{{"<700", ">700"}, {"红", "绿"}, {"a b", "a_b"}, {"PAR", "PAR -->"}};
  for (const auto& names : cases) {
    INFO(names[0] << " " << names[1]);
    const NamedResult files(names, names);
    const Result result(files / "r.h5");
    Progress progress;
    export_ply(result, files / "m.ply", {}, progress);
    const auto header = text_in(files / "m.ply").substr(0, 4000);
    all_different(found(header.substr(0, header.find("end_header")), "property float (\\S+)\n"), 2 + 2 * (2 * 3 + 2));
    CHECK_NOTHROW(read_plant(files / "m.ply"));
    CHECK(header.find("; called ") != std::string::npos);  // which is which
    export_vtkhdf(result, files / "m.vtkhdf", {}, progress);
    export_xdmf(result, files / "m.xdmf", {}, progress);
    pugi::xml_document xml;
    REQUIRE(xml.load_file((files / "m.xdmf").c_str()));
    const std::string text = text_in(files / "m.xdmf");
    for (const auto& comment : found(text, "<!--((?:.|\n)*?)-->")) CHECK(comment.find("--") == std::string::npos);
    for (const auto& grid : xml.select_nodes("//Grid[@GridType='Uniform']")) {
      std::vector<std::string> columns;
      for (const auto attribute : grid.node().children("Attribute")) columns.push_back(attribute.attribute("Name").value());
      all_different(columns, 3 + 2 * 3 + 2);
    }
    export_obj(result, files / "m.obj", {}, progress);
    all_different(found(text_in(files / "m.mtl"), "newmtl (\\S+)\n"), 3);
    export_glb(result, files / "m.glb", {}, progress);
    export_csv(result, files / "t.csv", progress);
    const std::string table = text_in(files / "t.csv");
    CHECK(table.find("absorbed_W_" + names[0] + "_" + names[1]) != std::string::npos);  // tables take any name
    const CopyValues copy = copy_values(result, result.geometry(), result.strings("names/placement").front(), progress);
    all_different(copy.names, 1 + 2 * (2 * 3 + 2) + 2);
  }
}

TEST_CASE("A band and a state that join to the name of another pair stay apart", "[view][export][names]") {
  const NamedResult files({"b", "b_a"}, {"a", "a_a"});
  const Result result(files / "r.h5");
  Progress progress;
  export_csv(result, files / "t.csv", progress);
  std::istringstream head(text_in(files / "t.csv").substr(0, text_in(files / "t.csv").find('\n')));
  std::vector<std::string> columns;
  for (std::string name; std::getline(head, name, ',');) columns.push_back(name);
  all_different(columns, 6 + 2 * (2 * 3 + 2) + 2);
  export_groups(result, files / "g.csv", "type", progress);
  export_ply(result, files / "m.ply", {}, progress);
  const auto header = text_in(files / "m.ply").substr(0, 4000);
  all_different(found(header.substr(0, header.find("end_header")), "property float (\\S+)\n"), 2 + 2 * (2 * 3 + 2));
}

TEST_CASE("Units of values are those of their bands", "[result][names]") {
  const NamedResult files({"PAR", "NIR"}, {"noon", "evening"}, true);
  const auto unit = [&](const char* dataset) {
    const h5::Id file(H5Fopen((files / "r.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)), data(H5Dopen2(file.get(), dataset, H5P_DEFAULT)),
        attribute(H5Aopen(data.get(), "units", H5P_DEFAULT)), type(H5Aget_type(attribute.get()));
    std::string text(H5Tget_size(type.get()), '\0');
    H5Aread(attribute.get(), type.get(), text.data());
    return text;
  };
  for (const char* name : {"facets/irradiance", "facets/absorbed", "organs/irradiance", "states/sun_irradiance", "states/sky_irradiance"}) {
    INFO(name);
    CHECK(unit(name) == "umol m^-2 s^-1");
  }
  for (const char* name : {"organs/absorbed", "balance/incident", "balance/profile/absorbed"}) {
    INFO(name);
    CHECK(unit(name) == "umol s^-1");
  }
}
