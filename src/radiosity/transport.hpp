// The transport of scattered light: reflect and transmit on every part, gather along links.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/scene/facets.hpp>

#include "line_links.hpp"

namespace sunfleck {

/// Fields hold one value per side of a part (an element or the enclosed part of one) and column (a band of a state):
/// value[side * columns + column].
using Field = std::vector<float>;

/// False if all is black: then irradiance is what sun and sky bring, and there is nothing to solve.
bool anything_scatters(const FacetScene& facets);

/// Optics per part, in the columns' bands.
class Reflection {
 public:
  Reflection(const FacetScene& facets, std::vector<std::uint32_t> material_of_part, std::size_t states);
  /// B_f = rho_f E_f + tau E_b, B_b = rho_b E_b + tau E_f.
  void apply(const float* irradiance, float* radiosity) const;
  std::size_t columns() const { return columns_; }
  bool transmits() const { return !through_.empty(); }
  std::size_t bytes() const;

 private:
  std::vector<std::uint32_t> material_;  ///< [parts]
  std::size_t columns_;
  std::vector<float> front_, back_, through_;  ///< [materials][columns]; through_ is empty where nothing transmits
};

/// Mean radiosity that each node sends and receives along each channel: [nodes][columns][channels].
struct ClusterFields {
  Field sent, received;
};

/// Gathers radiosity over what is not open sky, with one half of the lines: S_i = sum_j count_ij B_j / (lines_i - sky lines_i), far
/// light by way of the clusters: up the tree (means of what elements send along each channel), across far links, down the tree.
class Gather {
 public:
  /// `sky_lines[i]`: lines of side i that end at a sky whose light is known from elsewhere, and are left out of the mean. Sides that no
  /// line of this half meets (but in the sky) take over the row of a neighbour.
  /// `fields` is scratch space that both halves may share.
  Gather(const HalfLinks& half, const ClusterTree* tree, const std::vector<float>& sky_lines, std::size_t columns, ClusterFields& fields);
  void gather(const float* radiosity, float* gathered) const;
  /// Adds factor x the sun's light after its first reflection, gathered along the same lines.
  void add_first_reflection(float factor, const HalfLight& light, float* gathered) const;
  std::size_t bytes() const;

 private:
  void far_up(const float* radiosity) const;
  void far_across() const;
  void far_down() const;

  const HalfLinks& half_;
  const ClusterTree* tree_;
  std::size_t columns_;
  std::vector<float> inverse_;          ///< [sides] 1 / (lines - sky lines); 0 where nothing but sky is seen
  std::vector<std::uint32_t> donor_;    ///< [sides] the row that serves a side
  std::vector<float> inverse_through_;  ///< [nodes][channels]
  ClusterFields& fields_;
};

}  // namespace sunfleck
