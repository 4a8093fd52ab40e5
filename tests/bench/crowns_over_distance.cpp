// Error of the instantiation for two crowns of random leaves, over the distance between them: the table and plot of docs/instantiation.md.
// bench_crowns_over_distance [samples of the reference per facet, 64] [plot.svg]
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <sunfleck/core/sampling.hpp>
#include <sunfleck/instantiation/solve.hpp>
#include <sunfleck/plant/build.hpp>
#include <sunfleck/reference/path_tracer.hpp>
#include <sunfleck/scene/build.hpp>
#include <sunfleck/scene/facets.hpp>

using namespace sunfleck;

namespace {

/// 3,196 square leaves of 6 cm in a ball of radius 1 m, any way up.
Plant crown() {
  RandomStream random(1);
  std::vector<Mesh> leaves;
  constexpr double side = 0.06;
  while (leaves.size() < 3196) {
    const Vec3 c{2 * random.next() - 1, 2 * random.next() - 1, 2 * random.next() - 1};
    const double z = 2 * random.next() - 1, azimuth = 6.283185307179586 * random.next(), s = std::sqrt(1 - z * z);
    if (glm::length(c) > 1 - 0.7 * side) continue;
    Vec3 u, v;
    orthonormal_frame({s * std::cos(azimuth), s * std::sin(azimuth), z}, u, v);
    const Vec3 at = c + Vec3{0, 0, 1.3};
    u *= 0.5 * side, v *= 0.5 * side;
    leaves.push_back({{at - u - v, at + u - v, at + u + v, at - u + v}, {{0, 1, 2}, {0, 2, 3}}});
  }
  return make_plant(std::move(leaves), "crown", "leaf");
}

/// Absorbed power of each organ of plants, [organ][band] [W].
struct OrganSink final : IrradianceSink {
  explicit OrganSink(const FacetScene& f) : facets(f), power(f.organs.size() * f.bands, 0.0) {}
  void rows(const IrradianceRows& r) override {
    for (std::size_t i = 0; i < r.count; ++i) {
      const std::size_t f = r.first_facet + i;
      const auto& m = facets.materials[facets.optics[f]];
      for (std::size_t b = 0; b < facets.bands; ++b)
        power[facets.organ[f] * facets.bands + b] +=
            double{facets.area[f]} * ((1 - m.reflectance_front[b] - m.transmittance[b]) * r.irradiance[2 * i * facets.bands + b] +
                                      (1 - m.reflectance_back[b] - m.transmittance[b]) * r.irradiance[(2 * i + 1) * facets.bands + b]);
    }
  }
  const FacetScene& facets;
  std::vector<double> power;
};

struct Row {
  double distance, error[2], bias[2];
};

Row measure(double distance, std::uint32_t samples) {
  Scene scene;
  scene.bands = {"PAR", "NIR"};
  scene.band_units.assign(2, "W m^-2");
  scene.optics = {uniform_optics("leaf", {0.09, 0.45}, {0.05, 0.40})};
  scene.ground = flat_ground({8 + distance, 8}, {0.5 * distance, 0}, {16, 16}, {0.12, 0.20});
  scene.states.resize(1);
  scene.states[0].sun = Sun{glm::normalize(Vec3{0.5, 0, 0.8}), {400, 400}, 0.53};
  scene.states[0].sky.emplace();
  scene.states[0].sky->model = SkyModel::standard_overcast;
  scene.states[0].sky->irradiance = {100, 80};
  Stance first, second;
  second.position = {distance, 0, 0};
  second.turn_deg = 90;
  scene.plants.push_back(plant_entry("crown", crown(), 0, {placed(first), placed(second)}));
  check_scene(scene);
  const FacetScene facets = expand(scene);
  OrganSink solved(facets), reference(facets);
  solve_instantiation(scene, place(scene), {}, solved, silent());
  ReferenceSettings settings;
  settings.samples = samples;
  settings.seed = 77;
  // two independent halves: their difference tells the reference's noise
  OrganSink other(facets);
  trace_reference(scene, facets, settings, reference, silent());
  settings.seed = 78;
  trace_reference(scene, facets, settings, other, silent());
  Row row{distance, {}, {}};
  for (std::size_t b = 0; b < 2; ++b) {
    double square = 0, difference = 0, mean = 0;
    const std::size_t leaves = 2 * 3196;
    for (std::size_t o = 0; o < leaves; ++o) {
      const double r1 = reference.power[2 * o + b], r2 = other.power[2 * o + b], r = 0.5 * (r1 + r2);
      square += std::pow(solved.power[2 * o + b] - r, 2) - 0.25 * std::pow(r1 - r2, 2);
      difference += solved.power[2 * o + b] - r;
      mean += r;
    }
    row.error[b] = 100 * std::sqrt(std::max(0.0, square / leaves)) / (mean / leaves);
    row.bias[b] = 100 * difference / mean;
  }
  return row;
}

void plot(const std::vector<Row>& rows, const std::string& file) {
  const auto x = [](double d) { return 60 + 520 * d / 6.5; };
  const auto y = [](double e) { return 300 - 260 * e / 2.5; };
  std::FILE* f = std::fopen(file.c_str(), "w");
  if (!f) return;
  fmt::print(f, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 640 350\" font-family=\"sans-serif\" font-size=\"13\">\n");
  fmt::print(f, "<rect width=\"640\" height=\"350\" fill=\"white\"/>\n");
  for (int e = 0; e <= 5; ++e)
    fmt::print(f, "<path d=\"M60 {0:.1f}H590\" stroke=\"#ddd\"/><text x=\"52\" y=\"{1:.1f}\" text-anchor=\"end\">{2:.1f}</text>\n",
               y(0.5 * e), y(0.5 * e) + 4, 0.5 * e);
  for (int d = 0; d <= 6; ++d) fmt::print(f, "<text x=\"{:.1f}\" y=\"318\" text-anchor=\"middle\">{}</text>\n", x(d), d);
  fmt::print(f, "<text x=\"320\" y=\"340\" text-anchor=\"middle\">distance of the centres [radii]</text>\n");
  fmt::print(f, "<text x=\"16\" y=\"170\" transform=\"rotate(-90 16 170)\" text-anchor=\"middle\">error per leaf [%]</text>\n");
  const char* colour[2] = {"#3a7d2c", "#a3333d"};
  const char* name[2] = {"PAR (aim 1.5)", "NIR (aim 2.2)"};
  const double aim[2] = {1.5, 2.2};
  for (int b = 0; b < 2; ++b) {
    fmt::print(f,
               "<path d=\"M60 {0:.1f}H590\" stroke=\"{1}\" stroke-dasharray=\"5 4\"/>\n<polyline fill=\"none\" stroke=\"{1}\" "
               "stroke-width=\"2\" points=\"",
               y(aim[b]), colour[b]);
    for (const auto& r : rows) fmt::print(f, "{:.1f},{:.1f} ", x(r.distance), y(r.error[b]));
    fmt::print(f, "\"/>\n");
    for (const auto& r : rows)
      fmt::print(f, "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n", x(r.distance), y(r.error[b]), colour[b]);
    fmt::print(f, "<text x=\"585\" y=\"{:.1f}\" text-anchor=\"end\" fill=\"{}\">{}</text>\n", y(aim[b]) - 5, colour[b], name[b]);
  }
  fmt::print(f, "</svg>\n");
  std::fclose(f);
}

}  // namespace

int main(int argc, char** argv) {
  const auto samples = static_cast<std::uint32_t>(argc > 1 ? std::atoi(argv[1]) : 64);
  std::vector<Row> rows;
  fmt::print("| distance / radius | PAR % | NIR % | bias PAR / NIR % |\n|---|---|---|---|\n");
  for (const double d : {0.5, 1.0, 1.5, 1.8, 2.0, 2.5, 3.0, 4.0, 6.0}) {
    rows.push_back(measure(d, samples));
    const auto& r = rows.back();
    fmt::print("| {:.1f} | {:.2f} | {:.2f} | {:+.2f} / {:+.2f} |\n", d, r.error[0], r.error[1], r.bias[0], r.bias[1]);
    std::fflush(stdout);
  }
  if (argc > 2) plot(rows, argv[2]);
}
