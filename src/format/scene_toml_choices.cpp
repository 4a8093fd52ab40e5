// [output] and [solve].
#include <limits>

#include <format/scene_toml_parts.hpp>

namespace sunfleck {

TomlSchema output_schema() {
  return TomlSchema::of({"facets", "fields"});
}
TomlSchema solve_schema() {
  return TomlSchema::of(
      {"quality", "method", "seed", "certificate", "samples", "only", "lattice_mapping", "lattice_nodes", "occlusion_model"},
      {{"stop_at", TomlSchema::of({"size", "leaf_count"})}});
}

namespace {

void read_stop(const TomlValue& value, StopAt& out) {
  if (!value.is_table()) {
    out.type = value.text();
    if (out.type.empty()) value.fail("a type of structures such as \"axis\", or { size = ... } [m], or { leaf_count = ... }");
    return;
  }
  const auto size = value.get("size"), leaves = value.get("leaf_count");
  if (size.has_value() == leaves.has_value()) value.fail("either `size` [m] or `leaf_count`");
  if (size) out.size = size->positive();
  if (leaves) out.leaf_count = static_cast<std::uint64_t>(leaves->integer(1, std::numeric_limits<std::int64_t>::max()));
}

}  // namespace

void read_output(const TomlValue& root, OutputChoice& out) {
  const auto output = root.get("output");
  if (!output) return;
  if (const auto facets = output->get("facets")) out.facets = facets->flag();
  if (const auto fields = output->get("fields")) {
    for (const auto& field : fields->items()) {
      out.fields.push_back(field.one_of(output_fields()));
      if (!out.facets && out.fields.back().rfind("facets/", 0) == 0)
        field.fail("a dataset of organs, since facets = false keeps no others");
    }
    if (out.fields.empty()) fields->fail("at least one dataset, or no `fields` to keep all");
  }
}

void read_solve(const TomlValue& root, RunSettings& run) {
  const auto solve = root.get("solve");
  if (!solve) return;
  if (const auto quality = solve->get("quality")) {
    run.quality = quality_from_name(quality->one_of({"draft", "standard", "fine"}));
  }
  if (const auto method = solve->get("method")) run.method = method->one_of(method_names());
  if (const auto mapping = solve->get("lattice_mapping")) run.lattice_mapping = mapping->one_of({"matched", "paper"});
  if (const auto nodes = solve->get("lattice_nodes")) run.lattice_nodes = static_cast<std::uint32_t>(nodes->integer(2, 1024));
  if (const auto model = solve->get("occlusion_model")) run.occlusion_model = model->one_of({"table", "paper"});
  if (const auto seed = solve->get("seed"))
    run.seed = static_cast<std::uint64_t>(seed->integer(0, std::numeric_limits<std::int64_t>::max()));
  if (const auto certificate = solve->get("certificate")) run.certificate = certificate->flag();
  if (const auto only = solve->get("only")) {
    if (!only->is_array()) only->fail("an array of placements, such as [\"tile 3/*\", \"coffee 17\"]");
    for (const auto& item : only->items()) run.depth.only.push_back(item.text());
    if (run.depth.only.empty()) only->fail("at least one placement, or no `only` to open all");
  }
  if (const auto stop = solve->get("stop_at")) read_stop(*stop, run.depth.stop_at);
  if (const auto samples = solve->get("samples")) run.samples = static_cast<std::uint32_t>(samples->integer(1, 1 << 30));
}

}  // namespace sunfleck
