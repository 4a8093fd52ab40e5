// The parts of a result file that a scene fixes before anything is solved.
#pragma once

#include <sunfleck/scene/facets.hpp>

#include "result/row_dataset.hpp"

namespace sunfleck::h5 {

/// /bands, /states, /optics
void write_light_and_optics(OutputFile& file, ArrayWriter& arrays, const Scene& scene, const FacetScene& facets);
/// /names and the index columns of /organs
void write_organ_names(OutputFile& file, ArrayWriter& arrays, hid_t organs_group, const FacetScene& facets);
/// /geometry: unique meshes once, and the maps that place them.
void write_geometry(OutputFile& file, ArrayWriter& arrays, const Scene& scene, const FacetScene& facets);

}  // namespace sunfleck::h5
