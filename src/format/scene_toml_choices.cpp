// [output] and [solve].
#include <limits>

#include <format/scene_toml_parts.hpp>

namespace sunfleck {

TomlSchema output_schema() {
  return TomlSchema::of({"facets", "fields"});
}
TomlSchema solve_schema() {
  return TomlSchema::of({"quality", "method", "seed", "certificate", "samples"});
}

void read_output(const TomlValue& root, Scene& scene) {
  const auto output = root.get("output");
  if (!output) return;
  if (const auto facets = output->get("facets")) scene.output.facets = facets->flag();
  if (const auto fields = output->get("fields")) {
    for (const auto& field : fields->items()) {
      scene.output.fields.push_back(field.one_of(output_fields()));
      if (!scene.output.facets && scene.output.fields.back().rfind("facets/", 0) == 0)
        field.fail("a dataset of organs, since facets = false keeps no others");
    }
    if (scene.output.fields.empty()) fields->fail("at least one dataset, or no `fields` to keep all");
  }
}

void read_solve(const TomlValue& root, Scene& scene) {
  const auto solve = root.get("solve");
  if (!solve) return;
  if (const auto quality = solve->get("quality")) {
    const auto name = quality->one_of({"draft", "standard", "fine"});
    scene.solve.quality = name == "draft" ? Quality::draft : name == "fine" ? Quality::fine : Quality::standard;
  }
  if (const auto method = solve->get("method"))
    scene.solve.method = method->one_of({"instantiation", "clustering", "flat", "direct", "reference"});
  if (const auto seed = solve->get("seed"))
    scene.solve.seed = static_cast<std::uint64_t>(seed->integer(0, std::numeric_limits<std::int64_t>::max()));
  if (const auto certificate = solve->get("certificate")) scene.solve.certificate = certificate->flag();
  if (const auto samples = solve->get("samples")) scene.solve.samples = static_cast<std::uint32_t>(samples->integer(1, 1 << 30));
}

}  // namespace sunfleck
