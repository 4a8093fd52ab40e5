#include "instantiation/ground_rows.hpp"

namespace sunfleck {

void write_ground_rows(const SceneLight& s, const std::vector<float>& e, IrradianceSink& sink, SolveReport& report) {
  const std::size_t n = s.placed.ground.size();
  if (n == 0) return;
  std::vector<float> b = e;
  s.reflect_from_ground(b);
  const auto& optics = s.scene.ground->optics;
  const auto& parts = s.members.ground_parts;
  std::vector<float> share(parts.back());
  for (std::size_t f = 0; f < n; ++f) {
    double area = 0;
    for (auto part = parts[f]; part < parts[f + 1]; ++part) area += s.ground.area[part];
    for (auto part = parts[f]; part < parts[f + 1]; ++part) share[part] = area > 0 ? static_cast<float>(s.ground.area[part] / area) : 0.0f;
  }
  std::vector<float> irradiance(s.states * n * 2 * s.bands, 0.0f), sunlit(s.lights.suns.empty() ? 0 : s.states * n * 2, 0.0f);
  for (std::size_t part = 0, f = 0; part < share.size(); ++part) {
    while (part >= parts[f + 1]) ++f;
    for (std::size_t c = 0; c < s.columns; ++c) {
      const std::size_t state = c / s.bands, band = c % s.bands;
      auto& balance = report.balance[state][band];
      for (std::size_t side = 0; side < 2; ++side) {
        const std::size_t i = 2 * part + side;
        const float value = e[i * s.columns + c];
        irradiance[((state * n + f) * 2 + side) * s.bands + band] += share[part] * value;
        const double area = s.ground.area[part];
        balance.incident += area * s.ground_direct(i, c);
        balance.ground += area * value *
                          (1.0 - (side == 0 ? optics.reflectance_front[band] : optics.reflectance_back[band]) - optics.transmittance[band]);
        balance.escaped += area * b[i * s.columns + c] * s.ground.sky_seen[i];
        if (const auto sun = s.lights.sun_of_state[state]; sun != LightSources::none && band == 0)
          sunlit[(state * n + f) * 2 + side] += share[part] * s.ground.sunlit[sun][i];
      }
    }
  }
  sink.rows({s.placed.first_ground_facet, n, irradiance.data(), s.lights.suns.empty() ? nullptr : sunlit.data(), nullptr});
}

}  // namespace sunfleck
