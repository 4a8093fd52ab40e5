#include "cli/validators.hpp"

#include <cmath>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include <sunfleck/core/names.hpp>

namespace sunfleck {

namespace {

CLI::Validator checked_number(double low, double high, bool whole) {
  const bool open_above = high == std::numeric_limits<double>::infinity();
  const std::string allowed = fmt::format("a {}number {}", whole ? "whole " : "",
                                          open_above ? fmt::format("of at least {}", low) : fmt::format("from {} to {}", low, high));
  return CLI::Validator(
      [=](std::string& text) {
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        const bool is_number = !text.empty() && *end == '\0' && std::isfinite(value) && (!whole || value == std::floor(value));
        const bool plain = !whole || text.find_first_not_of("0123456789") == std::string::npos;  // "1e3" would not convert
        if (is_number && plain && value >= low && value <= high) return std::string();
        return fmt::format("found '{}'; expected {}", text, allowed);
      },
      "");
}

}  // namespace

CLI::Validator number_between(double low, double high) {
  return checked_number(low, high, false);
}

CLI::Validator count_from(double low, double high) {
  return checked_number(low, high, true);
}

CLI::Validator one_of(std::vector<std::string> names) {
  return CLI::Validator(
      [names = std::move(names)](std::string& text) {
        for (const auto& name : names)
          if (text == name) return std::string();
        const std::string near = nearest_name(text, names);
        return fmt::format("found '{}'; expected one of {}{}", text, joined(names), near.empty() ? "" : " (did you mean '" + near + "'?)");
      },
      "");
}

}  // namespace sunfleck
