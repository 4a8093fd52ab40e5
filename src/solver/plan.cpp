#include <sunfleck/solver/plan.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <sunfleck/core/names.hpp>
#include <sunfleck/instantiation/plan.hpp>
#include <sunfleck/policy/policy_toml.hpp>
#include <sunfleck/radiosity/plan.hpp>
#include <sunfleck/scene/facets.hpp>

#include <sunfleck/core/text_units.hpp>

#include "solver/bytes_of_scene.hpp"
#include "solver/method_settings.hpp"

namespace sunfleck {

namespace {

bool transmits(const Scene& scene) {
  return std::any_of(scene.optics.begin(), scene.optics.end(), [](const Optics& o) {
    return std::any_of(o.transmittance.begin(), o.transmittance.end(), [](float t) { return t > 0.0f; });
  });
}

/// Names of the states that have (or lack) a kind of light.
template <class Has>
PlanItem light_item(const Scene& scene, const std::string& name, Has has, const std::string& what) {
  std::vector<std::string> with;
  for (const auto& state : scene.states)
    if (has(state)) with.push_back(state.name);
  if (with.empty()) return {name, false, scene.states.size() == 1 ? "the scene has none" : "no state has any"};
  if (with.size() == scene.states.size()) return {name, true, what};
  return {name, true, fmt::format("{}; in {} of {} states", what, with.size(), scene.states.size())};
}

void add_light(const Scene& scene, std::vector<PlanItem>& items) {
  items.push_back({"bands", true, fmt::format("{}, carried together through one geometric computation", joined(scene.bands))});
  if (scene.states.size() > 1)
    items.push_back(
        {"states", true, fmt::format("{} lighting states; what does not depend on the light is done once", scene.states.size())});
  else
    items.push_back({"states", false, "one lighting state only: no loop over states"});
  items.push_back(light_item(
      scene, "sun", [](const LightState& s) { return s.sun.has_value(); }, "direct light, with the sunlit fraction of each side"));
  bool disc = false;
  for (const auto& state : scene.states) disc = disc || (state.sun && state.sun->angular_diameter_deg > 0.0);
  items.push_back({"sun disc", disc, disc ? "penumbrae of the sun's angular diameter" : "no sun, or a point"});
  items.push_back(light_item(
      scene, "sky", [](const LightState& s) { return s.sky.has_value(); }, "sky light through the gaps, direction by direction"));
}

/// Lamps and sensors: what a scene without them does not pay for.
void add_devices(const Scene& scene, const std::string& method, std::vector<PlanItem>& items) {
  const bool direct_only = method == "direct", sky_only = method == "occlusion";
  if (sky_only || scene.lamps.empty()) {
    items.push_back(
        {"lamps", false,
         sky_only ? "method 'occlusion' finds sky light alone" : "the scene has none: no shadow rays to lamps, no tree of rays for them"});
  } else {
    std::size_t copies = 0;
    for (const auto& lamp : scene.lamps) copies += lamp.placements.size();
    items.push_back(
        {"lamps", true, fmt::format("{}: shadow rays from every cell of the scene to points of lamps", counted(copies, "lamp", "lamps"))});
  }
  if (scene.sensors.empty() || sky_only || method == "lattice")
    items.push_back({"sensors", false, scene.sensors.empty() ? "the scene has none" : fmt::format("method '{}' knows none", method)});
  else
    items.push_back({"sensors", true,
                     fmt::format("{}: rays {}, after the solve", counted(scene.sensors.size(), "sensor", "sensors"),
                                 direct_only             ? "to sun, sky and lamps"
                                 : method == "reference" ? "followed as paths"
                                                         : "that gather the light of what they meet")});
}

PlanItem periodicity_item(const Scene& scene) {
  if (!scene.periodic) return {"periodicity", false, "the scene is finite"};
  return {"periodicity", true,
          fmt::format("a cell of {:g} m x {:g} m repeats without end{}", scene.periodic->width(), scene.periodic->depth(),
                      scene.periodic->is_level()
                          ? ""
                          : fmt::format(" along a slope of [{:g}, {:g}]", scene.periodic->slope_x, scene.periodic->slope_y))};
}

void add_geometry(const Scene& scene, const SceneCounts& counts, std::vector<PlanItem>& items) {
  items.push_back(periodicity_item(scene));
  if (scene.ground)
    items.push_back({"ground", true, fmt::format("{} in the same system as the leaves", counted(counts.ground_facets, "facet", "facets"))});
  else
    items.push_back({"ground", false, "the scene has none: light that falls through escapes"});
  if (counts.plant_facets > counts.unique_facets)
    items.push_back({"copies", true,
                     fmt::format("{} facets are read, {} stand in the scene: every copy is solved with its own light", counts.unique_facets,
                                 counts.plant_facets)});
  else
    items.push_back({"copies", false, "nothing is placed more than once"});
}

void add_scattering(const Scene& scene, const std::string& method, std::vector<PlanItem>& items) {
  const bool direct_only = method == "direct" || method == "occlusion";
  if (method == "occlusion")
    items.push_back({"scattering", false, "method 'occlusion' estimates sky light alone: no links, no rays to leaves"});
  else if (direct_only)
    items.push_back({"scattering", false, "method 'direct' stops at the light that arrives first"});
  else if (!scatters(scene))
    items.push_back({"scattering", false, "every surface is black in every band"});
  else if (method == "reference")
    items.push_back({"scattering", true, "paths traced from facets, with the variance of every mean"});
  else
    items.push_back({"scattering", true,
                     method == "lattice"         ? "on a lattice of nodes, as a fluid: no links"
                     : method == "flat"          ? "every facet with every other it sees"
                     : method == "instantiation" ? "inside originals by lines traced once, between copies by small fields of light"
                                                 : "links between clusters, chosen by their estimated error"});
  const bool passes = transmits(scene) && !direct_only;
  items.push_back({"transmission", passes,
                   passes        ? "leaves pass light from side to side"
                   : direct_only ? "no scattering"
                                 : "no optics transmits in any band"});
}

void add_certificate(const std::string& method, bool wanted, std::vector<PlanItem>& items) {
  if (method == "reference")
    items.push_back({"certificate", false, "the reference carries the variance of its own means"});
  else if (!wanted)
    items.push_back({"certificate", false, "the run turns it off"});
  else
    items.push_back({"certificate", true, "some organs are checked by path tracing after the solve"});
}

/// Above this many facets the copies are not laid out for the sake of a plan: they would take as long, and most of the memory, of the
/// solve.
constexpr std::uint64_t most_laid_out = 20'000'000;

using Names = std::vector<std::pair<std::string, std::string>>;  ///< a figure as solvers name it, and for people

void add_figures(const std::vector<std::pair<std::string, std::uint64_t>>& predicted, const Names& names, std::vector<PlanFigure>& out) {
  for (const auto& [part, amount] : predicted)
    for (const auto& [name, text] : names)
      if (name == part) out.push_back({part, text, amount});
}

/// Structures that others stand in for until their plant is opened; `shared`: null for methods that take every plant as it is.
void add_policies(const Scene& scene, const std::string& method, const InstantiationSharing* shared, std::vector<PlanItem>& items) {
  const auto why_not = [&]() -> std::string {
    if (std::all_of(scene.plants.begin(), scene.plants.end(), [](const auto& p) { return p.policy_file.empty(); }))
      return "no plant names one";
    if (!shared) return fmt::format("method '{}' takes every plant as it is, 'instantiation' follows them", method);
    return scene.periodic ? "in a periodic cell plants share nothing but exact copies"
                          : "no plant that stands once has structures of their classes";
  };
  if (!shared || shared->structures == 0)
    items.push_back({"policies", false, why_not()});
  else
    items.push_back(
        {"policies", true,
         fmt::format("{} stand for {} of {}, which {} opened one by one with {} own geometry", counted(shared->pieces, "piece", "pieces"),
                     counted(shared->structures, "structure", "structures"), counted(shared->opened_alone, "plant", "plants"),
                     shared->opened_alone == 1 ? "is" : "are", shared->opened_alone == 1 ? "its" : "their")});
}

/// Originals, their operators, and what copies hold.
void add_instantiation(const Scene& scene, const PlacedScene& placed, const MethodChoice& choice, const RunSettings& run,
                       Progress& progress, Plan& plan) {
  auto settings = instantiation_settings(choice, run);
  const auto classes = classes_of_policies(scene);
  settings.classes = classes ? &*classes : nullptr;
  const auto predicted = plan_instantiation(scene, placed, settings, progress);
  plan.items.push_back({"originals", true,
                        fmt::format("{} shared by {}: traced once, opened copy by copy",
                                    counted(predicted.originals, "original", "originals"), counted(predicted.copies, "copy", "copies"))});
  if (placed.share < 1)
    plan.items.push_back({"prediction", true, fmt::format("made of {} of the copies, the others taken alike", placed.copies.size())});
  add_policies(scene, choice.method, &predicted, plan.items);
  if (predicted.merged_copies > 0)
    plan.items.push_back(
        {"overlap", true,
         fmt::format("{} that reach into each other are solved together", counted(predicted.merged_copies, "copy", "copies"))});
  else
    plan.items.push_back({"overlap", false, "no copies reach so far into each other that they must be solved together"});
  static const Names parts{{"plants", "plants as read"},
                           {"originals", "originals and their operators"},
                           {"sun", "sunlit fractions of all cells"},
                           {"rays", "rays between copies"},
                           {"lanes", "light inside copies that are worked on"},
                           {"fields", "fields of light between copies"},
                           {"fine", "the original being opened, with its operator"},
                           {"rows", "rows that wait for the file"}};
  static const Names counts{{"originals", "originals"},
                            {"copies", "copies and pieces of copies"},
                            {"merged_copies", "copies solved together"},
                            {"elements", "elements of originals"},
                            {"links", "links of originals"},
                            {"line_fragments", "lines meet surfaces, in originals"},
                            {"rays", "rays between copies"},
                            {"sun_fragments", "lines meet surfaces, sun"},
                            {"gather_fragments", "lines meet surfaces, last gather"},
                            {"gather_rays", "rays, last gather"}};
  add_figures(predicted.memory, parts, plan.memory);
  add_figures(predicted.counts, counts, plan.work);
  for (const auto& [name, bytes] : predicted.memory)
    if (name == "at_once") plan.at_once = bytes;
}

/// Lines are gone when light is spread along the links, and then only there is light on every facet. The certificate comes when all that
/// is gone.
std::uint64_t most_at_once(const std::vector<PlanFigure>& memory) {
  std::uint64_t always = 0, solver = 0, before = 0, after = 0, certificate = 0;
  for (const auto& part : memory) {
    const bool later = part.name == "links" || part.name == "fields" || part.name == "light";
    const bool kept =
        part.name == "program" || part.name == "plants" || part.name == "layout" || part.name == "facets" || part.name == "file";
    (part.name == "certificate" ? certificate : part.name == "lines" ? before : later ? after : kept ? always : solver) += part.amount;
  }
  return always + std::max(solver + std::max(before, after), certificate);
}

/// Elements, links and lines of the radiosity methods.
void add_radiosity(const Scene& scene, const MethodChoice& choice, const RunSettings& run, Progress& progress, Plan& plan) {
  if (choice.method == "reference" || choice.method == "occlusion") {
    plan.items.push_back({"elements", false,
                          choice.method == "reference" ? "the reference traces paths facet by facet, without elements or links"
                                                       : "occlusion asks the shape of crowns alone: no elements, links or lines"});
    plan.at_once = most_at_once(plan.memory);
    return;
  }
  if (plan.counts.facets() > most_laid_out || plan.counts.facets() == 0) {
    plan.items.push_back({"prediction", false, fmt::format("elements and links are predicted for up to {} facets only", most_laid_out)});
    return;
  }
  const auto settings = radiosity_settings(choice, run);
  const FacetScene facets = expand(scene);
  if (facets.zero_area_facets == facets.size()) {
    plan.items.push_back({"prediction", false, "no facet has an area"});
    return;
  }
  const auto predicted = plan_radiosity(scene, facets, settings, progress);
  static const Names names{{"elements", "elements and cells"},
                           {"direct", "direct light on every cell"},
                           {"tree of rays", "tree of rays, for lamps and sensors"},
                           {"lamps", "light of lamps on every cell"},
                           {"links", "links and clusters"},
                           {"fields", "light on elements, iteration"},
                           {"lines", "lines, until they are links"}};
  add_figures(predicted.memory, names, plan.memory);
  plan.at_once = most_at_once(plan.memory);
  const auto add = [&](const char* name, const char* what, std::uint64_t n) {
    if (n > 0) plan.work.push_back({name, what, n});
  };
  add("cells", "cells, with direct light", predicted.cells);
  add("elements", "elements, with scattered light", predicted.elements);
  add("direct_fragments", "lines meet surfaces, sun and sky", predicted.sky_fragments + predicted.sun_fragments);
  add("lamp_rays", "rays to lamps", predicted.lamp_rays);
  add("sensor_rays", "rays of sensors", predicted.sensor_rays);
  if (choice.method == "lattice")
    plan.memory.push_back({"lattice", "nodes of the lattice", lattice_bytes(scene, facets, lattice_settings(choice, run))});
  if (choice.method == "direct" || choice.method == "lattice") return;
  add("fragments", "lines meet surfaces, scattering", predicted.line_fragments);
  add("clusters", "clusters", predicted.clusters);
  add("links", "links", predicted.links);
}

Plan plan_of(const Scene& scene, const MethodChoice& choice, const RunSettings& run, Progress& progress, std::uint64_t program) {
  refuse_depth(scene, run.depth, choice.method);
  const bool certificate = run.certificate.value_or(true);
  Plan plan;
  plan.choice = choice;
  plan.counts = count(scene);
  add_light(scene, plan.items);
  add_devices(scene, choice.method, plan.items);
  add_geometry(scene, plan.counts, plan.items);
  add_scattering(scene, choice.method, plan.items);
  add_certificate(choice.method, certificate, plan.items);
  const bool shares = choice.method == "instantiation";
  const PlacedScene placed = shares ? place(scene, run.depth, most_copies_in_plan) : PlacedScene{};
  const bool whole = shares && placed.share == 1;
  const std::uint64_t facets = whole ? placed.facets : plan.counts.facets();  // `only` and `stop_at` leave some closed
  if (program > 0) plan.memory.push_back({"program", "the program as it starts", program});
  if (!shares) {
    plan.memory.push_back({"plants", "plants as read", held_bytes(scene)});
    if (choice.method == "occlusion") {
      plan.memory.push_back({"crowns", "shells of crowns, and which of them every facet lies in", plan.counts.unique_facets});
    } else {
      plan.memory.push_back({"facets", "facets of all copies", expanded_bytes(plan.counts)});
      plan.memory.push_back({"light", "light on every facet", facets * solution_bytes_per_facet(scene)});
    }
    const std::uint64_t tree = tree_bytes(plan.counts);
    if (choice.method == "reference")
      plan.memory.push_back({"tree of rays", "tree of rays, to follow paths", tree});
    else if (certificate)
      plan.memory.push_back({"certificate", "tree of rays of the certificate, after the solve", tree});
  }
  const bool all_open = run.depth.whole();
  const std::uint64_t layout = all_open ? layout_bytes(plan.counts) : 0, file = all_open ? row_bytes(scene, plan.counts) : 0;
  if (all_open) plan.memory.push_back({"layout", "copies, and names of them and of ground cells", layout});
  if (all_open) plan.memory.push_back({"file", "sums and rows on their way into the file", file});
  plan.work = {{"facets", "facets", facets},
               {"organs", "organs", whole ? placed.organs : plan.counts.organs},
               {"result_bytes", "result bytes before compression", facets * result_bytes_per_facet(scene)}};
  if (shares) {
    add_instantiation(scene, placed, choice, run, progress, plan);
  } else {
    add_policies(scene, choice.method, nullptr, plan.items);
    add_radiosity(scene, choice, run, progress, plan);
  }
  if (shares) plan.at_once += program + layout + file;
  return plan;
}

/// Ground that is this large is not laid out for a plan, but two smaller pieces of it, with cells of the same size about its middle.
constexpr std::uint64_t most_ground_laid_out = 4'000'000;

Scene with_less_ground(const Scene& scene, std::uint64_t facets) {
  Scene out = scene;
  const double all = 2.0 * scene.ground->cells[0] * scene.ground->cells[1], share = std::sqrt(static_cast<double>(facets) / all);
  for (int axis = 0; axis < 2; ++axis) {
    const auto cells = std::max(1u, static_cast<std::uint32_t>(std::lround(scene.ground->cells[axis] * share)));
    out.ground->size[axis] *= static_cast<double>(cells) / scene.ground->cells[axis];
    out.ground->cells[axis] = cells;
  }
  out.periodic.reset();  // the ground no longer fills the cell
  return out;
}

/// What grows with the ground, grows in proportion to its facets.
std::uint64_t extrapolated(std::uint64_t less, std::uint64_t more, double steps) {
  const double grown = static_cast<double>(more) - static_cast<double>(less);
  return static_cast<std::uint64_t>(std::llround(std::max(0.0, static_cast<double>(more) + std::max(0.0, grown) * steps)));
}

void extrapolate(const std::vector<PlanFigure>& less, std::vector<PlanFigure>& more, double steps) {
  for (auto& figure : more)
    for (const auto& other : less)
      if (other.name == figure.name) figure.amount = extrapolated(other.amount, figure.amount, steps);
}

}  // namespace

Plan make_plan(const Scene& scene, const MethodChoice& choice, const RunSettings& run, Progress& progress, std::uint64_t program) {
  const auto counts = count(scene);
  if (!scene.ground || scene.ground->mesh || counts.ground_facets <= most_ground_laid_out)
    return plan_of(scene, choice, run, progress, program);
  const Plan less = plan_of(with_less_ground(scene, most_ground_laid_out / 8), choice, run, progress, program);
  Plan plan = plan_of(with_less_ground(scene, most_ground_laid_out / 4), choice, run, progress, program);
  const auto grown = static_cast<double>(plan.counts.ground_facets - less.counts.ground_facets);
  const double steps = static_cast<double>(counts.ground_facets - plan.counts.ground_facets) / grown;
  extrapolate(less.memory, plan.memory, steps);
  extrapolate(less.work, plan.work, steps);
  plan.at_once = extrapolated(less.at_once, plan.at_once, steps);
  plan.counts = counts;
  for (auto& item : plan.items) {
    if (item.name == "ground")
      item.why = fmt::format("{} in the same system as the leaves", counted(counts.ground_facets, "facet", "facets"));
    if (item.name == "periodicity" && scene.periodic) item = periodicity_item(scene);
  }
  plan.items.push_back({"prediction", true, "from two smaller pieces of the ground, in proportion to its facets"});
  return plan;
}

std::uint64_t Plan::memory_total() const {
  if (at_once > 0) return at_once;
  std::uint64_t total = 0;
  for (const auto& part : memory) total += part.amount;
  return total;
}

}  // namespace sunfleck
