// Which structures of a scene share an original: exact copies first, then what policies declare alike.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/policy/policy.hpp>
#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

inline constexpr std::uint32_t no_class = 0xffffffffu;

/// A structure of the scene, wherever it is placed: a group, a plant (structure 0), or a structure within a plant, with all below it.
struct StructureRef {
  bool is_group = false;
  std::uint32_t index = 0;      ///< row of Scene::groups or Scene::plants
  std::uint32_t structure = 0;  ///< row of Plant::structures
  friend bool operator==(const StructureRef&, const StructureRef&) = default;
};

struct ClassMember {
  StructureRef structure;
  /// Frame in which the representative lies -> frame in which the member lies: a similarity (rotation, mirror, uniform scale, move).
  /// These frames are the plant's for a structure of a plant. A whole plant or group lies in its own: then the map is the identity,
  /// and where it is placed is told by the scene.
  Affine from_representative;
  double scale = 1.0;        ///< of that map: areas of the representative times scale^2
  std::uint64_t copies = 0;  ///< how often the scene places it, at most too_many_copies
  double area_m2 = 0;        ///< one-sided, of its own geometry [m^2]
};

enum class Likeness {
  exact,  ///< all members have the geometry of the representative (to 1e-5 of its size) and its optics
  policy  ///< a policy says that they scatter light alike; each has geometry of its own
};

struct OriginalClass {
  std::string name;  ///< "branch: leaf_count [4, 16), order [2, 3)"
  Likeness likeness = Likeness::exact;
  std::uint32_t representative = 0;  ///< row of members
  std::vector<ClassMember> members;  ///< in scene order
  std::uint64_t copies = 0;          ///< of all members together
  std::uint64_t facets = 0;          ///< of the representative
  TableSettings tables;              ///< of the policy, or the defaults
  /// The original is the representative's geometry under this map: the identity but for copies that are placed with a shear or a
  /// stretch, which share no tables with others and get an original of their own.
  Mat3 stretch{1.0};
};

/// Classes of a scene. A structure may have a class while structures within it have theirs: a solver closes the outermost it likes.
struct Classification {
  std::vector<OriginalClass> classes;
  std::vector<std::vector<std::uint32_t>> of_structure;  ///< [plants][structures] row of classes, or no_class; [p][0] is the plant
  std::vector<std::uint32_t> of_group;                   ///< [groups]
  std::vector<std::string> notes;                        ///< what the user should know: types that no plant has, values left out

  std::uint32_t of(const StructureRef& s) const { return s.is_group ? of_group[s.index] : of_structure[s.index][s.structure]; }
};

/// Policies by the file that a plant names (PlantEntry::policy_file).
using PolicySet = std::map<std::string, Policy>;

/// Exact classes: structures of one type whose facets, in the order of the file, are those of another up to rotation, mirror, uniform
/// scale and move, with the same optics; at least two of them, of at least 16 facets. Whole plants and groups that the scene places at
/// least twice. Policy classes: structures that are in no exact class, of one type (of any type under "*" unless `type` is a parameter) and
/// policy, whose parameters fall into the same intervals and whose facets use the same optics; at least PolicyType::least_members of them.
/// Plants that name the same policy file share classes, so that ten poplars of various ages share one branch.
///
/// Values of parameters: the attribute of that name, else derived: `type`; `leaf_count`: structures of type leaf (in any case) in and
/// below it; `order`: axis-like structures (types axis, branch, trunk, stem, tiller in any case) from the plant down to it; `area`:
/// one-sided, of all its facets [m^2]; `length`: its extent along its own axis [m]; `height`: its vertical extent in the plant's frame [m].
/// Medoid: least sum of distances over ln(area), ln(radius of gyration / sqrt(area)) and the tensor of facet normals in its own frame,
/// each weighted by one over its standard deviation, to at most 1000 members evenly picked.
///
/// Takes no time or memory for placed copies. Throws InputError with the policy's line for a parameter that no structure of the type has,
/// intervals on a text, values on a number, and a type that looks misspelt.
Classification classify(const Scene& scene, const PolicySet& policies);

/// A structure of a plant with all below it.
struct StructureFacets {
  std::vector<Triangle> corners;      ///< [n] plant frame [m], by structure (depth first), then in the order of the file
  std::vector<std::uint32_t> optics;  ///< [n] row of Scene::optics
  Affine frame;                       ///< the structure's own rigid frame -> plant frame; its axis runs along +z
  Mat3 upright{1.0};                  ///< the same as a turn about the vertical only (Alignment::upright)
};
StructureFacets structure_facets(const PlantEntry& entry, std::uint32_t structure);

/// Values of parameters of a structure, where they are numbers.
struct StructureValues {
  std::uint64_t facets = 0;                    ///< in and below it
  std::vector<std::optional<double>> numbers;  ///< in the order asked for
};
/// [structures of the plant]
std::vector<StructureValues> structure_values(const PlantEntry& entry, const std::vector<std::string>& parameters);

}  // namespace sunfleck
