#include <sunfleck/result/result_writer.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/core.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/core/sha256.hpp>
#include <sunfleck/scene/absorptance.hpp>

#include "result/describe_scene.hpp"
#include "result/band_units.hpp"
#include "result/finish_result.hpp"
#include "result/height_profile.hpp"
#include "result/organ_rows.hpp"
#include "result/write_devices.hpp"

namespace sunfleck {

using h5::Id;
using h5::RowDataset;

namespace {

std::vector<std::string> checked_fields(const OutputChoice& output, const Scene& scene) {
  const auto& known = output_fields();
  for (const auto& field : output.fields)
    if (std::find(known.begin(), known.end(), field) == known.end()) {
      const std::string nearest = nearest_name(field, known);
      throw InputError(location(scene.file, 0, "output.fields"), "\"" + field + "\"",
                       nearest.empty() ? "one of " + joined(known) : "a dataset of the result, such as \"" + nearest + "\"");
    }
  return output.fields;
}

}  // namespace

/// /facets and the sums: rows come in, are cut at copies, and go to the file.
class ResultWriter::Impl {
 public:
  Impl(const std::string& path, const Scene& scene, const PlacedScene& placed, const OutputChoice& output,
       const std::string& software_version, const std::string& method)
      : rows_(scene, placed),
        fields_(checked_fields(output, scene)),
        states_(scene.states.size()),
        bands_(scene.band_count()),
        absorptance_(rows_.materials(), bands_),
        file_(path),
        queue_(file_),
        names_(organ_names(rows_)) {
    const h5::Quiet quiet;
    profile_ = HeightProfile(rows_, states_, bands_);
    for (const auto& m : rows_.materials()) is_leaf_.push_back(m.counts_as_leaf);
    std::vector<std::string> plants;
    for (const auto& entry : scene.plants) plants.push_back(entry.name);
    shares_ = PlantShares(states_, bands_, std::move(plants));

    h5::write_attribute(file_, file_.id(), "format", "sunfleck-result");
    h5::write_attribute(file_, file_.id(), "format_version", std::uint64_t{1});
    h5::write_attribute(file_, file_.id(), "software_version", software_version);
    h5::write_attribute(file_, file_.id(), "method", method);
    h5::write_attribute(file_, file_.id(), "scene", scene.text);
    h5::write_attribute(file_, file_.id(), "scene_file", scene.file);
    h5::write_attribute(file_, file_.id(), "scene_sha256", sha256_hex(scene.text));

    h5::ArrayWriter arrays(file_, queue_);
    h5::write_light_and_optics(file_, arrays, scene, rows_.materials());
    h5::write_lamps(file_, arrays, scene);
    h5::write_names(file_, arrays, names_, placed.paths);
    if (keeps("geometry")) h5::write_geometry(file_, arrays, scene, placed);
    organs_.emplace(file_, queue_, rows_, names_, states_, bands_, [this](const char* name) { return keeps(name); });
    if (output.facets) begin_facets();
    organs_->begin(copy_);
    end_complete_copies();
  }

  void keep_totals(std::vector<std::uint64_t> organs) {
    if (next_facet_ > 0) throw Error("organs whose totals are to be kept must be named before the first rows");
    if (!std::is_sorted(organs.begin(), organs.end()) || (!organs.empty() && organs.back() >= rows_.placed().organs))
      throw Error("organs whose totals are to be kept must be rows of the scene, rising");
    organs_->totals = OrganTotals(states_, bands_, std::move(organs));
  }

  void rows(const IrradianceRows& r) {
    const h5::Quiet quiet;
    const std::uint64_t facets = rows_.placed().facets;
    if (r.first_facet != next_facet_ || r.count > facets - next_facet_)
      throw Error(fmt::format("{}: rows {} to {} of {} facets arrived where row {} was due", file_.path(), r.first_facet,
                              r.first_facet + r.count, facets, next_facet_));
    constexpr std::uint64_t piece = 16384;  // scratch of a few MB, however many rows come at once
    for (std::size_t at = 0; at < r.count;) {
      const std::uint64_t first = next_facet_ - rows_.first_facet(copy_);
      const std::uint64_t count = std::min({piece, rows_.facet_count(copy_) - first, std::uint64_t{r.count - at}});
      look_at(first, count);
      for (std::size_t s = 0; s < states_; ++s) state_rows(r, s, at, count);
      at += count;
      next_facet_ += count;
      end_complete_copies();
    }
  }

  const OrganTotals& totals() const { return organs_->totals; }
  const PlantShares& shares() const { return shares_; }

  void finish(const SolveReport& report, const Certificate* certificate) {
    const h5::Quiet quiet;
    if (next_facet_ != rows_.placed().facets)
      throw Error(fmt::format("{}: only {} of {} facets have values", file_.path(), next_facet_, rows_.placed().facets));
    const auto datasets = {&irradiance_, &absorbed_, &sunlit_, &variance_, &area_, &organ_, &centroid_};
    for (auto* dataset : datasets)
      if (!dataset->empty()) dataset->front().finish();
    organs_->finish();
    queue_.flush();
    for (auto* dataset : datasets) dataset->clear();
    organs_->close();

    h5::ArrayWriter arrays(file_, queue_);
    h5::write_structures(file_, arrays, report, rows_.scene(), rows_.placed());
    h5::write_report(file_, arrays, report, certificate, shares_, profile_, h5::power_unit(rows_.scene()));
    h5::write_sensors(file_, arrays, rows_.scene(), report.sensors);
    facets_group_.close();
    variance_group_.close();
    file_.commit();
  }

 private:
  bool keeps(const std::string& name) const { return fields_.empty() || std::find(fields_.begin(), fields_.end(), name) != fields_.end(); }

  void begin_facets() {
    bool any = false;
    for (const char* name : {"facets/irradiance", "facets/absorbed", "facets/sunlit", "facets/area", "facets/centroid", "facets/organ"})
      any = any || keeps(name);
    if (!any) return;
    facets_group_ = h5::make_group(file_, file_.id(), "facets");
    const std::size_t n = rows_.placed().facets;
    const auto begin = [&](std::vector<RowDataset>& dataset, const char* name, hid_t type, RowDataset::Shape shape,
                           const std::string& unit) {
      dataset.emplace_back(file_, queue_, facets_group_.get(), name + sizeof "facets/" - 1, type, shape, unit);
    };
    const auto states = [&](std::vector<std::size_t> inner) { return RowDataset::Shape{states_, n, std::move(inner)}; };
    const std::string per_area = h5::irradiance_unit(rows_.scene());
    if (keeps("facets/irradiance")) begin(irradiance_, "facets/irradiance", H5T_NATIVE_FLOAT, states({2, bands_}), per_area);
    if (keeps("facets/absorbed")) begin(absorbed_, "facets/absorbed", H5T_NATIVE_FLOAT, states({bands_}), per_area);
    if (keeps("facets/sunlit")) begin(sunlit_, "facets/sunlit", H5T_NATIVE_FLOAT, states({2}), "1");
    begin(area_, "facets/area", H5T_NATIVE_FLOAT, {0, n, {}}, "m^2");
    wide_organs_ = rows_.placed().organs > std::uint64_t{1} << 32;
    begin(organ_, "facets/organ", wide_organs_ ? H5T_NATIVE_UINT64 : H5T_NATIVE_UINT32, {0, n, {}}, "row of /organs");
    if (keeps("facets/centroid")) begin(centroid_, "facets/centroid", H5T_NATIVE_DOUBLE, {0, n, {3}}, "m");
  }

  /// What the geometry says of facets [first, first + count) of the copy, and its columns of /facets.
  void look_at(std::uint64_t first, std::uint64_t count) {
    facets_.clear();
    centroids_.clear();
    const bool plant = !rows_.is_ground(copy_);
    rows_.visit(copy_, first, first + count, [&](std::uint64_t, const Triangle& c, std::uint32_t material, std::uint32_t organ) {
      const auto area = static_cast<float>(glm::length(area_vector(c)));
      facets_.push_back({area, material, organ, plant ? static_cast<std::uint32_t>(profile_.layer(c)) : 0});
      organs_->add_area(organ, area);
      if (plant) profile_.add_area(facets_.back().layer, area);
      if (!centroid_.empty()) {
        const Vec3 p = (c[0] + c[1] + c[2]) / 3.0;
        centroids_.insert(centroids_.end(), {p.x, p.y, p.z});
      }
    });
    if (!facets_group_) return;
    if (!centroid_.empty()) centroid_.front().append(0, centroids_.data(), count);
    floats_.clear();
    for (const auto& f : facets_) floats_.push_back(f.area);
    area_.front().append(0, floats_.data(), count);
    const std::uint64_t first_organ = rows_.first_organ(copy_);
    if (wide_organs_) {
      std::vector<std::uint64_t> organs;
      for (const auto& f : facets_) organs.push_back(first_organ + f.organ);
      organ_.front().append(0, organs.data(), count);
    } else {
      organ_rows_.clear();
      for (const auto& f : facets_) organ_rows_.push_back(static_cast<std::uint32_t>(first_organ + f.organ));
      organ_.front().append(0, organ_rows_.data(), count);
    }
  }

  /// Rows [at, at + count) of one state, which are those that look_at() saw.
  void state_rows(const IrradianceRows& r, std::size_t s, std::size_t at, std::size_t count) {
    const float* irradiance = r.irradiance + (s * r.count + at) * 2 * bands_;
    const float* sunlit = r.sunlit ? r.sunlit + (s * r.count + at) * 2 : nullptr;
    const float* variance = r.variance_of_absorbed ? r.variance_of_absorbed + (s * r.count + at) * bands_ : nullptr;
    const bool plant = !rows_.is_ground(copy_);
    const std::size_t share = plant ? shares_.at(s, rows_.placed().copies[copy_].plant, 0) : 0;
    floats_.resize(count * bands_);
    for (std::size_t i = 0; i < count; ++i) {
      const Facet& facet = facets_[i];
      const double area = facet.area;
      double* of_plant = plant ? &(is_leaf_[facet.material] ? shares_.leaf : shares_.other)[share] : nullptr;
      for (std::size_t b = 0; b < bands_; ++b) {
        const double front = irradiance[(i * 2) * bands_ + b], back = irradiance[(i * 2 + 1) * bands_ + b];
        if (!std::isfinite(front) || !std::isfinite(back))
          throw Error(fmt::format("{}: the irradiance of facet {} is not finite", file_.path(), next_facet_ + i));
        const auto absorbed = static_cast<float>(absorptance_.absorbed(facet.material, b, front, back));
        floats_[i * bands_ + b] = absorbed;
        organs_->add_irradiance(s, facet.organ, 0, b, area * front);
        organs_->add_irradiance(s, facet.organ, 1, b, area * back);
        organs_->add_absorbed(s, facet.organ, b, area * double{absorbed});
        if (of_plant) of_plant[b] += area * double{absorbed};
        if (plant) profile_.add_absorbed(s, facet.layer, b, area * double{absorbed});
        if (variance) organs_->add_variance(s, facet.organ, b, area * area * double{variance[i * bands_ + b]});
      }
      if (sunlit)
        for (std::size_t side = 0; side < 2; ++side) organs_->add_sunlit(s, facet.organ, side, area * sunlit[i * 2 + side]);
    }
    if (!irradiance_.empty()) irradiance_.front().append(s, irradiance, count);
    if (!absorbed_.empty()) absorbed_.front().append(s, floats_.data(), count);
    if (!sunlit_.empty()) {
      if (!sunlit) floats_.assign(2 * count, 0.0f);  // of a method that leaves the sun out
      sunlit_.front().append(s, sunlit ? sunlit : floats_.data(), count);
    }
    if (variance && facets_group_ && keeps("variance/facets")) {
      if (variance_.empty()) {
        variance_group_ = h5::open_or_make_group(file_, file_.id(), "variance");
        variance_.emplace_back(file_, queue_, variance_group_.get(), "facets", H5T_NATIVE_FLOAT,
                               RowDataset::Shape{states_, rows_.placed().facets, {bands_}},
                               h5::squared(h5::irradiance_unit(rows_.scene())));
      }
      variance_.front().append(s, variance, count);
    }
  }

  void end_complete_copies() {
    while (copy_ <= rows_.placed().copies.size() && next_facet_ == rows_.first_facet(copy_) + rows_.facet_count(copy_)) {
      organs_->end();
      if (++copy_ <= rows_.placed().copies.size()) organs_->begin(copy_);
    }
  }

  struct Facet {
    float area;
    std::uint32_t material, organ, layer;
  };

  FacetRows rows_;
  std::vector<std::string> fields_;
  std::size_t states_, bands_;
  Absorptance absorptance_;
  h5::OutputFile file_;
  h5::ChunkQueue queue_;
  OrganNames names_;
  Id facets_group_, variance_group_;
  std::vector<RowDataset> irradiance_, absorbed_, sunlit_, variance_, area_, organ_, centroid_;  ///< none or one each
  std::optional<h5::OrganRows> organs_;
  HeightProfile profile_;
  PlantShares shares_;
  std::vector<bool> is_leaf_;  ///< [material]
  bool wide_organs_ = false;
  std::uint64_t next_facet_ = 0;
  std::uint32_t copy_ = 0;  ///< that next_facet_ belongs to
  // Of the piece at hand:
  std::vector<Facet> facets_;
  std::vector<double> centroids_;
  std::vector<float> floats_;
  std::vector<std::uint32_t> organ_rows_;
};

ResultWriter::ResultWriter(const std::string& file, const Scene& scene, const PlacedScene& placed, const OutputChoice& output,
                           const std::string& software_version, const std::string& method)
    : impl_(std::make_unique<Impl>(file, scene, placed, output, software_version, method)) {}
ResultWriter::~ResultWriter() = default;

void ResultWriter::rows(const IrradianceRows& rows) {
  impl_->rows(rows);
}
void ResultWriter::keep_totals(std::vector<std::uint64_t> organs) {
  impl_->keep_totals(std::move(organs));
}
const OrganTotals& ResultWriter::totals() const {
  return impl_->totals();
}
const PlantShares& ResultWriter::plant_shares() const {
  return impl_->shares();
}
void ResultWriter::finish(const SolveReport& report, const Certificate* certificate) {
  impl_->finish(report, certificate);
}

}  // namespace sunfleck
