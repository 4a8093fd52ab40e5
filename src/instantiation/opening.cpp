#include "instantiation/opening.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>

#include <tbb/parallel_for.h>

#include <sunfleck/core/memory.hpp>
#include <sunfleck/core/sampling.hpp>

#include "instantiation/batches.hpp"
#include "instantiation/closed_light.hpp"
#include "instantiation/copy_rows.hpp"
#include "instantiation/ground_rows.hpp"
#include "instantiation/inside_gather.hpp"
#include "instantiation/opening_steps.hpp"
#include "instantiation/stored_operators.hpp"

namespace sunfleck {

namespace {

constexpr std::uint64_t fine_stream = 0x1b9e4d6a7c2f5083ULL;

class Opening {
 public:
  Opening(SceneLight& s, const Light& total, IrradianceSink& sink, SolveReport& report)
      : s_(s), total_(total), sink_(sink), report_(report), ordered_(sink), order_(opening_steps(s.members, s.placed, s.states, s.bands)) {}

  void open_all() {
    const auto ground_e = s_.ground_irradiance(&total_, true);  // before the fields change no more
    for (std::size_t k = 0; k < order_.steps.size(); ++k) {
      s_.progress.fraction("opening", static_cast<double>(k) / static_cast<double>(order_.steps.size()));
      const auto& step = order_.steps[k];
      step.own != no_parent ? open_own(step.own) : open_group(step);
    }
    write_ground_rows(s_, ground_e, sink_, report_);
    judge_stand_ins(s_, total_, pieces_, report_);
  }

 private:
  /// Opens the batches of a window that share an original.
  void open_group(const OpeningStep& step) {
    const std::uint32_t o = step.original;
    const auto& group = step.batches;
    auto rows = placed_rows(step.members);
    std::vector<std::vector<Balance>> partial(group.size());
    if (fine_of_ != o) {
      fine_.reset();
      fine_of_ = no_parent;
      s_.memory.hold("fine", 0);
    }
    if (step.once && !keeps_fine(o))
      open_once(group.front(), rows, partial.front());
    else
      open_shared(step, rows, partial);
    s_.progress.check();
    for (std::size_t q = 0; q < group.size(); ++q) add_balance(group[q], partial[q]);
    send(rows);
    if (!step.last || !order_.forgets) return;
    s_.members.originals[o].forget();  // makes room for those to come
    s_.memory.hold("originals", s_.members.bytes());
  }

  std::shared_ptr<const LineOperator> fine_operator(std::uint32_t o, const OperatorDensity& density) const {
    const auto& original = s_.members.originals[o];
    const auto seed = mix(s_.seed, fine_stream, o);
    const auto make = [&] {
      return std::make_unique<LineOperator>(original.elements, original.interior, density, seed, s_.progress, seen());
    };
    if (!keeps_fine(o)) return make();
    ContentKey key("fine operator");
    key.put(original.key), put_density(key, density), key.put(seed), key.put(seen());
    return s_.store->entries().fine(key.hex(), make);
  }

  /// Is the fine operator kept from solve to solve? One that would take more than a fourth of the store is followed as it is traced.
  bool keeps_fine(std::uint32_t o) const {
    if (!s_.store) return false;
    const auto lines = [](const OperatorDensity& d) { return d.directions * d.lines_per_organ; };
    const double more = lines(gather_density(s_.density, order_.opened_of_original[o])) / lines(s_.density.coarse);
    return 4.0 * more * static_cast<double>(s_.members.originals[o].coarse->bytes()) < static_cast<double>(s_.store->most_bytes());
  }

  /// Opens batches along one fine operator, which is kept for those of the next window.
  void open_shared(const OpeningStep& step, std::vector<CopyRows>& rows, std::vector<std::vector<Balance>>& partial) {
    const auto& group = step.batches;
    if (!fine_) {
      fine_of_ = step.original;
      fine_ = fine_operator(fine_of_, gather_density(s_.density, order_.opened_of_original[fine_of_]));
      s_.gather_fragments += fine_->fragments;
      s_.memory.pass("fine", fine_->built_with());
      s_.memory.hold("fine", fine_->bytes());
    }
    const LineOperator& fine = *fine_;
    const auto runs = runs_of_members(group, 0, group.size());
    s_.memory.pass("lanes", ends_at_once(group, runs) * fine.points.size() * sizeof(RayEnd) +
                                lanes_at_once(group, [&](const Batch& b) { return lanes_of(b, fine); }));
    s_.gather_rays += step.members.size() * fine.points.size();
    tbb::parallel_for(std::size_t{0}, runs.size(), [&](std::size_t r) {
      if (s_.progress.cancelled()) return;
      const auto [first_batch, last_batch] = std::pair(runs[r]);
      std::vector<std::vector<RayEnd>> ends;  // once for all columns
      for (const auto m : group[first_batch].members) {
        ends.emplace_back(fine.points.size());
        s_.look_from(m, fine, 0, fine.fields(), ends.back().data());
      }
      std::vector<const RayEnd*> fine_ends;
      for (const auto& list : ends) fine_ends.push_back(list.data());
      tbb::parallel_for(first_batch, last_batch,
                        [&](std::size_t q) { open(group[q], stored_ends(s_, group[q]), fine, fine_ends, rows, partial[q]); });
    });
  }

  /// Where the rays of a member end that is looked at along `op`, on all cores.
  std::vector<RayEnd> ends_of(std::uint32_t m, const LineOperator& op) const {
    std::vector<RayEnd> ends(op.points.size());
    const std::size_t pixels = std::size_t{op.pixels()} * op.pixels();
    tbb::parallel_for(std::size_t{0}, op.fields() / pixels,
                      [&](std::size_t sense) { s_.look_from(m, op, sense * pixels, (sense + 1) * pixels, ends.data()); });
    return ends;
  }

  void open_own(std::uint32_t copy) {
    const std::uint32_t own = s_.begin_own(copy);
    const LineOperator& op = s_.members.coarse_of(own);
    const auto ends = ends_of(own, op);
    auto rows = placed_rows({own});
    const auto batches = batches_of(s_, {own});
    s_.gather_rays += ends.size();
    s_.memory.pass("lanes", bytes_of(ends) + lanes_at_once(batches, [&](const Batch& b) { return lanes_of(b, op); }));
    std::vector<std::vector<Balance>> partial(batches.size());
    tbb::parallel_for(std::size_t{0}, batches.size(),
                      [&](std::size_t q) { open(batches[q], {ends.data()}, op, {ends.data()}, rows, partial[q]); });
    s_.progress.check();
    for (std::size_t q = 0; q < batches.size(); ++q) add_balance(batches[q], partial[q]);
    s_.end_own();
    pieces_.push_back(opened_pieces(s_, copy, rows.front()));
    send(rows);
  }

  void send(std::vector<CopyRows>& rows) {
    ordered_.send(rows);
    s_.memory.hold("rows", ordered_.bytes());
  }

  /// Space for the rows of the copies of the members, member by member, part by part.
  std::vector<CopyRows> placed_rows(const std::vector<std::uint32_t>& members) {
    std::vector<CopyRows> out;
    row_of_member_.clear();
    for (const auto m : members) {
      row_of_member_.emplace(m, out.size());
      for (const auto c : s_.members.found.members[m].copies) {
        CopyRows r;
        if (c >= s_.placed.copies.size()) {  // solved together with one that is opened
          out.push_back(std::move(r));
          continue;
        }
        r.first = s_.placed.copies[c].first_facet;
        r.count = s_.placed.plant_facets[s_.placed.copies[c].plant];
        r.irradiance.assign(s_.states * r.count * 2 * s_.bands, 0.0f);
        if (!s_.lights.suns.empty()) r.sunlit.assign(s_.states * r.count * 2, 0.0f);
        out.push_back(std::move(r));
      }
    }
    std::size_t bytes = ordered_.bytes();
    for (const auto& r : out) bytes += r.bytes();
    s_.memory.hold("rows", bytes);
    return out;
  }

  /// Opens the only batch of an original: the lines of the last gather are followed as they are traced, and never kept.
  void open_once(const Batch& b, std::vector<CopyRows>& rows, std::vector<Balance>& balance) {
    with_width(b.width, [&](auto constant) {
      constexpr int width = decltype(constant)::value;
      const auto& original = s_.members.originals[b.original];
      const LaneField<width> radiosity = solved<width>(b, stored_ends(s_, b));
      const LaneField<width> cells = seen() == LineOperator::Seen::cells ? on_cells<width>(b, radiosity) : LaneField<width>{};
      InsideGather<width> gather(original.elements, cells.empty() ? radiosity : cells, seen());
      const LineOperator fine(original.elements, original.interior, gather_density(s_.density, b.members.size()),
                              mix(s_.seed, fine_stream, b.original), s_.progress, seen(), &gather);
      s_.gather_fragments += fine.fragments;
      s_.gather_rays += b.members.size() * fine.points.size();
      s_.memory.pass("fine", fine.built_with() + gather.bytes() + bytes_of(radiosity) + bytes_of(cells));
      s_.memory.pass("lanes", b.members.size() * fine.points.size() * sizeof(RayEnd) + sizeof(float) * width * lanes_of(b, fine));
      std::vector<std::vector<RayEnd>> ends;
      std::vector<const RayEnd*> fine_ends;
      for (const auto m : b.members) {
        ends.push_back(ends_of(m, fine));
        fine_ends.push_back(ends.back().data());
      }
      s_.progress.check();
      finish<width>(b, fine, fine_ends, radiosity, gather.mean(fine), rows, balance);
    });
  }

  /// `coarse_ends` are of the original's own operator, `fine_ends` of the one that light is gathered along; they may be the same.
  void open(const Batch& b, const std::vector<const RayEnd*>& coarse_ends, const LineOperator& fine,
            const std::vector<const RayEnd*>& fine_ends, std::vector<CopyRows>& rows, std::vector<Balance>& balance) {
    with_width(b.width, [&](auto constant) { open_lanes<decltype(constant)::value>(b, coarse_ends, fine, fine_ends, rows, balance); });
  }

  template <int width>
  void open_lanes(const Batch& b, const std::vector<const RayEnd*>& coarse_ends, const LineOperator& fine,
                  const std::vector<const RayEnd*>& fine_ends, std::vector<CopyRows>& rows, std::vector<Balance>& balance) {
    const LaneField<width> radiosity = solved<width>(b, coarse_ends);
    const LaneField<width> cells = fine.seen() == LineOperator::Seen::cells ? on_cells<width>(b, radiosity) : LaneField<width>{};
    LaneField<width> inside(radiosity.size(), Lanes<width>{});
    add_inside<width>(fine, cells.empty() ? radiosity : cells, inside);
    finish<width>(b, fine, fine_ends, radiosity, std::move(inside), rows, balance);
  }

  std::size_t lanes_of(const Batch& b, const LineOperator& fine) const {
    return opening_lanes(s_.members.originals[b.original], fine.seen(), fine.fields());
  }

  /// Radiosity of the elements of a batch in the final light.
  template <int width>
  LaneField<width> solved(const Batch& b, const std::vector<const RayEnd*>& coarse_ends) const {
    const auto& original = s_.members.originals[b.original];
    LaneField<width> field, source(2 * original.elements.size(), Lanes<width>{}), radiosity;
    incoming<width>(s_, b, *original.coarse, coarse_ends, &total_, true, field);
    add_outside<width>(*original.coarse, field, source);
    add_sun<width>(s_, b, source);
    solve_inside<width>(*original.coarse, original.elements.material, optics_of<width>(s_, b), source,
                        static_cast<float>(s_.density.inner_tolerance), radiosity);
    return radiosity;
  }

  /// Rows of a batch, from its radiosity and what elements gather of it inside.
  template <int width>
  void finish(const Batch& b, const LineOperator& fine, const std::vector<const RayEnd*>& fine_ends, const LaneField<width>& radiosity,
              LaneField<width> scattered, std::vector<CopyRows>& rows, std::vector<Balance>& balance) {
    LaneField<width> field, sky(radiosity.size(), Lanes<width>{});  // the sky's light apart, for the balance
    incoming<width>(s_, b, fine, fine_ends, nullptr, true, field);
    add_outside<width>(fine, field, sky);
    incoming<width>(s_, b, fine, fine_ends, &total_, false, field);
    add_outside<width>(fine, field, scattered);
    balance.assign(b.columns, Balance{});
    escaped<width>(b, fine, fine_ends, radiosity, balance);
    for (std::size_t j = 0; j < b.members.size(); ++j)
      member_rows<width>(b, j, fine, sky, scattered, rows, row_of_member_.at(b.members[j]), balance);
  }

  /// With sun, lines tell lit cells of a leaf from others; without, elements are enough.
  LineOperator::Seen seen() const { return s_.lights.suns.empty() ? LineOperator::Seen::elements : LineOperator::Seen::cells; }

  /// Radiosity of cells: their element's, but for the sun's light, once reflected, which is the cell's own.
  template <int width>
  LaneField<width> on_cells(const Batch& b, const LaneField<width>& radiosity) const {
    const auto& e = s_.members.originals[b.original].elements;
    const auto& s = e.surface;
    LaneField<width> out(2 * s.cells());
    for (std::size_t cell = 0; cell < s.cells(); ++cell)
      for (std::size_t side = 0; side < 2; ++side) out[2 * cell + side] = radiosity[2 * std::size_t{e.element_of_cell[cell]} + side];
    std::vector<float> mean;
    for (std::size_t j = 0; j < b.members.size(); ++j)
      for (std::size_t sun = 0; sun < s_.lights.suns.size(); ++sun) {
        std::vector<std::array<std::size_t, 3>> columns;  // lane, state, band
        for (std::size_t c = 0; c < b.columns; ++c)
          if (const auto state = (b.first_column + c) / s_.bands; s_.lights.sun_of_state[state] == sun)
            columns.push_back({j * b.columns + c, state, (b.first_column + c) % s_.bands});
        if (columns.empty()) continue;
        s_.sun_on_elements(b.members[j], sun, mean);
        const Vec3 d = s_.members.maps[b.members[j]].direction_back(s_.lights.suns[sun]->direction);
        const std::uint8_t* lit = s_.lit_cells_of(sun, b.members[j]);
        for (std::size_t t = 0; t < s.size(); ++t) {
          if (s.split[t] == 0) continue;
          const auto cosine = static_cast<float>(s.normal[0][t] * d.x + s.normal[1][t] * d.y + s.normal[2][t] * d.z);
          for (auto cell = s.first_cell[t]; cell < s.first_cell[t + 1]; ++cell) {
            const auto element = std::size_t{e.element_of_cell[cell]};
            float more[2] = {-mean[2 * element], -mean[2 * element + 1]};
            more[cosine > 0 ? 0 : 1] += std::fabs(cosine) * static_cast<float>(lit[cell]) / 255.0f;
            const auto& optics = s_.scene.optics[e.material[element]];
            for (const auto& [lane, state, band] : columns) {
              const auto irradiance = static_cast<float>(s_.scene.states[state].sun->irradiance[band]);
              out[2 * cell][lane] += irradiance * (optics.reflectance_front[band] * more[0] + optics.transmittance[band] * more[1]);
              out[2 * cell + 1][lane] += irradiance * (optics.reflectance_back[band] * more[1] + optics.transmittance[band] * more[0]);
            }
          }
        }
      }
    return out;
  }

  /// Radiosity that ends in the sky: sum of area * B * (lines of the side that do) / W.
  template <int width>
  void escaped(const Batch& b, const LineOperator& op, const std::vector<const RayEnd*>& ends, const LaneField<width>& radiosity,
               std::vector<Balance>& balance) const {
    for (std::size_t j = 0; j < b.members.size(); ++j) {
      const auto areas = sky_areas(op, ends[j]);
      const double scale = s_.members.maps[b.members[j]].scale * s_.members.maps[b.members[j]].scale;
      for (std::size_t side = 0; side < areas.size(); ++side)
        if (areas[side] > 0)
          for (std::size_t c = 0; c < b.columns; ++c) balance[c].escaped += scale * areas[side] * radiosity[side][j * b.columns + c];
    }
  }

  template <int width>
  void member_rows(const Batch& b, std::size_t j, const LineOperator& fine, const LaneField<width>& sky, const LaneField<width>& scattered,
                   std::vector<CopyRows>& rows, std::size_t first_row, std::vector<Balance>& balance) {
    const std::uint32_t m = b.members[j];
    const auto& original = s_.members.originals[b.original];
    const auto& e = original.elements;
    const auto& s = e.surface;
    const double scale = s_.members.maps[m].scale * s_.members.maps[m].scale;
    std::vector<Vec3> towards_sun;
    for (const auto* sun : s_.lights.suns) towards_sun.push_back(s_.members.maps[m].direction_back(sun->direction));
    for (std::size_t t = 0; t < s.size(); ++t) {
      if (s.split[t] == 0) continue;
      const std::uint32_t facet = e.order[t];
      const std::size_t part = original.part_of(facet);
      CopyRows& out = rows[first_row + part];
      if (out.count == 0) continue;
      const std::size_t i = facet - original.facet_of_part[part];
      const std::uint32_t begin = s.first_cell[t], end = s.first_cell[t + 1];
      const float share = 1.0f / static_cast<float>(end - begin);
      const auto& optics = s_.scene.optics[original.facet_material[facet]];
      const double area = scale * s.cell_area[t] * (end - begin);
      auto known = LightSources::none;  // sun that `cosine` and `sunlit` are of: columns of one state follow each other
      double cosine = 0;
      float sunlit = 0;
      for (std::size_t c = 0; c < b.columns; ++c) {
        const std::size_t column = b.first_column + c, state = column / s_.bands, band = column % s_.bands, lane = j * b.columns + c;
        const auto sun = s_.lights.sun_of_state[state];
        if (sun != LightSources::none && sun != known) {
          known = sun;
          cosine = glm::dot(Vec3{s.normal[0][t], s.normal[1][t], s.normal[2][t]}, towards_sun[sun]);
          const std::uint8_t* lit = s_.lit_cells_of(sun, m);
          sunlit = 0;
          for (auto cell = begin; cell < end; ++cell) sunlit += share * static_cast<float>(lit[cell]) / 255.0f;
        }
        const float sun_strength = sun == LightSources::none ? 0.0f : static_cast<float>(s_.scene.states[state].sun->irradiance[band]);
        double absorbed = 0;
        for (std::size_t side = 0; side < 2; ++side) {
          float direct = 0, rest = 0;
          for (auto cell = begin; cell < end; ++cell) {
            const std::size_t from = 2 * std::size_t{fine.stand_in[e.element_of_cell[cell]]} + side;
            direct += share * fine.open(cell) * sky[from][lane];
            rest += share * fine.open(cell) * scattered[from][lane];
          }
          if (sun != LightSources::none) {
            const float lit = (cosine > 0) == (side == 0) ? sunlit : 0.0f;
            direct += lit * static_cast<float>(std::fabs(cosine)) * sun_strength;
            if (band == 0) out.sunlit[(state * out.count + i) * 2 + side] = lit;
          }
          out.irradiance[((state * out.count + i) * 2 + side) * s_.bands + band] = direct + rest;
          balance[c].incident += area * direct;
          absorbed += (1.0 - (side == 0 ? optics.reflectance_front[band] : optics.reflectance_back[band]) - optics.transmittance[band]) *
                      (double{direct} + rest);
        }
        balance[c].leaves += area * absorbed;
      }
    }
  }

  void add_balance(const Batch& b, const std::vector<Balance>& partial) {
    for (std::size_t c = 0; c < b.columns; ++c) {
      auto& out = report_.balance[(b.first_column + c) / s_.bands][(b.first_column + c) % s_.bands];
      out.incident += partial[c].incident;
      out.leaves += partial[c].leaves;
      out.escaped += partial[c].escaped;
    }
  }

  SceneLight& s_;
  const Light& total_;
  IrradianceSink& sink_;
  SolveReport& report_;
  std::map<std::uint32_t, std::size_t> row_of_member_;  ///< of the window
  RowsInOrder ordered_;
  std::vector<OpenedPieces> pieces_;
  const OpeningSteps order_;
  std::uint32_t fine_of_ = no_parent;  ///< the original that `fine_` is of
  std::shared_ptr<const LineOperator> fine_;
};

}  // namespace

void open_copies(SceneLight& s, const Light& light, IrradianceSink& sink, SolveReport& report) {
  Opening(s, light, sink, report).open_all();
}

}  // namespace sunfleck
