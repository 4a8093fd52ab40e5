// The transport operator E -> g (F R E): reflect and transmit on every element, gather along links.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/scene/facets.hpp>

#include "line_links.hpp"

namespace sunfleck {

/// Fields hold one value per side of a part (an element or the enclosed part of one) and column (a band of a state): value[side * columns + column].
using Field = std::vector<float>;

/// Gathers radiosity over what is not open sky: S_i = sum_j count_ij B_j / (lines_i - sky lines_i).
class Gather {
 public:
  virtual ~Gather() = default;
  /// S and B are fields of the same columns.
  virtual void gather(const Field& radiosity, Field& gathered, std::size_t columns) const = 0;
  virtual std::uint64_t links() const = 0;
  virtual std::size_t bytes() const = 0;
};

/// Optics per part, in the columns' bands.
class Reflection {
 public:
  Reflection(const FacetScene& facets, std::vector<std::uint32_t> material_of_part, std::size_t states);
  /// B_f = rho_f E_f + tau E_b, B_b = rho_b E_b + tau E_f.
  void apply(const Field& irradiance, Field& radiosity) const;
  std::size_t columns() const { return columns_; }

 private:
  std::vector<std::uint32_t> material_;  ///< [parts]
  std::size_t columns_;
  std::vector<float> front_, back_, through_;  ///< [materials][columns]
};

/// Flat gathering: every link of the lines as it is.
class FlatGather : public Gather {
 public:
  /// `sky_lines[i]`: lines of side i that end at a sky whose light is known from elsewhere, and are left out of the mean.
  FlatGather(LineLinks links, const std::vector<float>& sky_lines);
  void gather(const Field& radiosity, Field& gathered, std::size_t columns) const override;
  std::uint64_t links() const override { return links_.column.size(); }
  std::size_t bytes() const override { return links_.bytes(); }

 private:
  LineLinks links_;
  std::vector<float> inverse_;  ///< [sides] 1 / (lines - sky lines); 0 where nothing but sky is seen
};

}  // namespace sunfleck
