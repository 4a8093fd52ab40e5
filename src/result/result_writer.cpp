#include <sunfleck/result/result_writer.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>

#include "result/describe_scene.hpp"
#include "result/finish_result.hpp"
#include "result/sha256.hpp"

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

class ResultWriter::Impl {
 public:
  Impl(const std::string& path, const Scene& scene, const FacetScene& facets, const OutputChoice& output,
       const std::string& software_version, const std::string& method)
      : scene_(scene), facets_(facets), fields_(checked_fields(output, scene)), keep_facets_(output.facets), file_(path), queue_(file_) {
    const h5::Quiet quiet;
    totals_.states = scene.states.size();
    totals_.organs = facets.organs.size();
    totals_.bands = facets.bands;
    totals_.irradiance.assign(totals_.states * totals_.organs * 2 * totals_.bands, 0.0);
    totals_.absorbed.assign(totals_.states * totals_.organs * totals_.bands, 0.0);
    totals_.sunlit.assign(totals_.states * totals_.organs * 2, 0.0);
    totals_.area.assign(totals_.organs, 0.0);
    for (std::size_t f = 0; f < facets.size(); ++f) totals_.area[facets.organ[f]] += facets.area[f];
    profile_ = HeightProfile(facets, totals_.states);
    for (const auto& m : facets.materials)
      for (std::size_t b = 0; b < totals_.bands; ++b) {
        absorptance_.push_back(1.0 - double{m.reflectance_front[b]} - double{m.transmittance[b]});
        absorptance_.push_back(1.0 - double{m.reflectance_back[b]} - double{m.transmittance[b]});
      }
    for (auto& a : absorptance_) a = std::max(a, 0.0);  // rho + tau = 1 in float may exceed 1 by a rounding

    h5::write_attribute(file_, file_.id(), "format", "sunfleck-result");
    h5::write_attribute(file_, file_.id(), "format_version", std::uint64_t{1});
    h5::write_attribute(file_, file_.id(), "software_version", software_version);
    h5::write_attribute(file_, file_.id(), "method", method);
    h5::write_attribute(file_, file_.id(), "scene", scene.text);
    h5::write_attribute(file_, file_.id(), "scene_file", scene.file);
    h5::write_attribute(file_, file_.id(), "scene_sha256", sha256_hex(scene.text));

    h5::ArrayWriter arrays(file_, queue_);
    h5::write_light_and_optics(file_, arrays, scene, facets);
    organs_group_ = h5::make_group(file_, file_.id(), "organs");
    h5::write_organ_names(file_, arrays, organs_group_.get(), facets);
    if (keeps("geometry")) h5::write_geometry(file_, arrays, scene, facets);
    if (keep_facets_) begin_facets(arrays);
  }

  void rows(const IrradianceRows& r) {
    const h5::Quiet quiet;
    if (r.first_facet != next_facet_ || r.count > facets_.size() - next_facet_)
      throw Error(fmt::format("{}: rows {} to {} of {} facets arrived where row {} was due", file_.path(), r.first_facet,
                              r.first_facet + r.count, facets_.size(), next_facet_));
    for (std::size_t s = 0; s < totals_.states; ++s) state_rows(r, s);
    next_facet_ += r.count;
  }

  const OrganTotals& totals() const { return totals_; }

  void finish(const SolveReport& report, const Certificate* certificate) {
    const h5::Quiet quiet;
    if (next_facet_ != facets_.size())
      throw Error(fmt::format("{}: only {} of {} facets have values", file_.path(), next_facet_, facets_.size()));
    for (auto* dataset : {&irradiance_, &absorbed_, &sunlit_, &variance_})
      if (!dataset->empty()) dataset->front().finish();
    queue_.flush();
    for (auto* dataset : {&irradiance_, &absorbed_, &sunlit_, &variance_}) dataset->clear();

    h5::ArrayWriter arrays(file_, queue_);
    h5::write_organ_values(arrays, organs_group_.get(), totals_, [&](const char* name) { return keeps(name); });
    if (!report.organ_variance.absorbed.empty() && keeps("variance/organs")) {
      if (!variance_group_) variance_group_ = h5::make_group(file_, file_.id(), "variance");
      arrays.write_states(variance_group_.get(), "organs", report.organ_variance.absorbed.data(),
                          {totals_.states, totals_.organs, totals_.bands}, "W^2");
      arrays.flush();
    }
    h5::write_report(file_, arrays, report, certificate, totals_, profile_);
    facets_group_.close();
    organs_group_.close();
    variance_group_.close();
    file_.commit();
  }

 private:
  bool keeps(const std::string& name) const { return fields_.empty() || std::find(fields_.begin(), fields_.end(), name) != fields_.end(); }

  void begin_facets(h5::ArrayWriter& arrays) {
    const std::size_t n = facets_.size(), s = totals_.states, b = totals_.bands;
    bool any = false;
    for (const char* name : {"facets/irradiance", "facets/absorbed", "facets/sunlit", "facets/area", "facets/centroid", "facets/organ"})
      any = any || keeps(name);
    if (!any) return;
    facets_group_ = h5::make_group(file_, file_.id(), "facets");
    const hid_t group = facets_group_.get();
    const auto begin = [&](std::vector<RowDataset>& dataset, const char* name, std::vector<std::size_t> inner, const char* unit) {
      if (keeps(name))
        dataset.emplace_back(file_, queue_, group, name + sizeof "facets/" - 1, H5T_NATIVE_FLOAT, RowDataset::Shape{s, n, std::move(inner)},
                             unit);
    };
    begin(irradiance_, "facets/irradiance", {2, b}, "W m^-2");
    begin(absorbed_, "facets/absorbed", {b}, "W m^-2");
    begin(sunlit_, "facets/sunlit", {2}, "1");
    arrays.write(group, "area", facets_.area, "m^2");
    arrays.write(group, "organ", facets_.organ, "row of /organs");
    if (keeps("facets/centroid")) {
      RowDataset centroid(file_, queue_, group, "centroid", H5T_NATIVE_DOUBLE, {0, n, {3}}, "m");
      for (const auto& c : facets_.corners) {
        const Vec3 p = (c[0] + c[1] + c[2]) / 3.0;
        const double row[3] = {p.x, p.y, p.z};
        centroid.append(0, row, 1);
      }
      centroid.finish();
      queue_.flush();
    }
    arrays.flush();
  }

  void state_rows(const IrradianceRows& r, std::size_t s) {
    const std::size_t bands = totals_.bands;
    const float* irradiance = r.irradiance + s * r.count * 2 * bands;
    const float* sunlit = r.sunlit ? r.sunlit + s * r.count * 2 : nullptr;
    absorbed_rows_.resize(r.count * bands);
    for (std::size_t i = 0; i < r.count; ++i) {
      const std::size_t facet = r.first_facet + i, organ = facets_.organ[facet];
      const double area = facets_.area[facet];
      double* organ_irradiance = &totals_.irradiance[(s * totals_.organs + organ) * 2 * bands];
      double* organ_absorbed = &totals_.absorbed[(s * totals_.organs + organ) * bands];
      for (std::size_t b = 0; b < bands; ++b) {
        const double front = irradiance[(i * 2) * bands + b], back = irradiance[(i * 2 + 1) * bands + b];
        if (!std::isfinite(front) || !std::isfinite(back))
          throw Error(fmt::format("{}: the irradiance of facet {} is not finite", file_.path(), facet));
        const double* absorptance = &absorptance_[(facets_.optics[facet] * bands + b) * 2];
        const auto absorbed = static_cast<float>(absorptance[0] * front + absorptance[1] * back);
        absorbed_rows_[i * bands + b] = absorbed;
        organ_irradiance[b] += area * front;
        organ_irradiance[bands + b] += area * back;
        organ_absorbed[b] += area * double{absorbed};
        if (facet < facets_.plant_facets) profile_.add_absorbed(s, facet, b, area * double{absorbed});
      }
      if (sunlit)
        for (std::size_t side = 0; side < 2; ++side) totals_.sunlit[(s * totals_.organs + organ) * 2 + side] += area * sunlit[i * 2 + side];
    }
    if (!irradiance_.empty()) irradiance_.front().append(s, irradiance, r.count);
    if (!absorbed_.empty()) absorbed_.front().append(s, absorbed_rows_.data(), r.count);
    if (sunlit && !sunlit_.empty()) sunlit_.front().append(s, sunlit, r.count);
    if (r.variance_of_absorbed && facets_group_ && keeps("variance/facets")) {
      if (variance_.empty()) {
        variance_group_ = h5::make_group(file_, file_.id(), "variance");
        variance_.emplace_back(file_, queue_, variance_group_.get(), "facets", H5T_NATIVE_FLOAT,
                               RowDataset::Shape{totals_.states, facets_.size(), {bands}}, "W^2 m^-4");
      }
      variance_.front().append(s, r.variance_of_absorbed + s * r.count * bands, r.count);
    }
  }

  const Scene& scene_;
  const FacetScene& facets_;
  std::vector<std::string> fields_;
  bool keep_facets_;
  h5::OutputFile file_;
  h5::ChunkQueue queue_;
  Id organs_group_, facets_group_, variance_group_;
  std::vector<RowDataset> irradiance_, absorbed_, sunlit_, variance_;  ///< none or one each
  OrganTotals totals_;
  HeightProfile profile_;
  std::vector<double> absorptance_;  ///< [material][b][front, back]
  std::vector<float> absorbed_rows_;
  std::size_t next_facet_ = 0;
};

ResultWriter::ResultWriter(const std::string& file, const Scene& scene, const FacetScene& facets, const OutputChoice& output,
                           const std::string& software_version, const std::string& method)
    : impl_(std::make_unique<Impl>(file, scene, facets, output, software_version, method)) {}
ResultWriter::~ResultWriter() = default;

void ResultWriter::rows(const IrradianceRows& rows) {
  impl_->rows(rows);
}
const OrganTotals& ResultWriter::totals() const {
  return impl_->totals();
}
void ResultWriter::finish(const SolveReport& report, const Certificate* certificate) {
  impl_->finish(report, certificate);
}

}  // namespace sunfleck
