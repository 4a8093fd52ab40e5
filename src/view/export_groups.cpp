// Tables of sums over organs that have something in common.
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <optional>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/replaced_file.hpp>
#include <sunfleck/view/export.hpp>

#include "view/organ_keys.hpp"

namespace sunfleck {

namespace {

constexpr std::size_t grouped_at_once = std::size_t{1} << 16;
constexpr std::size_t layers_without_depth = 20;
constexpr std::size_t most_layers = 1000000;

/// Sums of a group: count, area, then per state absorbed [b], area x irradiance [2 b], area x sunlit [2].
class Sums {
 public:
  Sums(const Result& result, const KeptValues& kept)
      : kept_(kept), bands_(result.bands().size()), states_(result.states().size()), stride_(2 + states_ * (3 * bands_ + 2)) {}

  std::size_t row(const std::vector<std::uint32_t>& key) {
    const auto [at, added] = rows_.try_emplace(key, rows_.size());
    if (added) sums_.resize(sums_.size() + stride_, 0.0);
    return at->second;
  }
  const std::map<std::vector<std::uint32_t>, std::size_t>& rows() const { return rows_; }

  void count(std::size_t row, double area) {
    sums_[row * stride_] += 1;
    sums_[row * stride_ + 1] += area;
  }
  /// Row i of values; `power` is the area by which absorbed is still to be multiplied (facets), or 1 (organs).
  void add(std::size_t row, std::size_t state, const LightBlock& values, std::size_t i, double area, double power) {
    double* s = &sums_[row * stride_ + 2 + state * (3 * bands_ + 2)];
    for (std::size_t b = 0; b < bands_ && kept_.absorbed; ++b) s[b] += power * values.absorbed[i * bands_ + b];
    for (std::size_t k = 0; k < 2 * bands_ && kept_.irradiance; ++k) s[bands_ + k] += area * values.irradiance[i * 2 * bands_ + k];
    for (std::size_t k = 0; k < 2 && kept_.sunlit; ++k) s[3 * bands_ + k] += area * values.sunlit[2 * i + k];
  }

  void write(fmt::memory_buffer& text, std::size_t row, const std::vector<LightState>& states) const {
    const auto put = std::back_inserter(text);
    const double* s = &sums_[row * stride_];
    const double area = s[1];
    const auto mean = [&](double sum) { return static_cast<float>(area > 0 ? sum / area : 0.0); };
    fmt::format_to(put, "{},{}", static_cast<std::uint64_t>(s[0]), static_cast<float>(area));
    std::vector<double> energy(bands_, 0.0);
    s += 2;
    for (std::size_t state = 0; state < states_; ++state, s += 3 * bands_ + 2) {
      for (std::size_t b = 0; b < bands_; ++b) {
        energy[b] += s[b] * states[state].duration_s;
        if (kept_.absorbed) fmt::format_to(put, ",{}", static_cast<float>(s[b]));
        if (kept_.irradiance) fmt::format_to(put, ",{},{}", mean(s[bands_ + b]), mean(s[2 * bands_ + b]));
      }
      if (kept_.sunlit) fmt::format_to(put, ",{},{}", mean(s[3 * bands_]), mean(s[3 * bands_ + 1]));
    }
    if (kept_.sums)
      for (const double e : energy) fmt::format_to(put, ",{}", static_cast<float>(e));
    text.push_back('\n');
  }

 private:
  KeptValues kept_;
  std::size_t bands_, states_, stride_;
  std::map<std::vector<std::uint32_t>, std::size_t> rows_;
  std::vector<double> sums_;
};

class GroupTable {
 public:
  GroupTable(const Result& result, const std::string& by, Progress& progress) : result_(result), progress_(progress) {
    for (std::size_t begin = 0; begin <= by.size();) {
      const std::size_t end = std::min(by.find(',', begin), by.size());
      keys_.push_back(key_of(by.substr(begin, end - begin)));
      begin = end + 1;
    }
    for (std::size_t k = 0; k < keys_.size(); ++k)
      if (keys_[k].kind == GroupKeyKind::layer) {
        if (layer_) throw UsageError("--by: found two layers; expected one");
        layer_ = k;
      }
  }

  void write(const std::string& file) {
    const std::string source = layer_ ? "facets" : "organs";
    if (layer_ && !result_.has("facets/area"))
      throw InputError(location(result_.file(), 0, "/facets"), "nothing",
                       "values per facet for layers; the scene kept organs only ([output] facets = false)");
    const KeptValues kept = kept_values(result_, source);
    OrganKeys keys(result_, keys_);
    Sums sums(result_, kept);
    if (layer_)
      add_facets(keys, kept, sums);
    else
      add_organs(keys, kept, sums);

    ReplacedFile out(file);
    fmt::memory_buffer text;
    std::vector<std::string> head;
    for (std::size_t k = 0; k < keys_.size(); ++k)
      if (layer_ == k)
        head.insert(head.end(), {"z_low_m", "z_high_m"});
      else
        head.push_back(keys_[k].name);
    head.insert(head.end(), {source, "area_m2"});
    text.append(header_line(std::move(head), result_, kept));

    // sorted by the first key, then the second, ...
    std::vector<std::vector<std::uint32_t>> place;
    for (std::size_t k = 0; k < keys_.size(); ++k) place.push_back(layer_ == k ? std::vector<std::uint32_t>{} : keys.table(k).order());
    std::vector<std::pair<std::vector<std::uint32_t>, const std::vector<std::uint32_t>*>> rows;
    for (const auto& [key, row] : sums.rows()) {
      auto& sorted = rows.emplace_back(key, &key).first;
      for (std::size_t k = 0; k < keys_.size(); ++k)
        if (layer_ != k) sorted[k] = place[k][key[k]];
    }
    std::sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [sorted, key] : rows) {
      std::string line;
      for (std::size_t k = 0; k < keys_.size(); ++k) {
        if (k > 0) line += ',';
        line += layer_ == k ? fmt::format("{:.9g},{:.9g}", low_ + (*key)[k] * depth_, low_ + ((*key)[k] + 1) * depth_)
                            : keys.table(k).text((*key)[k]);
      }
      text.append(line + ",");
      sums.write(text, sums.rows().at(*key), result_.states());
    }
    out.write(text.data(), text.size());
    out.commit();
  }

 private:
  void add_organs(OrganKeys& keys, const KeptValues& kept, Sums& sums) {
    const std::size_t m = result_.organ_count();
    for (std::size_t first = 0; first < m; first += grouped_at_once) {
      progress_.check();
      const std::size_t count = std::min(grouped_at_once, m - first);
      const OrganBlock organs(result_, keys.names(), first, count);
      const auto area = result_.rows<float>("organs/area", first, count);
      std::vector<std::vector<std::uint32_t>> columns;
      for (std::size_t k = 0; k < keys_.size(); ++k) columns.push_back(keys.rows(k, organs));
      std::vector<std::size_t> group(count);
      std::vector<std::uint32_t> key(keys_.size());
      for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t k = 0; k < keys_.size(); ++k) key[k] = columns[k][i];
        group[i] = sums.row(key);
        sums.count(group[i], area[i]);
      }
      for (std::size_t s = 0; s < result_.states().size(); ++s) {
        const LightBlock values(result_, "organs", kept, s, first, count);
        for (std::size_t i = 0; i < count; ++i) sums.add(group[i], s, values, i, area[i], 1.0);
      }
      progress_.fraction("export", static_cast<double>(first + count) / static_cast<double>(m));
    }
  }

  /// Heights of the centroids of plant facets [first, first + count).
  std::vector<double> heights(const ResultGeometry* geometry, std::size_t first, std::size_t count) const {
    std::vector<double> z(count);
    if (geometry) {
      const auto corners = geometry->corners(first, count);
      for (std::size_t i = 0; i < count; ++i) z[i] = (corners[i][0].z + corners[i][1].z + corners[i][2].z) / 3;
    } else {
      const auto centroid = result_.rows<double>("facets/centroid", first, count);
      for (std::size_t i = 0; i < count; ++i) z[i] = centroid[3 * i + 2];
    }
    return z;
  }

  void add_facets(OrganKeys& keys, const KeptValues& kept, Sums& sums) {
    std::optional<ResultGeometry> geometry;
    if (!result_.has("facets/centroid")) geometry = result_.geometry();
    const ResultGeometry* meshes = geometry ? &*geometry : nullptr;
    const std::size_t n = plant_facets();
    double top = -std::numeric_limits<double>::infinity();
    low_ = std::numeric_limits<double>::infinity();
    each(n, 0.0, 0.3, [&](std::size_t first, std::size_t count) {
      for (const double z : heights(meshes, first, count)) low_ = std::min(low_, z), top = std::max(top, z);
    });
    if (n == 0) low_ = top = 0;
    depth_ = keys_[*layer_].depth;
    if (depth_ > 0) {  // layers begin at multiples of their depth
      low_ = std::floor(low_ / depth_) * depth_;
    } else {
      depth_ = (top - low_) / layers_without_depth;
      if (!(depth_ > 0)) depth_ = 1;
    }
    if ((top - low_) / depth_ > most_layers)
      throw UsageError(
          fmt::format("--by: found layers of {:g} m in plants of {:g} m; expected at most {} layers", depth_, top - low_, most_layers));
    const std::size_t last = static_cast<std::size_t>(std::max(0.0, std::ceil((top - low_) / depth_) - (keys_[*layer_].depth > 0 ? 0 : 1)));

    // other keys are the organ's; one row number an organ is kept for each of them
    std::vector<std::vector<std::uint32_t>> columns(keys_.size());
    if (keys_.size() > 1)
      for (std::size_t first = 0; first < result_.organ_count(); first += grouped_at_once) {
        const OrganBlock organs(result_, keys.names(), first, std::min(grouped_at_once, result_.organ_count() - first));
        for (std::size_t k = 0; k < keys_.size(); ++k) {
          if (layer_ == k) continue;
          const auto rows = keys.rows(k, organs);
          columns[k].insert(columns[k].end(), rows.begin(), rows.end());
        }
      }
    std::vector<std::uint32_t> key(keys_.size());
    each(n, 0.3, 1.0, [&](std::size_t first, std::size_t count) {
      const auto z = heights(meshes, first, count);
      const auto area = result_.rows<float>("facets/area", first, count);
      const auto organ = result_.facet_organs(first, count);
      std::vector<std::size_t> group(count);
      for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t k = 0; k < keys_.size(); ++k)
          key[k] = layer_ == k ? static_cast<std::uint32_t>(
                                     std::min<double>(std::max(0.0, std::floor((z[i] - low_) / depth_)), static_cast<double>(last)))
                               : columns[k][organ[i]];
        group[i] = sums.row(key);
        sums.count(group[i], area[i]);
      }
      for (std::size_t s = 0; s < result_.states().size(); ++s) {
        const LightBlock values(result_, "facets", kept, s, first, count);
        for (std::size_t i = 0; i < count; ++i) sums.add(group[i], s, values, i, area[i], area[i]);
      }
    });
  }

  std::size_t plant_facets() const {
    if (result_.has("geometry")) return result_.geometry().plant_facets;
    const std::size_t n = result_.facet_count();  // without geometry: up to the first facet of an organ without a structure
    for (std::size_t first = 0; first < n; first += grouped_at_once) {
      const std::size_t count = std::min(grouped_at_once, n - first);
      const auto organ = result_.facet_organs(first, count);
      for (std::size_t i = 0; i < count; ++i)
        if (result_.rows<std::uint32_t>("organs/structure", organ[i], 1).front() == no_parent) return first + i;
    }
    return n;
  }

  void each(std::size_t n, double begin, double end, const std::function<void(std::size_t, std::size_t)>& work) const {
    for (std::size_t first = 0; first < n; first += grouped_at_once) {
      progress_.check();
      const std::size_t count = std::min(grouped_at_once, n - first);
      work(first, count);
      progress_.fraction("export", begin + (end - begin) * static_cast<double>(first + count) / static_cast<double>(n));
    }
  }

  const Result& result_;
  Progress& progress_;
  std::vector<GroupKey> keys_;
  std::optional<std::size_t> layer_;  ///< which key
  double low_ = 0, depth_ = 1;        ///< of layers [m]
};

}  // namespace

void export_groups(const Result& result, const std::string& file, const std::string& by, Progress& progress) {
  GroupTable(result, by, progress).write(file);
}

}  // namespace sunfleck
