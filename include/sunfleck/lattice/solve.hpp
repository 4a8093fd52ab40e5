// Method lattice: scattered light as a fluid on a lattice, direct light given.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/scene/facets.hpp>
#include <sunfleck/scene/scene.hpp>
#include <sunfleck/scene/kept_light.hpp>
#include <sunfleck/scene/solution.hpp>
#include <sunfleck/visibility/rays.hpp>

namespace sunfleck {

/// How leaf optics become coefficients of the lattice. matched: results are W m^-2. paper: as Geist & Steele 2008, for comparison.
enum class LatticeMapping { matched, paper };
/// "matched", "paper".
const std::vector<std::string>& lattice_mapping_names();
std::optional<LatticeMapping> lattice_mapping_from_name(const std::string& name);

struct LatticeSettings : SolveSettings {
  LatticeMapping mapping = LatticeMapping::matched;
  std::uint32_t nodes = 64;      ///< along the longest side of the scene
  std::uint32_t own_nodes = 32;  ///< along the longest side of a plant that has a lattice of its own
  static constexpr std::uint32_t fewest_nodes = 2, most_nodes = 1024;
};

/// Bytes that the lattice of a scene holds at the most, besides what its facets take.
std::uint64_t lattice_bytes(const Scene& scene, const FacetScene& facets, const LatticeSettings& settings);

/// Throws what solve_lattice() cannot take: InputError for sensors and slopes, UsageError for a number of nodes, OutOfMemory. To be called
/// before direct light is found.
void check_lattice(const Scene& scene, const FacetScene& facets, const LatticeSettings& settings);

/// Direct light, as a method that stops at it hands it over.
struct DirectFacets {
  const KeptLight& light;                            ///< of all facets
  const std::vector<std::vector<Balance>>& balance;  ///< [s][b]; `incident`, `leaves` and `ground` are used
  const RayScene* rays;                              ///< of the facets, for mapping matched; else null
};

/// Scattered light on the D3Q19 lattice of Geist & Steele (2008; lattice.hpp), in steady state:
///
///  - Leaf area is cut by the cells about the nodes: coefficients come from the exact area in each (lattice_medium()).
///  - Density is matched, too (mapping matched): a factor on k with which the lattice catches as much of the light that leaves send out as
///    rays find that the leaves do. Leaves of a size, in clumps and in thin layers are no even cloud, and half of a lattice's light stays
///    level.
///  - What facets send on of their direct light starts evenly in their cells. f_i(r + c_i) = (1 - sigma_t) f_i + w_i (sigma_s sum f + q):
///    the steady state by conjugate gradients over sum f (the operator is symmetric), each application a sweep along all 18 directions;
///    with mapping paper, whose scattering is not symmetric, by repeated sweeps.
///  - One lattice over the stand, with the ground as a plane of nodes below it; where plants stand apart, and are placed more than once or
///    are many, a finer one of each plant's own. Copies share its leaf area; light enters it from the stand's lattice, and what a plant
///    absorbs in all is as the stand's has it.
///  - A facet's sides get (phi / 4 -+ J . n / 2) / spacing^2, phi = sum f and J = sum f_i c_i / |c_i| of its cells by its area in each,
///  kept
///    between 0 and phi / 2, so that both sides together have what the lattice says.
///
/// Balance: what the lattice lost on its way to a facet's two sides (their optics may differ) is made up by one factor per state and band,
/// Balance::scattered_scale. For scenes that have passed check_lattice().
SolveReport solve_lattice(const Scene& scene, const FacetScene& facets, const DirectFacets& direct, const LatticeSettings& settings,
                          IrradianceSink& sink, Progress& progress);

}  // namespace sunfleck
