#include "shades.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <Eigen/Eigenvalues>
#include <tbb/parallel_for.h>

#include "pilot_light.hpp"

namespace sunfleck {

namespace {
constexpr double least_gain = 4e-4;    ///< variance x area that a cut takes away, over the area of an element
constexpr double significance = 8.0;   ///< of a cut's gain, over the variance of single lines
constexpr double fewest_lines = 10.0;  ///< on either side of a cut
constexpr int few_reflections = 6;     ///< tell whether light falls off
constexpr int reflections = 12;        ///< what later ones add hardly changes which of two cells is the brighter

/// Sums over cells: front and back.
struct Sums {
  double lines[2] = {0, 0}, light[2] = {0, 0}, open[2] = {0, 0};
  void add(const PilotLight& pilot, std::uint32_t cell) {
    for (std::size_t side = 0; side < 2; ++side) {
      lines[side] += pilot.lines[2 * std::size_t{cell} + side];
      light[side] += pilot.sum[2 * std::size_t{cell} + side];
      open[side] += pilot.open[2 * std::size_t{cell} + side];
    }
  }
  bool enough() const { return lines[0] >= fewest_lines && lines[1] >= fewest_lines; }
  Sums less(const Sums& part) const {
    Sums rest = *this;
    for (std::size_t side = 0; side < 2; ++side) {
      rest.lines[side] -= part.lines[side];
      rest.light[side] -= part.light[side];
    }
    return rest;
  }
  double brightness() const { return light[0] / std::max(lines[0], 1.0) + light[1] / std::max(lines[1], 1.0); }
};

/// What the squares about the mean lessen by, summed over lines, where a and b each take their own.
double gain_of(const Sums& a, const Sums& b) {
  double gain = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    const double apart = a.light[side] / a.lines[side] - b.light[side] / b.lines[side];
    gain += a.lines[side] * b.lines[side] / (a.lines[side] + b.lines[side]) * apart * apart;
  }
  return gain;
}

Eigen::Vector3d centre_of(const Surface& s, std::size_t row, int i, int j, int upper) {
  const double k = s.split[row], third = upper ? 2.0 / 3.0 : 1.0 / 3.0, u = (i + third) / k, v = (j + third) / k;
  Eigen::Vector3d p;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = s.corner[static_cast<std::size_t>(axis)][row];
    p[axis] =
        at + u * (s.corner[static_cast<std::size_t>(3 + axis)][row] - at) + v * (s.corner[static_cast<std::size_t>(6 + axis)][row] - at);
  }
  return p;
}

class Cutter {
 public:
  Cutter(const Elements& e, const PilotLight& pilot, double least)
      : e_(e), pilot_(pilot), least_(least * e.element_area), centre_(e.surface.cells(), Eigen::Vector3d::Zero()) {
    const auto& s = e.surface;
    tbb::parallel_for(std::size_t{0}, s.size(), [&](std::size_t t) {
      const int k = s.split[t];
      for (int j = 0; j < k; ++j)
        for (int i = 0; i + j < k; ++i)
          for (int upper = 0; upper < (i + j < k - 1 ? 2 : 1); ++upper)
            centre_[s.first_cell[t] + static_cast<std::uint32_t>(j * (2 * k - j) + 2 * i + upper)] = centre_of(s, t, i, j, upper);
    });
  }

  /// Numbers the shades of an element's cells, from the darkest to the brightest; returns the variance x area that they take away.
  double cut(std::size_t element, std::vector<std::uint16_t>& shade_of_cell) const {
    const std::uint32_t first = e_.first_cell[element], last = e_.first_cell[element + 1];
    std::vector<std::uint32_t> cells(e_.cells.begin() + first, e_.cells.begin() + last);
    struct Part {
      std::size_t begin, end;
      double brightness;
    };
    std::vector<Part> waiting{{0, cells.size(), 0.0}}, shades;
    double removed = 0;
    while (!waiting.empty()) {
      Part part = waiting.back();
      waiting.pop_back();
      const std::size_t middle = best_cut(cells, part.begin, part.end, part.brightness, removed);
      if (middle == part.begin) {
        shades.push_back(part);
      } else {
        waiting.push_back({middle, part.end, 0.0});
        waiting.push_back({part.begin, middle, 0.0});
      }
    }
    std::sort(shades.begin(), shades.end(), [](const Part& a, const Part& b) { return a.brightness < b.brightness; });
    for (std::size_t k = 0; k < shades.size(); ++k)
      for (std::size_t i = shades[k].begin; i < shades[k].end; ++i) shade_of_cell[cells[i]] = static_cast<std::uint16_t>(k);
    return removed;
  }

 private:
  double area(std::uint32_t cell) const {
    const auto t = e_.row_of_cell[cell];
    return e_.surface.split[t] > 0 ? static_cast<double>(e_.surface.cell_area[t]) : 0.0;
  }

  /// Puts one side of the best cut first and returns where the other begins; `begin` if none is worth it.
  std::size_t best_cut(std::vector<std::uint32_t>& cells, std::size_t begin, std::size_t end, double& brightness, double& removed) const {
    Sums all;
    double whole = 0, squares[2] = {0, 0};
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (std::size_t k = begin; k < end; ++k) {
      all.add(pilot_, cells[k]);
      whole += area(cells[k]);
      mean += area(cells[k]) * centre_[cells[k]];
      for (std::size_t side = 0; side < 2; ++side) squares[side] += pilot_.squares[2 * std::size_t{cells[k]} + side];
    }
    brightness = all.brightness();
    if (end - begin < 2 || !(whole > 0.0) || !all.enough()) return begin;
    double noise = 0, variance = 0;
    for (std::size_t side = 0; side < 2; ++side) {
      const double about = squares[side] - all.light[side] * all.light[side] / all.lines[side];
      variance += about / all.lines[side];
      noise = std::max(noise, about / all.lines[side]);
    }
    if (variance * whole <= least_) return begin;
    mean /= whole;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (std::size_t k = begin; k < end; ++k) {
      const Eigen::Vector3d d = centre_[cells[k]] - mean;
      spread += area(cells[k]) * d * d.transpose();
    }
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
    axes.computeDirect(spread);
    double best = 0;
    std::size_t best_size = 0;
    std::vector<std::pair<double, std::uint32_t>> order, best_order;
    for (int axis = 1; axis < 3; ++axis) {  // the third stands across the surface
      const Eigen::Vector3d along = axes.eigenvectors().col(axis);
      order.clear();
      for (std::size_t k = begin; k < end; ++k) order.emplace_back(along.dot(centre_[cells[k]]), cells[k]);
      std::sort(order.begin(), order.end());
      Sums low;
      std::size_t here = 0;
      for (std::size_t k = 0; k + 1 < order.size(); ++k) {
        low.add(pilot_, order[k].second);
        const Sums high = all.less(low);
        if (!low.enough() || !high.enough()) continue;
        if (const double gain = gain_of(low, high); gain > best) {
          best = gain;
          here = k + 1;
        }
      }
      if (here == 0) continue;
      best_size = here;
      best_order.swap(order);
    }
    const double gained = best / (all.lines[0] + all.lines[1]) * 2.0 * whole;
    if (best_size == 0 || best <= significance * noise || gained <= least_) return begin;
    removed += gained;
    for (std::size_t k = 0; k < best_order.size(); ++k) cells[begin + k] = best_order[k].second;
    return begin + best_size;
  }

  const Elements& e_;
  const PilotLight& pilot_;
  const double least_;  ///< variance x area that a cut takes away
  std::vector<Eigen::Vector3d> centre_;
};

/// The mean of its shade speaks for a cell as so many lines do.
constexpr float lines_of_doubt = 1.0f;
/// Of what comes straight: the sun's light is followed from the cells themselves, and what is left is less uneven than light from all
/// round.
constexpr float straight_left_out = 0.35f;

struct ShadesOfCells {
  PilotLight pilot;
  std::vector<std::uint16_t> shade;  ///< [cells]
  std::vector<double> removed;       ///< [elements] variance x area that shades take away
};

ShadesOfCells shades_of_cells(const FacetScene& facets, const Elements& e, std::uint32_t directions, double pitch, int followed,
                              double least) {
  ShadesOfCells out{pilot_light(facets, e, directions, pitch, followed), std::vector<std::uint16_t>(e.surface.cells(), 0),
                    std::vector<double>(e.size())};
  const Cutter cutter(e, out.pilot, least);
  tbb::parallel_for(std::size_t{0}, e.size(), [&](std::size_t i) { out.removed[i] = cutter.cut(i, out.shade); });
  return out;
}

}  // namespace

double unevenness(const FacetScene& facets, const Elements& e, std::uint32_t directions, double pitch) {
  const auto removed = shades_of_cells(facets, e, directions, pitch, few_reflections, 0.0).removed;
  const double area = std::accumulate(e.area.begin(), e.area.end(), 0.0);
  return area > 0.0 ? std::accumulate(removed.begin(), removed.end(), 0.0) / area : 0.0;
}

namespace {

/// Exitance of each side of each cell, [2 * cells]: of few lines, and what the mean of its shade adds to them.
std::vector<float> exitance(const FacetScene& facets, const Elements& e, const PilotLight& pilot, const std::vector<std::uint16_t>& shade) {
  std::vector<float> out(pilot.sum.size(), 0.0f);
  tbb::parallel_for(std::size_t{0}, e.size(), [&](std::size_t i) {
    std::vector<Sums> of_shade;
    for (auto k = e.first_cell[i]; k < e.first_cell[i + 1]; ++k) {
      const auto c = e.cells[k];
      if (of_shade.size() <= shade[c]) of_shade.resize(shade[c] + std::size_t{1});
      of_shade[shade[c]].add(pilot, c);
    }
    for (auto k = e.first_cell[i]; k < e.first_cell[i + 1]; ++k) {
      const auto c = e.cells[k];
      const auto& all = of_shade[shade[c]];
      const Brightest optics(facets.materials[facets.optics[e.order[e.row_of_cell[c]]]]);
      float light[2];
      for (std::size_t side = 0; side < 2; ++side) {
        const auto mean = static_cast<float>((all.light[side] - straight_left_out * all.open[side]) / std::max(all.lines[side], 1.0));
        light[side] = (pilot.sum[2 * c + side] - straight_left_out * pilot.open[2 * c + side] + lines_of_doubt * mean) /
                      (pilot.lines[2 * c + side] + lines_of_doubt);
      }
      out[2 * c] = optics.front * light[0] + optics.through * light[1];
      out[2 * c + 1] = optics.back * light[1] + optics.through * light[0];
    }
  });
  return out;
}

}  // namespace

Shades find_shades(const FacetScene& facets, const Elements& e, std::uint32_t directions, double pitch) {
  const auto found = shades_of_cells(facets, e, directions, pitch, reflections, least_gain);
  const auto& shade = found.shade;
  if (std::all_of(shade.begin(), shade.end(), [](std::uint16_t k) { return k == 0; })) return {};
  const auto& s = e.surface;
  std::vector<std::uint32_t> row_of_facet(s.size());
  for (std::uint32_t t = 0; t < s.size(); ++t) row_of_facet[e.order[t]] = t;
  const auto sent = exitance(facets, e, found.pilot, shade);
  Shades out;
  out.split.assign(s.size(), 0);
  out.first_cell.assign(1, 0);
  for (std::size_t f = 0; f < s.size(); ++f) {
    const auto t = row_of_facet[f];
    const auto first = shade.begin() + s.first_cell[t], last = shade.begin() + s.first_cell[t + 1];
    const bool cut = !std::equal(first + 1, last, first);
    if (cut) out.split[f] = s.split[t];
    out.of_cell.insert(out.of_cell.end(), first, cut ? last : first + 1);
    const auto begin = s.first_cell[t], end = s.first_cell[t + 1];
    if (cut) {
      out.emission.insert(out.emission.end(), sent.begin() + 2 * std::ptrdiff_t{begin}, sent.begin() + 2 * std::ptrdiff_t{end});
    } else {  // cells of a facet are equally large
      for (std::size_t side = 0; side < 2; ++side) {
        float sum = 0;
        for (auto c = begin; c < end; ++c) sum += sent[2 * c + side];
        out.emission.push_back(sum / static_cast<float>(end - begin));
      }
    }
    out.first_cell.push_back(static_cast<std::uint32_t>(out.of_cell.size()));
  }
  return out;
}

}  // namespace sunfleck
