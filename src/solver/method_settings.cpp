#include "solver/method_settings.hpp"

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/instantiation/fineness.hpp>
#include <sunfleck/radiosity/fineness.hpp>

namespace sunfleck {

namespace {

template <class Settings>
Settings shared(const RunSettings& run) {
  Settings settings;
  settings.seed = seed_of(run);
  settings.threads = run.threads;
  return settings;
}

}  // namespace

std::uint64_t seed_of(const RunSettings& run) {
  return run.seed.value_or(1);
}

InstantiationSettings instantiation_settings(const MethodChoice& choice, const RunSettings& run) {
  auto settings = shared<InstantiationSettings>(run);
  settings.density = choice.fineness ? instantiation_density_at(*choice.fineness) : instantiation_density(choice.quality);
  return settings;
}

RadiositySettings radiosity_settings(const MethodChoice& choice, const RunSettings& run) {
  auto settings = shared<RadiositySettings>(run);
  settings.density = choice.fineness ? density_at(*choice.fineness) : density_of(choice.quality);
  settings.method = choice.method == "flat"                                   ? RadiosityMethod::flat
                    : choice.method == "direct" || choice.method == "lattice" ? RadiosityMethod::direct
                                                                              : RadiosityMethod::clustering;
  return settings;
}

ReferenceSettings reference_settings(const RunSettings& run) {
  auto settings = shared<ReferenceSettings>(run);
  if (run.samples) settings.samples = *run.samples;
  return settings;
}

LatticeSettings lattice_settings(const MethodChoice& choice, const RunSettings& run) {
  auto settings = shared<LatticeSettings>(run);
  const auto finer = static_cast<std::uint32_t>(choice.quality);  // draft 0, standard 1, fine 2
  settings.nodes = run.lattice_nodes.value_or(32u << finer);
  settings.own_nodes = 16u << finer;
  if (!run.lattice_mapping) return settings;
  const auto mapping = lattice_mapping_from_name(*run.lattice_mapping);
  if (!mapping)
    throw UsageError(fmt::format("lattice mapping: found '{}'; expected one of {}", *run.lattice_mapping, joined(lattice_mapping_names())));
  settings.mapping = *mapping;
  return settings;
}

OcclusionSettings occlusion_settings(const RunSettings& run) {
  auto settings = shared<OcclusionSettings>(run);
  if (!run.occlusion_model) return settings;
  const auto model = occlusion_model_from_name(*run.occlusion_model);
  if (!model)
    throw UsageError(fmt::format("occlusion model: found '{}'; expected one of {}", *run.occlusion_model, joined(occlusion_model_names())));
  settings.model = *model;
  return settings;
}

}  // namespace sunfleck
