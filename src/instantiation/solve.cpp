#include <sunfleck/instantiation/solve.hpp>

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/memory.hpp>
#include <sunfleck/core/release_memory.hpp>
#include <sunfleck/instantiation/plan.hpp>
#include <sunfleck/light/wide_sun.hpp>

#include "instantiation/batches.hpp"
#include "instantiation/closed_light.hpp"
#include "instantiation/opening.hpp"
#include "instantiation/outer_iteration.hpp"
#include "instantiation/scene_light.hpp"

namespace sunfleck {

namespace {

std::uint64_t report_originals(const SceneLight& s, SolveReport& report) {
  std::uint64_t elements = 0, links = 0, fragments = 0;
  for (const auto& o : s.members.originals) {
    elements += o.elements.size();
    links += o.coarse->inside.size();
    fragments += o.coarse->fragments;
  }
  report.counts.emplace_back("originals", s.members.originals.size());
  report.counts.emplace_back("copies", s.members.size());
  if (s.members.merged > 0) report.counts.emplace_back("merged_copies", s.members.merged);
  report.counts.emplace_back("elements", elements);
  report.counts.emplace_back("links", links);
  report.counts.emplace_back("line_fragments", fragments);
  s.progress.line(
      fmt::format("{} originals for {} copies, {} elements, {} links", s.members.originals.size(), s.members.size(), elements, links));
  if (!s.placed.closed.empty())
    s.progress.line(fmt::format("{} copies are opened, {} near them stay closed, {} farther away are seen", s.placed.copies.size(),
                                s.placed.near.size(), s.placed.far.size()));
  return links;
}

/// One pass over all members: what they send when `in` comes in; `direct`: with sun and sky.
std::uint64_t pass(const SceneLight& s, const std::vector<Batch>& batches, const Light* in, bool direct, Light& out) {
  std::vector<std::uint32_t> sweeps(batches.size(), 0);
  tbb::parallel_for(std::size_t{0}, batches.size(), [&](std::size_t q) {
    if (s.progress.cancelled()) return;
    with_width(batches[q].width, [&](auto constant) {
      constexpr int width = decltype(constant)::value;
      const Batch& b = batches[q];
      const auto& original = s.members.originals[b.original];
      const LineOperator& op = *original.coarse;
      LaneField<width> field, source(2 * original.elements.size(), Lanes<width>{}), radiosity;
      incoming<width>(s, b, op, stored_ends(s, b), in, direct, field);
      add_outside<width>(op, field, source);
      if (direct) add_sun<width>(s, b, source);
      const auto swept = solve_inside<width>(op, original.elements.material, optics_of<width>(s, b), source,
                                             static_cast<float>((direct ? 1.0 : 5.0) * s.density.inner_tolerance), radiosity);
      sweeps[q] = swept.sweeps;
      outgoing<width>(op, radiosity, field);
      for (std::size_t j = 0; j < b.members.size(); ++j)
        for (std::size_t f = 0; f < op.fields(); ++f)
          for (std::size_t c = 0; c < b.columns; ++c)
            out.fields[(s.field_start[b.members[j]] + f) * s.columns + b.first_column + c] = field[f][j * b.columns + c];
    });
  });
  s.progress.check();
  std::uint64_t all = 0;
  for (const auto n : sweeps) all += n;
  out.ground = s.ground_irradiance(in, direct);
  s.reflect_from_ground(out.ground);
  return all;
}

}  // namespace

InstantiationDensity instantiation_density(Quality quality) {
  switch (quality) {
    case Quality::draft:
      return {{32, 1.5, 6, 1}, {64, 3.0, 6, 1}, 2.0, 4, 400.0, 32, 5e-3, 3e-3};
    case Quality::standard:
      return {{32, 1.5, 8, 1}, {160, 6.0, 12, 2}, 2.0, 8, 3000.0, 64, 2e-3, 1e-3};
    case Quality::fine:
      return {{96, 4.0, 8, 2}, {256, 9.6, 12, 2}, 4.0, 12, 8000.0, 128, 3e-4, 5e-5};
  }
  return {};
}

OperatorDensity gather_density(const InstantiationDensity& density, std::size_t opened) {
  OperatorDensity d = density.fine;
  if (opened < 8) return d;
  d.directions = std::max(d.directions, std::min(2 * d.directions, 320u));
  d.points = (d.points + 1) / 2;
  return d;
}

void check_instantiable(const Scene& scene) {
  for (const auto& state : scene.states)
    if (state.sun && state.sun->angular_diameter_deg > widest_narrow_sun_deg)
      throw InputError(location(scene.file, 0, "sun.angular_diameter"),
                       fmt::format("{} with method 'instantiation'", state.sun->angular_diameter_deg),
                       fmt::format("at most {} degrees, or method clustering, flat, direct or reference", widest_narrow_sun_deg));
  if (!scene.lamps.empty() || !scene.sensors.empty())
    throw InputError(location(scene.file, 0, scene.lamps.empty() ? "sensor" : "lamp"),
                     scene.lamps.empty() ? "a sensor with method 'instantiation'" : "a lamp with method 'instantiation'",
                     "clustering, flat, direct or reference, which know lamps and sensors");
}

SolveReport solve_instantiation(const Scene& scene, const PlacedScene& placed, const InstantiationSettings& settings, IrradianceSink& sink,
                                Progress& progress) {
  check_instantiable(scene);
  std::optional<tbb::global_control> control;
  if (settings.threads > 0) control.emplace(tbb::global_control::max_allowed_parallelism, settings.threads);
  SolveReport report;
  report.method = "instantiation";
  report.balance.assign(scene.states.size(), std::vector<Balance>(scene.band_count()));
  Stopwatch watch;
  const auto timed = [&](const char* phase) {
    add_seconds(report.timings, phase, watch.seconds());
    watch = {};
  };
  release_freed_memory();  // what reading and classifying have left
  SceneLight s(scene, placed, settings, progress);
  const auto links = report_originals(s, report);
  if (s.members.tangled > much_tangled)
    progress.line(fmt::format(
        "note: {:.1f} % of what is seen inside copies is hidden by others that reach into them, or by images of their own across "
        "the cell's border, or by the ground: expect errors of several per cent, and a balance that does not close; clustering has no such "
        "limit",
        100 * s.members.tangled));
  timed("originals");
  s.project_sun();
  timed("sun");
  s.look_around(report);
  timed("rays");

  const auto batches = batches_of(s, s.all_members());
  s.memory.hold("lanes", lanes_at_once(batches, [&](const Batch& b) {
                  const auto& o = s.members.originals[b.original];
                  return 2 * 2 * o.elements.size() + o.coarse->fields();
                }));
  std::uint64_t sweeps = 0;
  OuterIteration outer;
  outer.tolerance = settings.tolerance > 0 ? settings.tolerance : s.density.tolerance;
  outer.pass = [&](const Light* in, bool direct, Light& out) { sweeps += pass(s, batches, in, direct, out); };
  outer.say = [&](std::uint32_t passes, double residual) {
    report.convergence.push_back({0, passes - 1, residual, links, watch.seconds()});
    progress.line(fmt::format("pass {}: residual {:.1e}, {:.1f} s", passes, residual, watch.seconds()));
  };
  const auto iterated = iterate(s, outer);
  s.memory.hold("fields", iterated.bytes);
  if (!iterated.converged) report.status = SolveStatus::not_converged;
  s.memory.hold("lanes", 0);
  s.memory.hold("fields", s.bytes_of_light());
  report.counts.emplace_back("sweeps", sweeps);
  timed("iteration");

  open_copies(s, iterated.light, sink, report);
  timed("opening");
  report.counts.emplace_back("sun_fragments", s.sun_fragments);
  report.counts.emplace_back("gather_fragments", s.gather_fragments);
  report.counts.emplace_back("gather_rays", s.gather_rays);
  absorb_closed(s, iterated.light, report);
  if (!placed.closed.empty()) timed("closed structures");
  report.memory = s.memory.rows();
  return report;
}

}  // namespace sunfleck
