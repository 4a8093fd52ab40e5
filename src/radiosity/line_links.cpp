#include "line_links.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <sunfleck/radiosity/interior.hpp>
#include <sunfleck/core/memory.hpp>
#include <sunfleck/core/release_memory.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/light/sky_parts.hpp>

#include "line_collector.hpp"

namespace sunfleck {

namespace {

constexpr std::uint64_t line_stream = 0x9fb21c651e98df25ULL;
constexpr std::uint64_t emission_stream = 0xd1b54a32d192ed03ULL;

/// Collects DirectLines.
class LineRecord {
 public:
  LineRecord(const Elements& e, std::uint32_t directions)
      : lines(e.surface.cells(), 0.0f),
        met_(std::max(4 * e.size(), 2 * e.surface.cells())),
        withheld_(std::max(2 * e.size(), 2 * e.surface.cells())),
        open_(std::max<std::size_t>(2 * directions, 2 * e.surface.cells())),
        escapes_(2 * e.surface.cells(), 0.0f) {}

  void add(const DirectionLines& d, std::uint32_t direction, float weight) {
    const auto see_out = [&](std::uint32_t from, std::uint32_t cell_side, std::uint32_t sense) {
      open_.add_end(cell_side, 2 * direction + sense);
      if (from & enclosed_bit)
        withhold(from, cell_side);
      else
        escapes_[cell_side] += 1.0f;
    };
    const auto meet = [&](std::uint32_t row, std::uint32_t from, std::uint32_t cell_side) {
      if (from & enclosed_bit)
        withhold(from, cell_side);
      else if (row & enclosed_bit)
        enclosed_.push_back({row, cell_side});
      else
        met_.add_end(row, cell_side);
    };
    for (std::size_t k = 0, n = d.side.size(); k < n; ++k) {
      const std::uint32_t down = d.side[k] ^ 1u;
      lines[d.cell_side[k] >> 1] += weight;
      if (d.link[k] == HitLink::lowest) {
        see_out(down, d.cell_side[k] ^ 1u, 1);
      } else {
        meet(d.side[k - 1], down, d.cell_side[k] ^ 1u);
        meet(down, d.side[k - 1], d.cell_side[k - 1]);
      }
      if (k + 1 == n || d.link[k + 1] == HitLink::lowest) see_out(d.side[k], d.cell_side[k], 0);
    }
    for (const auto& o : d.outside) {
      const std::uint32_t up = 2 * o.cell + (o.front_up ? 0 : 1);
      lines[o.cell] += weight * o.lines;
      outside_.push_back({up, 2 * direction, o.lines});
      outside_.push_back({up ^ 1u, 2 * direction + 1, o.lines});
      escapes_[up] += o.lines;
      escapes_[up ^ 1u] += o.lines;
    }
  }

  DirectLines finish(std::size_t sides, std::size_t element_sides, const auto& part_side) {
    for (const auto& r : enclosed_) met_.add_end(part_side(r.low), r.high);
    DirectLines out;
    std::vector<float> unused(std::max(sides, escapes_.size()), 0.0f);
    out.met = met_.finish(sides, unused);
    if (any_withheld_) out.withheld = withheld_.finish(element_sides, unused);
    out.open = open_.finish(escapes_.size(), unused);
    out.escapes = std::move(escapes_);
    out.lines = std::move(lines);
    out.outside = std::move(outside_);
    return out;
  }

  std::vector<float> lines;  ///< as DirectLines

 private:
  void withhold(std::uint32_t side, std::uint32_t cell_side) {
    withheld_.add_end(side & ~enclosed_bit, cell_side);
    any_withheld_ = true;
  }

  NearBuilder met_, withheld_, open_;
  std::vector<float> escapes_;
  std::vector<SidePair> enclosed_;  ///< row, and side of the cell that is met
  std::vector<DirectLines::Outside> outside_;
  bool any_withheld_ = false;
};

/// Collects one half of the links while directions come in, bin by bin.
class HalfBuilder {
 public:
  /// `recorded_directions`: 0 = lines are not recorded.
  HalfBuilder(const Elements& elements, const ClusterTree* tree, const SunReflection& sun, std::size_t skies, bool count_cells,
              std::uint32_t recorded_directions)
      : e_(elements), tree_(tree), sun_(sun), near_(4 * elements.size()) {
    const std::size_t sides = 2 * e_.size();
    open_up_.assign(sides, 0.0f);
    open_down_.assign(sides, 0.0f);
    if (!e_.emission.empty()) sent_up_.assign(sides, 0.0f), sent_down_.assign(sides, 0.0f), missing_.assign(sides, 0.0f);
    if (recorded_directions > 0) record_.emplace(e_, recorded_directions);
    if (count_cells && !record_) sky_ = SkySums(e_.surface.cells(), skies);
    if (!sun_.exitance.empty() && !record_) {
      reflection_.assign(sides * sun_.columns, 0.0f);
      escaped_.assign(sun_.columns, 0.0);
    }
    if (tree_) {
      far_.of_side.assign(sides * channels, 0);
      far_.through.assign(tree_->size() * channels, 0);
      far_.linked.assign(tree_->size() * channels, 0);
      far_.node_bits = static_cast<int>(std::bit_width(tree_->size()));
      by_node_.resize(tree_->size() + 1);
    }
  }

  /// Directions of one bin that belong to this half, in order.
  void add_bin(std::uint32_t bin, const std::vector<const DirectionLines*>& lines, const std::vector<std::uint32_t>& directions,
               const std::vector<LineSky>& skies) {
    std::vector<FarPair> far;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (e_.emission.empty())
        add_hits<false>(*lines[i], directions[i]);
      else
        add_hits<true>(*lines[i], directions[i]);
      if (!sky_.empty()) add_sky(*lines[i], skies[directions[i]]);
      if (record_)
        record_->add(*lines[i], directions[i], skies[directions[i]].weight);
      else if (sun_.columns == 2)
        add_reflections<2>(*lines[i]);
      else if (!sun_.exitance.empty())
        add_reflections<0>(*lines[i]);
      add_far(bin, lines[i]->far, far);
    }
    if (!far.empty()) merge_far(bin, far);
  }

  /// Needs skies or `count_cells`.
  float lines_of_cell(std::size_t cell) const { return record_ ? record_->lines[cell] : sky_.all(cell); }

  HalfLinks finish(std::size_t sides, const std::vector<std::uint32_t>& enclosed_part, HalfLight& light, DirectLines& direct) {
    HalfLinks half;
    const auto part_side = [&](std::uint32_t s) { return s & enclosed_bit ? 2 * enclosed_part[(s & ~enclosed_bit) >> 1] + (s & 1u) : s; };
    const auto of_parts = [&](std::vector<float>& of_elements, const std::vector<std::uint32_t>& enclosed) {
      of_elements.resize(sides, 0.0f);
      for (const auto s : enclosed) of_elements[part_side(s)] += 1.0f;
      return std::move(of_elements);
    };
    half.open_up = of_parts(open_up_, enclosed_up_);
    half.open_down = of_parts(open_down_, enclosed_down_);
    if (!e_.emission.empty()) {
      half.sent_up = of_parts(sent_up_, enclosed_up_);
      half.sent_down = of_parts(sent_down_, enclosed_down_);
    }
    light.sky = std::move(sky_);
    light.first_reflection = std::move(reflection_);
    light.escaped_reflection = std::move(escaped_);
    light.withheld_reflection = std::move(withheld_);
    if (!light.first_reflection.empty()) light.first_reflection.resize(sides * sun_.columns, 0.0f);
    for (const auto& r : enclosed_reflections_)
      for (std::size_t c = 0; c < sun_.columns; ++c)
        light.first_reflection[part_side(r.low) * sun_.columns + c] += sun_.exitance[std::size_t{r.high} * sun_.columns + c];
    if (record_) direct = record_->finish(sides, 2 * e_.size(), part_side);
    half.lines.resize(sides);
    for (std::size_t i = 0; i < sides; ++i) half.lines[i] = half.open_up[i] + half.open_down[i];
    for (const auto& p : enclosed_pairs_) near_.add(part_side(p.low), part_side(p.high));
    half.near = near_.finish(sides, half.lines);
    for (std::size_t i = 0; i < missing_.size(); ++i) half.lines[i] += missing_[i];
    if (tree_) far_rows(half);
    return half;
  }

 private:
  /// Lines meet cells in no order that a processor could foresee.
  static constexpr std::size_t ahead = 16;
  static void prefetch(const float* where) { __builtin_prefetch(where, 1); }

  static void add_open(std::vector<float>& open, std::vector<std::uint32_t>& enclosed, std::uint32_t side) {
    if (side & enclosed_bit)
      enclosed.push_back(side);
    else
      open[side] += 1.0f;
  }

  /// A line counts as often as the cell that it comes from sends out beside its element's mean, by chance rounded to a whole number;
  /// and once for the row that it reaches.
  void see(std::uint32_t row, std::uint32_t from, std::uint32_t cell_side, std::uint64_t draw) {
    const double times = e_.emission[cell_side] / 32.0;
    const auto whole = static_cast<int>(times + unit_interval(draw));
    for (int k = 0; k < whole; ++k) near_.add_end(row, from);
    missing_[row] += static_cast<float>(1 - whole);
  }

  template <bool Weighted>
  void add_hits(const DirectionLines& d, [[maybe_unused]] std::uint32_t direction) {
    const auto send = [&](std::size_t k, std::uint32_t sense) {
      if constexpr (Weighted) {
        const std::uint32_t side = d.side[k] ^ sense;
        if (!(side & enclosed_bit)) (sense ? sent_down_ : sent_up_)[side] += e_.emission[d.cell_side[k] ^ sense] / 32.0f;
      }
    };
    for (std::size_t k = 0, n = d.side.size(); k < n; ++k) {
      if (d.link[k] == HitLink::lowest) {
        add_open(open_down_, enclosed_down_, d.side[k] ^ 1u);
        send(k, 1u);
      } else if (d.link[k] == HitLink::near) {
        const std::uint32_t low = d.side[k - 1], high = d.side[k] ^ 1u;
        if ((low | high) & enclosed_bit)
          enclosed_pairs_.push_back({low, high});
        else if constexpr (Weighted) {
          const auto draw = mix(emission_stream, direction, k);
          see(low, high, d.cell_side[k] ^ 1u, draw);
          see(high, low, d.cell_side[k - 1], mix(draw));
        } else {
          near_.add(low, high);
        }
      }
      if (k + 1 == n || d.link[k + 1] == HitLink::lowest) {
        add_open(open_up_, enclosed_up_, d.side[k]);
        send(k, 0u);
      }
    }
    for (const auto& o : d.outside) {
      const std::uint32_t up = 2 * e_.element_of_cell[o.cell] + (o.front_up ? 0 : 1);
      open_up_[up] += o.lines;
      open_down_[up ^ 1u] += o.lines;
      if constexpr (Weighted) sent_up_[up] += o.lines, sent_down_[up ^ 1u] += o.lines;
    }
  }

  void add_sky(const DirectionLines& d, const LineSky& sky) {
    const std::size_t n = d.cell_side.size();
    for (const auto& o : d.outside) sky_.all(o.cell) += sky.weight * o.lines;
    if (sky_.skies() == 0) {
      for (std::size_t k = 0; k < n; ++k) sky_.all(d.cell_side[k] >> 1) += sky.weight;
      return;
    }
    const bool from_below = !sky.below.empty();
    const auto see = [&](std::size_t cell_side, float lines, const std::vector<float>& radiance) {
      sky_.seen(cell_side) += sky.weight * lines;
      for (std::size_t i = 0; i < radiance.size(); ++i) sky_.seen(cell_side, 1 + i) += radiance[i] * lines;
    };
    for (std::size_t k = 0; k < n; ++k) {
      prefetch(&sky_.all(d.cell_side[std::min(k + ahead, n - 1)] >> 1));
      sky_.all(d.cell_side[k] >> 1) += sky.weight;
      if (from_below && d.link[k] == HitLink::lowest) see(d.cell_side[k] ^ 1u, 1.0f, sky.below);
      if (k + 1 == n || d.link[k + 1] == HitLink::lowest) see(d.cell_side[k], 1.0f, sky.above);
    }
    for (const auto& o : d.outside) {
      const std::size_t up = 2 * std::size_t{o.cell} + (o.front_up ? 0 : 1);
      see(up, o.lines, sky.above);
      if (from_below) see(up ^ 1u, o.lines, sky.below);
    }
  }

  /// Each line brings the sun's light, once reflected, from the very cell that it meets. The sun does not shine on enclosed parts: what
  /// they would reflect is withheld, and left to the rest of the element.
  template <std::size_t Columns>
  void add_reflections(const DirectionLines& d) {
    const std::size_t columns = Columns ? Columns : sun_.columns;
    const auto add = [&](auto& sum, std::size_t row, std::uint32_t cell_side) {
      const float* from = sun_.exitance.data() + std::size_t{cell_side} * columns;
      auto* to = sum.data() + row * columns;
      for (std::size_t c = 0; c < columns; ++c) to[c] += from[c];
    };
    const auto withhold = [&](std::uint32_t side, std::uint32_t cell_side) {
      if (withheld_.empty()) withheld_.assign(reflection_.size(), 0.0f);
      add(withheld_, side & ~enclosed_bit, cell_side);
    };
    const auto reflect = [&](std::uint32_t row, std::uint32_t from, std::uint32_t cell_side) {
      if (from & enclosed_bit)
        withhold(from, cell_side);
      else if (row & enclosed_bit)
        enclosed_reflections_.push_back({row, cell_side});
      else
        add(reflection_, row, cell_side);
    };
    const auto escape = [&](std::uint32_t from, std::uint32_t cell_side) {
      if (from & enclosed_bit)
        withhold(from, cell_side);
      else
        add(escaped_, 0, cell_side);
    };
    for (std::size_t k = 0, n = d.side.size(); k < n; ++k) {
      const std::size_t soon = std::min(k + ahead, n - 1);
      prefetch(sun_.exitance.data() + std::size_t{d.cell_side[soon]} * columns);
      prefetch(reflection_.data() + std::size_t{d.side[soon] & ~enclosed_bit} * columns);
      const std::uint32_t down = d.side[k] ^ 1u;
      if (d.link[k] == HitLink::lowest) {
        escape(down, d.cell_side[k] ^ 1u);
      } else {
        reflect(d.side[k - 1], down, d.cell_side[k] ^ 1u);
        reflect(down, d.side[k - 1], d.cell_side[k - 1]);
      }
      if (k + 1 == n || d.link[k + 1] == HitLink::lowest) escape(d.side[k], d.cell_side[k]);
    }
    for (const auto& o : d.outside)
      for (std::size_t cell_side = 2 * std::size_t{o.cell}, end = cell_side + 2; cell_side < end; ++cell_side)
        for (std::size_t c = 0; c < columns; ++c) escaped_[c] += o.lines * sun_.exitance[cell_side * columns + c];
  }

  void add_far(std::uint32_t bin, const std::vector<FarPair>& pairs, std::vector<FarPair>& far) {
    for (const auto& p : pairs) {
      auto& low = far_.of_side[std::size_t{p.low} * channels + 2 * bin];
      auto& high = far_.of_side[std::size_t{p.high} * channels + 2 * bin + 1];
      if (low == 255 || high == 255) {  // a large element: its lines stay links of its own
        near_.add(p.low, p.high);
        continue;
      }
      ++low;
      ++high;
      ++far_.through[std::size_t{tree_->cluster_of_element[p.low >> 1]} * channels + 2 * bin];
      ++far_.through[std::size_t{tree_->cluster_of_element[p.high >> 1]} * channels + 2 * bin + 1];
      ++far_.linked[std::size_t{p.low_node} * channels + 2 * bin];
      ++far_.linked[std::size_t{p.high_node} * channels + 2 * bin + 1];
      far.push_back(p);
    }
  }

  /// Equal links become one with a count: bucket by receiving node, sort each bucket. Bins rise from call to call.
  void merge_far(std::uint32_t bin, const std::vector<FarPair>& far) {
    std::fill(by_node_.begin(), by_node_.end(), 0u);
    for (const auto& p : far) ++by_node_[p.low_node + 1];
    for (std::size_t i = 1; i < by_node_.size(); ++i) by_node_[i] += by_node_[i - 1];
    other_.resize(far.size());
    for (const auto& p : far) other_[by_node_[p.low_node]++] = p.high_node;
    for (std::size_t node = 0, begin = 0; node + 1 < by_node_.size(); ++node) {
      const std::size_t end = by_node_[node];
      std::sort(other_.begin() + static_cast<std::ptrdiff_t>(begin), other_.begin() + static_cast<std::ptrdiff_t>(end));
      for (std::size_t k = begin; k < end;) {
        std::size_t last = k + 1;
        while (last < end && other_[last] == other_[k] && last - k < far_.most_count()) ++last;
        merged_[bin].push_back({static_cast<std::uint32_t>(node), far_.packed(other_[k], last - k)});
        k = last;
      }
      begin = end;
    }
  }

  void far_rows(HalfLinks& half) {
    for (std::size_t i = 0; i < 2 * e_.size(); ++i) {
      std::uint32_t lines = 0;
      for (std::uint32_t q = 0; q < channels; ++q) lines += far_.of_side[i * channels + q];
      half.lines[i] += static_cast<float>(lines);
    }
    // lines that are not linked at a node pass through its parent
    for (std::size_t node = tree_->size(); node-- > 0;) {
      const auto up = tree_->parent[node];
      if (up == ClusterTree::none) continue;
      for (std::uint32_t q = 0; q < channels; ++q)
        far_.through[up * channels + q] += far_.through[node * channels + q] - far_.linked[node * channels + q];
    }
    const std::size_t slots = tree_->size() * channels;
    far_.first_link.assign(slots + 1, 0);
    const auto low_slot = [](const MergedLink& m, std::uint32_t bin) { return std::size_t{m.low} * channels + 2 * bin; };
    const auto high_slot = [&](const MergedLink& m, std::uint32_t bin) {
      return std::size_t{far_.node_of(m.high)} * channels + 2 * bin + 1;
    };
    for (std::uint32_t bin = 0; bin < direction_bins; ++bin)
      for (const auto& m : merged_[bin]) {
        ++far_.first_link[low_slot(m, bin) + 1];
        ++far_.first_link[high_slot(m, bin) + 1];
      }
    for (std::size_t i = 0; i < slots; ++i) far_.first_link[i + 1] += far_.first_link[i];
    far_.links.resize(far_.first_link.back());
    // starts of rows serve as cursors, and stand one row further when all is placed
    for (std::uint32_t bin = 0; bin < direction_bins; ++bin) {
      for (const auto& m : merged_[bin]) {
        far_.links[far_.first_link[low_slot(m, bin)]++] = m.high;
        far_.links[far_.first_link[high_slot(m, bin)]++] = far_.packed(m.low, far_.count_of(m.high));
      }
      merged_[bin] = {};
    }
    std::copy_backward(far_.first_link.begin(), far_.first_link.end() - 1, far_.first_link.end());
    far_.first_link[0] = 0;
    half.far = std::move(far_);
  }

  struct MergedLink {
    std::uint32_t low, high;  ///< node; node and count, packed
  };

  const Elements& e_;
  const ClusterTree* tree_;
  const SunReflection& sun_;
  std::optional<LineRecord> record_;
  std::vector<float> reflection_, withheld_;
  std::vector<double> escaped_;
  SkySums sky_;
  std::vector<SidePair> enclosed_reflections_;                              ///< row, and side of the cell that reflects
  std::vector<float> open_up_, open_down_, sent_up_, sent_down_, missing_;  ///< the last: lines that links tell too few or too many of
  std::vector<std::uint32_t> enclosed_up_, enclosed_down_;
  NearBuilder near_;
  std::vector<SidePair> enclosed_pairs_;
  FarField far_;
  std::array<std::vector<MergedLink>, direction_bins> merged_;
  std::vector<std::uint32_t> by_node_, other_;
};

double line_pitch(const Elements& e, const RadiosityDensity& density) {
  double area = 0;
  for (std::size_t t = 0; t < e.surface.focus_count; ++t)
    if (e.surface.split[t] > 0)
      area += static_cast<double>(e.surface.cell_area[t]) * (e.surface.first_cell[t + 1] - e.surface.first_cell[t]);
  const double fewest = density.fewest_hits / density.directions;
  return std::sqrt(0.5 * std::min(e.element_area / density.lines_per_element, area / std::max(1.0, fewest)));
}

std::vector<LineSky> skies_along(const std::vector<Projection>& projection, const std::vector<const Sky*>& skies, double mean_line_area) {
  bool below = false;
  for (const auto* sky : skies) below = below || sky->reaches_below_horizon();
  std::vector<Vec3> directions;
  for (const auto& p : projection) directions.push_back(p.direction);
  std::vector<LineSky> out(projection.size());
  for (std::size_t d = 0; d < out.size(); ++d) out[d].weight = static_cast<float>(projection[d].line_area / mean_line_area);
  for (const auto* sky : skies) {
    const auto radiance = radiances_along(*sky, directions);
    for (std::size_t d = 0; d < out.size(); ++d) {
      const auto of_lines = [&](double r) { return out[d].weight * static_cast<float>(std::numbers::pi * r); };
      out[d].above.push_back(of_lines(radiance[d]));
      if (below) out[d].below.push_back(of_lines(sky->relative_radiance(-directions[d])));
    }
  }
  return out;
}

/// That a line stands for [m^2].
double mean_line_area(const LineLinks& links, std::size_t directions) {
  return links.area_of_line * static_cast<double>(directions) / 2.0;
}

/// Do at least 5 % of the lines between elements run far?
bool clusters_pay(const std::vector<DirectionLines>& found) {
  std::size_t near = 0, far = 0;
  for (const auto& f : found) {
    far += f.far.size();
    near += static_cast<std::size_t>(std::count(f.link.begin(), f.link.end(), HitLink::near));
  }
  return 20 * far >= near + far;
}

std::size_t bytes_of_half(const HalfLinks& h) {
  return h.near.bytes() + bytes_of(h.far.of_side) + bytes_of(h.far.through) + bytes_of(h.far.linked) + bytes_of(h.far.first_link) +
         bytes_of(h.far.links) + bytes_of(h.lines) + bytes_of(h.open_up) + bytes_of(h.open_down) + bytes_of(h.sent_up) +
         bytes_of(h.sent_down);
}

}  // namespace

std::uint32_t bin_of(const Vec3& d) {
  // three rings of 4, 8 and 12 bins, in proportion to their areas
  constexpr double ring_z[2] = {5.0 / 6.0, 0.5};
  constexpr std::uint32_t ring_first[3] = {0, 4, 12}, ring_bins[3] = {4, 8, 12};
  const int ring = d.z >= ring_z[0] ? 0 : d.z >= ring_z[1] ? 1 : 2;
  const double turns = std::atan2(d.y, d.x) / (2.0 * std::numbers::pi);
  const auto k = static_cast<std::uint32_t>((turns - std::floor(turns)) * ring_bins[ring]);
  return ring_first[ring] + std::min(k, ring_bins[ring] - 1);
}

void release_pages(const Elements& elements) {
  if (elements.size() > 100'000) release_freed_memory();
}

std::uint64_t LineLinks::link_count() const {
  std::uint64_t n = 0;
  for (const auto& h : half) n += h.near.size() + h.far.links.size();
  return n;
}

std::size_t LineLinks::bytes() const {
  std::size_t total = bytes_of(whole) + bytes_of(enclosed_part) + bytes_of(enclosed) + bytes_of(projection);
  for (std::size_t h = 0; h < 2; ++h) total += bytes_of_half(half[h]) + direct[h].bytes();
  return total;
}

double line_batch(std::size_t elements, const RadiosityDensity& density) {
  const double expected = static_cast<double>(elements) * density.lines_per_element;
  return std::clamp(std::floor(4e6 / std::max(1.0, expected)), 2.0, 16.0);
}

LineLinks line_links(const Elements& e, const ClusterTree* tree, const SunReflection& sun, const std::vector<const Sky*>& skies,
                     const RadiositySettings& settings, bool recorded, Progress& progress) {
  const std::uint32_t directions = settings.density.directions;
  const double pitch = line_pitch(e, settings.density);
  LineLinks links;
  std::vector<bool> interior;
  if (settings.method != RadiosityMethod::flat) interior = interior_sides(e, pitch, settings.seed, progress);
  const GroundContact contact(e, pitch, settings.seed);
  LineCollector collector(e, tree, settings.density.link_error, interior, contact);
  std::optional<HalfBuilder> builder[2];
  // bin by bin, so that equal far links meet and are merged early
  std::vector<Projection> projection(directions);
  std::vector<std::vector<std::uint32_t>> bins(direction_bins);
  for (std::uint32_t d = 0; d < directions; ++d) {
    const Vec3 direction = hemisphere_direction(d, directions, mix(settings.seed, line_stream));
    projection[d] = project_set_member(e.surface, direction, d, pitch, mix(settings.seed, line_stream, 1));
    bins[bin_of(direction)].push_back(d);
    // a side of area A meets A D / (2 line area) lines
    links.area_of_line += 2.0 * projection[d].line_area / (static_cast<double>(directions) * directions);
  }
  const std::vector<LineSky> line_sky = skies_along(projection, skies, mean_line_area(links, directions));
  std::uint32_t done = 0;
  // a batch of directions, mostly of one bin, keeps the threads busy; its hits wait in memory to be sorted into links
  std::vector<std::uint32_t> queue;
  for (const auto& bin : bins) queue.insert(queue.end(), bin.begin(), bin.end());
  const auto batch_size = static_cast<std::size_t>(line_batch(e.size(), settings.density));
  std::vector<DirectionLines> found(std::min(batch_size, queue.size()));
  tbb::enumerable_thread_specific<LineBundle> bundles;
  for (std::size_t first = 0; first < queue.size(); first += batch_size) {
    const std::vector<std::uint32_t> batch(queue.begin() + static_cast<std::ptrdiff_t>(first),
                                           queue.begin() + static_cast<std::ptrdiff_t>(std::min(queue.size(), first + batch_size)));
    found.resize(batch.size());
    tbb::parallel_for(std::size_t{0}, batch.size(), [&](std::size_t i) {
      if (progress.cancelled()) return;
      LineBundle& bundle = bundles.local();
      trace_lines(e.surface, projection[batch[i]], bundle, LinesKept::met);
      collector.collect(bundle, projection[batch[i]].direction, found[i]);
      found[i].outside = outside_focus(e.surface, projection[batch[i]]);
    });
    progress.check();
    if (first == 0) {
      // where hardly a line of the first batch runs far, clusters cost more than they save
      if (tree && !clusters_pay(found)) {
        tree = nullptr;
        collector.forget_clusters();
        for (auto& f : found) {
          std::replace(f.link.begin(), f.link.end(), HitLink::far, HitLink::near);
          f.far.clear();
        }
      }
      links.clustered = tree != nullptr;
      for (auto& b : builder)
        b.emplace(e, tree, sun, skies.size(), !skies.empty() || !collector.inside().empty(), recorded ? directions : 0);
    }
    for (const auto& f : found) links.fragments += f.side.size();
    const auto add = [&](std::uint32_t h) {
      for (std::size_t i = 0; i < batch.size();) {
        const auto bin = bin_of(projection[batch[i]].direction);
        std::vector<const DirectionLines*> mine;
        std::vector<std::uint32_t> mine_direction;
        for (; i < batch.size() && bin_of(projection[batch[i]].direction) == bin; ++i)
          if (batch[i] % 2 == h) {
            mine.push_back(&found[i]);
            mine_direction.push_back(batch[i]);
          }
        builder[h]->add_bin(bin, mine, mine_direction, line_sky);
      }
    };
    tbb::parallel_invoke([&] { add(0); }, [&] { add(1); });
    done += static_cast<std::uint32_t>(batch.size());
    progress.fraction("lines", static_cast<double>(done) / directions);
  }
  found = {};
  bundles.clear();
  release_pages(e);
  links.whole.resize(e.size());
  std::iota(links.whole.begin(), links.whole.end(), 0u);
  const auto& inside = collector.inside();
  if (std::any_of(inside.begin(), inside.end(), [](const auto& lines) { return lines > 0; })) {
    links.enclosed.assign(inside.size(), 0.0f);
    links.enclosed_part.assign(e.size(), LineLinks::none);
    for (std::size_t c = 0; c < inside.size(); ++c) {
      if (inside[c] == 0) continue;
      links.enclosed[c] = std::min(1.0f, static_cast<float>(inside[c]) / (builder[0]->lines_of_cell(c) + builder[1]->lines_of_cell(c)));
      auto& part = links.enclosed_part[e.element_of_cell[c]];
      if (part != LineLinks::none) continue;
      part = static_cast<std::uint32_t>(links.whole.size());
      links.whole.push_back(e.element_of_cell[c]);
    }
  }
  for (std::size_t h = 0; h < 2; ++h) {
    links.half[h] = builder[h]->finish(links.sides(), links.enclosed_part, links.light[h], links.direct[h]);
    builder[h].reset();
  }
  if (recorded) links.projection = std::move(projection);
  return links;
}

std::array<HalfLight, 2> light_along(const LineLinks& links, const SunReflection& sun, const std::vector<const Sky*>& skies) {
  const auto line_sky = skies_along(links.projection, skies, mean_line_area(links, links.projection.size()));
  return {links.direct[0].light(sun, line_sky, skies.size()), links.direct[1].light(sun, line_sky, skies.size())};
}

}  // namespace sunfleck
