#include "solver/solve_again.hpp"

#include <algorithm>
#include <set>
#include <string>

#include <fmt/format.h>

#include <sunfleck/core/free_memory.hpp>
#include <sunfleck/core/memory.hpp>
#include <sunfleck/instantiation/fineness.hpp>
#include <sunfleck/radiosity/fineness.hpp>

namespace sunfleck {

namespace {

constexpr std::uint32_t compared_organs = 4000;

/// The largest fineness whose memory, which grows about as the samples do, stays below three fifths of what there is for it.
double finest_in_memory(const MethodChoice& choice, const SolveReport& report) {
  const auto samples = [&](double fineness) {
    if (choice.method == "instantiation") {
      const auto d = instantiation_density_at(fineness);
      return d.coarse.directions * d.coarse.lines_per_organ + d.fine.directions * d.fine.lines_per_organ;
    }
    const auto d = density_at(fineness);
    return d.directions * d.lines_per_element * d.elements_per_organ;
  };
  const double room = 0.6 * (static_cast<double>(free_memory().bytes) + static_cast<double>(resident_bytes()));
  double held = 0;
  for (const auto& [name, bytes] : report.memory)
    if (name != "at_once") held += static_cast<double>(bytes);
  double fineness = finest_fineness;
  while (fineness > *choice.fineness && held * samples(fineness) / samples(*choice.fineness) > room) fineness -= 0.05;
  return std::max(fineness, *choice.fineness);
}

std::string percent_of_bands(const Scene& scene, const std::vector<double>& goal, const auto& value) {
  std::string text;
  for (std::size_t b = 0; b < goal.size(); ++b)
    if (goal[b] > 0) text += fmt::format("{}{} {:.2f} %", text.empty() ? "" : ", ", scene.bands[b], 100.0 * value(b));
  return text;
}

}  // namespace

std::vector<ChosenOrgan> organs_to_compare(const FacetRows& rows, const CertificateSettings& checking) {
  CertificateSettings more = checking;
  more.organs = std::max(more.organs, compared_organs);
  return choose_organs(rows, more);
}

std::vector<std::uint64_t> rows_of(const std::vector<ChosenOrgan>& a, const std::vector<ChosenOrgan>& b) {
  std::set<std::uint64_t> rows;
  for (const auto* chosen : {&a, &b})
    for (const auto& c : *chosen) rows.insert(c.organ);
  return {rows.begin(), rows.end()};
}

bool refine_further(const Scene& scene, const SolveReport& report, Certificate& certificate, const std::vector<SolveDifference>& to_earlier,
                    Refinement& refinement, MethodChoice& choice, Progress& progress) {
  const auto& goal = refinement.goal();
  const double fineness = *choice.fineness;
  refinement.add(fineness, certificate, to_earlier);
  certificate.wanted = goal;
  const auto expected = [&](double at) {
    return percent_of_bands(scene, goal, [&](std::size_t b) { return refinement.expected(b, at, 0.0); });
  };
  const std::string found = percent_of_bands(scene, goal, [&](std::size_t b) { return refinement.found(b); });
  const std::string wanted = percent_of_bands(scene, goal, [&](std::size_t b) { return goal[b]; });
  if (report.status != SolveStatus::converged || refinement.reached()) {
    progress.line(fmt::format("error of about {} at fineness {:.2f}; wanted {}", found, fineness, wanted));
    return false;
  }
  const double limit = finest_in_memory(choice, report);
  const auto next = refinement.next(limit);
  if (!next) {
    progress.line(fmt::format("error of about {} at fineness {:.2f}; wanted {}, not reached", found, fineness, wanted));
    return false;
  }
  progress.line(fmt::format("error of about {} at fineness {:.2f}; wanted {}: solving again at fineness {:.2f}{}, where {} is expected",
                            found, fineness, wanted, *next,
                            *next < limit - 1e-9      ? ""
                            : limit < finest_fineness ? ", the finest that memory allows"
                                                      : ", the finest there is",
                            expected(*next)));
  choice.fineness = next;
  return true;
}

std::string not_reached_text(const Scene& scene, const Refinement& refinement, const Certificate& certificate) {
  const auto& goal = refinement.goal();
  std::string intervals;
  for (std::size_t b = 0; b < goal.size(); ++b)
    if (goal[b] > 0)
      intervals += fmt::format("{}{} {:.2f} to {:.2f} %", intervals.empty() ? "" : ", ", scene.bands[b], 100.0 * certificate.rmse_low[b],
                               100.0 * certificate.rmse_high[b]);
  return fmt::format(
      "the wanted error, {}, was not reached: about {} is found (95 % interval of the certificate: {}). The result has "
      "status 'not_converged'. For less: another method, or method reference with as many samples as it takes",
      percent_of_bands(scene, goal, [&](std::size_t b) { return goal[b]; }),
      percent_of_bands(scene, goal, [&](std::size_t b) { return refinement.found(b); }), intervals);
}

}  // namespace sunfleck
