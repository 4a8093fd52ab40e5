#include <sunfleck/radiosity/cluster_order.hpp>

#include <algorithm>

namespace sunfleck {

namespace {

constexpr std::size_t most_children = 4;

/// A structure (or patch) on its way into the tree.
struct Unit {
  Vec3 weighted_centroid{0.0};
  double area = 0;
  std::vector<std::uint32_t> children;  ///< units
  std::uint32_t patch = no_parent;      ///< for units without children

  Vec3 centroid() const { return area > 0 ? weighted_centroid / area : weighted_centroid; }
};

class TreeBuilder {
 public:
  explicit TreeBuilder(const std::vector<Unit>& units, ClusterOrder& out) : units_(units), out_(out) {}

  void build(std::vector<std::uint32_t> roots) {
    out_.nodes.push_back({});
    // an explicit stack: hierarchies may be ten thousand levels deep
    struct Task {
      std::uint32_t node;
      std::vector<std::uint32_t> members;
    };
    std::vector<Task> tasks;
    tasks.push_back({0, std::move(roots)});
    while (!tasks.empty()) {
      Task task = std::move(tasks.back());
      tasks.pop_back();
      auto members = std::move(task.members);
      // a chain of single children adds nothing
      while (members.size() == 1 && !units_[members[0]].children.empty()) members = units_[members[0]].children;
      if (members.size() == 1) {
        out_.nodes[task.node].first_patch = units_[members[0]].patch;  // the patch itself; number_patches() turns it into a position
        continue;
      }
      const auto parts = split(members);
      const auto first = static_cast<std::uint32_t>(out_.nodes.size());
      out_.nodes[task.node].first_child = first;
      out_.nodes[task.node].child_count = static_cast<std::uint32_t>(parts.size());
      for (std::size_t i = 0; i < parts.size(); ++i) {
        ClusterNode child;
        child.parent = task.node;
        out_.nodes.push_back(child);
      }
      for (std::size_t i = 0; i < parts.size(); ++i) tasks.push_back({first + static_cast<std::uint32_t>(i), parts[i]});
    }
    number_patches();
  }

 private:
  std::vector<std::vector<std::uint32_t>> split(std::vector<std::uint32_t>& members) const {
    std::vector<std::vector<std::uint32_t>> parts;
    if (members.size() <= most_children) {
      for (const auto m : members) parts.push_back({m});
      return parts;
    }
    Box box;
    for (const auto m : members) box.add(units_[m].centroid());
    const Vec3 size = box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    const auto middle = members.begin() + static_cast<std::ptrdiff_t>(members.size() / 2);
    std::nth_element(members.begin(), middle, members.end(), [&](std::uint32_t a, std::uint32_t b) {
      const double x = units_[a].centroid()[axis], y = units_[b].centroid()[axis];
      return x < y || (x == y && a < b);
    });
    parts.emplace_back(members.begin(), middle);
    parts.emplace_back(middle, members.end());
    return parts;
  }

  /// Depth-first positions of patches.
  void number_patches() {
    std::vector<std::uint32_t> stack{0};
    std::vector<std::uint32_t> order;
    while (!stack.empty()) {
      const auto i = stack.back();
      stack.pop_back();
      order.push_back(i);
      const auto& node = out_.nodes[i];
      for (std::uint32_t c = node.child_count; c-- > 0;) stack.push_back(node.first_child + c);
    }
    for (const auto i : order) {
      auto& node = out_.nodes[i];
      if (node.child_count > 0) continue;
      const auto patch = node.first_patch;
      node.first_patch = static_cast<std::uint32_t>(out_.patches.size());
      node.patch_count = 1;
      out_.patches.push_back(patch);
    }
    for (std::size_t k = order.size(); k-- > 0;) {
      auto& node = out_.nodes[order[k]];
      if (node.child_count == 0) continue;
      node.first_patch = out_.nodes[node.first_child].first_patch;
      for (std::uint32_t c = 0; c < node.child_count; ++c) node.patch_count += out_.nodes[node.first_child + c].patch_count;
    }
  }

  const std::vector<Unit>& units_;
  ClusterOrder& out_;
};

}  // namespace

ClusterOrder cluster_order(const Scene& scene, const FacetScene& facets, const Patches& patches) {
  std::vector<Unit> units(patches.size());
  for (std::size_t i = 0; i < units.size(); ++i) units[i].patch = static_cast<std::uint32_t>(i);
  for (std::size_t f = 0; f < facets.size(); ++f) {
    auto& unit = units[patches.of_facet[f]];
    const auto& c = facets.corners[f];
    unit.weighted_centroid += static_cast<double>(facets.area[f]) * (c[0] + c[1] + c[2]) / 3.0;
    unit.area += facets.area[f];
  }
  std::vector<std::uint32_t> plants, ground;
  std::uint32_t first = 0;
  for (std::size_t copy = 0; copy < facets.copies.size(); ++copy) {
    const auto& plant = *scene.plants[facets.copy_plant[copy]].plant;
    const auto base = static_cast<std::uint32_t>(units.size());
    units.resize(units.size() + plant.structures.size());
    for (std::size_t s = plant.structures.size(); s-- > 1;)
      units[base + plant.structures[s].parent].children.push_back(base + static_cast<std::uint32_t>(s));
    for (auto patch = first; patch < patches.end_of_copy[copy]; ++patch) units[base + patches.structure[patch]].children.push_back(patch);
    first = patches.end_of_copy[copy];
    for (std::size_t s = plant.structures.size(); s-- > 0;) {
      auto& unit = units[base + s];
      std::erase_if(unit.children, [&](std::uint32_t c) { return c >= base && units[c].children.empty(); });
      std::sort(unit.children.begin(), unit.children.end());
      for (const auto c : unit.children) {
        unit.weighted_centroid += units[c].weighted_centroid;
        unit.area += units[c].area;
      }
    }
    if (!units[base].children.empty()) plants.push_back(base);
  }
  for (auto patch = first; patch < patches.size(); ++patch) ground.push_back(patch);
  std::vector<std::uint32_t> roots;
  const auto add_root = [&](std::vector<std::uint32_t>& members) {
    if (members.empty()) return;
    Unit unit;
    unit.children = std::move(members);
    units.push_back(std::move(unit));
    roots.push_back(static_cast<std::uint32_t>(units.size() - 1));
  };
  add_root(plants);
  add_root(ground);
  ClusterOrder order;
  TreeBuilder(units, order).build(roots);
  return order;
}

}  // namespace sunfleck
