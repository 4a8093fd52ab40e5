#include <sunfleck/solver/error_goal.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>

namespace sunfleck {

std::vector<double> error_goal(const std::vector<WantedError>& wanted, const std::vector<std::string>& bands) {
  std::vector<double> goal(bands.size(), 0.0);
  for (const auto& [name, value] : wanted) {
    if (!(value >= least_wanted_error && value <= most_wanted_error))
      throw UsageError(fmt::format("error: found {:g}; expected a fraction of the mean, such as 0.02, from {:g} to {:g}", value,
                                   least_wanted_error, most_wanted_error));
    if (name.empty() && wanted.size() == 1) return std::vector<double>(bands.size(), value);
    const auto band = std::find(bands.begin(), bands.end(), name);
    if (band == bands.end()) {
      const std::string near = nearest_name(name, bands);
      throw UsageError(fmt::format("error: found band '{}'; expected one of {}{}", name, joined(bands),
                                   near.empty() ? "" : " (did you mean '" + near + "'?)"));
    }
    double& of_band = goal[static_cast<std::size_t>(band - bands.begin())];
    if (of_band > 0) throw UsageError(fmt::format("error: found band '{}' twice; expected each band once", name));
    of_band = value;
  }
  return goal;
}

}  // namespace sunfleck
