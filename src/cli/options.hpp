// The command line of each verb: its options, their help and what they may hold. CLI11 is slow to compile: only options_*.cpp,
// validators.cpp and program.cpp include it.
#pragma once

#include <sunfleck/cli/verbs.hpp>

namespace CLI {
class App;
}

namespace sunfleck {

// options_solve.cpp
void define_solve(CLI::App& verb, SolveOptions& o);
void define_plan(CLI::App& verb, PlanOptions& o);
void define_compare(CLI::App& verb, CompareOptions& o);

// options_result.cpp
void define_export(CLI::App& verb, ExportOptions& o);
void define_info(CLI::App& verb, InfoOptions& o);
void define_render(CLI::App& verb, RenderOptions& o);
void define_preview(CLI::App& verb, PreviewOptions& o);
void define_view(CLI::App& verb, ViewOptions& o);

// options_plant.cpp
void define_generate(CLI::App& verb, GenerateOptions& o);
void define_import(CLI::App& verb, ImportOptions& o);
void define_originals(CLI::App& verb, OriginalsOptions& o);
void define_policy(CLI::App& verb, PolicyOptions& o);

}  // namespace sunfleck
