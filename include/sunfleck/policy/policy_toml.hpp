// Policy files: TOML as docs/formats-policy.md describes it.
#pragma once

#include <optional>
#include <string>

#include <sunfleck/policy/classes.hpp>

namespace sunfleck {

/// Reads an instantiation policy. Throws InputError with file, line and key: a value out of its range, intervals that do not rise or
/// overlap; all unknown keys at once, each with the nearest known one. Whether plants have the parameters is seen by classify().
Policy read_policy(const std::string& file);

/// The policies that the plants of a scene name, each read once.
PolicySet read_policies(const Scene& scene);

/// What the policies that plants of a scene name say of it; nothing where none names one. Throws what read_policy() and classify() do.
std::optional<Classification> classes_of_policies(const Scene& scene);

}  // namespace sunfleck
