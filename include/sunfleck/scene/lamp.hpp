// Lamps: Lambertian area emitters, and luminaires described by photometric files.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/light/photometry.hpp>
#include <sunfleck/plant/mesh.hpp>
#include <sunfleck/scene/placement.hpp>

namespace sunfleck {

struct Scene;

/// A kind of lamp and where its copies hang. Either a mesh, each of whose faces shines from its front with the same radiance in all
/// directions, or the intensities of a photometric file. A lamp is light and nothing else: it does not shade, reflect or absorb. Where
/// its housing matters, the same mesh placed as a plant stands for it.
struct LampEntry {
  std::string name;
  Mesh mesh;                                     ///< [m]; empty with `photometry`
  std::shared_ptr<const Photometry> photometry;  ///< null with `mesh`; prepared
  bool by_power = false;                         ///< what `strength` is; always with photometry
  std::vector<double> strength;                  ///< per band: exitance [W m^-2], or power that each copy gives off [W]
  std::vector<Placement> placements;             ///< in the world
  std::vector<std::uint32_t> states;             ///< rows of Scene::states in which it shines; empty = all
};

/// All lamps of a scene in the world.
struct Lamps {
  static constexpr std::uint32_t none = 0xffffffffu;

  struct Unit {                    ///< one copy of a lamp
    std::uint32_t entry;           ///< row of Scene::lamps
    std::vector<double> exitance;  ///< of its faces, per band [W m^-2]; empty with photometry
    std::vector<double> power;     ///< per band [W]
  };
  struct Face {  ///< shines from the side of `normal`
    Triangle corners;
    Vec3 normal;
    double area;  ///< [m^2]
    std::uint32_t unit;
  };
  struct Beam {
    Vec3 position;  ///< of the opening's centre [m]
    Vec3 x, y;      ///< edges of the opening's rectangle, from side to side [m]; zero for a point
    Mat3 to_lamp;   ///< world -> the lamp's frame, an orthogonal matrix
    const Photometry* photometry;
    std::uint32_t unit;
    /// The point of the opening for (u, v) uniform in [0, 1)^2.
    Vec3 point(double u, double v) const;
  };

  std::vector<Unit> units;
  std::vector<Face> faces;  ///< with an area above zero
  std::vector<Beam> beams;
  /// Which lamps shine together: sets of entries that some state has; states with the same lamps share a set.
  std::vector<std::vector<bool>> sets;      ///< [set][entry]
  std::vector<std::uint32_t> set_of_state;  ///< [s] row of `sets`, or none

  bool empty() const { return units.empty(); }
  bool shines(std::size_t set, std::uint32_t unit) const { return sets[set][units[unit].entry]; }
};

/// The scene must have passed check_scene() and outlive the result.
Lamps place_lamps(const Scene& scene);

/// Draws light as it leaves the lamps: units by lamp_shares(), points uniform over faces and openings, directions by cosine or uniform
/// over the sphere.
class LampEmission {
 public:
  explicit LampEmission(const Lamps& lamps);
  struct Particle {
    Vec3 from, direction;
    std::uint32_t unit = 0;
    double weight = 0;  ///< times the unit's power of a band: power of the particle, for one particle in all
  };
  /// x [5] uniform in [0, 1).
  Particle draw(const double* x) const;
  /// The sum of lamp_shares(): 0 where no lamp gives off anything.
  double power() const { return cumulative_.empty() ? 0.0 : cumulative_.back(); }

 private:
  const Lamps& lamps_;
  std::vector<double> cumulative_;  ///< of lamp_shares()
};

}  // namespace sunfleck
