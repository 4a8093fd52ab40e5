#include "policy/whole_copies.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include <sunfleck/scene/counts.hpp>

#include "policy/similarity.hpp"

namespace sunfleck {

namespace {

/// Copies, facets and areas of groups; each group is worked out once. The scene has no cycle among groups.
class Groups {
 public:
  explicit Groups(const Scene& scene) : scene_(scene), copies_(scene.groups.size()), contents_(scene.groups.size()) {
    parents_.resize(scene.groups.size());
    for (std::uint32_t g = 0; g < scene.groups.size(); ++g)
      for (const auto& member : scene.groups[g].members)
        if (member.is_group) parents_[member.index].push_back(g);
  }

  struct Contents {
    std::uint64_t facets = 0;
    double area = 0;
  };

  std::uint64_t copies(std::uint32_t group) {
    if (copies_[group]) return *copies_[group];
    std::uint64_t n = std::min<std::uint64_t>(too_many_copies, scene_.groups[group].placements.size());
    for (const auto parent : parents_[group]) n = std::min(too_many_copies, n + copies(parent));
    copies_[group] = n;
    return n;
  }

  const Contents& contents(std::uint32_t group) {
    if (contents_[group]) return *contents_[group];
    Contents sum;
    for (const auto& member : scene_.groups[group].members) {
      const Contents inner = member.is_group ? contents(member.index) : plant(member.index);
      const double scale = uniform_scale(member.placement.map.linear).value_or(1.0);
      sum.facets += inner.facets;
      sum.area += inner.area * scale * scale;
    }
    contents_[group] = sum;
    return *contents_[group];
  }

  static Contents of_plant(const Plant& plant) { return {plant.facet_count(), plant.area()}; }

 private:
  Contents plant(std::uint32_t p) {
    plants_.resize(scene_.plants.size());
    if (!plants_[p]) plants_[p] = of_plant(*scene_.plants[p].plant);
    return *plants_[p];
  }

  const Scene& scene_;
  std::vector<std::vector<std::uint32_t>> parents_;  ///< groups that hold it, once per placement
  std::vector<std::optional<std::uint64_t>> copies_;
  std::vector<std::optional<Contents>> contents_;
  std::vector<std::optional<Contents>> plants_;
};

void add_groups(const Scene& scene, Groups& groups, Classification& out) {
  out.of_group.assign(scene.groups.size(), no_class);
  for (std::uint32_t g = 0; g < scene.groups.size(); ++g) {
    const auto copies = groups.copies(g);
    if (copies < 2) continue;
    OriginalClass c;
    c.name = fmt::format("group: all copies of \"{}\"", scene.groups[g].name);
    c.copies = copies;
    c.facets = groups.contents(g).facets;
    c.members.push_back({{true, g, 0}, {}, 1.0, copies, groups.contents(g).area});
    out.of_group[g] = static_cast<std::uint32_t>(out.classes.size());
    out.classes.push_back(std::move(c));
  }
}

/// Placements that are no similarity, with what holds them as often as it is placed.
void add_stretched(const Scene& scene, Groups& groups, Classification& out) {
  const auto add = [&](bool is_group, std::uint32_t index, const Mat3& linear, std::uint64_t copies) {
    if (copies == 0 || uniform_scale(linear)) return;
    const StructureRef ref{is_group, index, 0};
    for (auto& c : out.classes) {
      if (c.stretch == Mat3{1.0} || !(c.members.front().structure == ref)) continue;
      if (!uniform_scale(linear * glm::inverse(c.stretch))) continue;
      c.copies = std::min(too_many_copies, c.copies + copies);
      c.members.front().copies = c.copies;
      return;
    }
    OriginalClass c;
    const auto& name = is_group ? scene.groups[index].name : scene.plants[index].name;
    const auto contents = is_group ? groups.contents(index) : Groups::of_plant(*scene.plants[index].plant);
    c.name = fmt::format("{}: stretched copies of \"{}\"", is_group ? "group" : "plant", name);
    c.copies = copies;
    c.facets = contents.facets;
    c.stretch = linear;
    c.members.push_back({ref, {}, 1.0, copies, contents.area});
    out.classes.push_back(std::move(c));
  };
  for (std::uint32_t p = 0; p < scene.plants.size(); ++p)
    for (const auto& placement : scene.plants[p].placements) add(false, p, placement.map.linear, 1);
  for (std::uint32_t g = 0; g < scene.groups.size(); ++g) {
    for (const auto& placement : scene.groups[g].placements) add(true, g, placement.map.linear, 1);
    for (const auto& member : scene.groups[g].members) add(member.is_group, member.index, member.placement.map.linear, groups.copies(g));
  }
}

}  // namespace

void add_whole_copies(const Scene& scene, Classification& out) {
  Groups groups(scene);
  add_groups(scene, groups, out);
  add_stretched(scene, groups, out);
}

}  // namespace sunfleck
