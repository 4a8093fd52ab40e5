// The parts of a result file that a scene fixes before anything is solved.
#pragma once

#include <sunfleck/scene/facet_rows.hpp>

#include "result/row_dataset.hpp"

namespace sunfleck::h5 {

/// /bands, /states, /optics
void write_light_and_optics(OutputFile& file, ArrayWriter& arrays, const Scene& scene, const std::vector<Optics>& materials);
/// /names
void write_names(OutputFile& file, ArrayWriter& arrays, const OrganNames& names, std::vector<std::string> placements);
/// /geometry: unique meshes once, and the maps that place them.
void write_geometry(OutputFile& file, ArrayWriter& arrays, const Scene& scene, const PlacedScene& placed);

}  // namespace sunfleck::h5
