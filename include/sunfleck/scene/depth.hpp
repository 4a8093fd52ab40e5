// How deep a scene is opened: which placements, and down to which structures.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/plant/plant.hpp>

namespace sunfleck {

/// Structures at which opening ends: what they absorb is told as a whole. Exactly one member is set.
struct StopAt {
  std::string type;                         ///< of structures ("branch"), "plant", or the name of a plant or group of the scene
  std::optional<double> size;               ///< the outermost structures that are no larger: longest side of their box [m]
  std::optional<std::uint64_t> leaf_count;  ///< the outermost structures with no more leaves, and at least one facet

  bool empty() const { return type.empty() && !size && !leaf_count; }
};

/// Which placements are opened, and down to what; by default all, down to facets.
struct Depth {
  std::vector<std::string> only;  ///< placements that are opened (PathPatterns); empty = all
  StopAt stop_at;                 ///< structures at which opening ends; empty = facets

  bool whole() const { return only.empty() && stop_at.empty(); }
};

/// "branch", "size=0.5" [m] or "leaf_count=20". Throws UsageError.
StopAt stop_from_text(const std::string& text);

/// Which placements `only` names. A pattern is a path of segments between "/": "tile[3]/coffee[1]" as the result names placements;
/// "tile 3" is the same as "tile[3]", "tile" is any of them, "*" is anything. All that a placement holds goes with it.
class PathPatterns {
 public:
  /// Throws InputError(where, ...) if a pattern is empty or has an empty segment.
  PathPatterns(const std::vector<std::string>& patterns, const std::string& where);

  enum class Match {
    none,     ///< neither the placement nor anything in it
    inside,   ///< perhaps something in it
    complete  ///< the placement and all in it
  };
  /// Of a path with no more segments than it is deep; remembers which patterns were met completely.
  Match match(const std::vector<std::string>& path);
  bool empty() const { return patterns_.empty(); }
  /// The first pattern that no path has met; empty if there is none.
  std::string unmet() const;

 private:
  struct Pattern {
    std::string text;
    std::vector<std::string> segments;  ///< "name[3]", "name" or "*"
    bool met = false;
  };
  std::vector<Pattern> patterns_;
};

/// The structures within a plant that `stop` names, numbered in the plant's order from 1, and to which of them each structure of the plant
/// belongs; what is within none of them belongs to 0. Of a type that is within itself, as axes bear axes, the innermost counts.
struct StructureCuts {
  std::vector<std::uint32_t> of_structure;  ///< [structures]
  std::vector<std::uint32_t> structures;    ///< [closed] row of Plant::structures; [0] is the plant itself
  std::size_t closed() const { return structures.size() - 1; }
};
StructureCuts cut_structures(const Plant& plant, const StopAt& stop);

}  // namespace sunfleck
