// Reading plants. One file a format; this is the door.
#pragma once

#include <string>

#include <sunfleck/plant/plant.hpp>

namespace sunfleck {

/// Reads a plant by the suffix of its file (in any case): .opf, .obj, .ply, .can, .h5 (ours) or .toml (a species, grown). Lengths of
/// the file are multiplied by unit_m [m] (0.01 for cm; species and our own files are in metres already). Keeps the file's hierarchy,
/// every face in its order (zero-area ones too, polygons as fans from their first vertex) and double-precision coordinates.
/// Throws InputError naming file and line, byte or key: what was found and what was expected.
Plant read_plant(const std::string& file, double unit_m = 1.0);

/// Open Plant Format: topology with types and attributes, shared meshes with matrices and taper. Structures are named by their Name
/// or CLASS_ID; attributes "scale" and "id" hold those of the element. Values "NA" and "NaN" are left out.
Plant read_opf(const std::string& file);

/// Wavefront OBJ: a group, or an object without groups, is an organ (type "organ", named alike); an object with groups is a structure
/// between. Without either, organs are what shares vertices. Materials by `usemtl`; the library named by `mtllib` is not opened.
Plant read_obj(const std::string& file);

/// PLY, ascii or binary of either order. Organs are what shares vertices, or the face property "organ" (a whole number) where there is one.
Plant read_ply(const std::string& file);

/// CARIBU/canestra .can with OpenAlea's labels: species (1 digit), plant (5), leaf (3), element (3). Below the whole (type "canopy")
/// come the plants, below them organs by plant and leaf digits, of type "leaf" (leaf above 0), "stem", or "soil" (species 0 too), with
/// attributes label (of the first polygon), plant, leaf, optical_species, transparency. Materials are "species_1", "species_2", ...
Plant read_can(const std::string& file);

/// Our own plant file (HDF5): gives back what write_plant_h5 was given, bit by bit; only Plant::file becomes the path read from.
Plant read_plant_h5(const std::string& file);

/// Writes under a temporary name and renames when all is on disk. The same plant gives the same bytes. Throws OutputError, and InputError
/// for a plant that check_plant refuses.
void write_plant_h5(const Plant& plant, const std::string& file);

}  // namespace sunfleck
