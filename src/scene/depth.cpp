#include <sunfleck/scene/depth.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/plant/leaf_type.hpp>

namespace sunfleck {

namespace {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string::npos ? std::string() : text.substr(first, last - first + 1);
}

/// "tile 3" as "tile[3]".
std::string as_in_results(const std::string& segment) {
  const auto space = segment.find_last_of(' ');
  if (space == std::string::npos || space + 1 == segment.size()) return segment;
  const auto digits = segment.substr(space + 1);
  if (!std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isdigit(c); })) return segment;
  return trimmed(segment.substr(0, space)) + "[" + digits + "]";
}

bool meets(const std::string& pattern, const std::string& segment) {
  if (pattern == "*" || pattern == segment) return true;
  return segment.size() > pattern.size() && segment[pattern.size()] == '[' && segment.compare(0, pattern.size(), pattern) == 0;
}

bool same_word(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// What counts of every structure with all below it.
struct Contents {
  Box bounds;
  std::uint64_t leaves = 0, facets = 0;
};

std::vector<Contents> contents_of(const Plant& plant) {
  std::vector<Contents> out(plant.structures.size());
  for (const auto& shape : plant.shapes) {
    auto& c = out[shape.structure];
    c.facets += shape.triangle_count;
    for (std::uint32_t t = 0; t < shape.triangle_count; ++t)
      for (const auto& p : shape_triangle(plant, shape, t)) c.bounds.add(p);
  }
  for (auto s = plant.structures.size(); s-- > 0;) {
    if (is_leaf_type(plant.types[plant.structures[s].type])) ++out[s].leaves;
    const auto parent = plant.structures[s].parent;
    if (parent == no_parent) continue;
    out[parent].bounds.add(out[s].bounds);
    out[parent].leaves += out[s].leaves;
    out[parent].facets += out[s].facets;
  }
  return out;
}

}  // namespace

StopAt stop_from_text(const std::string& text) {
  StopAt stop;
  const auto equals = text.find('=');
  if (equals == std::string::npos && !text.empty()) {
    stop.type = text;
    return stop;
  }
  const std::string key = text.substr(0, equals), value = equals == std::string::npos ? "" : text.substr(equals + 1);
  try {
    std::size_t used = 0;
    const double number = std::stod(value, &used);
    if (used == value.size() && std::isfinite(number) && number > 0) {
      if (key == "size") stop.size = number;
      if (key == "leaf_count" && number >= 1 && number < 9e15 && number == std::floor(number))
        stop.leaf_count = static_cast<std::uint64_t>(number);
    }
  } catch (const std::logic_error&) {  // said below
  }
  if (stop.empty())
    throw UsageError(fmt::format("--stop-at: found '{}'; expected a type of structures, size=METRES or leaf_count=N", text));
  return stop;
}

PathPatterns::PathPatterns(const std::vector<std::string>& patterns, const std::string& where) {
  for (const auto& text : patterns) {
    Pattern p;
    p.text = text;
    for (std::size_t first = 0; first <= text.size();) {
      const auto end = std::min(text.find('/', first), text.size());
      p.segments.push_back(as_in_results(trimmed(text.substr(first, end - first))));
      if (p.segments.back().empty())
        throw InputError(where, fmt::format("\"{}\"", text), "a path of placements such as \"tile 3/coffee 1\" or \"tile 3/*\"");
      first = end + 1;
    }
    patterns_.push_back(std::move(p));
  }
}

PathPatterns::Match PathPatterns::match(const std::vector<std::string>& path) {
  Match best = Match::none;
  for (auto& p : patterns_) {
    const std::size_t n = std::min(path.size(), p.segments.size());
    if (!std::equal(p.segments.begin(), p.segments.begin() + static_cast<std::ptrdiff_t>(n), path.begin(), meets)) continue;
    if (p.segments.size() <= path.size()) {
      p.met = true;
      best = Match::complete;
    } else if (best == Match::none) {
      best = Match::inside;
    }
  }
  return best;
}

std::string PathPatterns::unmet() const {
  for (const auto& p : patterns_)
    if (!p.met) return p.text;
  return {};
}

StructureCuts cut_structures(const Plant& plant, const StopAt& stop) {
  StructureCuts out;
  out.of_structure.assign(plant.structures.size(), 0);
  out.structures.push_back(0);
  const auto contents = stop.type.empty() ? contents_of(plant) : std::vector<Contents>{};
  for (std::uint32_t s = 1; s < plant.structures.size(); ++s) {
    const auto& structure = plant.structures[s];
    if (structure.parent != no_parent) out.of_structure[s] = out.of_structure[structure.parent];
    if (stop.type.empty() && out.of_structure[s] != 0) continue;
    bool ends = false;
    if (!stop.type.empty()) {
      ends = same_word(plant.types[structure.type], stop.type);
    } else if (contents[s].facets > 0) {
      const Vec3 size = contents[s].bounds.size();
      ends = stop.size ? std::max({size.x, size.y, size.z}) <= *stop.size : contents[s].leaves <= *stop.leaf_count;
    }
    if (!ends) continue;
    out.of_structure[s] = static_cast<std::uint32_t>(out.structures.size());
    out.structures.push_back(s);
  }
  return out;
}

}  // namespace sunfleck
