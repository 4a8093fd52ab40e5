#include "occlusion/stand.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <tbb/parallel_for.h>

namespace sunfleck {

namespace {

using std::numbers::pi;

constexpr std::size_t rays_from_shell = 64, rays_from_ground = 64;
constexpr double covering = 0.7;       // of the ground under shells, from which a stand is a layer
constexpr double lowest_stand = 0.25;  // height over width of a finite one
constexpr double tables_per_e = 50.0;  // tables of optical radii closer than 2 % are shared
constexpr int most_points_a_side = 8;  // of a facet of the ground

}  // namespace

OccludedSky::OccludedSky(const FacetRows& rows, const std::vector<const Sky*>& skies, OcclusionModel model)
    : skies_(skies), model_(model), grid_({}, std::nullopt) {
  place_crowns(rows);
  find_layer(rows);
  for (const auto* sky : skies_) directions_.push_back(sky_directions(*sky, rays_from_shell));
  if (profile_)
    for (const auto* sky : skies_) layer_.emplace_back(*sky, profile_->whole());
  else
    look_out();
}

void OccludedSky::place_crowns(const FacetRows& rows) {
  const Scene& scene = rows.scene();
  const PlacedScene& placed = rows.placed();
  crowns_.assign(scene.plants.size(), CrownShells{});
  std::vector<bool> known(scene.plants.size(), false);
  std::vector<std::uint32_t> wanted;
  for (const auto& copy : placed.copies)
    if (!known[copy.plant]) known[copy.plant] = true, wanted.push_back(copy.plant);
  tbb::parallel_for(std::size_t{0}, wanted.size(),
                    [&](std::size_t i) { crowns_[wanted[i]] = crown_shells(*scene.plants[wanted[i]].plant); });
  std::vector<CrownShell> shells;
  for (const auto& copy : placed.copies) {
    first_shell_.push_back(static_cast<std::uint32_t>(shells.size()));
    plant_of_.push_back(copy.plant);
    for (const auto& shell : crowns_[copy.plant].shells) shells.push_back(shell.placed(copy.map));
  }
  grid_ = ShellGrid(std::move(shells), scene.periodic);
}

/// Where shells cover the cell, or a wide and low stand.
void OccludedSky::find_layer(const FacetRows& rows) {
  const auto& shells = grid_.shells();
  const auto& periodic = rows.scene().periodic;
  Box box;
  double covered = 0.0;
  for (const auto& s : shells) {
    const Vec3 half = s.half_extent();
    box.add(s.centre - half), box.add(s.centre + half);
    covered += pi * half.x * half.y;
  }
  if (shells.empty()) return;
  const Vec3 size = box.size();
  const double ground_area = periodic ? periodic->area() : size.x * size.y;
  const bool low = periodic || size.z < lowest_stand * std::min(size.x, size.y);
  if (!low || !(covered > covering * ground_area)) return;
  profile_.emplace(box.low.z, box.high.z, ground_area);
  for (std::uint32_t copy = 0; copy < rows.placed().copies.size(); ++copy)
    rows.visit(copy, 0, rows.facet_count(copy), [&](std::uint64_t, const Triangle& t, std::uint32_t, std::uint32_t) {
      profile_->add((t[0].z + t[1].z + t[2].z) / 3.0, glm::length(area_vector(t)));
    });
  profile_->finish();
}

/// Tables of the shells, and what reaches each from outside, past the others.
void OccludedSky::look_out() {
  const auto& shells = grid_.shells();
  std::map<long, std::shared_ptr<const BallTable>> tables;
  std::vector<long> key(shells.size());
  for (std::size_t s = 0; s < shells.size(); ++s) {
    optical_radius_.push_back(shells[s].optical_radius());
    normals_to_ball_.push_back(glm::transpose(glm::inverse(shells[s].to_ball)));
    key[s] = std::lround(tables_per_e * std::log(std::max(optical_radius_[s], 1e-4)));
    tables.try_emplace(key[s]);
  }
  if (model_ == OcclusionModel::table) {
    std::vector<std::pair<const long, std::shared_ptr<const BallTable>>*> all;
    for (auto& entry : tables) all.push_back(&entry);
    tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
      all[i]->second = std::make_shared<const BallTable>(std::exp(static_cast<double>(all[i]->first) / tables_per_e));
    });
    for (const auto k : key) table_.push_back(tables[k]);
  }
  ambient_.resize(shells.size() * skies());
  tbb::parallel_for(std::size_t{0}, shells.size(), [&](std::size_t s) {
    for (std::size_t k = 0; k < skies(); ++k)
      for (const auto& d : directions_[k]) {
        const bool past_others = model_ == OcclusionModel::table && d.light > 0.0;
        const double depth = past_others ? grid_.optical_depth(shells[s].centre, d.towards, static_cast<std::uint32_t>(s)) : 0.0;
        ambient_[s * skies() + k].add(d.towards, d.light * std::exp(-depth));
      }
  });
}

std::uint32_t OccludedSky::shell_of(std::uint32_t copy, std::uint64_t facet) const {
  return first_shell_[copy] + crowns_[plant_of_[copy]].of_facet[facet];
}

void OccludedSky::on_leaf(std::uint32_t shell, const Vec3& point, const Vec3& normal, double* light) const {
  const std::size_t n = skies();
  if (profile_) {
    const double above = profile_->above(point.z), height = (point.z - profile_->low()) / (profile_->high() - profile_->low());
    for (int side = 0; side < 2; ++side) {
      const double z = side == 0 ? normal.z : -normal.z;
      for (std::size_t k = 0; k < n; ++k)
        light[side * n + k] = model_ == OcclusionModel::table ? layer_[k].on(z, above) : std::clamp(height, 0.0, 1.0) * 0.5 * (1.0 + z);
    }
    return;
  }
  const auto& s = grid_.shells()[shell];
  Vec3 out = s.to_ball * (point - s.centre);
  const double radius = glm::length(out);
  out = radius > 0.0 ? out / radius : Vec3{0.0, 0.0, 1.0};
  for (int side = 0; side < 2; ++side) {
    const Vec3 towards = side == 0 ? normal : -normal;
    for (std::size_t k = 0; k < n; ++k) {
      const auto& ambient = ambient_[shell * n + k];
      // Light that comes from above alone does not reach a side through all of the ball about its normal. What the side sees of it is about
      // the sum of its normal and the light's mean direction: errors of random leaves at k R = 2 fall from 30 to 23 %.
      const Vec3 in_ball = normals_to_ball_[shell] * (model_ == OcclusionModel::table ? towards + ambient.mean_direction() : towards);
      const double length = glm::length(in_ball);
      const BallPlace place{std::min(radius, 1.0), length > 0.0 ? std::clamp(glm::dot(in_ball, out) / length, -1.0, 1.0) : 0.0};
      const double seen = model_ == OcclusionModel::table ? table_[shell]->at(place) : cap_visibility(place, optical_radius_[shell]);
      light[side * n + k] = seen * ambient.on(towards);
    }
  }
}

void OccludedSky::add_at_ground(const Vec3& point, const Vec3& normal, double share, double* light) const {
  const std::size_t n = skies();
  if (model_ == OcclusionModel::paper) {
    double hidden = 0.0;
    for (const auto& s : grid_.shells()) {
      const Vec3 to = s.centre - point;
      hidden += 0.5 * std::min(1.0, s.radius * s.radius / std::max(glm::dot(to, to), 1e-300));
    }
    for (std::size_t k = 0; k < n; ++k) light[k] += share * std::max(0.0, 1.0 - hidden) * 0.5 * (1.0 + normal.z);
    return;
  }
  for (std::size_t k = 0; k < n; ++k)
    for (const auto& d : directions_[k]) {
      const double cosine = glm::dot(normal, d.towards);
      if (d.light > 0.0 && cosine != 0.0)
        light[(cosine > 0.0 ? 0 : n) + k] +=
            share * d.light * std::abs(cosine) * std::exp(-grid_.optical_depth(point, d.towards, ShellGrid::none));
    }
}

void OccludedSky::on_ground(const Triangle& corners, const Vec3& normal, double* light) const {
  const std::size_t n = skies();
  std::fill(light, light + 2 * n, 0.0);
  if (profile_) {
    for (std::size_t k = 0; k < n; ++k)
      for (int side = 0; side < 2; ++side)
        light[side * n + k] = model_ == OcclusionModel::table ? layer_[k].on(side == 0 ? normal.z : -normal.z, profile_->whole()) : 0.0;
    return;
  }
  double width = 0.0;
  for (const auto& s : grid_.shells()) width += s.radius;
  width /= static_cast<double>(std::max<std::size_t>(grid_.shells().size(), 1));
  const double longest =
      std::max({glm::distance(corners[0], corners[1]), glm::distance(corners[1], corners[2]), glm::distance(corners[2], corners[0])});
  const int m = width > 0.0 ? std::clamp(static_cast<int>(std::ceil(std::min(longest / width, 1e3))), 1, most_points_a_side) : 1;
  for (int i = 0; i < m; ++i)  // the middles of m^2 like triangles
    for (int j = 0; j + i < m; ++j)
      for (int turned = 0; turned < (i + j + 1 < m ? 2 : 1); ++turned) {
        const double u = (i + (turned ? 2.0 : 1.0) / 3.0) / m, v = (j + (turned ? 2.0 : 1.0) / 3.0) / m;
        add_at_ground(corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]), normal, 1.0 / (m * m), light);
      }
}

std::size_t OccludedSky::bytes() const {
  std::size_t all = grid_.bytes() + ambient_.capacity() * sizeof(AmbientLight) + normals_to_ball_.capacity() * sizeof(Mat3);
  for (const auto& c : crowns_) all += c.of_facet.capacity() + c.shells.capacity() * sizeof(CrownShell);
  return all;
}

}  // namespace sunfleck
