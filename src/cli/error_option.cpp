#include "cli/error_option.hpp"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>

#include <sunfleck/solver/error_goal.hpp>

namespace sunfleck {

namespace {

double error_value(const std::string& text) {
  char* end = nullptr;
  const double number = text.empty() ? 0.0 : std::strtod(text.c_str(), &end);
  const std::string rest = end ? end : "";
  const bool percent = rest == "%";
  const double value = percent ? number / 100.0 : number;
  if (!end || (!rest.empty() && !percent) || !(value >= least_wanted_error && value <= most_wanted_error))
    throw UsageError(fmt::format(
        "--error: found '{}'; expected per cent, such as 2%, or a fraction, such as 0.02: from {:g} to {:g}{}", text, least_wanted_error,
        most_wanted_error,
        rest.empty() && number > most_wanted_error && number <= 100 * most_wanted_error ? fmt::format(" (did you mean {}%?)", text) : ""));
  return value;
}

}  // namespace

std::vector<WantedError> wanted_errors(const std::string& text) {
  if (text.find('=') == std::string::npos) return {{"", error_value(text)}};
  std::vector<WantedError> named;
  for (std::size_t first = 0; first <= text.size();) {
    const std::size_t end = std::min(text.find(',', first), text.size());
    const std::string part = text.substr(first, end - first);
    first = end + 1;
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError(fmt::format("--error: found '{}'; expected BAND=ERROR, such as PAR=2%", part));
    const std::string name = part.substr(0, equals);
    named.push_back({name, error_value(part.substr(equals + 1))});
  }
  return named;
}

}  // namespace sunfleck
