// Which structures of a species scatter light alike, as data: an instantiation policy.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace sunfleck {

/// Half-open: low <= value < high.
struct Interval {
  double low = 0, high = 0;
  bool holds(double value) const { return low <= value && value < high; }
};

/// A parameter that tells structures of one type apart. Exactly one of `each`, `intervals`, `values` is set. A structure whose value is
/// in no interval and not listed, or that has no value, belongs to no class.
struct PolicyParameter {
  std::string name;                 ///< an attribute of the plant, or type, leaf_count, order, area, length, height
  bool each = false;                ///< every value is a class of its own: texts, truth values, whole numbers
  std::vector<Interval> intervals;  ///< rising, not overlapping; the last may reach to infinity
  std::vector<std::string> values;  ///< texts, "true", "false"
  long line = 0;                    ///< of the policy file, for messages; 0 = made in memory
};

/// Structures with a larger value are one class, whatever their other parameters are: large structures converge.
struct Convergence {
  std::string parameter;
  double above = 0;
  long line = 0;
};

enum class Representative {
  medoid,  ///< the member with the least sum of distances to the others (area, compactness, orientation of its leaves; classes.hpp)
  first,   ///< the first in the order of the scene
  largest  ///< the one with the largest area
};

/// How a representative stands in for another member.
enum class StandIn {
  area,  ///< scaled so that its area is the member's
  size   ///< at its own size
};

/// How a representative is turned to where another member is.
enum class Alignment {
  upright,  ///< about the vertical only, until both axes point to the same azimuth: for species whose leaves turn to the sky
  frame     ///< frame on frame: for structures that bear their leaves alike however they lean
};

/// What is asked of structures of one type.
struct PolicyType {
  std::string type;  ///< "*" = every type that no other entry names
  std::vector<PolicyParameter> parameters;
  std::optional<Convergence> converged;
  Representative representative = Representative::medoid;
  StandIn scale = StandIn::area;
  Alignment align = Alignment::upright;
  std::uint32_t least_members = 3;  ///< a class with fewer is opened with its parent
  long line = 0;
};

/// How tables of originals are held.
struct TableSettings {
  enum class Basis {
    harmonics,  ///< spherical harmonics up to `order`
    directions  ///< 66 directions: an octahedron split twice
  };
  Basis basis = Basis::harmonics;
  std::uint32_t order = 2;         ///< of the harmonics, 1 to 6
  double error = 0.002;            ///< sampling error of a table, relative [-]
  std::uint32_t field_pixels = 8;  ///< K of the K x K fields between copies; 1 = a phase function alone
};

/// A policy file; docs/formats-policy.md.
struct Policy {
  std::string file;  ///< for messages; empty if made in memory
  std::vector<PolicyType> types;
  TableSettings tables;
};

/// Names as the file has them.
std::string name_of(Representative representative);
std::string name_of(StandIn scale);
std::string name_of(Alignment align);
std::string name_of(TableSettings::Basis basis);

/// The policy as a file that reads back to the same (lines aside).
std::string policy_text(const Policy& policy);

}  // namespace sunfleck
