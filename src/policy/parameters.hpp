// Values of likeness parameters: attributes of the plant file, or derived.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sunfleck/plant/plant.hpp>

#include "policy/subtrees.hpp"

namespace sunfleck {

/// Parameters that every plant has.
const std::vector<std::string>& derived_parameters();

/// A number (truth values as text), a text, or nothing.
struct ParameterValue {
  std::optional<double> number;
  std::string text;  ///< empty for numbers
  bool whole = false;
  explicit operator bool() const { return number.has_value() || !text.empty(); }
};

ParameterValue parameter_value(const Subtrees& subtrees, std::uint32_t structure, const std::string& name);

}  // namespace sunfleck
