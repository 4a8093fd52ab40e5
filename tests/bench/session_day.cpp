// What a session saves when a day's light changes: bench_session_day SCENE.toml [METHOD] [QUALITY]
// The scene's states are solved, then the same states with their suns half an hour later; beside it a solve of those without a session.
#include <cmath>
#include <cstdio>
#include <numbers>

#include <sunfleck/sunfleck.hpp>

using namespace sunfleck;

namespace {

Scene later(Scene scene, double turn_deg) {
  const double a = turn_deg * std::numbers::pi / 180.0;
  for (auto& state : scene.states) {
    const auto turned = [&](const Vec3& d) {
      return Vec3{d.x * std::cos(a) + d.y * std::sin(a), -d.x * std::sin(a) + d.y * std::cos(a), d.z};
    };
    if (state.sun) state.sun->direction = turned(state.sun->direction);
    if (state.sky && state.sky->sun) {
      state.sky->sun = turned(*state.sky->sun);
      state.sky->normalisation = 0;
    }
  }
  return scene;
}

double seconds_of(const SolveReport& report, const std::string& phase) {
  for (const auto& [name, seconds] : report.timings)
    if (name == phase) return seconds;
  return 0;
}

void print(const char* what, const Solution& s, double seconds) {
  const double sun = seconds_of(s.report, "sun");
  std::printf("%-24s %7.2f s in all, %6.2f s tracing suns, %6.2f s beyond:", what, seconds, sun, seconds - sun);
  for (const auto& [name, spent] : s.report.timings)
    if (name != "sun") std::printf(" %s %.2f", name.c_str(), spent);
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) return std::fprintf(stderr, "usage: bench_session_day SCENE.toml [METHOD] [QUALITY]\n"), 2;
  const Scene first = read_scene(argv[1]), second = later(first, 7.5);
  RunSettings run;
  if (argc > 2) run.method = argv[2];
  if (argc > 3) run.quality = quality_from_name(argv[3]);
  run.certificate = false;
  Session session(run);
  const auto timed = [](const char* what, const auto& call) {
    const Stopwatch watch;
    const Solution s = call();
    print(what, s, watch.seconds());
    return s;
  };
  timed("session, first day", [&] { return session.solve(first); });
  const Solution update = timed("session, another day", [&] { return session.solve(second); });
  for (const auto& [name, number] : session.reused().reused)
    std::printf("  reused %llu %s\n", static_cast<unsigned long long>(number), name.c_str());
  std::printf("  saved %.2f s\n", session.reused().saved_seconds);
  const Solution fresh = timed("without a session", [&] { return solve(second, run); });
  double worst = 0, mean = 0;
  for (std::size_t i = 0; i < fresh.facets.irradiance.size(); ++i) {
    worst = std::max(worst, std::abs(double{fresh.facets.irradiance[i]} - update.facets.irradiance[i]));
    mean += fresh.facets.irradiance[i] / static_cast<double>(fresh.facets.irradiance.size());
  }
  std::printf("largest difference %.1e of the mean irradiance\n", worst / mean);
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_session_day: %s\n", error.what());
  return 1;
}
