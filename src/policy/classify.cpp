#include <sunfleck/policy/classes.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/scene/counts.hpp>

#include "policy/exact_classes.hpp"
#include "policy/policy_key.hpp"
#include "policy/representative.hpp"
#include "policy/whole_copies.hpp"

namespace sunfleck {

namespace {

/// Below this many facets, what an instance takes (its map, its fields) is more than what it saves.
constexpr std::uint64_t least_exact_facets = 16;

class Classifier {
 public:
  Classifier(const Scene& scene, const PolicySet& policies) : scene_(scene), policies_(policies), copies_(placed_copies(scene)) {}

  Classification run() {
    list_plants();
    for (const auto& entry : scene_.plants) out_.of_structure.emplace_back(entry.plant->structures.size(), no_class);
    add_exact();
    add_policies();
    for (std::size_t p = 0; p < scene_.plants.size(); ++p)
      if (same_as_[p] != p) out_.of_structure[p] = out_.of_structure[same_as_[p]];
    add_whole_copies(scene_, out_);
    return std::move(out_);
  }

 private:
  const Policy* policy_of(std::uint32_t entry) const {
    const auto& file = scene_.plants[entry].policy_file;
    if (file.empty()) return nullptr;
    const auto at = policies_.find(file);
    if (at == policies_.end()) throw Error("policy file " + file + " of plant \"" + scene_.plants[entry].name + "\" was not read");
    return &at->second;
  }

  /// Entries that are the same plant with the same optics and policy are one.
  void list_plants() {
    std::map<std::tuple<const Plant*, std::vector<std::uint32_t>, std::string>, std::size_t> known;
    same_as_.resize(scene_.plants.size());
    placed_.resize(scene_.plants.size(), 0);
    for (std::size_t p = 0; p < scene_.plants.size(); ++p) {
      const auto& entry = scene_.plants[p];
      same_as_[p] = known.try_emplace({entry.plant.get(), entry.shape_optics, entry.policy_file}, p).first->second;
      placed_[same_as_[p]] = std::min(too_many_copies, placed_[same_as_[p]] + copies_[p]);
    }
    for (std::uint32_t p = 0; p < scene_.plants.size(); ++p)
      if (same_as_[p] == p && placed_[p] > 0) {
        entry_of_.push_back(p);
        plants_.emplace_back(scene_.plants[p]);
      }
  }

  ClassMember member(const SubtreeRef& s, const Similarity& from_representative) const {
    ClassMember m;
    m.structure = {false, entry_of_[s.plant], s.structure};
    m.from_representative = from_representative.affine();
    m.scale = from_representative.scale;
    m.copies = placed_[entry_of_[s.plant]];
    m.area_m2 = plants_[s.plant].moments(s.structure).area;
    return m;
  }

  void add(OriginalClass&& c, const SubtreeRef& representative) {
    const auto row = static_cast<std::uint32_t>(out_.classes.size());
    for (const auto& m : c.members) {
      c.copies = std::min(too_many_copies, c.copies + m.copies);
      out_.of_structure[m.structure.index][m.structure.structure] = row;
    }
    c.facets = plants_[representative.plant].moments(representative.structure).facets;
    out_.classes.push_back(std::move(c));
  }

  void add_exact() {
    for (const auto& group : exact_groups(plants_)) {
      const SubtreeRef& first = group.front().subtree;
      const bool whole = first.structure == 0;
      if (!whole && plants_[first.plant].moments(first.structure).facets < least_exact_facets) continue;
      if (group.size() < 2 && !(whole && placed_[entry_of_[first.plant]] >= 2)) continue;
      const Plant& plant = plants_[first.plant].plant();
      OriginalClass c;
      c.name =
          whole ? fmt::format("{}: all copies of \"{}\"", plant.types[plant.structures[0].type], scene_.plants[entry_of_[first.plant]].name)
                : fmt::format("{}: copies of {}", plant.types[plant.structures[first.structure].type], organ_label(plant, first.structure));
      if (const auto* policy = policy_of(entry_of_[first.plant])) c.tables = policy->tables;
      for (const auto& m : group) c.members.push_back(member(m.subtree, m.from_first));
      add(std::move(c), first);
    }
  }

  static std::string organ_label(const Plant& plant, std::uint32_t s) {
    const auto& structure = plant.structures[s];
    return structure.name.empty() ? fmt::format("{}_{}", plant.types[structure.type], s) : structure.name;
  }

  void add_policies() {
    struct Draft {
      const Policy* policy;
      const PolicyType* entry;
      std::vector<SubtreeRef> members;
    };
    std::map<const Policy*, std::vector<const Subtrees*>> users;
    for (std::uint32_t p = 0; p < plants_.size(); ++p)
      if (const auto* policy = policy_of(entry_of_[p])) users[policy].push_back(&plants_[p]);
    for (const auto& [file, policy] : policies_)
      if (users.count(&policy)) check_policy(policy, users[&policy], out_.notes);

    std::map<std::tuple<std::string, std::string, std::vector<std::uint32_t>>, Draft> drafts;
    for (std::uint32_t p = 0; p < plants_.size(); ++p) {
      const auto* policy = policy_of(entry_of_[p]);
      if (!policy) continue;
      const Plant& plant = plants_[p].plant();
      std::map<std::string, std::size_t> lacking;
      for (std::uint32_t s = 0; s < plant.structures.size(); ++s) {
        const Moments& m = plants_[p].moments(s);
        const std::string& type = plant.types[plant.structures[s].type];
        const auto* entry = entry_for(*policy, type, s == 0);
        if (!entry || !(m.area > 0) || out_.of_structure[entry_of_[p]][s] != no_class) continue;
        const auto key = policy_key(*policy, *entry, plants_[p], s, lacking[type]);
        if (!key) continue;
        auto& draft = drafts.try_emplace({policy->file, *key, m.materials}, Draft{policy, entry, {}}).first->second;
        draft.members.push_back({p, s});
      }
      for (const auto& [type, count] : lacking)
        if (count > 0)
          out_.notes.push_back(fmt::format("{}: {} of type {} of \"{}\" lack a parameter of the policy: opened with their parents",
                                           policy->file, count, type, scene_.plants[entry_of_[p]].name));
    }
    std::vector<std::pair<std::string, Draft>> ordered;
    for (auto& [key, draft] : drafts) ordered.emplace_back(std::get<1>(key), std::move(draft));
    const auto first = [](const Draft& d) { return std::pair(d.members.front().plant, d.members.front().structure); };
    std::stable_sort(ordered.begin(), ordered.end(), [&](const auto& a, const auto& b) { return first(a.second) < first(b.second); });
    for (auto& [name, draft] : ordered) {
      if (draft.members.size() < draft.entry->least_members) continue;
      OriginalClass c;
      c.name = name;
      c.likeness = Likeness::policy;
      c.tables = draft.policy->tables;
      c.representative = choose_representative(*draft.entry, plants_, draft.members);
      const SubtreeRef model = draft.members[c.representative];
      for (const auto& m : draft.members) c.members.push_back(member(m, stand_in(*draft.entry, plants_, model, m)));
      add(std::move(c), model);
    }
  }

  const Scene& scene_;
  const PolicySet& policies_;
  std::vector<std::uint64_t> copies_;    ///< [plants of the scene]
  std::vector<std::uint64_t> placed_;    ///< [plants of the scene] of all entries that are the same
  std::vector<std::size_t> same_as_;     ///< [plants of the scene]
  std::vector<std::uint32_t> entry_of_;  ///< [plants looked at] row of Scene::plants
  std::vector<Subtrees> plants_;
  Classification out_;
};

}  // namespace

Classification classify(const Scene& scene, const PolicySet& policies) {
  return Classifier(scene, policies).run();
}

}  // namespace sunfleck
