#include "solver/second_try.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <sunfleck/radiosity/fineness.hpp>

namespace sunfleck {

namespace {

constexpr int most_tries = 2;

MethodChoice with(const MethodChoice& choice, const std::string& method, double finer) {
  MethodChoice out = choice;
  out.method = method;
  out.why = "its own certificate spoke against method " + choice.method;
  if (finer > 0 || choice.fineness) out.fineness = std::min(fineness_of(choice) + finer, finest_fineness);
  return out;
}

}  // namespace

double fineness_of(const MethodChoice& choice) {
  return choice.fineness.value_or(static_cast<double>(choice.quality));
}

std::optional<MethodChoice> SecondTry::next(const MethodChoice& failed) {
  const bool shares = failed.method == "instantiation";
  if (run_.method) {
    advice_ = fmt::format("Method '{}' was asked for and is kept: leave the choice to the program, or ask for {}", failed.method,
                          failed.method == "clustering" ? "--quality fine or method reference" : "clustering or reference");
    return std::nullopt;
  }
  if (shares && !run_.depth.whole()) {
    advice_ =
        "What stays closed ('only', 'stop_at') is known to method instantiation alone: open the whole scene, or ask for method reference";
    return std::nullopt;
  }
  advice_ = "For less: method reference with as many --samples as it takes";
  if (tries_ == most_tries || (!shares && fineness_of(failed) >= finest_fineness)) return std::nullopt;
  ++tries_;
  const auto choice = with(failed, "clustering", shares ? 0.0 : 1.0);
  std::string why_not;
  if (fits_(choice, why_not)) return choice;
  advice_ = fmt::format("Method clustering{} would be nearer to the truth, but {}",
                        choice.fineness ? fmt::format(" at fineness {:.2f}", *choice.fineness) : "", why_not);
  return std::nullopt;
}

Aims aims_of(const MethodChoice& choice, const std::vector<double>& goal, const FacetRows& rows, const std::vector<ChosenOrgan>& chosen) {
  const bool complete = choice.method == "direct" && !scatters(rows.scene());
  if (!complete && !why_not_judged(choice.method).empty()) return {};
  const bool wanted = !goal.empty();
  Aims aims{aimed_errors(rows, chosen, fineness_of(choice)), wanted ? fmt::format("fineness {:.2f} aims at", fineness_of(choice))
                                                                    : fmt::format("quality {} aims at", name_of(choice.quality))};
  for (std::size_t b = 0; b < goal.size(); ++b) aims.error[b] = goal[b] > 0 ? std::max(goal[b], aims.error[b]) : 0.0;
  return aims;
}

std::string text_of(const Contradiction& found, const Aims& aims, const Scene& scene) {
  return fmt::format("{} of {:.2f} % in {}, {:.2f} % at least, where {} {:.2g} %", found.bias ? "a bias of all plants" : "an error",
                     100.0 * found.found, scene.bands[found.band], 100.0 * found.at_least, aims.who, 100.0 * found.aim);
}

std::string inaccurate_text(const Contradiction& found, const Aims& aims, const Scene& scene, const std::string& advice) {
  return fmt::format("inaccurate: the certificate finds {}. The result has status 'inaccurate'. {}", text_of(found, aims, scene), advice);
}

}  // namespace sunfleck
