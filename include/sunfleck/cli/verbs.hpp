// One struct of options and one function per verb; the command line is parsed into the structs (src/cli/options_*.cpp), verb_NAME.cpp does
// the work.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/format/import_scene.hpp>

namespace sunfleck {

struct SolveOptions {
  std::string scene, result;
  std::optional<std::string> method, quality;
  std::optional<std::string> error;  ///< wanted error, per organ: "2%", "0.02", "PAR=1%,NIR=2%"
  std::optional<std::uint64_t> seed;
  std::optional<std::uint32_t> samples;        ///< reference method, per facet
  std::optional<std::string> lattice_mapping;  ///< method lattice
  std::optional<std::uint32_t> lattice_nodes;  ///< method lattice, along the longest side
  std::optional<std::string> occlusion_model;  ///< method occlusion
  int threads = 0;
  std::optional<std::string> picture;  ///< .png that is drawn while rows come by
  std::vector<std::string> only;       ///< placements that are opened, as [solve] only
  std::optional<std::string> stop_at;  ///< as [solve] stop_at: TYPE, size=METRES or leaf_count=N
  bool certificate = true;
  std::optional<std::uint32_t> certificate_organs;  ///< organs that are path-traced
  std::optional<std::uint64_t> certificate_rays;    ///< rays to spend on them, about
};
int verb_solve(const SolveOptions& options, Progress& progress);

struct PlanOptions {
  std::string scene;
  std::optional<std::string> method, quality;
  int threads = 0;
  bool json = false;
};
int verb_plan(const PlanOptions& options, Progress& progress);

struct CompareOptions {
  std::string result, reference;
  bool json = false;
  bool ignore_places = false;  ///< plants that were moved or turned are compared row by row
};
int verb_compare(const CompareOptions& options, Progress& progress);

struct ExportOptions {
  std::string result, output;
  std::optional<std::string> quantity, band, state;
  std::optional<std::string> by;        ///< tables: keys that organs are summed by
  std::vector<std::string> sensors;     ///< tables: of these sensors ("all": of all) in the place of organs
  std::optional<std::string> copy;      ///< .opf: which copy, by its placement
  std::optional<std::string> original;  ///< .opf: the file that gains attributes
};
int verb_export(const ExportOptions& options, Progress& progress);

/// Where a picture is taken from, and its size.
struct CameraOptions {
  std::vector<double> eye, target;  ///< empty = frames the scene
  std::optional<double> azimuth_deg, elevation_deg, field_of_view_deg;
  bool orthographic = false;  ///< parallel projection
  int width = 1200, height = 900, samples = 9;
};

struct RenderOptions : CameraOptions {
  std::string result, output;
  std::optional<std::string> quantity, band, state, colormap;  ///< quantity: "colour" or a stored quantity
  std::vector<double> range;                                   ///< low, high; empty = from the data
  bool logarithmic = false, ground = true;
  bool map_ground = false;              ///< a map colours the ground by its values too
  bool infinite = false;                ///< a periodic scene is drawn with its repetition
  std::vector<std::string> views, rgb;  ///< rgb: names of three bands, as red, green and blue
  std::string cut;                      ///< "x=1.5", or six numbers: a point and a normal
  std::optional<std::string> reference, background;
  double exposure_stops = 0;
  bool scale_bar = false;
};
int verb_render(const RenderOptions& options, Progress& progress);

struct PreviewOptions : CameraOptions {
  PreviewOptions() { samples = 4; }
  std::string scene, output;
  std::optional<std::string> state;
  int threads = 0;
};
int verb_preview(const PreviewOptions& options, Progress& progress);

struct ViewOptions {
  std::string result;                        ///< or a scene, of which a preview is shown
  std::optional<std::string> other;          ///< to compare with it
  std::optional<std::string> listen, token;  ///< address other than the loopback; what requests must bring
  int port = 0;                              ///< 0 = any that is free
};
int verb_view(const ViewOptions& options, Progress& progress);

struct GenerateOptions {
  std::string species, output;
  std::optional<double> age;
  std::optional<std::uint64_t> seed;
};
int verb_generate(const GenerateOptions& options, Progress& progress);

struct InfoOptions {
  std::string file;
  bool json = false;
};
int verb_info(const InfoOptions& options, Progress& progress);

struct OriginalsOptions {
  std::string scene;
  std::optional<std::string> policy;  ///< takes the place of the policies that the scene names
  std::optional<std::string> cache;   ///< folder; default default_cache_folder()
  bool no_cache = false, tables = true;
  std::uint32_t spread = 0;  ///< members of each class that are compared with its representative
  std::uint64_t cache_limit_mib = 256;
  int threads = 0;
  bool json = false;
};
int verb_originals(const OriginalsOptions& options, Progress& progress);

struct PolicyOptions {
  std::string scene;
  bool suggest = false;
  std::optional<double> likeness;
  std::uint32_t measured = 48;
  int threads = 0;
};
int verb_policy(const PolicyOptions& options, Progress& progress);

struct ImportOptions {
  ImportChoice choice;
};
int verb_import(const ImportOptions& options, Progress& progress);

}  // namespace sunfleck
