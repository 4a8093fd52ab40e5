#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/scene/absorptance.hpp>
#include <sunfleck/solver/solution.hpp>

namespace sunfleck {

/// Rows that arrive, cut at copies.
class LightInMemory::Rows final : public IrradianceSink {
 public:
  Rows(const SolveStart& start, bool keeps_facets, FacetLight& facets, OrganLight& organs)
      : rows_(start.scene, start.rows), absorptance_(rows_.materials(), start.scene.band_count()), facets_(facets), organs_(organs) {
    const std::size_t s = start.scene.states.size(), b = start.scene.band_count(), m = start.rows.organs;
    states_ = s, bands_ = b;
    facets_ = {};
    organs_ = {};
    organs_.states = s, organs_.count = m, organs_.bands = b;
    organs_.irradiance.resize(s * m * 2 * b);
    organs_.absorbed.resize(s * m * b);
    organs_.sunlit.resize(s * m * 2);
    organs_.area.resize(m);
    name_organs(start.rows);
    if (!keeps_facets) return;
    const std::size_t n = start.rows.facets;
    facets_.states = s, facets_.count = n, facets_.bands = b;
    facets_.irradiance.resize(s * n * 2 * b);
    facets_.absorbed.resize(s * n * b);
    facets_.sunlit.resize(s * n * 2);
    facets_.area.resize(n);
    facets_.organ.resize(n);
  }

  void rows(const IrradianceRows& r) override {
    if (r.first_facet != next_ || r.count > rows_.placed().facets - next_) throw Error("rows of facets arrived out of their order");
    if (r.variance_of_absorbed && organs_.variance.empty()) {
      organs_.variance.resize(organs_.absorbed.size());
      facets_.variance.resize(facets_.absorbed.size());
    }
    for (std::size_t at = 0; at < r.count;) {
      const CopyFacet start = rows_.at(r.first_facet + at);
      const std::size_t count = std::min<std::size_t>(r.count - at, rows_.facet_count(start.copy) - start.facet);
      const std::uint64_t first_organ = rows_.first_organ(start.copy);
      rows_.visit(start.copy, start.facet, start.facet + count,
                  [&](std::uint64_t facet, const Triangle& corners, std::uint32_t material, std::uint32_t organ) {
                    add(r, at + (facet - start.facet), static_cast<float>(glm::length(area_vector(corners))), material,
                        first_organ + organ);
                  });
      at += count;
    }
    next_ += r.count;
  }

  /// Means and fractions from sums.
  void end() {
    if (next_ != rows_.placed().facets) throw Error("rows of facets are missing");
    for (std::size_t s = 0; s < states_; ++s)
      for (std::size_t o = 0; o < organs_.count; ++o) {
        const double area = organs_.area[o], scale = area > 0 ? 1.0 / area : 0.0;
        double* irradiance = &organs_.irradiance[(s * organs_.count + o) * 2 * bands_];
        for (std::size_t i = 0; i < 2 * bands_; ++i) irradiance[i] *= scale;
        for (std::size_t side = 0; side < 2; ++side) organs_.sunlit[(s * organs_.count + o) * 2 + side] *= scale;
      }
  }

 private:
  void name_organs(const PlacedScene& placed) {
    organs_.names = organ_names(rows_);
    organs_.placements = placed.paths;
    organs_.placements.push_back("ground");
    for (std::uint32_t c = 0; c <= placed.copies.size(); ++c)
      for (std::uint32_t k = 0; k < rows_.organ_count(c); ++k) {
        organs_.plant.push_back(rows_.is_ground(c) ? of_ground : placed.copies[c].plant);
        organs_.copy.push_back(c);
        organs_.member.push_back(k);
      }
  }

  /// The facet at place i of the rows.
  void add(const IrradianceRows& r, std::size_t i, float area, std::uint32_t material, std::uint64_t organ) {
    const std::size_t n = facets_.count, m = organs_.count, facet = r.first_facet + i;
    organs_.area[organ] += area;
    if (n > 0) facets_.area[facet] = area, facets_.organ[facet] = static_cast<std::uint32_t>(organ);
    for (std::size_t s = 0; s < states_; ++s) {
      const float* sides = r.irradiance + (s * r.count + i) * 2 * bands_;
      for (std::size_t b = 0; b < bands_; ++b) {
        const double front = sides[b], back = sides[bands_ + b];
        if (!std::isfinite(front) || !std::isfinite(back)) throw Error(fmt::format("the irradiance of facet {} is not finite", facet));
        const auto absorbed = static_cast<float>(absorptance_.absorbed(material, b, front, back));
        double* mean = &organs_.irradiance[(s * m + organ) * 2 * bands_ + b];
        mean[0] += area * front;
        mean[bands_] += area * back;
        organs_.absorbed[(s * m + organ) * bands_ + b] += double{area} * double{absorbed};
        if (n > 0) facets_.absorbed[(s * n + facet) * bands_ + b] = absorbed;
        if (r.variance_of_absorbed) {
          const float variance = r.variance_of_absorbed[(s * r.count + i) * bands_ + b];
          organs_.variance[(s * m + organ) * bands_ + b] += double{area} * area * variance;
          if (n > 0) facets_.variance[(s * n + facet) * bands_ + b] = variance;
        }
      }
      if (n > 0) std::copy_n(sides, 2 * bands_, &facets_.irradiance[(s * n + facet) * 2 * bands_]);
      if (!r.sunlit) continue;
      for (std::size_t side = 0; side < 2; ++side) {
        const float sunlit = r.sunlit[(s * r.count + i) * 2 + side];
        organs_.sunlit[(s * m + organ) * 2 + side] += double{area} * sunlit;
        if (n > 0) facets_.sunlit[(s * n + facet) * 2 + side] = sunlit;
      }
    }
  }

  FacetRows rows_;
  Absorptance absorptance_;
  FacetLight& facets_;
  OrganLight& organs_;
  std::size_t states_ = 0, bands_ = 0;
  std::uint64_t next_ = 0;
};

LightInMemory::LightInMemory(bool keeps_facets) : keeps_facets_(keeps_facets) {}
LightInMemory::~LightInMemory() = default;

IrradianceSink& LightInMemory::begin(const SolveStart& start) {
  wanted_ = start.totals;
  rows_ = std::make_unique<Rows>(start, keeps_facets_, facets, organs);
  return *rows_;
}

void LightInMemory::end(Progress&) {
  rows_->end();
  rows_.reset();
  totals_ = OrganTotals(organs.states, organs.bands, wanted_);
  const std::size_t b = organs.bands, k = totals_.organs.size();
  const auto irradiance = [&](std::size_t s, std::size_t o, std::size_t i) {
    return organs.area[o] * organs.irradiance[(s * organs.count + o) * 2 * b + i];
  };
  for (std::size_t o = 0; o < organs.count; ++o) {
    if (organs.plant[o] == of_ground) continue;
    totals_.plant_area += organs.area[o];
    for (std::size_t s = 0; s < organs.states; ++s)
      for (std::size_t i = 0; i < b; ++i) {
        totals_.plant_irradiance[s * b + i] += irradiance(s, o, i) + irradiance(s, o, b + i);
        totals_.plant_absorbed[s * b + i] += organs.absorbed_in(o, i, s);
      }
  }
  for (std::size_t j = 0; j < k; ++j) {
    const auto o = totals_.organs[j];
    totals_.area[j] = organs.area[o];
    for (std::size_t s = 0; s < organs.states; ++s) {
      for (std::size_t i = 0; i < 2 * b; ++i) totals_.irradiance[(s * k + j) * 2 * b + i] = irradiance(s, o, i);
      for (std::size_t i = 0; i < b; ++i) totals_.absorbed[(s * k + j) * b + i] = organs.absorbed_in(o, i, s);
    }
  }
}

const OrganTotals& LightInMemory::totals() const {
  return totals_;
}

void LightInMemory::finish(const SolveReport&, const Certificate*) {}

Solution solve(const Scene& scene, const RunSettings& run, Progress& progress, bool facets) {
  LightInMemory light(facets);
  Solution solution{solve(scene, run, light, progress), {}, {}};
  solution.facets = std::move(light.facets);
  solution.organs = std::move(light.organs);
  return solution;
}

}  // namespace sunfleck
