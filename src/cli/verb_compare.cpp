#include <sunfleck/cli/verbs.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sunfleck/result/compare.hpp>

#include "cli/json_text.hpp"
#include "cli/result_status.hpp"

namespace sunfleck {

namespace {

nlohmann::ordered_json json_of(const std::vector<BandError>& errors, const std::vector<std::string>& bands) {
  auto json = nlohmann::ordered_json::object();
  for (std::size_t b = 0; b < bands.size(); ++b) {
    const auto& e = errors[b];
    json[bands[b]] = {{"bias", e.bias},   {"rmse", e.rmse}, {"maximum", e.maximum},
                      {"noise", e.noise}, {"mean", e.mean}, {"quantity", e.irradiance ? "irradiance" : "absorbed"},
                      {"count", e.count}};
  }
  return json;
}

/// The method, and the status where it is not the usual one.
std::string made_by(const Result& file) {
  const auto& header = file.header();
  return header.status == "converged" ? header.method : header.method + ", " + header.status;
}

void print_rows(const std::string& state, const std::vector<BandError>& errors, const Result& reference) {
  for (std::size_t b = 0; b < errors.size(); ++b) {
    const auto& e = errors[b];
    fmt::print("  {:<12} {:<8} {:>+9.3f} % {:>9.3f} % {:>9.3f} % {:>9.3f} %  {:>11.5g} {}{}\n", state, reference.bands()[b], 100 * e.bias,
               100 * e.rmse, 100 * e.maximum, 100 * e.noise, e.mean, reference.band_units()[b],
               e.irradiance ? " (irradiance: next to nothing is absorbed)" : "");
  }
}

void print_table(const char* what, const ErrorTable& table, const Result& reference) {
  const std::size_t states = table.states.size();
  fmt::print("{} ({} compared)\n  {:<12} {:<8} {:>11} {:>11} {:>11} {:>11}  {:>11}\n", what, table.overall[0].count / states, "state",
             "band", "bias", "rmse", "maximum", "noise", "mean");
  if (states > 1)
    for (std::size_t s = 0; s < states; ++s) print_rows(reference.states()[s].name, table.states[s], reference);
  print_rows("all", table.overall, reference);
}

}  // namespace

int verb_compare(const CompareOptions& options, Progress& progress) {
  const Result result(options.result), reference(options.reference);
  say_status(result, progress);
  say_status(reference, progress);
  const Comparison c = compare(result, reference, !options.ignore_places);
  const auto& bands = reference.bands();
  if (options.json) {
    nlohmann::ordered_json json;
    json["result"] = {{"file", options.result}, {"method", result.header().method}, {"status", result.header().status}};
    json["reference"] = {{"file", options.reference}, {"method", reference.header().method}, {"status", reference.header().status}};
    json["notes"] = c.notes;
    json["organs"] = json_of(c.organs.overall, bands);
    if (!c.facets.empty()) json["facets"] = json_of(c.facets.overall, bands);
    json["states"] = nlohmann::ordered_json::array();
    for (std::size_t s = 0; s < reference.states().size(); ++s) {
      nlohmann::ordered_json state;
      state["name"] = reference.states()[s].name;
      state["organs"] = json_of(c.organs.states[s], bands);
      if (!c.facets.empty()) state["facets"] = json_of(c.facets.states[s], bands);
      json["states"].push_back(state);
    }
    fmt::print("{}\n", json_text(json));
    return 0;
  }
  fmt::print("result     {} ({})\nreference  {} ({})\n", options.result, made_by(result), options.reference, made_by(reference));
  for (const auto& note : c.notes) fmt::print("note       {}\n", note);
  fmt::print(
      "Absorbed power per area, area-weighted, over the reference's mean; the reference's noise is taken out of rmse, not of maximum.\n\n");
  print_table("per organ", c.organs, reference);
  if (c.facets.empty())
    fmt::print("\nper facet: not compared, since not both files keep facets\n");
  else
    fmt::print("\n"), print_table("per facet", c.facets, reference);
  return 0;
}

}  // namespace sunfleck
