#include <sunfleck/original/suggest.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>

#include "original/partition.hpp"

namespace sunfleck {

namespace {

constexpr std::uint64_t least_facets = 16;

MeasureSettings quick(double error) {
  MeasureSettings settings;
  settings.tables.error = error;
  settings.most_samples = std::uint64_t{1} << 18;
  settings.fit = false;
  return settings;
}

struct Candidate {
  std::uint32_t plant, structure;
  double area;
};

/// A number with three digits, rounded down, as people write bounds; whole numbers stay.
double rounded_down(double value) {
  if (value == std::floor(value) && std::abs(value) < 1e6) return value;
  if (!(value > 0)) return value < 0 ? value : 0.0;
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2.0);
  return std::stod(fmt::format("{:.9g}", std::floor(value / unit) * unit));
}

/// Types and structures that are in no exact class, by type.
std::map<std::string, std::vector<Candidate>> candidates_of(const Scene& scene, const Classification& exact, std::uint64_t most_facets) {
  std::map<std::string, std::vector<Candidate>> all;
  std::set<const Plant*> seen;
  for (std::uint32_t p = 0; p < scene.plants.size(); ++p) {
    const Plant& plant = *scene.plants[p].plant;
    if (!seen.insert(&plant).second) continue;
    const auto values = structure_values(scene.plants[p], {"area"});
    for (std::uint32_t s = 0; s < plant.structures.size(); ++s) {
      const auto& v = values[s];
      if (v.facets < least_facets || v.facets > most_facets || !v.numbers[0] || !(*v.numbers[0] > 0)) continue;
      if (s > 0 && exact.of_structure[p][s] != no_class) continue;
      all[plant.types[plant.structures[s].type]].push_back({p, s, *v.numbers[0]});
    }
  }
  return all;
}

std::vector<Candidate> evenly_by_area(std::vector<Candidate> all, std::size_t most) {
  std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) { return a.area < b.area; });
  if (all.size() <= most) return all;
  std::vector<Candidate> picked;
  for (std::size_t i = 0; i < most; ++i) picked.push_back(all[i * (all.size() - 1) / (most - 1)]);
  return picked;
}

/// Numeric parameters that every one of the structures has and that are not the same for all; names of things are none.
std::vector<std::string> numeric_parameters(const Scene& scene, const std::vector<Candidate>& picked) {
  std::vector<std::string> names{"leaf_count", "order", "area", "length", "height"};
  for (const auto& c : picked)
    for (const auto& name : scene.plants[c.plant].plant->attribute_names)
      if (name != "id" && name != "scale" && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names;
}

struct Population {
  std::vector<std::string> names;
  std::vector<Specimen> specimens;
};

struct Measurements {
  std::vector<std::string> names;               ///< of parameters
  std::vector<std::vector<double>> parameters;  ///< [structures][names]
  std::vector<OriginalTables> tables;           ///< [structures] in the plant's frame
  std::vector<StructureFacets> frames;          ///< without facets
};

Measurements measure(const Scene& scene, const std::vector<Candidate>& picked, const SuggestSettings& settings, Progress& progress) {
  Measurements out;
  const auto names = numeric_parameters(scene, picked);
  std::map<std::uint32_t, std::vector<StructureValues>> values;
  for (const auto& c : picked)
    if (!values.count(c.plant)) values.emplace(c.plant, structure_values(scene.plants[c.plant], names));
  std::vector<std::size_t> used;
  for (std::size_t k = 0; k < names.size(); ++k) {
    std::set<double> distinct;
    bool all = true;
    for (const auto& c : picked) {
      const auto& number = values[c.plant][c.structure].numbers[k];
      all = all && number.has_value();
      if (number) distinct.insert(*number);
    }
    if (all && distinct.size() > 1) used.push_back(k);
  }
  for (const auto k : used) out.names.push_back(names[k]);
  for (const auto& c : picked) {
    out.parameters.emplace_back();
    for (const auto k : used) out.parameters.back().push_back(*values[c.plant][c.structure].numbers[k]);
    out.frames.push_back(structure_facets(scene.plants[c.plant], c.structure));
    out.frames.back().corners.clear();
    out.tables.push_back(measure_original(structure_geometry(scene, c.plant, c.structure), quick(settings.error), progress));
  }
  return out;
}

/// Tables per area, turned as a representative would be, bands of equal weight.
Population aligned(const Measurements& m, Alignment align) {
  Population population{m.names, {}};
  const std::size_t bands = m.tables[0].bands;
  std::vector<double> scale(bands, 0.0);
  for (std::size_t i = 0; i < m.tables.size(); ++i) {
    const Mat3 back = glm::transpose(align == Alignment::frame ? m.frames[i].frame.linear : m.frames[i].upright);
    Specimen s{transformed(m.tables[i], back).phase, m.parameters[i]};
    const std::size_t band = s.table.size() / bands;
    for (std::size_t k = 0; k < s.table.size(); ++k) {
      s.table[k] /= m.tables[i].area_m2;
      scale[k / band] += s.table[k] * s.table[k] / static_cast<double>(m.tables.size());
    }
    population.specimens.push_back(std::move(s));
  }
  for (auto& s : population.specimens)
    for (std::size_t k = 0; k < s.table.size(); ++k) {
      const double square = scale[k / (s.table.size() / bands)];
      s.table[k] = square > 0 ? s.table[k] / std::sqrt(square * static_cast<double>(bands)) : 0.0;
    }
  return population;
}

PolicyType type_of(const std::string& type, const Population& population, const std::vector<Cuts>& cuts, const SuggestSettings& settings) {
  PolicyType out;
  out.type = type;
  out.least_members = settings.least_members;
  for (const auto& c : cuts) {
    PolicyParameter parameter;
    parameter.name = population.names[c.parameter];
    for (std::size_t i = 0; i < c.bounds.size(); ++i) {
      // The lowest bound lets in what is a little smaller than all that were measured.
      const double low = i == 0 ? rounded_down(0.8 * c.bounds[0]) : rounded_down(c.bounds[i]);
      const bool whole = c.bounds[0] == std::floor(c.bounds[0]) && c.bounds.back() == std::floor(c.bounds.back());
      const double bound = i == 0 && whole ? std::min(c.bounds[0], 1.0) : low;
      if (!parameter.intervals.empty()) {
        if (!(bound > parameter.intervals.back().low)) continue;
        parameter.intervals.back().high = bound;
      }
      parameter.intervals.push_back({bound, std::numeric_limits<double>::infinity()});
    }
    out.parameters.push_back(std::move(parameter));
  }
  // Where two parameters count, the largest may still be all alike.
  if (cuts.size() == 2 && cuts[0].bounds.size() > 1) {
    std::vector<Specimen> top;
    for (const auto& s : population.specimens)
      if (s.parameters[cuts[0].parameter] >= cuts[0].bounds.back()) top.push_back(s);
    if (top.size() > 1 && std::sqrt(within_classes(top, {})) <= settings.likeness)
      out.converged = Convergence{population.names[cuts[0].parameter], out.parameters[0].intervals.back().low, 0};
  }
  std::sort(out.parameters.begin(), out.parameters.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return out;
}

}  // namespace

ClassSpread class_spread(const Scene& scene, const OriginalClass& original, std::size_t most, double error, Progress& progress) {
  ClassSpread spread;
  const auto& members = original.members;
  const auto model = measure_original(original_geometry(scene, original), quick(error), progress);
  spread.phase.assign(model.bands, 0.0);
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < members.size(); ++i)
    if (i != original.representative && !members[i].structure.is_group) others.push_back(i);
  const std::size_t count = std::min(most, others.size());
  for (std::size_t k = 0; k < count; ++k) {
    const auto& m = members[others[count == 1 ? 0 : k * (others.size() - 1) / (count - 1)]];
    const auto own = measure_original(structure_geometry(scene, m.structure.index, m.structure.structure), quick(error), progress);
    const auto copy = transformed(model, m.from_representative.linear);
    for (std::uint32_t b = 0; b < model.bands; ++b)
      spread.phase[b] += std::pow(phase_difference(copy, own, b), 2) / static_cast<double>(count);
    double difference = 0, norm = 0;
    for (std::size_t i = 0; i < own.sigma.size(); ++i) {
      difference += std::pow(copy.sigma[i] - own.sigma[i], 2);
      norm += own.sigma[i] * own.sigma[i];
    }
    spread.sigma += norm > 0 ? difference / norm / static_cast<double>(count) : 0.0;
    spread.noise += (std::pow(own.errors[0].sampling, 2) + std::pow(model.errors[0].sampling, 2)) / static_cast<double>(count);
  }
  spread.members = count;
  for (auto& p : spread.phase) p = std::sqrt(p);
  spread.sigma = std::sqrt(spread.sigma);
  spread.noise = std::sqrt(spread.noise);
  return spread;
}

PolicySuggestion suggest_policy(const Scene& scene, const SuggestSettings& settings, Progress& progress) {
  PolicySuggestion suggestion;
  Scene bare = scene;
  for (auto& entry : bare.plants) entry.policy_file.clear();
  const Classification exact = classify(bare, {});
  for (const auto& [type, candidates] : candidates_of(scene, exact, settings.most_facets)) {
    if (candidates.size() < 2 * settings.least_members) continue;
    const auto picked = evenly_by_area(candidates, settings.measured);
    progress.line(fmt::format("{}: measuring {} of {}", type, picked.size(), candidates.size()));
    const Measurements measured = measure(scene, picked, settings, progress);
    std::vector<Cuts> cuts;
    Population population;
    Alignment align = Alignment::upright;
    double apart = std::numeric_limits<double>::infinity();
    std::string remark =
        fmt::format("{}: {} of {} measured; rms difference of S per area from its class's mean", type, picked.size(), candidates.size());
    for (const auto one : {Alignment::upright, Alignment::frame}) {
      Population turned = aligned(measured, one);
      const auto best = best_cuts(turned.specimens, turned.names.size(), settings.likeness * settings.likeness, settings.least_members);
      const double left = within_classes(turned.specimens, best);
      remark += fmt::format("{} {}: {:.1f} % as one class, {:.1f} % cut", one == Alignment::upright ? "" : ";", name_of(one),
                            100 * std::sqrt(within_classes(turned.specimens, {})), 100 * std::sqrt(left));
      if (left < apart) apart = left, cuts = best, align = one, population = std::move(turned);
    }
    suggestion.policy.types.push_back(type_of(type, population, cuts, settings));
    suggestion.policy.types.back().align = align;
    suggestion.remarks.push_back(remark);
  }
  if (suggestion.policy.types.empty())
    throw InputError(location(scene.file),
                     fmt::format("no structure type with {} structures or more that are no exact copies", 2 * settings.least_members),
                     "plants whose structures repeat");
  return suggestion;
}

}  // namespace sunfleck
