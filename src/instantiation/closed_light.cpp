#include "instantiation/closed_light.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <sunfleck/scene/counts.hpp>

#include "instantiation/batches.hpp"

namespace sunfleck {

namespace {

class ClosedLight {
 public:
  ClosedLight(const SceneLight& s, const Light& total) : s_(s), total_(total) {
    first_part_.push_back(0);
    for (std::uint32_t m = 0; m < s.members.size(); ++m)
      first_part_.push_back(first_part_.back() + s.members.found.members[m].copies.size());
    absorbed_.assign(first_part_.back() * s.columns, 0.0);
    direct_ = escaped_ = absorbed_;
  }

  void run(SolveReport& report) {
    bool any_far = false;
    for (const auto& c : s_.placed.closed) any_far = any_far || !c.solved;
    std::vector<std::uint32_t> wanted;
    for (std::uint32_t m = 0; m < s_.members.size(); ++m)
      if (any_far || !all_opened(m)) wanted.push_back(m);
    absorb(wanted);
    const auto absorbed = by_copy(absorbed_);
    add_structures(absorbed, report);
    if (!s_.placed.partial) add_balance(absorbed, report);
  }

  /// What some members absorb, from their fields.
  void absorb(const std::vector<std::uint32_t>& members) {
    const auto batches = batches_of(s_, members);
    tbb::parallel_for(std::size_t{0}, batches.size(), [&](std::size_t q) {
      if (s_.progress.cancelled()) return;
      with_width(batches[q].width, [&](auto constant) { absorb<decltype(constant)::value>(batches[q]); });
    });
    s_.progress.check();
  }

  /// Absorbed by a member of one part, per column [W].
  const double* of_member(std::uint32_t m) const { return absorbed_.data() + first_part_[m] * s_.columns; }

 private:
  bool all_opened(std::uint32_t m) const {
    const auto& copies = s_.members.found.members[m].copies;
    return std::all_of(copies.begin(), copies.end(), [&](std::uint32_t c) { return c < s_.placed.copies.size(); });
  }

  template <int width>
  void absorb(const Batch& b) {
    const auto& original = s_.members.originals[b.original];
    const LineOperator& op = *original.coarse;
    const auto& e = original.elements;
    const auto ends = stored_ends(s_, b);
    LaneField<width> field, direct(2 * e.size(), Lanes<width>{}), source, radiosity;
    incoming<width>(s_, b, op, ends, nullptr, true, field);
    add_outside<width>(op, field, direct);
    add_sun<width>(s_, b, direct);
    source = direct;
    incoming<width>(s_, b, op, ends, &total_, false, field);
    add_outside<width>(op, field, source);
    solve_inside<width>(op, e.material, optics_of<width>(s_, b), source, static_cast<float>(s_.density.inner_tolerance), radiosity);
    add_inside<width>(op, radiosity, source);
    for (std::size_t j = 0; j < b.members.size(); ++j) {
      add_facets<width>(b, j, direct, source);
      add_escaped<width>(b, j, ends[j], radiosity);
    }
  }

  template <int width>
  void add_facets(const Batch& b, std::size_t j, const LaneField<width>& direct, const LaneField<width>& all) {
    const std::uint32_t m = b.members[j];
    const auto& original = s_.members.originals[b.original];
    const auto& e = original.elements;
    const auto& s = e.surface;
    const double scale = s_.members.maps[m].scale * s_.members.maps[m].scale;
    for (std::size_t t = 0; t < s.size(); ++t) {
      if (s.split[t] == 0) continue;
      const std::uint32_t facet = e.order[t];
      const std::size_t part = first_part_[m] + original.part_of(facet);
      const auto& optics = s_.scene.optics[original.facet_material[facet]];
      for (std::size_t c = 0; c < b.columns; ++c) {
        const std::size_t column = b.first_column + c, band = column % s_.bands, lane = j * b.columns + c;
        const double absorptance[2] = {1.0 - optics.reflectance_front[band] - optics.transmittance[band],
                                       1.0 - optics.reflectance_back[band] - optics.transmittance[band]};
        double absorbed = 0, first = 0;
        for (auto cell = s.first_cell[t]; cell < s.first_cell[t + 1]; ++cell)
          for (std::size_t side = 0; side < 2; ++side) {
            const double open = original.coarse->open(cell);
            const std::size_t from = 2 * std::size_t{original.coarse->stand_in[e.element_of_cell[cell]]} + side;
            absorbed += std::max(0.0, absorptance[side]) * open * all[from][lane];
            first += open * direct[from][lane];
          }
        absorbed_[part * s_.columns + column] += scale * s.cell_area[t] * absorbed;
        direct_[part * s_.columns + column] += scale * s.cell_area[t] * first;
      }
    }
  }

  /// Light that leaves for the sky; of a member of several parts it counts with the first.
  template <int width>
  void add_escaped(const Batch& b, std::size_t j, const RayEnd* ends, const LaneField<width>& radiosity) {
    const std::uint32_t m = b.members[j];
    const auto areas = sky_areas(*s_.members.originals[b.original].coarse, ends);
    const double scale = s_.members.maps[m].scale * s_.members.maps[m].scale;
    double* out = &escaped_[first_part_[m] * s_.columns + b.first_column];
    for (std::size_t side = 0; side < areas.size(); ++side)
      if (areas[side] > 0)
        for (std::size_t c = 0; c < b.columns; ++c) out[c] += scale * areas[side] * radiosity[side][j * b.columns + c];
  }

  /// Sums of parts by the copies that they are of.
  std::vector<double> by_copy(const std::vector<double>& of_part) const {
    std::vector<double> out(s_.placed.all_copies() * s_.columns, 0.0);
    for (std::uint32_t m = 0; m < s_.members.size(); ++m) {
      const auto& copies = s_.members.found.members[m].copies;
      for (std::size_t part = 0; part < copies.size(); ++part)
        for (std::size_t c = 0; c < s_.columns; ++c)
          out[copies[part] * s_.columns + c] += of_part[(first_part_[m] + part) * s_.columns + c];
    }
    return out;
  }

  void add_structures(const std::vector<double>& absorbed, SolveReport& report) const {
    const auto& placed = s_.placed;
    report.structures.assign(placed.closed.size() * s_.columns, 0.0);
    std::vector<std::vector<std::uint64_t>> solved(placed.closed.size());  // copies per plant, where some are not
    for (std::size_t k = 0; k < placed.closed.size(); ++k)
      if (!placed.closed[k].solved) solved[k].assign(s_.scene.plants.size(), 0);
    for (std::size_t n = 0; n < placed.near.size(); ++n) {
      const auto row = placed.near[n].structure;
      if (!placed.closed[row].solved) ++solved[row][placed.near[n].plant];
      for (std::size_t c = 0; c < s_.columns; ++c)
        report.structures[row * s_.columns + c] += absorbed[(placed.copies.size() + n) * s_.columns + c];
    }
    std::vector<double> sum(s_.scene.plants.size() * s_.columns, 0.0);
    std::vector<std::uint64_t> copies(s_.scene.plants.size(), 0);
    std::vector<bool> known_light(placed.all_copies(), false);  // far ones too, if they are the first of their kind
    for (std::uint32_t m = 0; m < s_.members.size(); ++m)
      for (const auto c : s_.members.found.members[m].copies) known_light[c] = true;
    for (std::size_t i = 0; i < placed.all_copies(); ++i) {
      if (!known_light[i]) continue;
      const auto plant = placed.plant_of(i);
      ++copies[plant];
      for (std::size_t c = 0; c < s_.columns; ++c) sum[plant * s_.columns + c] += absorbed[i * s_.columns + c];
    }
    std::map<std::pair<bool, std::uint32_t>, std::vector<std::uint64_t>> known;
    for (std::size_t k = 0; k < placed.closed.size(); ++k) {
      const auto& closed = placed.closed[k];
      if (closed.solved) continue;
      auto& inside = known[{closed.is_group, closed.index}];
      if (inside.empty()) inside = copies_inside(s_.scene, closed.is_group, closed.index);
      for (std::size_t p = 0; p < inside.size(); ++p) {
        if (inside[p] <= solved[k][p] || copies[p] == 0) continue;
        const double share = static_cast<double>(inside[p] - solved[k][p]) / static_cast<double>(copies[p]);
        for (std::size_t c = 0; c < s_.columns; ++c) report.structures[k * s_.columns + c] += share * sum[p * s_.columns + c];
      }
    }
  }

  void add_balance(const std::vector<double>& absorbed, SolveReport& report) const {
    const auto direct = by_copy(direct_), escaped = by_copy(escaped_);
    for (std::size_t i = s_.placed.copies.size(); i < s_.placed.solved(); ++i)
      for (std::size_t c = 0; c < s_.columns; ++c) {
        auto& out = report.balance[c / s_.bands][c % s_.bands];
        out.incident += direct[i * s_.columns + c];
        out.leaves += absorbed[i * s_.columns + c];
        out.escaped += escaped[i * s_.columns + c];
      }
  }

  const SceneLight& s_;
  const Light& total_;
  std::vector<std::size_t> first_part_;              ///< [members + 1]
  std::vector<double> absorbed_, direct_, escaped_;  ///< [parts of all members][columns] W
};

}  // namespace

OpenedPieces opened_pieces(const SceneLight& s, std::uint32_t copy, const CopyRows& rows) {
  const std::uint32_t p = s.placed.plant_of(copy);
  const auto& entry = s.scene.plants[p];
  const auto& piece_of = s.members.approximation.piece_of[p];
  OpenedPieces out;
  out.copy = copy;
  out.area.assign(s.members.approximation.of_plant[p].size() + 1, 0.0);
  out.absorbed.assign(out.area.size() * s.columns, 0.0);
  const double scale = std::pow(std::fabs(glm::determinant(s.placed.map_of(copy).linear)), 2.0 / 3.0);
  std::size_t i = 0;
  for (std::size_t shape = 0; shape < entry.plant->shapes.size(); ++shape) {
    const auto& piece = entry.plant->shapes[shape];
    const std::size_t k = piece_of[piece.structure];
    const auto& optics = s.scene.optics[entry.shape_optics[shape]];
    for (std::uint32_t t = 0; t < piece.triangle_count; ++t, ++i) {
      const double area = scale * glm::length(area_vector(shape_triangle(*entry.plant, piece, t)));
      out.area[k] += area;
      for (std::size_t c = 0; c < s.columns; ++c) {
        const std::size_t state = c / s.bands, b = c % s.bands;
        const float* sides = &rows.irradiance[((state * rows.count + i) * 2) * s.bands + b];
        out.absorbed[k * s.columns + c] += area * ((1.0 - optics.reflectance_front[b] - optics.transmittance[b]) * sides[0] +
                                                   (1.0 - optics.reflectance_back[b] - optics.transmittance[b]) * sides[s.bands]);
      }
    }
  }
  return out;
}

void judge_stand_ins(const SceneLight& s, const Light& light, const std::vector<OpenedPieces>& opened, SolveReport& report) {
  if (opened.empty()) return;
  std::vector<std::uint32_t> wanted;
  for (std::uint32_t m = 0; m < s.members.size(); ++m)
    if (s.members.found.members[m].stands_in) wanted.push_back(m);
  ClosedLight closed(s, light);
  closed.absorb(wanted);
  std::vector<double> weight(s.bands, 0.0), mean(s.bands, 0.0), square(s.bands, 0.0), difference(s.bands, 0.0);
  for (const auto& copy : opened) {
    const auto& pieces = s.members.approximation.of_plant[s.placed.plant_of(copy.copy)];
    std::size_t piece = 0;
    for (const auto m : wanted) {
      if (s.members.found.members[m].copies.front() != copy.copy) continue;
      const std::size_t k = piece++;  // members of a copy stand in the order of its pieces
      if (pieces[k].rest || !(copy.area[k] > 0)) continue;
      for (std::size_t c = 0; c < s.columns; ++c) {
        const double own = copy.absorbed[k * s.columns + c] / copy.area[k], stood = closed.of_member(m)[c] / copy.area[k];
        const std::size_t b = c % s.bands;
        weight[b] += copy.area[k];
        mean[b] += copy.area[k] * own;
        difference[b] += copy.area[k] * (stood - own);
        square[b] += copy.area[k] * (stood - own) * (stood - own);
      }
    }
  }
  for (std::size_t b = 0; b < s.bands; ++b) {
    const double level = mean[b] > 0 ? mean[b] / weight[b] : 1.0;
    report.stand_in_rmse.push_back(weight[b] > 0 ? std::sqrt(square[b] / weight[b]) / level : 0.0);
    report.stand_in_bias.push_back(weight[b] > 0 ? difference[b] / weight[b] / level : 0.0);
    s.progress.line(
        fmt::format("approximation, {}: closed structures absorbed {:+.2f} % on average and {:.2f} % rms other than opened ones",
                    s.scene.bands[b], 100 * report.stand_in_bias[b], 100 * report.stand_in_rmse[b]));
  }
}

void absorb_closed(const SceneLight& s, const Light& light, SolveReport& report) {
  if (s.placed.closed.empty()) return;
  ClosedLight(s, light).run(report);
}

}  // namespace sunfleck
