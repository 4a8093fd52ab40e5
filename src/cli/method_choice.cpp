#include "cli/method_choice.hpp"

#include <array>
#include <vector>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>

namespace sunfleck {

namespace {

const std::vector<std::string> methods{"instantiation", "clustering", "flat", "direct", "reference"};

/// What the densities of each quality were chosen for: rms error over organs in the near infrared, the worst band, on a canopy of
/// leaves, coffee and wheat. An aim, not a bound: docs/accuracy.md tells what is reached where.
struct Aim {
  Quality quality;
  double error;
};
constexpr std::array<Aim, 3> aims{{{Quality::draft, 0.06}, {Quality::standard, 0.02}, {Quality::fine, 0.012}}};

std::string checked_method(const std::string& name) {
  for (const auto& known : methods)
    if (name == known) return name;
  const std::string near = nearest_name(name, methods);
  throw UsageError(fmt::format("method: found '{}'; expected one of {}{}", name, joined(methods),
                               near.empty() ? "" : " (did you mean '" + near + "'?)"));
}

Quality quality_for_error(double error) {
  for (const auto& [quality, aim] : aims)
    if (aim <= error) return quality;
  throw UsageError(
      fmt::format("--error: found {}; expected at least {}, what 'fine' aims at (for less: --method reference)", error, aims.back().error));
}

Quality quality_from_name(const std::string& name) {
  for (const auto& known : aims)
    if (name == name_of(known.quality)) return known.quality;
  throw UsageError(fmt::format("--quality: found '{}'; expected one of draft, standard, fine", name));
}

}  // namespace

std::string name_of(Quality quality) {
  switch (quality) {
    case Quality::draft:
      return "draft";
    case Quality::standard:
      return "standard";
    case Quality::fine:
      return "fine";
  }
  return {};
}

MethodChoice choose_method(const std::optional<std::string>& method, const std::optional<std::string>& quality,
                           const std::optional<double>& error, const SolveChoice& scene) {
  MethodChoice choice;
  choice.method = checked_method(method ? *method : scene.method.value_or("clustering"));
  if (quality)
    choice.quality = quality_from_name(*quality);
  else if (error)
    choice.quality = quality_for_error(*error);
  else
    choice.quality = scene.quality.value_or(Quality::standard);
  return choice;
}

RadiosityMethod radiosity_method(const std::string& method) {
  return method == "flat" ? RadiosityMethod::flat : method == "direct" ? RadiosityMethod::direct : RadiosityMethod::clustering;
}

}  // namespace sunfleck
