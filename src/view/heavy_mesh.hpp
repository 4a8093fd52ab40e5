// Points, triangles and values of a lit mesh as HDF5 datasets, streamed.
#pragma once

#include <functional>

#include <sunfleck/view/export.hpp>

#include "result/row_dataset.hpp"
#include "view/lit_colours.hpp"
#include "view/lit_mesh.hpp"

namespace sunfleck::h5 {

/// Points [v, 3] float64 [m], in the order of facets.
void write_points(OutputFile& file, ChunkQueue& queue, hid_t group, const char* name, const LitMesh& mesh, Progress& progress, double end);

/// Rows of `type` (H5T_NATIVE_INT64 or _UINT32) [n * 3] or [n, 3].
void write_triangles(OutputFile& file, ChunkQueue& queue, hid_t group, const char* name, const LitMesh& mesh, bool flat, Progress& progress,
                     double begin, double end);

/// Colour of every facet [n, 3] uint8, sRGB codes.
void write_colours(OutputFile& file, ChunkQueue& queue, hid_t group, const char* name, const LitMesh& mesh, const LitColours& colours,
                   Progress& progress, double begin, double end);

}  // namespace sunfleck::h5
