#include <sunfleck/cli/verbs.hpp>

#include <optional>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/policy/policy_toml.hpp>
#include <sunfleck/format/scene_toml.hpp>
#include <sunfleck/original/suggest.hpp>

namespace sunfleck {

namespace {

void print_in_use(const Scene& scene) {
  const PolicySet policies = read_policies(scene);
  if (policies.empty())
    throw UsageError(scene.file + ": no plant names a policy; `policy = \"FILE\"` in [[plant]] does, and --suggest derives one");
  classify(scene, policies);  // refuses what does not fit the plants
  for (const auto& [file, policy] : policies) fmt::print("# {}\n{}\n", file, policy_text(policy));
}

}  // namespace

int verb_policy(const PolicyOptions& options, Progress& progress) {
  std::optional<tbb::global_control> limit;
  if (options.threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options.threads));
  if (options.likeness && !options.suggest) throw UsageError("--likeness belongs to --suggest");
  const Scene scene = read_scene(options.scene);
  for (const auto& note : scene.notes) progress.line("note: " + note);
  if (!options.suggest) {
    print_in_use(scene);
    return 0;
  }
  SuggestSettings settings;
  settings.measured = options.measured;
  settings.likeness = options.likeness.value_or(settings.likeness);
  const auto suggestion = suggest_policy(scene, settings, progress);
  fmt::print("# Suggested from the plants of {}, for differences of at most {:g} % within a class where cuts reach it.\n", scene.file,
             100 * settings.likeness);
  for (const auto& remark : suggestion.remarks) fmt::print("# {}\n", remark);
  fmt::print("{}", policy_text(suggestion.policy));
  return 0;
}

}  // namespace sunfleck
