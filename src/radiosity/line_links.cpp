#include "line_links.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <sunfleck/core/memory.hpp>
#include <sunfleck/core/sampling.hpp>

#include "line_collector.hpp"

namespace sunfleck {

namespace {

constexpr std::uint64_t line_stream = 0x9fb21c651e98df25ULL;

/// Collects one half of the links while directions come in, bin by bin.
class HalfBuilder {
 public:
  HalfBuilder(const Elements& elements, const ClusterTree* tree, const SunReflection& sun) : e_(elements), tree_(tree), sun_(sun) {
    const std::size_t sides = 2 * e_.size();
    open_up_.assign(sides, 0.0f);
    open_down_.assign(sides, 0.0f);
    if (!sun_.exitance.empty()) {
      reflection_.assign(sides * sun_.columns, 0.0f);
      escaped_.assign(sun_.columns, 0.0);
    }
    if (tree_) {
      far_.of_side.assign(sides * channels, 0);
      far_.through.assign(tree_->size() * channels, 0);
      far_.linked.assign(tree_->size() * channels, 0);
      by_node_.resize(tree_->size() + 1);
    }
  }

  /// Directions of one bin that belong to this half, in order.
  void add_bin(std::uint32_t bin, const std::vector<DirectionLines*>& lines) {
    std::vector<FarPair> far;
    for (auto* d : lines) {
      for (const auto s : d->open_up) add_open(open_up_, enclosed_up_, s);
      for (const auto s : d->open_down) add_open(open_down_, enclosed_down_, s);
      for (const auto& o : d->outside) {
        const std::uint32_t up = 2 * e_.element_of_cell[o.cell] + (o.front_up ? 0 : 1);
        open_up_[up] += o.lines;
        open_down_[up ^ 1u] += o.lines;
        if (!sun_.exitance.empty())
          for (std::size_t cell_side = 2 * std::size_t{o.cell}, end = cell_side + 2; cell_side < end; ++cell_side)
            for (std::size_t c = 0; c < sun_.columns; ++c) escaped_[c] += o.lines * sun_.exitance[cell_side * sun_.columns + c];
      }
      for (const auto& r : d->reflections) {
        const float* from = sun_.exitance.data() + std::size_t{r.cell_side} * sun_.columns;
        if (r.row == no_row)
          for (std::size_t c = 0; c < sun_.columns; ++c) escaped_[c] += from[c];
        else if (r.row & enclosed_bit)
          enclosed_reflections_.push_back(r);
        else
          for (std::size_t c = 0; c < sun_.columns; ++c) reflection_[r.row * sun_.columns + c] += from[c];
      }
      d->reflections = {};
      if (!d->withheld.empty() && withheld_.empty()) withheld_.assign(reflection_.size(), 0.0f);
      for (const auto cell_side : d->withheld) {
        const std::size_t row = 2 * std::size_t{e_.element_of_cell[cell_side >> 1]} + (cell_side & 1u);
        for (std::size_t c = 0; c < sun_.columns; ++c)
          withheld_[row * sun_.columns + c] += sun_.exitance[std::size_t{cell_side} * sun_.columns + c];
      }
      for (const auto& p : d->far) {
        auto& low = far_.of_side[std::size_t{p.low} * channels + 2 * bin];
        auto& high = far_.of_side[std::size_t{p.high} * channels + 2 * bin + 1];
        if (low == 255 || high == 255) {  // a large element: its lines stay links of its own
          d->near.push_back({p.low, p.high});
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
      near_.push_back(std::move(d->near));
    }
    if (!far.empty()) merge_far(bin, far);
  }

  HalfLinks finish(std::size_t sides, const std::vector<std::uint32_t>& enclosed_part) {
    HalfLinks half;
    const auto part_side = [&](std::uint32_t s) { return s & enclosed_bit ? 2 * enclosed_part[(s & ~enclosed_bit) >> 1] + (s & 1u) : s; };
    half.open_up = std::move(open_up_);
    half.open_down = std::move(open_down_);
    half.open_up.resize(sides, 0.0f);
    half.open_down.resize(sides, 0.0f);
    for (const auto s : enclosed_up_) half.open_up[part_side(s)] += 1.0f;
    for (const auto s : enclosed_down_) half.open_down[part_side(s)] += 1.0f;
    half.first_reflection = std::move(reflection_);
    half.escaped_reflection = std::move(escaped_);
    half.withheld_reflection = std::move(withheld_);
    if (!half.first_reflection.empty()) half.first_reflection.resize(sides * sun_.columns, 0.0f);
    for (const auto& r : enclosed_reflections_)
      for (std::size_t c = 0; c < sun_.columns; ++c)
        half.first_reflection[part_side(r.row) * sun_.columns + c] += sun_.exitance[std::size_t{r.cell_side} * sun_.columns + c];
    half.lines.assign(sides, 0.0f);
    near_rows(sides, part_side, half);
    if (tree_) far_rows(half);
    return half;
  }

 private:
  static void add_open(std::vector<float>& open, std::vector<std::uint32_t>& enclosed, std::uint32_t side) {
    if (side & enclosed_bit)
      enclosed.push_back(side);
    else
      open[side] += 1.0f;
  }

  /// Equal links become one with a count: bucket by receiving node, sort each bucket.
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
        while (last < end && other_[last] == other_[k] && last - k < std::numeric_limits<std::uint16_t>::max()) ++last;
        merged_.push_back(
            {static_cast<std::uint32_t>(node), other_[k], static_cast<std::uint16_t>(last - k), static_cast<std::uint16_t>(bin)});
        k = last;
      }
      begin = end;
    }
  }

  template <class PartSide>
  void near_rows(std::size_t sides, const PartSide& part_side, HalfLinks& half) {
    std::vector<std::uint32_t> start(sides + 1, 0);
    for (auto& list : near_)
      for (auto& p : list) {
        p = {part_side(p.low), part_side(p.high)};
        ++start[p.low + 1];
        ++start[p.high + 1];
      }
    for (std::size_t i = 0; i < sides; ++i) start[i + 1] += start[i];
    std::vector<std::uint32_t> column(start[sides]);
    std::vector<std::uint32_t> cursor(start.begin(), start.end() - 1);
    for (auto& list : near_) {
      for (const auto& p : list) {
        column[cursor[p.low]++] = p.high;
        column[cursor[p.high]++] = p.low;
      }
      list = {};
    }
    auto& near = half.near;
    constexpr std::uint32_t most = std::numeric_limits<std::uint16_t>::max();
    // sort each row and merge equal columns in place
    std::vector<std::uint32_t> distinct(sides);
    std::vector<std::uint16_t> count(column.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sides, 256), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        std::sort(column.begin() + start[i], column.begin() + start[i + 1]);
        std::uint32_t out = start[i];
        for (std::uint32_t k = start[i]; k < start[i + 1]; ++k) {
          if (out > start[i] && column[out - 1] == column[k] && count[out - 1] < most) {
            ++count[out - 1];
          } else {
            column[out] = column[k];
            count[out++] = 1;
          }
        }
        distinct[i] = out - start[i];
        half.lines[i] = static_cast<float>(start[i + 1] - start[i]) + half.open_up[i] + half.open_down[i];
      }
    });
    near.start.assign(sides + 1, 0);
    for (std::size_t i = 0; i < sides; ++i) {
      near.start[i + 1] = near.start[i] + distinct[i];
      std::copy_n(column.begin() + start[i], distinct[i], column.begin() + near.start[i]);
      std::copy_n(count.begin() + start[i], distinct[i], count.begin() + near.start[i]);
    }
    column.resize(near.start[sides]);
    count.resize(near.start[sides]);
    column.shrink_to_fit();
    count.shrink_to_fit();
    near.column = std::move(column);
    near.count = std::move(count);
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
    far_.first_link.assign(tree_->size() + 1, 0);
    for (const auto& m : merged_) {
      ++far_.first_link[m.low + 1];
      ++far_.first_link[m.high + 1];
    }
    for (std::size_t i = 0; i < tree_->size(); ++i) far_.first_link[i + 1] += far_.first_link[i];
    far_.links.resize(far_.first_link.back());
    std::vector<std::uint32_t> cursor(far_.first_link.begin(), far_.first_link.end() - 1);
    for (const auto& m : merged_) {
      const auto above = static_cast<std::uint16_t>(2 * m.bin), below = static_cast<std::uint16_t>(2 * m.bin + 1);
      far_.links[cursor[m.low]++] = {m.high * channels + below, m.count, above};
      far_.links[cursor[m.high]++] = {m.low * channels + above, m.count, below};
    }
    merged_ = {};
    half.far = std::move(far_);
  }

  struct MergedLink {
    std::uint32_t low, high;
    std::uint16_t count, bin;
  };

  const Elements& e_;
  const ClusterTree* tree_;
  const SunReflection& sun_;
  std::vector<float> reflection_, withheld_;
  std::vector<double> escaped_;
  std::vector<FirstReflection> enclosed_reflections_;
  std::vector<float> open_up_, open_down_;
  std::vector<std::uint32_t> enclosed_up_, enclosed_down_;
  std::vector<std::vector<SidePair>> near_;
  FarField far_;
  std::vector<MergedLink> merged_;
  std::vector<std::uint32_t> by_node_, other_;
};

/// Do at least 5 % of the lines between elements run far?
bool clusters_pay(const std::vector<DirectionLines>& found) {
  std::size_t near = 0, far = 0;
  for (const auto& f : found) {
    near += f.near.size();
    far += f.far.size();
  }
  return 20 * far >= near + far;
}

std::size_t bytes_of_half(const HalfLinks& h) {
  return bytes_of(h.near.start) + bytes_of(h.near.column) + bytes_of(h.near.count) + bytes_of(h.far.of_side) + bytes_of(h.far.through) +
         bytes_of(h.far.linked) + bytes_of(h.far.first_link) + bytes_of(h.far.links) + bytes_of(h.lines) + bytes_of(h.open_up) +
         bytes_of(h.open_down) + bytes_of(h.first_reflection);
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

std::uint64_t LineLinks::link_count() const {
  std::uint64_t n = 0;
  for (const auto& h : half) n += h.near.column.size() + h.far.links.size();
  return n;
}

std::size_t LineLinks::bytes() const {
  return bytes_of_half(half[0]) + bytes_of_half(half[1]) + bytes_of(whole) + bytes_of(enclosed_part) + bytes_of(enclosed);
}

double line_batch(std::size_t elements, const RadiosityDensity& density) {
  const double expected = static_cast<double>(elements) * density.lines_per_element;
  return std::clamp(std::floor(4e6 / std::max(1.0, expected)), 2.0, 16.0);
}

LineLinks line_links(const Elements& e, const ClusterTree* tree, const SunReflection& sun, const RadiositySettings& settings,
                     Progress& progress) {
  const std::uint32_t directions = settings.density.directions;
  const double pitch = std::sqrt(0.5 * e.element_area / settings.density.lines_per_element);
  LineLinks links;
  std::vector<bool> interior;
  if (settings.method != RadiosityMethod::flat) interior = interior_sides(e, pitch, settings.seed, progress);
  LineCollector collector(e, tree, settings.density.link_error, std::move(interior), !sun.exitance.empty());
  std::optional<HalfBuilder> builder[2];
  // bin by bin, so that equal far links meet and are merged early
  std::vector<Vec3> direction(directions);
  std::vector<std::vector<std::uint32_t>> bins(direction_bins);
  for (std::uint32_t d = 0; d < directions; ++d) {
    direction[d] = hemisphere_direction(d, directions, mix(settings.seed, line_stream));
    bins[bin_of(direction[d])].push_back(d);
  }
  std::uint32_t done = 0;
  // a batch of directions, mostly of one bin, keeps the threads busy; its fragments wait in memory to be sorted into links
  std::vector<std::uint32_t> queue;
  for (const auto& bin : bins) queue.insert(queue.end(), bin.begin(), bin.end());
  const auto batch_size = static_cast<std::size_t>(line_batch(e.size(), settings.density));
  for (std::size_t first = 0; first < queue.size(); first += batch_size) {
    const std::vector<std::uint32_t> batch(queue.begin() + static_cast<std::ptrdiff_t>(first),
                                           queue.begin() + static_cast<std::ptrdiff_t>(std::min(queue.size(), first + batch_size)));
    std::vector<DirectionLines> found(batch.size());
    std::vector<double> line_area(batch.size());
    tbb::parallel_for(std::size_t{0}, batch.size(), [&](std::size_t i) {
      if (progress.cancelled()) return;
      thread_local LineBundle bundle;
      const auto d = batch[i];
      const auto p = project_set_member(e.surface, direction[d], d, pitch, mix(settings.seed, line_stream, 1));
      line_area[i] = p.line_area;
      trace_lines(e.surface, p, bundle);
      collector.collect(bundle, found[i]);
      found[i].outside = outside_focus(e.surface, p);
    });
    progress.check();
    // a side of area A meets A D / (2 line area) lines
    for (const double a : line_area) links.area_of_line += 2.0 * a / (static_cast<double>(directions) * directions);
    if (first == 0) {
      // where hardly a line of the first batch runs far, clusters cost more than they save
      if (tree && !clusters_pay(found)) {
        tree = nullptr;
        collector.forget_clusters();
        for (auto& f : found) {
          for (const auto& p : f.far) f.near.push_back({p.low, p.high});
          f.far.clear();
        }
      }
      links.clustered = tree != nullptr;
      for (auto& b : builder) b.emplace(e, tree, sun);
    }
    for (const auto& f : found) links.fragments += f.near.size() + f.far.size() + f.open_up.size();
    const auto add = [&](std::uint32_t h) {
      for (std::size_t i = 0; i < batch.size();) {
        const auto bin = bin_of(direction[batch[i]]);
        std::vector<DirectionLines*> mine;
        for (; i < batch.size() && bin_of(direction[batch[i]]) == bin; ++i)
          if (batch[i] % 2 == h) mine.push_back(&found[i]);
        builder[h]->add_bin(bin, mine);
      }
    };
    tbb::parallel_invoke([&] { add(0); }, [&] { add(1); });
    done += static_cast<std::uint32_t>(batch.size());
    progress.fraction("lines", static_cast<double>(done) / directions);
  }
  links.whole.resize(e.size());
  std::iota(links.whole.begin(), links.whole.end(), 0u);
  links.enclosed = collector.enclosed();
  if (!links.enclosed.empty()) {
    links.enclosed_part.assign(e.size(), LineLinks::none);
    for (std::size_t c = 0; c < links.enclosed.size(); ++c) {
      auto& part = links.enclosed_part[e.element_of_cell[c]];
      if (links.enclosed[c] == 0.0f || part != LineLinks::none) continue;
      part = static_cast<std::uint32_t>(links.whole.size());
      links.whole.push_back(e.element_of_cell[c]);
    }
  }
  for (std::size_t h = 0; h < 2; ++h) links.half[h] = builder[h]->finish(links.sides(), links.enclosed_part);
  return links;
}

}  // namespace sunfleck
