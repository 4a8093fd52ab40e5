// Procedural species: parameter sets that grow into a plant, the same bits for the same age and seed.
//
// Two growth programs, no species in the code:
//  - tree: axes made of yearly growth units, their parameters indexed by physiological age (the class of an axis), after
//    de Reffye, Edelin, Francon, Jaeger, Puech 1988, "Plant models faithful to botanical structure and development",
//    doi:10.1145/54852.378505; cross-sections by the pipe model (Shinozaki et al. 1964, doi:10.18960/seitai.14.3_97).
//  - cereal: a stem of phytomers that appear one phyllochron apart, with tillers and inflorescences, after
//    Fournier & Andrieu 1998, "A 3D architectural and process-based model of maize development", doi:10.1006/anbo.1997.0549.
// docs/species.md holds the model; the ranges of all parameters stand beside their names in src/format/species_toml.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <sunfleck/plant/plant.hpp>

namespace sunfleck {

/// Half-width of a blade, relative to half of the full width, at relative positions from base (0) to tip (1), increasing.
using Outline = std::vector<std::array<double, 2>>;

/// Leaves of a tree: one blade on a petiole, or leaflets in pairs along a rachis with one at its end.
struct LeafParameters {
  double length_m = 0.08;    ///< blade, or leaflet
  double width_ratio = 0.6;  ///< full width / length of the blade
  Outline outline{{0.0, 0.0}, {0.3, 1.0}, {0.7, 0.8}, {1.0, 0.0}};
  double fold_deg = 12.0;              ///< each half rises by this angle from the midrib
  double curvature_deg = 20.0;         ///< from base to tip the blade bends down by this angle
  double petiole_ratio = 0.3;          ///< petiole length / blade length
  double petiole_width_ratio = 0.03;   ///< petiole width / blade length
  double hinge_deg = 20.0;             ///< the blade turns down by this angle where the petiole ends
  double insertion_deg = 60.0;         ///< between stem and petiole
  double insertion_spread_deg = 10.0;  ///< half-width of the uniform spread
  double droop_deg = 0.0;              ///< the whole leaf turns down by this angle
  double uprightness = 0.7;            ///< 0: the front faces the stem's apex; 1: it is turned to the sky
  double size_spread = 0.15;           ///< half-width of the uniform relative spread of lengths
  double life_years = 1.0;             ///< growth units older than this are bare
  std::int64_t leaflets_low = 1;       ///< 1 = a simple leaf; else odd counts from low to high
  std::int64_t leaflets_high = 1;
  double rachis_length_m = 0.2;  ///< of a leaf with leaflets_high leaflets, petiole included
  double rachis_radius_m = 0.001;
  double rachis_curvature_deg = 25.0;  ///< from base to end the rachis bends down by this angle
  double leaflet_angle_deg = 70.0;     ///< between rachis and leaflet
};

/// What axes of one physiological age do. Class 1 is the trunk.
struct AxisClass {
  double nodes = 10.0;         ///< of the first growth unit, at vigour 1
  double nodes_spread = 0.15;  ///< half-width of the uniform relative spread
  double internode_length_m = 0.03;
  double decline = 0.05;             ///< each growth unit has this share fewer nodes than the one before
  double lifetime_years = 100.0;     ///< then the axis is shed, with all it bears (self-pruning)
  std::int64_t strong_branches = 0;  ///< topmost buds of a growth unit that grow into axes of class strong_class
  std::int64_t strong_class = 2;
  double weak_probability = 0.0;  ///< chance that one of the other buds grows into an axis of class weak_class ...
  double acrotony = 1.0;          ///< ... times (relative height in the growth unit)^acrotony
  std::int64_t weak_class = 3;
  double basal_vigour = 0.6;    ///< vigour of the lowest lateral of a growth unit; the highest has 1
  double insertion_deg = 50.0;  ///< of axes of this class on what bears them
  double insertion_spread_deg = 8.0;
  double sag_deg = 0.0;           ///< the insertion angle grows by this much per year
  double elevation_deg = 90.0;    ///< the axis turns towards this angle above the horizontal ...
  double tropism_deg = 10.0;      ///< ... by this many degrees per metre
  double wobble_deg = 3.0;        ///< random turn at each node
  double divergence_deg = 137.5;  ///< between the azimuths of successive leaves
  double leaf_scale = 1.0;        ///< size of leaves relative to LeafParameters
  std::int64_t sides = 6;         ///< of the prisms that are its internodes
};

struct TreeGrowth {
  LeafParameters leaf;
  std::vector<AxisClass> axes;     ///< [physiological age - 1]
  double relay_deg = 0.0;          ///< 0: monopodial. Else the apex dies each year and its relay leaves at this angle (sympodial)
  double clear_trunk = 0.0;        ///< branches on the trunk below this share of its height are shed
  std::int64_t highest_order = 4;  ///< buds of axes of this order stay dormant; the trunk has order 1
  std::int64_t merge_nodes = 4;    ///< in wood, at most so many internodes without a living branch become one
  double tip_radius_m = 0.0015;    ///< radius of the last internode of an axis
  double pipe_exponent = 2.2;      ///< radius^exponent below a fork = sum over what it bears
  double pipe_per_node = 0.3;      ///< each node adds this share of a tip's radius^exponent
};

/// A spike, or several: ear, tassel, panicle.
struct Inflorescence {
  std::string type = "ear";  ///< structure type
  double rank = 1.0;         ///< where on the stem: 0 lowest node, 1 its top
  double appears = 60.0;     ///< age at which it appears [days]
  double expansion = 15.0;   ///< time from then to full size [days]
  double length_m = 0.1;
  double radius_m = 0.008;
  std::int64_t spikes = 1;
  double spread_deg = 0.0;     ///< between the middle spike and the outermost
  double insertion_deg = 0.0;  ///< between the stem and it
  std::int64_t spikelets = 0;  ///< in two rows along each spike; 0: a smooth spindle
  double awn_length_m = 0.0;   ///< 0: none
};

struct CerealGrowth {
  double leaves = 10.0;        ///< on the main stem
  double leaves_spread = 0.0;  ///< half-width of the uniform spread
  double phyllochron = 6.0;    ///< time between two leaves [days]
  double expansion = 12.0;     ///< time from a leaf's appearance to its full length [days]
  double leaf_life = 60.0;     ///< a leaf is shed this long after it appeared [days]
  // stem: what one sees between two collars (sheaths included)
  double basal_nodes = 4.0;  ///< so many lowest nodes stay short
  double basal_length_m = 0.01;
  double upper_length_m = 0.1;
  double elongation_start = 0.0;   ///< before this age all internodes stay as short as the basal ones [days]
  double peduncle_length_m = 0.0;  ///< bare stem between the highest collar and an inflorescence at the top
  double base_radius_m = 0.004;
  double top_radius_m = 0.002;
  std::int64_t sides = 6;
  double lean_deg = 4.0;  ///< largest lean of the main stem
  // blades
  double blade_length_m = 0.3;   ///< of the longest
  double blade_width_m = 0.015;  ///< of the widest
  double longest_rank = 0.6;     ///< relative rank of the longest blade
  double first_blade = 0.3;      ///< length of the lowest blade, relative to the longest
  double last_blade = 0.6;       ///< length of the highest blade, relative to the longest
  Outline outline{{0.0, 0.6}, {0.3, 1.0}, {0.7, 0.7}, {1.0, 0.0}};
  std::int64_t segments = 8;          ///< along a blade; 4 triangles each, 2 the last
  double fold_deg = 15.0;             ///< each half rises by this angle from the midrib
  double insertion_first_deg = 50.0;  ///< between stem and the lowest blade
  double insertion_last_deg = 20.0;   ///< between stem and the highest blade
  double insertion_spread_deg = 5.0;
  double curvature_first_deg = 60.0;  ///< from base to tip the lowest blade bends down by this angle
  double curvature_last_deg = 90.0;   ///< the same of the highest blade
  double curvature_spread_deg = 20.0;
  double divergence_deg = 180.0;  ///< between the azimuths of successive blades; 180 = distichous
  double divergence_spread_deg = 10.0;
  // tillers
  std::int64_t tillers = 0;  ///< highest number on one stem, from its lowest leaf axils upwards
  double tiller_probability = 1.0;
  double tiller_delay = 3.0;          ///< a tiller's first leaf appears so many phyllochrons after the leaf that bears it
  double tiller_deg = 30.0;           ///< its angle from the stem
  double tiller_straightening = 0.3;  ///< at each node it turns up by this share of what is left
  double tiller_leaves = 0.8;         ///< leaves of a tiller's final number, relative to those left on its stem
  double tiller_scale = 0.9;          ///< its lengths relative to the stem's
  std::int64_t highest_order = 2;     ///< the main stem has order 1
  std::vector<Inflorescence> inflorescences;
};

struct Species {
  std::string name;
  std::string file;                      ///< for messages; empty if made in memory
  std::string age_unit;                  ///< "years" for trees, "days" after emergence for cereals
  double age = 1.0;                      ///< grown to this age if none is asked for
  double age_low = 0.0, age_high = 1.0;  ///< ages it is meant for
  std::uint64_t seed = 1;
  std::variant<TreeGrowth, CerealGrowth> growth;
};

/// Grows a plant of this age. Structures: plant > trunk > growth_unit > metamer > internode, leaf (or leaf > rachis, leaflet),
/// branch > growth_unit ... of a tree; plant > stem > metamer > internode, leaf, tiller > ... and inflorescences of a cereal. Organs are
/// the structures with shapes: leaf, leaflet, rachis, internode, inflorescences. Attributes of every structure:
///   leaf_count (int)         leaves in and below it (a compound leaf is one; its leaflets hold none)
///   order (int)              branching order, 1 for the trunk or main stem, 0 for the plant
///   physiological_age (int)  class of its axis; 0 for the plant. Cereals: its order
///   length (double)          along its axis [m]; height for the plant
/// Materials: leaf, bark (tree) or stem (cereal), ear. Fronts of leaves are adaxial. z = 0 is the ground; nothing lies below.
/// Throws InputError for an age outside [age_low, age_high], and if the plant would have more than 4 million nodes.
Plant grow(const Species& species, double age, std::uint64_t seed);

/// Leaves (structures of type leaf) of a plant that was grown, and their one-sided area [m^2].
struct LeafTotals {
  std::size_t leaves = 0;
  double area_m2 = 0;
};
LeafTotals leaf_totals(const Plant& plant);

}  // namespace sunfleck
