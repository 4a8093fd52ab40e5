#include "instantiation/opening_steps.hpp"

#include <algorithm>

namespace sunfleck {

namespace {

/// Copies with rows that others stand in for.
std::vector<std::uint32_t> copies_stood_for(const Members& members, const PlacedScene& placed) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t m = 0; m < members.size(); ++m) {
    const auto& member = members.found.members[m];
    if (member.stands_in && member.copies.front() < placed.copies.size() && (out.empty() || out.back() != member.copies.front()))
      out.push_back(member.copies.front());
  }
  return out;
}

std::vector<std::uint32_t> members_of(const std::vector<Batch>& batches) {
  std::vector<std::uint32_t> out;
  for (const auto& [first, last] : runs_of_members(batches, 0, batches.size()))
    out.insert(out.end(), batches[first].members.begin(), batches[first].members.end());
  return out;
}

}  // namespace

bool has_rows(const Members& members, const PlacedScene& placed, std::uint32_t m) {
  const auto& member = members.found.members[m];
  return !member.stands_in &&
         std::any_of(member.copies.begin(), member.copies.end(), [&](std::uint32_t c) { return c < placed.copies.size(); });
}

OpeningSteps opening_steps(const Members& members, const PlacedScene& placed, std::size_t states, std::size_t bands) {
  OpeningSteps out;
  std::vector<std::uint32_t> opened;  // members with rows
  out.opened_of_original.assign(members.originals.size(), 0);
  for (std::uint32_t m = 0; m < members.size(); ++m)
    if (has_rows(members, placed, m)) {
      opened.push_back(m);
      ++out.opened_of_original[members.found.members[m].original];
    }
  const auto stood_for = copies_stood_for(members, placed);
  out.forgets = stood_for.empty() && placed.closed.empty();
  const auto first_copy = [&](std::size_t k) { return members.found.members[opened[k]].copies.front(); };
  auto left = out.opened_of_original;
  std::size_t first = 0, next_own = 0;
  while (first < opened.size() || next_own < stood_for.size()) {
    const std::uint32_t own = next_own < stood_for.size() ? stood_for[next_own] : no_parent;
    if (first == opened.size() || own < first_copy(first)) {
      out.steps.emplace_back().own = own;
      ++next_own;
      continue;
    }
    std::vector<std::uint32_t> window;
    std::size_t bytes = 0;
    for (; first < opened.size() && (window.empty() || bytes < opening_window_bytes) && first_copy(first) < own; ++first) {
      window.push_back(opened[first]);
      bytes += members.original_facets(opened[first]) * 2 * sizeof(float) * states * (bands + 1);
    }
    const auto batches = batches_of(members, states * bands, window);
    for (auto begin = batches.begin(); begin != batches.end();) {
      const auto end = std::find_if(begin, batches.end(), [&](const Batch& b) { return b.original != begin->original; });
      auto& step = out.steps.emplace_back();
      step.original = begin->original;
      step.batches.assign(begin, end);
      step.members = members_of(step.batches);
      step.once = step.batches.size() == 1 && out.opened_of_original[step.original] == step.members.size();
      left[step.original] -= static_cast<std::uint32_t>(step.members.size());
      step.last = left[step.original] == 0;
      begin = end;
    }
  }
  return out;
}

}  // namespace sunfleck
