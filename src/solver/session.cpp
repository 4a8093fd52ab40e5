#include <sunfleck/solver/session.hpp>

#include <optional>

#include <sunfleck/instantiation/operator_store.hpp>
#include <sunfleck/radiosity/transport_store.hpp>
#include <sunfleck/scene/content.hpp>

namespace sunfleck {

struct Session::Impl {
  explicit Impl(const SessionSettings& settings) : operators(settings.most_bytes, settings.folder), transports(settings.most_bytes) {}

  OperatorStore operators;
  TransportStore transports;
  std::string geometry, whole;  ///< keys of the last scene
  std::optional<Solution> last;
  double last_seconds = 0;
  bool trusted = false;  ///< the last certificate did not speak against the method that the program chose
  Reuse reuse;
};

namespace {

/// All that a result depends on besides the scene.
std::string run_key(const RunSettings& run, bool facets) {
  ContentKey key("run");
  key.put(run.method.value_or("")), key.put(run.quality.value_or(Quality::standard)), key.put(run.quality.has_value());
  for (const auto& e : run.error) key.put(e.band), key.put(e.error);
  key.put(run.seed.value_or(1)), key.put(run.certificate.has_value()), key.put(run.certificate.value_or(true));
  key.put(run.certificate_organs.value_or(0)), key.put(run.certificate_rays.value_or(0)), key.put(run.samples.value_or(0));
  key.put(run.lattice_mapping.value_or("")), key.put(run.lattice_nodes.value_or(0)), key.put(run.occlusion_model.value_or(""));
  key.put(run.depth.only), key.put(run.depth.stop_at.type), key.put(run.depth.stop_at.size.value_or(-1.0));
  key.put(run.depth.stop_at.leaf_count.value_or(0)), key.put(facets);
  return key.hex();
}

}  // namespace

Session::Session(RunSettings settings, SessionSettings store) : run(std::move(settings)), impl_(std::make_unique<Impl>(store)) {}
Session::~Session() = default;

const Reuse& Session::reused() const {
  return impl_->reuse;
}

Solution Session::solve(const Scene& scene, Progress& progress, bool facets) {
  Impl& s = *impl_;
  RunSettings settings = run;
  if (!settings.certificate && settings.error.empty() && s.trusted) settings.certificate = false;
  const std::string geometry = geometry_key(scene), whole = scene_key(scene, geometry) + run_key(run, facets);
  Reuse reuse;
  reuse.geometry = geometry == s.geometry;
  if (s.last && whole == s.whole) {
    reuse.everything = true;
    reuse.reused = {{"solution", 1}};
    reuse.saved_seconds = s.last_seconds;
    s.reuse = reuse;
    return *s.last;
  }
  s.operators.start();
  s.transports.start();
  const Stopwatch watch;
  LightInMemory light(facets);
  SolveCaller caller;
  caller.operators = &s.operators;
  caller.transports = &s.transports;
  caller.geometry = geometry;
  Solution solution{sunfleck::solve(scene, settings, light, progress, caller), std::move(light.facets), std::move(light.organs)};
  const auto& use = s.operators.use();
  if (use.found + use.read > 0) reuse.reused.emplace_back("operators", use.found + use.read);
  if (use.read > 0) reuse.reused.emplace_back("operators_read", use.read);
  if (use.made > 0) reuse.made.emplace_back("operators", use.made);
  const auto& transport = s.transports.use();
  if (transport.found > 0) reuse.reused.emplace_back("transport", transport.found);
  if (transport.made > 0) reuse.made.emplace_back("transport", transport.made);
  reuse.saved_seconds = use.saved_seconds + transport.saved_seconds;
  s.reuse = reuse;
  s.geometry = geometry;
  s.whole = whole;
  s.last = solution;
  if (solution.certificate) s.trusted = solution.report.status == SolveStatus::converged && !solution.tried_again;
  s.last_seconds = watch.seconds();
  return solution;
}

}  // namespace sunfleck
