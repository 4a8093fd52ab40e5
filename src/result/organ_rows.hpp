// Sums of a solution per organ, written copy by copy.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <sunfleck/result/organ_totals.hpp>
#include <sunfleck/scene/facet_rows.hpp>

#include "result/row_dataset.hpp"

namespace sunfleck::h5 {

/// The columns of /organs and /variance/organs. Organs of one copy interleave, so that they are held until its last facet has come.
class OrganRows {
 public:
  /// `keeps` says which datasets are written, by their names in the file. Handles are open until finish().
  OrganRows(OutputFile& file, ChunkQueue& queue, const FacetRows& rows, const OrganNames& names, std::size_t states, std::size_t bands,
            std::function<bool(const char*)> keeps);

  void begin(std::uint32_t copy);
  void add_area(std::size_t organ, double area) { area_[organ] += area; }
  /// Area x irradiance of one side [W], absorbed [W], area x sunlit fraction of one side [m^2], variance of absorbed [W^2] of one facet.
  void add_irradiance(std::size_t s, std::size_t organ, std::size_t side, std::size_t b, double power) {
    irradiance_[((s * count_ + organ) * 2 + side) * bands_ + b] += power;
  }
  void add_absorbed(std::size_t s, std::size_t organ, std::size_t b, double power) {
    absorbed_[(s * count_ + organ) * bands_ + b] += power;
  }
  void add_sunlit(std::size_t s, std::size_t organ, std::size_t side, double area) { sunlit_[(s * count_ + organ) * 2 + side] += area; }
  void add_variance(std::size_t s, std::size_t organ, std::size_t b, double variance);
  /// Writes the organs of the copy.
  void end();

  /// Hands over what is left and, after the queue has been flushed, close() lets go of the datasets.
  void finish();
  void close();

  OrganTotals totals;

 private:
  void keep_totals();

  OutputFile& file_;
  ChunkQueue& queue_;
  const FacetRows& rows_;
  const OrganNames& names_;
  std::size_t states_, bands_;
  std::function<bool(const char*)> keeps_;
  Id group_, variance_group_;
  std::vector<RowDataset> name_, type_, plant_, placement_, structure_, area_rows_, irradiance_rows_, absorbed_rows_, sunlit_rows_,
      variance_rows_;  ///< none or one each

  std::uint32_t copy_ = 0;
  std::size_t count_ = 0;  ///< organs of the copy
  std::size_t next_total_ = 0;
  std::vector<double> area_, irradiance_, absorbed_, sunlit_, variance_;  ///< [m], [s][m][2][b], [s][m][b], [s][m][2], [s][m][b] or none
  std::vector<float> floats_;
};

}  // namespace sunfleck::h5
