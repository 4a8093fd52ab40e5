#include "cli/error_goal.hpp"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>

namespace sunfleck {

namespace {

constexpr double least = 1e-4, most = 0.5;

double error_value(const std::string& text) {
  char* end = nullptr;
  const double number = text.empty() ? 0.0 : std::strtod(text.c_str(), &end);
  const std::string rest = end ? end : "";
  const bool percent = rest == "%";
  const double value = percent ? number / 100.0 : number;
  if (!end || (!rest.empty() && !percent) || !(value >= least && value <= most))
    throw UsageError(fmt::format("--error: found '{}'; expected per cent, such as 2%, or a fraction, such as 0.02: from {:g} to {:g}{}",
                                 text, least, most,
                                 rest.empty() && number > most && number <= 100 * most ? fmt::format(" (did you mean {}%?)", text) : ""));
  return value;
}

}  // namespace

NamedErrors named_errors(const std::string& text) {
  if (text.find('=') == std::string::npos) return {{"", error_value(text)}};
  NamedErrors named;
  for (std::size_t first = 0; first <= text.size();) {
    const std::size_t end = std::min(text.find(',', first), text.size());
    const std::string part = text.substr(first, end - first);
    first = end + 1;
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError(fmt::format("--error: found '{}'; expected BAND=ERROR, such as PAR=2%", part));
    const std::string name = part.substr(0, equals);
    for (const auto& [known, value] : named)
      if (known == name) throw UsageError(fmt::format("--error: found band '{}' twice; expected each band once", name));
    named.emplace_back(name, error_value(part.substr(equals + 1)));
  }
  return named;
}

std::vector<double> error_goal(const NamedErrors& named, const std::vector<std::string>& bands) {
  std::vector<double> goal(bands.size(), 0.0);
  for (const auto& [name, value] : named) {
    if (name.empty()) return std::vector<double>(bands.size(), value);
    const auto band = std::find(bands.begin(), bands.end(), name);
    if (band == bands.end()) {
      const std::string near = nearest_name(name, bands);
      throw UsageError(fmt::format("--error: found band '{}'; expected one of {}{}", name, joined(bands),
                                   near.empty() ? "" : " (did you mean '" + near + "'?)"));
    }
    goal[static_cast<std::size_t>(band - bands.begin())] = value;
  }
  return goal;
}

}  // namespace sunfleck
