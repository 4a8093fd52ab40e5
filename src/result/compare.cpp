#include <sunfleck/result/compare.hpp>

#include <algorithm>
#include <cmath>

#include <sunfleck/result/scene_match.hpp>

namespace sunfleck {

namespace {

constexpr double least_absorbed = 1e-6;  // of the incident light; below it irradiance is compared
constexpr std::size_t rows_at_once = std::size_t{1} << 18;

/// The sums of BandError's formulas.
struct Sums {
  double weight = 0, reference = 0, difference = 0, squares = 0, variance = 0, maximum = 0;
  std::size_t count = 0;

  void add(double w, double x, double r, double var) {
    const double d = x - r;
    weight += w;
    reference += w * r;
    difference += w * d;
    squares += w * d * d;
    variance += w * var;
    maximum = std::max(maximum, std::abs(d));
    ++count;
  }
  void add(const Sums& other) {
    weight += other.weight;
    reference += other.reference;
    difference += other.difference;
    squares += other.squares;
    variance += other.variance;
    maximum = std::max(maximum, other.maximum);
    count += other.count;
  }
  BandError error(bool irradiance) const {
    BandError e;
    e.irradiance = irradiance;
    e.count = count;
    if (weight <= 0) return e;
    e.mean = reference / weight;
    if (e.mean <= 0) return e;
    e.bias = difference / weight / e.mean;
    e.rmse = std::sqrt(std::max(0.0, squares / weight - variance / weight)) / e.mean;
    e.maximum = maximum / e.mean;
    e.noise = std::sqrt(variance / weight) / e.mean;
    return e;
  }
};

class Comparing {
 public:
  Comparing(const Result& result, const Result& reference)
      : x_(result), r_(reference), states_(reference.states().size()), bands_(reference.bands().size()) {
    choose_quantities();
  }

  ErrorTable organs() const {
    return table("organs", "variance/organs", r_.organ_count(), true, [&](std::size_t first, std::size_t count) {
      auto weights = r_.rows<float>("organs/area", first, count);
      const auto structure = r_.rows<std::uint32_t>("organs/structure", first, count);
      for (std::size_t i = 0; i < count; ++i)
        if (structure[i] == no_parent) weights[i] = 0.0f;
      return weights;
    });
  }

  ErrorTable facets() const {
    const std::size_t n = std::min(r_.facet_count(), x_.facet_count());
    if (n == 0) return {};
    for (const auto* file : {&x_, &r_})
      if (!file->has("facets/absorbed") || (any_irradiance_ && !file->has("facets/irradiance"))) return {};
    return table("facets", "variance/facets", n, false, [&](std::size_t first, std::size_t count) {
      auto weights = r_.rows<float>("facets/area", first, count);
      const auto organ = r_.facet_organs(first, count);
      // Facets that follow each other have organs that do: read those only.
      const auto [low, high] = std::minmax_element(organ.begin(), organ.end());
      const auto structure = r_.rows<std::uint32_t>("organs/structure", *low, *high - *low + 1);
      for (std::size_t i = 0; i < count; ++i)
        if (structure[organ[i] - *low] == no_parent) weights[i] = 0.0f;
      return weights;
    });
  }

 private:
  /// Absorbed or irradiance, per state and band and for all states together.
  void choose_quantities() {
    const auto balance = r_.balance();
    const auto dark = [](double leaves, double incident) { return incident > 0 && leaves < least_absorbed * incident; };
    for (std::size_t b = 0; b < bands_; ++b) {
      double leaves = 0, incident = 0;
      for (std::size_t s = 0; s < states_; ++s) {
        leaves += balance[s][b].leaves;
        incident += balance[s][b].incident;
        state_irradiance_.push_back(0);
      }
      overall_irradiance_.push_back(dark(leaves, incident));
      any_irradiance_ = any_irradiance_ || overall_irradiance_.back();
    }
    for (std::size_t s = 0; s < states_; ++s)
      for (std::size_t b = 0; b < bands_; ++b) {
        state_irradiance_[s * bands_ + b] = dark(balance[s][b].leaves, balance[s][b].incident);
        any_irradiance_ = any_irradiance_ || state_irradiance_[s * bands_ + b];
      }
  }

  /// `power`: absorbed is in W and becomes W m^-2 (and its variance likewise). `weights(first, count)`
  /// are the areas of rows, 0 = not compared.
  template <class Weights>
  ErrorTable table(const std::string& group, const std::string& variance, std::size_t rows, bool power, Weights weights) const {
    std::vector<Sums> absorbed(states_ * bands_), irradiance(states_ * bands_);
    for (std::size_t s = 0; s < states_; ++s)
      for (std::size_t first = 0; first < rows; first += rows_at_once) {
        const std::size_t count = std::min(rows_at_once, rows - first);
        const std::vector<float> areas = weights(first, count);
        const auto read = [&](const Result& file, const std::string& name) { return file.state_rows<float>(name, s, first, count); };
        const auto x = read(x_, group + "/absorbed"), r = read(r_, group + "/absorbed");
        std::vector<float> no_values;
        const auto var_x = x_.has(variance) ? read(x_, variance) : no_values, var_r = r_.has(variance) ? read(r_, variance) : no_values;
        const auto e_x = any_irradiance_ ? read(x_, group + "/irradiance") : no_values,
                   e_r = any_irradiance_ ? read(r_, group + "/irradiance") : no_values;
        for (std::size_t i = 0; i < count; ++i) {
          const double w = areas[i];
          if (w <= 0) continue;
          const double scale = power ? 1.0 / w : 1.0;
          for (std::size_t b = 0; b < bands_; ++b) {
            const std::size_t at = i * bands_ + b, front = 2 * i * bands_ + b, back = front + bands_;
            const double var = (var_x.empty() ? 0.0 : var_x[at]) + (var_r.empty() ? 0.0 : var_r[at]);
            absorbed[s * bands_ + b].add(w, x[at] * scale, r[at] * scale, var * scale * scale);
            if (any_irradiance_) irradiance[s * bands_ + b].add(w, double{e_x[front]} + e_x[back], double{e_r[front]} + e_r[back], 0.0);
          }
        }
      }
    ErrorTable out;
    for (std::size_t b = 0; b < bands_; ++b) {
      Sums all;
      for (std::size_t s = 0; s < states_; ++s) all.add(overall_irradiance_[b] ? irradiance[s * bands_ + b] : absorbed[s * bands_ + b]);
      out.overall.push_back(all.error(overall_irradiance_[b]));
    }
    for (std::size_t s = 0; s < states_; ++s) {
      auto& row = out.states.emplace_back();
      for (std::size_t b = 0; b < bands_; ++b) {
        const bool e = state_irradiance_[s * bands_ + b];
        row.push_back((e ? irradiance : absorbed)[s * bands_ + b].error(e));
      }
    }
    return out;
  }

  const Result& x_;
  const Result& r_;
  std::size_t states_, bands_;
  std::vector<char> overall_irradiance_, state_irradiance_;  ///< [b], [s][b]
  bool any_irradiance_ = false;
};

}  // namespace

Comparison compare(const Result& result, const Result& reference, bool places) {
  auto notes = check_same_scene(result, reference, places);
  const Comparing comparing(result, reference);
  return {comparing.organs(), comparing.facets(), std::move(notes)};
}

}  // namespace sunfleck
