// What a user says of a run: how a scene's light is found, and what of it is kept. Nothing of the scene itself.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/scene/depth.hpp>

namespace sunfleck {

enum class Quality { draft, standard, fine };
std::string name_of(Quality quality);
/// "draft", "standard" or "fine"; nothing for any other text.
std::optional<Quality> quality_from_name(const std::string& name);

/// Names of methods: "instantiation", "clustering", "flat", "direct", "lattice", "occlusion", "reference".
const std::vector<std::string>& method_names();

/// An rms error of an organ's absorbed light over the mean that is wanted in a band; in all of them, where `band` is empty.
struct WantedError {
  std::string band;
  double error = 0;
};

/// How light is found; what is not said is chosen by the program.
struct RunSettings {
  std::optional<std::string> method;  ///< of method_names(); nothing: the one that suits the scene
  std::optional<Quality> quality;     ///< nothing: standard
  std::vector<WantedError> error;     ///< in the place of a quality: solves until its certificate says that the error is reached
  std::optional<std::uint64_t> seed;  ///< of all sampling; nothing: 1
  std::optional<bool> certificate;    ///< path-traces some organs to tell the error of the result; nothing: yes
  std::optional<std::uint32_t> certificate_organs;  ///< that are traced; nothing: 240
  std::optional<std::uint64_t> certificate_rays;    ///< that are spent on them, about; nothing: by the size of the scene
  std::optional<std::uint32_t> samples;             ///< method reference: paths per facet
  std::optional<std::string> lattice_mapping;        ///< method lattice: "matched" or "paper"; nothing: matched
  std::optional<std::uint32_t> lattice_nodes;        ///< method lattice: along the longest side; nothing: by the quality
  std::optional<std::string> occlusion_model;       ///< method occlusion: "table" or "paper"; nothing: table
  Depth depth;                                      ///< which placements are opened, and down to what
  int threads = 0;                                  ///< 0: all cores. Results have the same bits for any number
};

/// `given`, and what it does not say from `defaults`.
RunSettings filled_up(RunSettings given, const RunSettings& defaults);

/// What a result keeps.
struct OutputChoice {
  bool facets = true;               ///< false keeps organs only
  std::vector<std::string> fields;  ///< dataset names as in the result ("facets/irradiance"); empty = all
};

/// Names that [output] fields may list: "facets/irradiance", ... Rows of names and places are always kept.
const std::vector<std::string>& output_fields();

}  // namespace sunfleck
