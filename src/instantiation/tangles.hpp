// How far members reach into each other.
#pragma once

#include <cstdint>
#include <vector>

#include "instantiation/members.hpp"
#include "instantiation/member_surroundings.hpp"

namespace sunfleck {

/// What member `b` (b = a: an image of it; or MemberSurroundings::the_ground) spoils of member `a`: the share of the lines inside `a` that
/// it interrupts, and of the lines that leave `a` those that meet an inner face of it, as from within a house.
struct Tangle {
  double share;
  std::uint32_t a, b;
};

/// By rays, some hundred lines of either kind for each member.
std::vector<Tangle> tangles(const Members& members, const MemberSurroundings& around, const Progress& progress);

/// Per member, all that is spoilt.
std::vector<double> spoilt_shares(const Members& members, const std::vector<Tangle>& list);

/// See much_tangled: by area, so that one housing in which much stands does not vanish among many that hold nothing.
double mean_share(const Members& members, const std::vector<Tangle>& list);

}  // namespace sunfleck
