// Numbers about what is selected: a histogram and a vertical profile of the quantity shown.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "view/viewer_shader.hpp"

namespace sunfleck {

/// Over the facets of the selected organs that have area; weights are one-sided areas (each side of a facet by itself where the quantity
/// belongs to sides).
struct SelectionStatistics {
  std::vector<std::string> title;       ///< of the quantity, with its unit
  std::vector<std::string> categories;  ///< not empty: the quantity is a name, and histogram_area is one a name
  std::size_t organs = 0, facets = 0;
  double area = 0;                                    ///< one-sided [m^2]
  double mean = 0, deviation = 0, low = 0, high = 0;  ///< area-weighted mean and standard deviation, extremes; numbers only
  std::vector<double> histogram_edge;                 ///< [bins + 1] in the quantity's unit
  std::vector<double> histogram_area;                 ///< [bins] m^2
  std::vector<double> height;                         ///< [layers + 1] edges [m]; a facet counts where its centroid is
  std::vector<double> layer_area;                     ///< [layers] m^2
  std::vector<double> layer_mean;      ///< [layers] area-weighted mean of the quantity; NaN where a layer is empty; numbers only
  std::vector<std::string> bands;      ///< whose absorbed power the file keeps
  std::vector<double> layer_absorbed;  ///< [layers][bands] W
  std::vector<double> absorbed;        ///< [bands] W
};

/// Bins run over the range that the selection holds. A difference has no absorbed power. "colour" counts as absorbed, where that is kept.
SelectionStatistics selection_statistics(const ViewerScenes& scenes, std::size_t result, const ShownQuantity& shown,
                                         const std::string& selection, std::size_t bins, std::size_t layers);

/// Tables after RFC 4180 with a header line.
std::string histogram_csv(const SelectionStatistics& statistics);
std::string profile_csv(const SelectionStatistics& statistics);

}  // namespace sunfleck
