#include "original/partition.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace sunfleck {

namespace {

constexpr double least_gain = 0.05;  ///< of one cut, of what all are apart
constexpr double second_gain = 0.2;  ///< of a second parameter, of what the first leaves
constexpr std::size_t most_bounds = 9;
constexpr std::size_t tried_cuts = 40;  ///< per round, evenly picked

std::size_t class_along(const Cuts& cuts, double value) {
  const auto at = std::upper_bound(cuts.bounds.begin(), cuts.bounds.end(), value);
  return static_cast<std::size_t>(std::max<std::ptrdiff_t>(at - cuts.bounds.begin() - 1, 0));
}

double lowest(const std::vector<Specimen>& all, std::size_t parameter) {
  double low = all[0].parameters[parameter];
  for (const auto& s : all) low = std::min(low, s.parameters[parameter]);
  return low;
}

}  // namespace

double within_classes(const std::vector<Specimen>& all, const std::vector<Cuts>& cuts) {
  struct Sums {
    std::vector<double> table;
    double squares = 0, count = 0;
  };
  std::map<std::vector<std::size_t>, Sums> classes;
  for (const auto& s : all) {
    std::vector<std::size_t> key;
    for (const auto& c : cuts) key.push_back(class_along(c, s.parameters[c.parameter]));
    Sums& sums = classes[key];
    sums.table.resize(s.table.size(), 0.0);
    for (std::size_t i = 0; i < s.table.size(); ++i) {
      sums.table[i] += s.table[i];
      sums.squares += s.table[i] * s.table[i];
    }
    ++sums.count;
  }
  double total = 0;
  for (const auto& [key, sums] : classes) {
    // Apart from the mean of others of the class: one alone is as far from its class as all are, or cuts into single specimens would look
    // best.
    if (sums.count < 2) {
      total += 1.0;
      continue;
    }
    double mean = 0;
    for (const double t : sums.table) mean += t * t / sums.count;
    total += (sums.squares - mean) * sums.count / (sums.count - 1.0);
  }
  return total / static_cast<double>(all.size());
}

Cuts cut_along(const std::vector<Specimen>& all, std::size_t parameter, const std::vector<Cuts>& others, double wanted, std::size_t least,
               double gain) {
  std::vector<Cuts> cuts = others;
  cuts.push_back({parameter, {lowest(all, parameter)}});
  std::set<double> distinct;
  for (const auto& s : all) distinct.insert(s.parameters[parameter]);
  const double apart = within_classes(all, {});
  double now = within_classes(all, cuts);
  while (now > wanted && cuts.back().bounds.size() < most_bounds) {
    std::vector<double> candidates(std::next(distinct.begin()), distinct.end());
    const std::size_t step = (candidates.size() + tried_cuts - 1) / tried_cuts;
    double best = now;
    std::vector<double> best_bounds;
    for (std::size_t k = 0; k < candidates.size(); k += std::max<std::size_t>(step, 1)) {
      auto trial = cuts;
      auto& bounds = trial.back().bounds;
      if (std::binary_search(bounds.begin(), bounds.end(), candidates[k])) continue;
      bounds.insert(std::upper_bound(bounds.begin(), bounds.end(), candidates[k]), candidates[k]);
      std::vector<std::size_t> counts(bounds.size(), 0);
      for (const auto& s : all) ++counts[class_along(trial.back(), s.parameters[parameter])];
      if (*std::min_element(counts.begin(), counts.end()) < least) continue;
      const double value = within_classes(all, trial);
      if (value < best) best = value, best_bounds = bounds;
    }
    if (best_bounds.empty() || now - best < gain * apart) break;
    cuts.back().bounds = best_bounds;
    now = best;
  }
  return cuts.back();
}

std::vector<Cuts> best_cuts(const std::vector<Specimen>& all, std::size_t parameters, double wanted, std::size_t least) {
  std::vector<Cuts> chosen;
  double now = within_classes(all, {});
  for (int round = 0; round < 2; ++round) {
    Cuts best;
    double value = now;
    for (std::size_t p = 0; p < parameters; ++p) {
      if (!chosen.empty() && chosen[0].parameter == p) continue;
      const Cuts cuts = cut_along(all, p, chosen, wanted, least, least_gain);
      auto trial = chosen;
      trial.push_back(cuts);
      const double left = within_classes(all, trial);
      // Among parameters that do equally well the one that comes first, and needs the fewest classes.
      if (cuts.bounds.size() > 1 && left < value * 0.98) value = left, best = cuts;
    }
    if (best.bounds.empty() || (round == 1 && value > (1.0 - second_gain) * now)) break;
    chosen.push_back(best);
    now = value;
    if (now <= wanted) break;
  }
  return chosen;
}

}  // namespace sunfleck
