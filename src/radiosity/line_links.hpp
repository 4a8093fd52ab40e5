// Links counted from global lines: near ones between sides of elements, far ones between clusters.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/radiosity/elements.hpp>
#include <sunfleck/visibility/projection.hpp>

#include "cluster_tree.hpp"
#include "direct_lines.hpp"
#include "near_links.hpp"

namespace sunfleck {

/// Directions fall into bins, equal parts of the upper hemisphere; a channel is a bin looked at from below (2 bin: light comes from
/// above) or from above (2 bin + 1: light comes from below).
inline constexpr std::uint32_t direction_bins = 24;
inline constexpr std::uint32_t channels = 2 * direction_bins;
std::uint32_t bin_of(const Vec3& direction);

/// Lines that run so far that a cluster may stand for its elements at both ends. What a side receives along channel q is the mean of
/// what its cluster receives there, and it contributes to what its cluster sends back along q: one count serves both.
struct FarField {
  std::vector<std::uint8_t> of_side;      ///< [sides of elements][channels] lines; empty without far links
  std::vector<std::uint32_t> through;     ///< [nodes][channels] lines of the node's elements that run far
  std::vector<std::uint32_t> linked;      ///< [nodes][channels] of these, lines whose link is at this node; the others pass to the parent
  std::vector<std::uint32_t> first_link;  ///< [nodes * channels + 1]
  /// What a node receives along channel q, from nodes that send along q ^ 1: the emitting node in the low `node_bits`, in the others how
  /// many lines less one; what does not fit goes on in a further link.
  std::vector<std::uint32_t> links;
  int node_bits = 0;

  std::size_t most_count() const { return std::size_t{1} << (32 - node_bits); }
  std::uint32_t packed(std::uint32_t node, std::size_t count) const { return node | static_cast<std::uint32_t>(count - 1) << node_bits; }
  std::uint32_t node_of(std::uint32_t link) const { return link & ((1u << node_bits) - 1); }
  std::uint32_t count_of(std::uint32_t link) const { return (link >> node_bits) + 1; }
};

/// One of two independent sets of lines. The two take turns, E_a = E0 + F_a R E_b and E_b = E0 + F_b R E_a: light that goes back and
/// forth between two elements then meets two independent estimates, whose product is unbiased; the square of one estimate is not.
struct HalfLinks {
  NearLinks near;
  FarField far;
  std::vector<float> lines, open_up, open_down;  ///< [sides]
  std::vector<float> sent_up, sent_down;         ///< [sides] the same open ends, each counted by Elements::emission; empty = all alike
};

/// Rows are sides, 2 * part + (0 front, 1 back). Parts are the elements, followed by the *enclosed parts* of those elements that stick in
/// another organ, as the base of a petiole does in a stem: hits that face the inside of a hollow organ belong to the enclosed part. An
/// element that kept it would shine inside the organ that hides it; stems of a real plant then absorbed 20 % too much.
struct LineLinks {
  std::array<HalfLinks, 2> half;
  std::array<HalfLight, 2> light;            ///< what the lines brought, unless they are recorded
  std::array<DirectLines, 2> direct;         ///< the lines themselves, where they are recorded
  std::vector<Projection> projection;        ///< [directions] the same
  std::vector<std::uint32_t> whole;          ///< [parts] the element that a part belongs to; part i < elements belongs to element i
  std::vector<std::uint32_t> enclosed_part;  ///< [elements] its enclosed part, or none; empty where no element has one
  std::vector<float> enclosed;               ///< [cells] fraction of a cell that is enclosed; empty where no element has an enclosed part
  bool clustered = false;                    ///< some links run between clusters
  std::uint64_t fragments = 0;
  double area_of_line = 0;  ///< one-sided area that a line of both halves together stands for: sum of lines x this = area [m^2]
  static constexpr std::uint32_t none = 0xffffffffu;

  std::size_t sides() const { return 2 * whole.size(); }
  bool recorded() const { return !projection.empty(); }
  std::uint64_t link_count() const;
  std::size_t bytes() const;
};

/// Directions whose lines are held at a time: fewer the more fragments each has.
double line_batch(std::size_t elements, const RadiosityDensity& density);

/// Gives what one phase has freed back to the system, where that is much: it pays from some 100 MB on.
void release_pages(const Elements& elements);

/// Traces lines and makes links. The refinement oracle takes, for the ends of each line, the largest pair of clusters A, B with
///     albedo x (diameter_A + diameter_B) / distance <= density.link_error,
/// an estimate of how much the radiosity met, relative to the mean, changes when A sees B from elsewhere within A: the light of dark
/// things is scattered little, and a look from far spreads over what lies around anyway. No such pair: a link between the elements.
/// Method flat has no clusters; a scene in which hardly a line runs far makes no use of them.
/// The lines also tell what of the `skies` each cell sees, and bring the sun's first reflection: at once, or, where lines are `recorded`,
/// whenever they are asked (light_along()).
LineLinks line_links(const Elements& elements, const ClusterTree* tree, const SunReflection& sun, const std::vector<const Sky*>& skies,
                     const RadiositySettings& settings, bool recorded, Progress& progress);

/// What recorded lines bring.
std::array<HalfLight, 2> light_along(const LineLinks& links, const SunReflection& sun, const std::vector<const Sky*>& skies);

}  // namespace sunfleck
