#include "result/finish_result.hpp"

#include <limits>

#include <sunfleck/core/memory.hpp>

#include "result/band_units.hpp"

namespace sunfleck::h5 {

namespace {

void write_balance(OutputFile& file, ArrayWriter& arrays, const SolveReport& report, const PlantShares& shares,
                   const HeightProfile& profile, const std::string& power) {
  const std::size_t states = shares.states, bands = shares.bands;
  constexpr std::size_t n = 10;
  std::vector<double> columns[n];
  const char* names[n] = {
      "incident", "leaves",          "ground", "escaped", "residual", "absorbed_fraction_leaves", "absorbed_fraction_ground",
      "albedo",   "scattered_scale", "other"};
  for (std::size_t s = 0; s < states; ++s)
    for (std::size_t b = 0; b < bands; ++b) {
      const Balance balance = report.balance.empty() ? Balance{} : report.balance.at(s).at(b);
      const double part = balance.incident > 0 ? 1.0 / balance.incident : 0.0;
      const double other = shares.other_of_all(s, b);
      const double values[n] = {balance.incident,        balance.leaves,
                                balance.ground,          balance.escaped,
                                balance.residual(),      (balance.leaves - other) * part,
                                balance.ground * part,   balance.escaped * part,
                                balance.scattered_scale, other};
      for (std::size_t i = 0; i < n; ++i) columns[i].push_back(values[i]);
    }
  const Id group = make_group(file, file.id(), "balance");
  for (std::size_t i = 0; i < n; ++i)
    arrays.write(group.get(), names[i], columns[i].data(), {states, bands}, i < 5 || i == 9 ? power : "1");
  if (!shares.names.empty()) {
    const Id plants = make_group(file, group.get(), "plants");
    arrays.write_strings(plants.get(), "name", shares.names);
    arrays.write_states(plants.get(), "leaf", shares.leaf.data(), {states, shares.names.size(), bands}, power);
    arrays.write_states(plants.get(), "other", shares.other.data(), {states, shares.names.size(), bands}, power);
    arrays.flush();
  }
  const Id layers = make_group(file, group.get(), "profile");
  arrays.write(layers.get(), "height", profile.height, "m");
  arrays.write(layers.get(), "area", profile.area, "m^2");
  arrays.write_states(layers.get(), "absorbed", profile.absorbed.data(), {states, HeightProfile::layers, bands}, power);
  arrays.flush();
}

void write_certificate(OutputFile& file, ArrayWriter& arrays, const Certificate& c, std::size_t states, std::size_t bands,
                       const std::string& power) {
  const std::vector<std::size_t> dims{states, c.organs.size(), bands};
  const Id group = make_group(file, file.id(), "certificate");
  const std::vector<std::uint32_t> narrow(c.organs.begin(), c.organs.end());
  if (!c.organs.empty() && c.organs.back() > std::numeric_limits<std::uint32_t>::max())
    arrays.write(group.get(), "organs", c.organs, "row of /organs");
  else
    arrays.write(group.get(), "organs", narrow, "row of /organs");
  arrays.write_states(group.get(), "solved", c.solved.data(), dims, power);
  arrays.write_states(group.get(), "reference", c.reference.data(), dims, power);
  arrays.write_states(group.get(), "standard_error", c.standard_error.data(), dims, power);
  write_attribute(file, group.get(), "rmse", c.rmse);
  write_attribute(file, group.get(), "rmse_low", c.rmse_low);
  write_attribute(file, group.get(), "rmse_high", c.rmse_high);
  write_attribute(file, group.get(), "bias", c.bias);
  if (!c.bias_standard_error.empty()) write_attribute(file, group.get(), "bias_standard_error", c.bias_standard_error);
  if (!c.wanted.empty()) write_attribute(file, group.get(), "wanted", c.wanted);
  write_attribute(file, group.get(), "rays", c.rays);
  write_attribute(file, group.get(), "seed", c.seed);
  arrays.flush();
}

/// Two columns, /GROUP/name and /GROUP/value.
template <class T>
void write_pairs(OutputFile& file, ArrayWriter& arrays, hid_t group, const std::vector<std::pair<std::string, T>>& pairs,
                 const char* column, const char* unit) {
  std::vector<std::string> names;
  std::vector<T> values;
  for (const auto& [name, value] : pairs) {
    names.push_back(name);
    values.push_back(value);
  }
  arrays.write_strings(group, "name", names);
  arrays.write(group, column, values, unit);
  arrays.flush();
  file.check();
}

}  // namespace

void write_report(OutputFile& file, ArrayWriter& arrays, const SolveReport& report, const Certificate* certificate,
                  const PlantShares& shares, const HeightProfile& profile, const std::string& power) {
  write_attribute(file, file.id(), "status", name_of(report.status));
  if (!report.stand_in_rmse.empty()) {
    write_attribute(file, file.id(), "stand_in_rmse", report.stand_in_rmse);
    write_attribute(file, file.id(), "stand_in_bias", report.stand_in_bias);
  }
  write_balance(file, arrays, report, shares, profile, power);

  std::vector<std::uint32_t> level, iteration;
  std::vector<double> residual, seconds;
  std::vector<std::uint64_t> links;
  for (const auto& row : report.convergence) {
    level.push_back(row.level);
    iteration.push_back(row.iteration);
    residual.push_back(row.residual);
    links.push_back(row.links);
    seconds.push_back(row.seconds);
  }
  const Id timings = make_group(file, file.id(), "timings"), convergence = make_group(file, file.id(), "convergence");
  arrays.write(convergence.get(), "level", level, "1");
  arrays.write(convergence.get(), "iteration", iteration, "1");
  arrays.write(convergence.get(), "residual", residual, "1");
  arrays.write(convergence.get(), "links", links, "1");
  if (!report.spectral_radius.empty()) write_attribute(file, convergence.get(), "spectral_radius", report.spectral_radius);
  arrays.write(timings.get(), "iteration", seconds, "s");
  arrays.flush();
  // Only /timings and /memory differ between two runs: the seconds live there, and convergence points to them.
  file.check(H5Lcreate_soft("/timings/iteration", convergence.get(), "seconds", H5P_DEFAULT, H5P_DEFAULT) >= 0);
  write_pairs(file, arrays, timings.get(), report.timings, "seconds", "s");

  const Id counts = make_group(file, file.id(), "counts"), memory = make_group(file, file.id(), "memory");
  write_pairs(file, arrays, counts.get(), report.counts, "value", "1");
  write_pairs(file, arrays, memory.get(), report.memory, "bytes", "byte");
  write_attribute(file, memory.get(), "peak_resident_bytes", peak_resident_bytes());
  if (certificate) write_certificate(file, arrays, *certificate, shares.states, shares.bands, power);
}

void write_structures(OutputFile& file, ArrayWriter& arrays, const SolveReport& report, const Scene& scene, const PlacedScene& placed) {
  if (placed.closed.empty()) return;
  const std::size_t n = placed.closed.size(), states = scene.states.size(), bands = scene.band_count();
  std::vector<std::string> path, type;
  std::vector<double> map, absorbed(states * n * bands, 0.0);
  std::vector<std::uint8_t> solved;
  for (std::size_t k = 0; k < n; ++k) {
    const auto& c = placed.closed[k];
    path.push_back(c.path);
    const Plant* plant = c.is_group ? nullptr : scene.plants[c.index].plant.get();
    type.push_back(plant ? plant->types[plant->structures[c.structure].type] : scene.groups[c.index].name);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) map.push_back(c.map.linear[column][row]);
      map.push_back(c.map.translation[row]);
    }
    solved.push_back(c.solved);
    for (std::size_t s = 0; s < states; ++s)
      for (std::size_t b = 0; b < bands && !report.structures.empty(); ++b)
        absorbed[(s * n + k) * bands + b] = report.structures.at((k * states + s) * bands + b);
  }
  const Id group = make_group(file, file.id(), "structures");
  arrays.write_strings(group.get(), "placement", path);
  arrays.write_strings(group.get(), "type", type);
  arrays.write(group.get(), "map", map.data(), {n, 3, 4}, "m");
  arrays.write(group.get(), "solved", solved, "1");
  arrays.write_states(group.get(), "absorbed", absorbed.data(), {states, n, bands}, power_unit(scene));
  arrays.flush();
}

}  // namespace sunfleck::h5
