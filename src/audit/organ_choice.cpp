#include <algorithm>
#include <cmath>

#include <sunfleck/audit/certificate.hpp>
#include <sunfleck/core/sampling.hpp>

#include "audit/organ_choice.hpp"

namespace sunfleck {

namespace {

/// Areas of the organs of one copy after another. A copy that is only turned, mirrored, moved and scaled takes its plant's.
class OrganAreas {
 public:
  explicit OrganAreas(const FacetRows& rows) : rows_(rows), of_plant_(rows.scene().plants.size()) {
    for (std::uint32_t c = 0; c < rows.placed().copies.size(); ++c) {
      auto& areas = of_plant_[rows.placed().copies[c].plant];
      const double square = square_of_scale(c);
      if (!areas.empty() || !(square > 0.0)) continue;
      areas = measure(c);
      for (auto& a : areas) a /= square;
    }
  }

  /// Calls visit(row of /organs, area) for all organs of plants with an area, rising.
  template <class Visit>
  void visit(Visit&& visit) const {
    std::vector<double> own;
    for (std::uint32_t c = 0; c < rows_.placed().copies.size(); ++c) {
      const auto& copy = rows_.placed().copies[c];
      double square = square_of_scale(c);
      const std::vector<double>* areas = &of_plant_[copy.plant];
      if (!(square > 0.0)) own = measure(c), areas = &own, square = 1.0;
      for (std::size_t o = 0; o < areas->size(); ++o)
        if (const double area = square * (*areas)[o]; static_cast<float>(area) > 0.0f) visit(copy.first_organ + o, area);
    }
  }

 private:
  /// Of the copy's map; 0 if it stretches.
  double square_of_scale(std::uint32_t copy) const {
    const Mat3& m = rows_.placed().copies[copy].map.linear;
    const Mat3 gram = glm::transpose(m) * m;
    const double square = (gram[0][0] + gram[1][1] + gram[2][2]) / 3.0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (!(std::abs(gram[i][j] - (i == j ? square : 0.0)) <= 1e-9 * square)) return 0.0;
    return square;
  }

  std::vector<double> measure(std::uint32_t copy) const {
    std::vector<double> areas(rows_.organ_count(copy), 0.0);
    rows_.visit(copy, 0, rows_.facet_count(copy), [&](std::uint64_t, const Triangle& corners, std::uint32_t, std::uint32_t organ) {
      areas[organ] += glm::length(area_vector(corners));
    });
    return areas;
  }

  const FacetRows& rows_;
  std::vector<std::vector<double>> of_plant_;  ///< at scale 1
};

/// One place drawn from each of equal stretches [k, k + 1) of a line on which members lie end to end, none longer than a stretch, and no
/// member twice: one that a border cuts keeps its probability a + b, as it is taken from the second stretch with b / (1 - a) if the first
/// has not taken it, and never if it has (J.-C. Deville 1998, Une nouvelle methode de tirage a probabilites inegales, INSEE).
/// Not steps of one length: in a stand of copies, steps of 3/5 of a copy would meet the same five organs in all of them.
class Stretches {
 public:
  Stretches(std::size_t count, std::uint64_t seed) : count_(count), random_(seed), place_(random_.next()) {}

  /// Is the next member drawn, which ends at `end`?
  bool draws(double end) {
    const double begin = end_;
    end_ = end;
    bool drawn = count_ > 0 && place_ >= begin && place_ < std::min(end, border_);
    if (end <= border_ || border_ >= static_cast<double>(count_)) return drawn;
    const double before = border_ - begin, after = std::min(end - border_, 1.0);
    const bool here = !drawn && random_.next() * (1.0 - before) < after;
    place_ = here ? begin : border_ + after + (1.0 - after) * random_.next();  // begin: behind all that follow
    border_ += 1.0;
    return drawn || here;
  }

 private:
  std::size_t count_;
  RandomStream random_;
  double place_, border_ = 1.0, end_ = 0.0;
};

/// Sampling of `wanted` members of a population, which `each(visit(member))` lists in the same order whenever it is called. Sizes are what
/// probabilities are proportional to; members of at least a stretch are certain.
template <class Each>
std::vector<ChosenOrgan> draw(Each&& each, std::uint32_t wanted, std::uint64_t seed) {
  double rest = 0.0, share = 0.0;
  std::size_t count = 0;
  std::vector<ChosenOrgan> large;  // a heap of the `wanted` largest, the smallest of them first
  const auto larger = [](const ChosenOrgan& a, const ChosenOrgan& b) { return a.size != b.size ? a.size > b.size : a.organ < b.organ; };
  each([&](const ChosenOrgan& c) {
    ++count;
    rest += c.size;
    share += c.share;
    if (large.size() == wanted && (large.empty() || !larger(c, large.front()))) return;
    large.push_back(c);
    std::push_heap(large.begin(), large.end(), larger);
    if (large.size() <= wanted) return;
    std::pop_heap(large.begin(), large.end(), larger);
    large.pop_back();
  });
  std::sort(large.begin(), large.end(), larger);
  // Those larger than the step are taken for sure; that makes the step for the others smaller, until none is left over.
  std::size_t places = wanted, certain = 0;
  if (count <= wanted) {
    certain = count;
  } else {
    for (; certain < large.size() && large[certain].size * static_cast<double>(places) >= rest; ++certain) {
      rest -= large[certain].size;
      --places;
    }
  }
  large.resize(certain);
  std::sort(large.begin(), large.end(), [](const auto& a, const auto& b) { return a.organ < b.organ; });

  std::vector<ChosenOrgan> chosen;
  const double step = rest / static_cast<double>(std::max<std::size_t>(places, 1));
  Stretches stretches(places, seed);
  double passed = 0.0, by_chance = share, drawn = 0.0;
  std::size_t sure = 0;
  each([&](ChosenOrgan c) {
    if (sure < large.size() && large[sure].organ == c.organ) {
      ++sure;
      c.certain = true;
      by_chance -= c.share;
      chosen.push_back(c);
      return;
    }
    passed += c.size;
    if (!stretches.draws(passed / step)) return;
    c.share /= c.size;
    c.size = step;  // were some of these drawn once more, all of them would have the same chance
    c.certain = false;
    drawn += c.share;
    chosen.push_back(c);
  });
  for (auto& c : chosen)
    if (!c.certain) c.share *= by_chance / drawn;
  return chosen;
}

}  // namespace

std::uint64_t certificate_seed(const CertificateSettings& settings) {
  return mix(settings.seed, 0x6365727469667921ULL);  // not the numbers of the solve, nor of the reference method
}

std::vector<ChosenOrgan> choose_organs(const FacetRows& rows, const CertificateSettings& settings) {
  const OrganAreas areas(rows);
  double total = 0.0;
  std::size_t count = 0;
  areas.visit([&](std::uint64_t, double area) { total += area, ++count; });
  if (count == 0) return {};
  const double mean = total / static_cast<double>(count);
  return draw(
      [&](auto&& visit) {
        areas.visit([&](std::uint64_t organ, double area) { visit(ChosenOrgan{organ, area / total, area + 3.0 * mean, false}); });
      },
      settings.organs, mix(certificate_seed(settings), 0));
}

std::vector<ChosenOrgan> choose_fewer(const std::vector<ChosenOrgan>& chosen, std::uint32_t wanted, const CertificateSettings& settings) {
  return draw(
      [&](auto&& visit) {
        for (const auto& c : chosen) visit(c);
      },
      wanted, mix(certificate_seed(settings), 1));
}

}  // namespace sunfleck
