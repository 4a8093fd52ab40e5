#include "result/organ_rows.hpp"

#include "result/band_units.hpp"

namespace sunfleck::h5 {

namespace {

constexpr std::size_t name_length = sizeof "organs/" - 1;

}  // namespace

OrganRows::OrganRows(OutputFile& file, ChunkQueue& queue, const FacetRows& rows, const OrganNames& names, std::size_t states,
                     std::size_t bands, std::function<bool(const char*)> keeps)
    : totals(states, bands, {}),
      file_(file),
      queue_(queue),
      rows_(rows),
      names_(names),
      states_(states),
      bands_(bands),
      keeps_(std::move(keeps)),
      group_(make_group(file, file.id(), "organs")) {
  const std::size_t m = rows.placed().organs;
  const auto column = [&](std::vector<RowDataset>& dataset, const char* name, const char* unit) {
    dataset.emplace_back(file_, queue_, group_.get(), name, H5T_NATIVE_UINT32, RowDataset::Shape{0, m, {}}, unit);
  };
  column(name_, "name", "row of /names/organ");
  column(type_, "type", "row of /names/type");
  column(plant_, "plant", "row of /names/plant");
  column(placement_, "placement", "row of /names/placement");
  column(structure_, "structure", "row of the plant's structures in /geometry, 4294967295 = ground");
  area_rows_.emplace_back(file_, queue_, group_.get(), "area", H5T_NATIVE_FLOAT, RowDataset::Shape{0, m, {}}, "m^2");
  const auto values = [&](std::vector<RowDataset>& dataset, const char* name, std::vector<std::size_t> inner, const std::string& unit) {
    if (keeps_(name))
      dataset.emplace_back(file_, queue_, group_.get(), name + name_length, H5T_NATIVE_FLOAT,
                           RowDataset::Shape{states_, m, std::move(inner)}, unit);
  };
  values(irradiance_rows_, "organs/irradiance", {2, bands_}, irradiance_unit(rows.scene()));
  values(absorbed_rows_, "organs/absorbed", {bands_}, power_unit(rows.scene()));
  values(sunlit_rows_, "organs/sunlit", {2}, "1");
}

void OrganRows::begin(std::uint32_t copy) {
  copy_ = copy;
  count_ = rows_.organ_count(copy);
  area_.assign(count_, 0.0);
  irradiance_.assign(states_ * count_ * 2 * bands_, 0.0);
  absorbed_.assign(states_ * count_ * bands_, 0.0);
  sunlit_.assign(states_ * count_ * 2, 0.0);
  variance_.clear();
}

void OrganRows::add_variance(std::size_t s, std::size_t organ, std::size_t b, double variance) {
  if (variance_.empty()) variance_.assign(states_ * count_ * bands_, 0.0);
  variance_[(s * count_ + organ) * bands_ + b] += variance;
}

void OrganRows::end() {
  if (count_ == 0) return;
  keep_totals();
  const bool ground = rows_.is_ground(copy_);
  const auto& columns = ground ? names_.ground : names_.of_plant[rows_.placed().copies[copy_].plant];
  name_.front().append(0, columns.name.data(), count_);
  type_.front().append(0, columns.type.data(), count_);
  structure_.front().append(0, columns.structure.data(), count_);
  std::vector<std::uint32_t> same(count_, columns.plant);
  plant_.front().append(0, same.data(), count_);
  same.assign(count_, copy_);
  placement_.front().append(0, same.data(), count_);

  floats_.assign(area_.begin(), area_.end());
  area_rows_.front().append(0, floats_.data(), count_);
  // sums[s][m][inner], divided by the organ's area if asked for; zero where there is no area.
  const auto append = [&](std::vector<RowDataset>& dataset, const std::vector<double>& sums, std::size_t inner, bool per_area) {
    if (dataset.empty()) return;
    floats_.resize(count_ * inner);
    for (std::size_t s = 0; s < states_; ++s) {
      const double* sum = &sums[s * count_ * inner];
      for (std::size_t i = 0; i < count_ * inner; ++i) {
        const double area = per_area ? area_[i / inner] : 1.0;
        floats_[i] = area > 0 ? static_cast<float>(sum[i] / area) : 0.0f;
      }
      dataset.front().append(s, floats_.data(), count_);
    }
  };
  append(irradiance_rows_, irradiance_, 2 * bands_, true);
  append(absorbed_rows_, absorbed_, bands_, false);
  append(sunlit_rows_, sunlit_, 2, true);
  if (!variance_.empty() && keeps_("variance/organs")) {
    if (variance_rows_.empty()) {
      variance_group_ = open_or_make_group(file_, file_.id(), "variance");
      variance_rows_.emplace_back(file_, queue_, variance_group_.get(), "organs", H5T_NATIVE_FLOAT,
                                  RowDataset::Shape{states_, rows_.placed().organs, {bands_}}, squared(power_unit(rows_.scene())));
    }
    append(variance_rows_, variance_, bands_, false);
  }
}

void OrganRows::keep_totals() {
  if (!rows_.is_ground(copy_)) {
    for (const double a : area_) totals.plant_area += a;
    for (std::size_t s = 0; s < states_; ++s)
      for (std::size_t o = 0; o < count_; ++o)
        for (std::size_t b = 0; b < bands_; ++b) {
          const double* sides = &irradiance_[(s * count_ + o) * 2 * bands_ + b];
          totals.plant_irradiance[s * bands_ + b] += sides[0] + sides[bands_];
          totals.plant_absorbed[s * bands_ + b] += absorbed_[(s * count_ + o) * bands_ + b];
        }
  }
  const std::uint64_t first = rows_.first_organ(copy_);
  const std::size_t kept = totals.organs.size();
  for (; next_total_ < kept && totals.organs[next_total_] < first + count_; ++next_total_) {
    const std::size_t organ = totals.organs[next_total_] - first;
    totals.area[next_total_] = area_[organ];
    for (std::size_t s = 0; s < states_; ++s) {
      for (std::size_t i = 0; i < 2 * bands_; ++i)
        totals.irradiance[(s * kept + next_total_) * 2 * bands_ + i] = irradiance_[(s * count_ + organ) * 2 * bands_ + i];
      for (std::size_t b = 0; b < bands_; ++b)
        totals.absorbed[(s * kept + next_total_) * bands_ + b] = absorbed_[(s * count_ + organ) * bands_ + b];
    }
  }
}

void OrganRows::finish() {
  for (auto* dataset :
       {&name_, &type_, &plant_, &placement_, &structure_, &area_rows_, &irradiance_rows_, &absorbed_rows_, &sunlit_rows_, &variance_rows_})
    if (!dataset->empty()) dataset->front().finish();
}

void OrganRows::close() {
  for (auto* dataset :
       {&name_, &type_, &plant_, &placement_, &structure_, &area_rows_, &irradiance_rows_, &absorbed_rows_, &sunlit_rows_, &variance_rows_})
    dataset->clear();
  group_.close();
  variance_group_.close();
}

}  // namespace sunfleck::h5
