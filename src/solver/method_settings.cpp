#include "solver/method_settings.hpp"

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
  settings.method = choice.method == "flat"     ? RadiosityMethod::flat
                    : choice.method == "direct" ? RadiosityMethod::direct
                                                : RadiosityMethod::clustering;
  return settings;
}

ReferenceSettings reference_settings(const RunSettings& run) {
  auto settings = shared<ReferenceSettings>(run);
  if (run.samples) settings.samples = *run.samples;
  return settings;
}

}  // namespace sunfleck
