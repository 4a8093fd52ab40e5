#include <sunfleck/result/result_reader.hpp>

#include <algorithm>

#include <fmt/core.h>

#include <sunfleck/core/error.hpp>

#include "result/dataset_reader.hpp"
#include "result/read_geometry.hpp"

namespace sunfleck {

namespace {

constexpr std::size_t most_rows = std::size_t{1} << 48;  // sizes and products of them stay far from wrapping around

}  // namespace

class Result::Impl {
 public:
  explicit Impl(const std::string& file) : reader(file) {
    if (!reader.has_attribute("/", "format") || reader.text_attribute("/", "format") != "sunfleck-result")
      throw InputError(file, "an HDF5 file without format = \"sunfleck-result\"", "a result file");
    if (const auto version = reader.count_attribute("/", "format_version"); version != 1)
      throw InputError(location(file, 0, "format_version"), std::to_string(version),
                       version > 1 ? "1: this program is older than the file" : "1, the only version there is");
    header.software_version = reader.text_attribute("/", "software_version");
    header.method = reader.text_attribute("/", "method");
    header.status = reader.text_attribute("/", "status");
    header.scene_text = reader.text_attribute("/", "scene");
    header.scene_file = reader.text_attribute("/", "scene_file");
    header.scene_sha256 = reader.text_attribute("/", "scene_sha256");
    bands = reader.strings("bands/name");
    band_units = reader.strings("bands/unit");
    if (bands.empty() || bands.size() != band_units.size())
      reader.fail("bands/unit", std::to_string(band_units.size()) + " rows", std::to_string(bands.size()));
    read_states();
    check_shapes();
  }

  void read_states() {
    const auto names = reader.strings("states/name"), models = reader.strings("states/sky_model");
    const std::size_t s = names.size(), b = bands.size();
    if (s == 0) reader.fail("states/name", "no state", "at least one");
    for (const char* name :
         {"states/duration", "states/sun_present", "states/sun_angular_diameter", "states/sky_present", "states/sky_model"})
      reader.expect(name, {s});
    reader.expect("states/sun_direction", {s, 3});
    for (const char* name : {"states/sun_irradiance", "states/sky_irradiance"}) reader.expect(name, {s, b});
    const auto duration = reader.all<double>("states/duration"), direction = reader.all<double>("states/sun_direction"),
               diameter = reader.all<double>("states/sun_angular_diameter"), sun = reader.all<double>("states/sun_irradiance"),
               sky = reader.all<double>("states/sky_irradiance");
    const auto has_sun = reader.all<std::uint8_t>("states/sun_present"), has_sky = reader.all<std::uint8_t>("states/sky_present");
    const auto band_values = [&](const std::vector<double>& all, std::size_t i) {
      const auto begin = all.begin() + static_cast<std::ptrdiff_t>(i * b);
      return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(b));
    };
    for (std::size_t i = 0; i < s; ++i) {
      LightState state;
      state.name = names[i];
      state.duration_s = duration[i];
      if (has_sun[i]) state.sun = Sun{{direction[i * 3], direction[i * 3 + 1], direction[i * 3 + 2]}, band_values(sun, i), diameter[i]};
      if (has_sky[i]) {
        state.sky.emplace();
        const auto model = sky_model_from_name(models[i]);
        if (!model) reader.fail("states/sky_model", "\"" + models[i] + "\"", "a sky model this program knows");
        state.sky->model = *model;
        state.sky->irradiance = band_values(sky, i);
      }
      states.push_back(std::move(state));
    }
  }

  void check_shapes() {
    const std::size_t s = states.size(), b = bands.size();
    const auto rows_of = [&](const std::string& name) {
      const auto dims = reader.shape(name);
      if (dims.size() != 1 || dims[0] > most_rows) reader.fail(name, h5::shape_text(dims), "one row each, at most 2^48");
      return dims[0];
    };
    organs = rows_of("organs/area");
    facets = reader.has("facets/area") ? rows_of("facets/area") : 0;
    const std::size_t m = organs, n = facets;
    const auto expect = [&](const char* name, const std::vector<std::size_t>& dims) {
      if (reader.has(name)) reader.expect(name, dims);
    };
    for (const char* name : {"organs/name", "organs/type", "organs/plant", "organs/placement", "organs/structure"})
      reader.expect(name, {m});
    expect("organs/irradiance", {s, m, 2, b});
    expect("organs/absorbed", {s, m, b});
    expect("organs/sunlit", {s, m, 2});
    expect("variance/organs", {s, m, b});
    if (!reader.has("facets/area")) return;
    reader.expect("facets/organ", {n});
    expect("facets/centroid", {n, 3});
    expect("facets/irradiance", {s, n, 2, b});
    expect("facets/absorbed", {s, n, b});
    expect("facets/sunlit", {s, n, 2});
    expect("variance/facets", {s, n, b});
  }

  h5::DatasetReader reader;
  ResultHeader header;
  std::vector<std::string> bands, band_units;
  std::vector<LightState> states;
  std::size_t facets = 0, organs = 0;
};

bool is_result(const std::string& file) {
  try {
    const h5::DatasetReader reader(file);
    return reader.has_attribute("/", "format") && reader.text_attribute("/", "format") == "sunfleck-result";
  } catch (const Error&) {
    return false;
  }
}

Result::Result(const std::string& file) : impl_(std::make_unique<Impl>(file)) {}
Result::~Result() = default;
Result::Result(Result&&) noexcept = default;
Result& Result::operator=(Result&&) noexcept = default;

const std::string& Result::file() const {
  return impl_->reader.path();
}
const ResultHeader& Result::header() const {
  return impl_->header;
}
const std::vector<std::string>& Result::bands() const {
  return impl_->bands;
}
const std::vector<std::string>& Result::band_units() const {
  return impl_->band_units;
}
const std::vector<LightState>& Result::states() const {
  return impl_->states;
}
std::size_t Result::facet_count() const {
  return impl_->facets;
}
std::size_t Result::organ_count() const {
  return impl_->organs;
}
bool Result::has(const std::string& dataset) const {
  return impl_->reader.has(dataset);
}
std::vector<std::size_t> Result::shape(const std::string& dataset) const {
  return impl_->reader.shape(dataset);
}
std::vector<std::string> Result::strings(const std::string& dataset) const {
  return impl_->reader.strings(dataset);
}

template <class T>
std::vector<T> Result::rows(const std::string& dataset, std::size_t first, std::size_t count) const {
  return impl_->reader.block<T>(dataset, {}, first, count);
}
template <class T>
std::vector<T> Result::state_rows(const std::string& dataset, std::size_t state, std::size_t first, std::size_t count) const {
  return impl_->reader.block<T>(dataset, {state}, first, count);
}
template <class T>
std::vector<T> Result::all(const std::string& dataset) const {
  return impl_->reader.all<T>(dataset);
}

#define SUNFLECK_INSTANTIATE(T)                                                                                   \
  template std::vector<T> Result::rows<T>(const std::string&, std::size_t, std::size_t) const;                    \
  template std::vector<T> Result::state_rows<T>(const std::string&, std::size_t, std::size_t, std::size_t) const; \
  template std::vector<T> Result::all<T>(const std::string&) const;
SUNFLECK_INSTANTIATE(float)
SUNFLECK_INSTANTIATE(double)
SUNFLECK_INSTANTIATE(std::uint8_t)
SUNFLECK_INSTANTIATE(std::uint32_t)
SUNFLECK_INSTANTIATE(std::uint64_t)
SUNFLECK_INSTANTIATE(std::int64_t)
#undef SUNFLECK_INSTANTIATE

OrganTable Result::organs() const {
  const auto& reader = impl_->reader;
  OrganTable table;
  table.names = reader.strings("names/organ");
  table.types = reader.strings("names/type");
  table.plants = reader.strings("names/plant");
  table.placements = reader.strings("names/placement");
  const auto column = [&](const char* name, const std::vector<std::string>& texts) {
    auto rows = reader.all<std::uint32_t>(name);
    for (const auto row : rows)
      if (row >= texts.size()) reader.fail(name, "row " + std::to_string(row), "a row below " + std::to_string(texts.size()));
    return rows;
  };
  table.name = column("organs/name", table.names);
  table.type = column("organs/type", table.types);
  table.plant = column("organs/plant", table.plants);
  table.placement = column("organs/placement", table.placements);
  table.structure = reader.all<std::uint32_t>("organs/structure");
  return table;
}

std::vector<Optics> Result::materials() const {
  const auto& reader = impl_->reader;
  const auto names = reader.strings("optics/name");
  const std::size_t b = impl_->bands.size();
  const auto column = [&](const char* name) {
    reader.expect(name, {names.size(), b});
    return reader.all<float>(name);
  };
  const auto front = column("optics/reflectance_front"), back = column("optics/reflectance_back"), through = column("optics/transmittance");
  const auto row = [&](const std::vector<float>& all, std::size_t i) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(i * b);
    return std::vector<float>(begin, begin + static_cast<std::ptrdiff_t>(b));
  };
  std::vector<Optics> out;
  for (std::size_t i = 0; i < names.size(); ++i) out.push_back({names[i], row(front, i), row(back, i), row(through, i)});
  return out;
}

std::vector<std::uint32_t> Result::facet_organs(std::size_t first, std::size_t count) const {
  auto organs = rows<std::uint32_t>("facets/organ", first, count);
  for (const auto o : organs)
    if (o >= impl_->organs) impl_->reader.fail("facets/organ", "row " + std::to_string(o), "a row below " + std::to_string(impl_->organs));
  return organs;
}

ResultGeometry Result::geometry() const {
  const auto& reader = impl_->reader;
  if (!reader.has("geometry")) reader.fail("geometry", "nothing", "meshes; [output] fields of the scene left them out");
  auto geometry = h5::read_geometry(reader, reader.strings("optics/name").size());
  if (reader.has("facets/area") && geometry.facet_count() != impl_->facets)
    reader.fail("geometry", std::to_string(geometry.facet_count()) + " facets", std::to_string(impl_->facets) + " as in /facets");
  return geometry;
}

std::vector<std::vector<Balance>> Result::balance() const {
  const auto& reader = impl_->reader;
  const std::size_t s = impl_->states.size(), b = impl_->bands.size();
  const auto column = [&](const char* name) {
    reader.expect(name, {s, b});
    return reader.all<double>(name);
  };
  const auto incident = column("balance/incident"), leaves = column("balance/leaves"), ground = column("balance/ground"),
             escaped = column("balance/escaped");
  const auto scale = reader.has("balance/scattered_scale") ? column("balance/scattered_scale") : std::vector<double>(s * b, 1.0);
  std::vector<std::vector<Balance>> out(s, std::vector<Balance>(b));
  for (std::size_t i = 0; i < s * b; ++i) out[i / b][i % b] = {incident[i], leaves[i], ground[i], escaped[i], scale[i]};
  return out;
}

StoredProfile Result::profile() const {
  const auto& reader = impl_->reader;
  StoredProfile out{reader.all<double>("balance/profile/height"), reader.all<double>("balance/profile/area"), {}};
  if (out.height.size() != out.area.size() + 1)
    reader.fail("balance/profile/height", std::to_string(out.height.size()) + " rows", std::to_string(out.area.size() + 1));
  reader.expect("balance/profile/absorbed", {impl_->states.size(), out.area.size(), impl_->bands.size()});
  out.absorbed = reader.all<double>("balance/profile/absorbed");
  return out;
}

std::vector<StoredLamp> Result::lamps() const {
  const auto& reader = impl_->reader;
  std::vector<StoredLamp> out;
  if (!reader.has("lamps")) return out;
  const std::size_t s = impl_->states.size(), b = impl_->bands.size();
  for (const auto& name : reader.strings("lamps/name")) out.push_back({name, 0, {}, {}});
  const std::size_t n = out.size();
  reader.expect("lamps/copies", {n});
  reader.expect("lamps/power", {n, b});
  reader.expect("lamps/shines", {s, n});
  const auto copies = reader.all<std::uint32_t>("lamps/copies");
  const auto power = reader.all<double>("lamps/power");
  const auto shines = reader.all<std::uint8_t>("lamps/shines");
  for (std::size_t l = 0; l < n; ++l) {
    out[l].copies = copies[l];
    for (std::size_t i = 0; i < b; ++i) out[l].power.push_back(power[l * b + i]);
    for (std::size_t i = 0; i < s; ++i) out[l].shines.push_back(shines[i * n + l] != 0);
  }
  return out;
}

std::vector<StoredSensor> Result::sensors() const {
  const auto& reader = impl_->reader;
  std::vector<StoredSensor> out;
  if (!reader.has("names/sensor")) return out;
  const std::size_t s = impl_->states.size(), b = impl_->bands.size();
  for (const auto& name : reader.strings("names/sensor")) {
    const std::string group = "sensors/" + name;
    if (name.empty() || name.find('/') != std::string::npos || !reader.has(group))
      reader.fail("names/sensor", "\"" + name + "\"", "the name of a group in /sensors");
    auto& sensor = out.emplace_back();
    sensor.name = name;
    sensor.kind = reader.text_attribute(group, "kind");
    sensor.area = reader.all<float>(group + "/area");
    const std::size_t k = sensor.area.size();
    const auto values = [&](const char* dataset, const std::vector<std::size_t>& dims) {
      reader.expect(group + dataset, dims);
      return reader.all<float>(group + dataset);
    };
    sensor.reading.irradiance = values("/irradiance", {s, k, b});
    sensor.reading.standard_error = values("/standard_error", {s, k, b});
    if (reader.has(group + "/irradiance_back")) {
      sensor.reading.back = values("/irradiance_back", {s, k, b});
      sensor.reading.back_standard_error = values("/standard_error_back", {s, k, b});
    }
    for (const char* name_of : {"/centroid", "/normal"}) reader.expect(group + name_of, {k, 3});
    sensor.centroid = reader.all<double>(group + "/centroid");
    sensor.normal = reader.all<double>(group + "/normal");
    if (!reader.has(group + "/cells")) continue;
    reader.expect(group + "/cells", {2});
    sensor.cells = reader.all<std::uint32_t>(group + "/cells");
    if (std::size_t{sensor.cells[0]} * sensor.cells[1] != k)
      reader.fail(group + "/cells", fmt::format("{} x {}", sensor.cells[0], sensor.cells[1]), fmt::format("{} in all", k));
  }
  return out;
}

std::vector<IterationRow> Result::convergence() const {
  const auto& reader = impl_->reader;
  const auto level = reader.all<std::uint32_t>("convergence/level");
  for (const char* name : {"convergence/iteration", "convergence/residual", "convergence/links", "timings/iteration"})
    reader.expect(name, {level.size()});
  const auto iteration = reader.all<std::uint32_t>("convergence/iteration");
  const auto residual = reader.all<double>("convergence/residual"), seconds = reader.all<double>("timings/iteration");
  const auto links = reader.all<std::uint64_t>("convergence/links");
  std::vector<IterationRow> out;
  for (std::size_t i = 0; i < level.size(); ++i) out.push_back({level[i], iteration[i], residual[i], links[i], seconds[i]});
  return out;
}

std::vector<double> Result::spectral_radius() const {
  const auto& reader = impl_->reader;
  if (!reader.has_attribute("convergence", "spectral_radius")) return {};
  auto values = reader.values_attribute("convergence", "spectral_radius");
  if (values.size() != impl_->bands.size())
    reader.fail("convergence/@spectral_radius", std::to_string(values.size()) + " values", std::to_string(impl_->bands.size()));
  return values;
}

namespace {

template <class T>
std::vector<std::pair<std::string, T>> read_pairs(const h5::DatasetReader& reader, const std::string& group, const std::string& column) {
  const auto names = reader.strings(group + "/name");
  reader.expect(group + "/" + column, {names.size()});
  const auto values = reader.all<T>(group + "/" + column);
  std::vector<std::pair<std::string, T>> out;
  for (std::size_t i = 0; i < names.size(); ++i) out.emplace_back(names[i], values[i]);
  return out;
}

}  // namespace

Timings Result::timings() const {
  return read_pairs<double>(impl_->reader, "timings", "seconds");
}
std::vector<std::pair<std::string, std::uint64_t>> Result::counts() const {
  return read_pairs<std::uint64_t>(impl_->reader, "counts", "value");
}
std::vector<std::pair<std::string, std::uint64_t>> Result::memory() const {
  auto out = read_pairs<std::uint64_t>(impl_->reader, "memory", "bytes");
  out.emplace_back("peak_resident", impl_->reader.count_attribute("memory", "peak_resident_bytes"));
  return out;
}

std::optional<PeriodicCell> Result::periodic() const {
  const auto& reader = impl_->reader;
  if (!reader.has("geometry/periodic_cell")) return std::nullopt;
  reader.expect("geometry/periodic_cell", {4});
  const auto cell = reader.all<double>("geometry/periodic_cell");
  PeriodicCell out{cell[0], cell[1], cell[2], cell[3]};
  h5::read_slope(reader, out);
  return out;
}

std::optional<Certificate> Result::certificate() const {
  const auto& reader = impl_->reader;
  if (!reader.has("certificate")) return std::nullopt;
  Certificate c;
  c.organs = reader.all<std::uint64_t>("certificate/organs");
  for (const auto o : c.organs)
    if (o >= impl_->organs) reader.fail("certificate/organs", "row " + std::to_string(o), "a row below " + std::to_string(impl_->organs));
  const std::vector<std::size_t> dims{impl_->states.size(), c.organs.size(), impl_->bands.size()};
  for (const char* name : {"certificate/solved", "certificate/reference", "certificate/standard_error"}) reader.expect(name, dims);
  c.solved = reader.all<float>("certificate/solved");
  c.reference = reader.all<float>("certificate/reference");
  c.standard_error = reader.all<float>("certificate/standard_error");
  const auto per_band = [&](const char* name) {
    auto values = reader.values_attribute("certificate", name);
    if (values.size() != impl_->bands.size())
      reader.fail(std::string("certificate/@") + name, std::to_string(values.size()) + " values", std::to_string(impl_->bands.size()));
    return values;
  };
  c.rmse = per_band("rmse");
  c.rmse_low = per_band("rmse_low");
  c.rmse_high = per_band("rmse_high");
  c.bias = per_band("bias");
  if (reader.has_attribute("certificate", "bias_standard_error")) c.bias_standard_error = per_band("bias_standard_error");
  if (reader.has_attribute("certificate", "wanted")) c.wanted = per_band("wanted");
  c.rays = reader.count_attribute("certificate", "rays");
  c.seed = reader.count_attribute("certificate", "seed");
  return c;
}

}  // namespace sunfleck
