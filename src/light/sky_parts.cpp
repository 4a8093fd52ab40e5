#include <sunfleck/light/sky_parts.hpp>

#include <cmath>
#include <numbers>

#include <light/angles.hpp>

namespace sunfleck {

namespace {

using std::numbers::pi;

constexpr double least_height = 1e-6;  ///< of a part's middle, over which its solid angle is not told by what falls on level ground

void each_pixel(const SkyImage& image, std::size_t fewest, const VisitPart& visit) {
  const Panorama& picture = image.picture();
  const double pixels = static_cast<double>(picture.columns) * picture.rows_up();
  const auto cuts = static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(fewest) / pixels)));
  const double step = 1.0 / cuts;
  for (std::uint32_t row = 0; row < picture.rows_up(); ++row)
    for (std::uint32_t k = 0; k < cuts; ++k) {
      const double top = row + k * step, level = picture.level_angle(top, top + step) * step;
      if (!(level > 0)) continue;  // the half of a row that is below the horizon
      for (std::uint32_t column = 0; column < picture.columns; ++column) {
        const double light = level * image.relative_radiance(row, column);
        for (std::uint32_t j = 0; j < cuts; ++j) {
          Vec3 middle = picture.direction(top + 0.5 * step, column + (j + 0.5) * step);
          middle.z = std::max(middle.z, 0.0);
          visit(middle, light, level);
        }
      }
    }
}

}  // namespace

void each_part(const Sky& sky, std::size_t fewest, const VisitPart& visit) {
  if (sky.model == SkyModel::image && sky.image) return each_pixel(*sky.image, fewest, visit);
  // A sunflower: parts of the same solid angle, which keep no step with rings and azimuths of directions.
  const double golden = pi * (3 - std::sqrt(5.0)), parts = static_cast<double>(fewest);
  Sky open = sky;
  open.horizon = {0, 0, 1};
  for (std::size_t i = 0; i < fewest; ++i) {
    const Vec3 d = direction_at((static_cast<double>(i) + 0.5) / parts, golden * static_cast<double>(i));
    const double level = d.z * 2 * pi / parts;
    visit(d, open.relative_radiance(d) * level, level);
  }
}

Sky in_cells(const Sky& sky, const std::vector<Vec3>& directions) {
  if (!has_detail(sky)) return sky;
  constexpr std::size_t parts_of_cell = 400;
  const SkyTable cells(directions, std::vector<double>(directions.size(), 1.0), "directions of the sky");
  std::vector<double> light(directions.size(), 0.0), solid = light;
  each_part(sky, std::max<std::size_t>(std::size_t{1} << 17, parts_of_cell * directions.size()), [&](const Vec3& d, double l, double w) {
    const auto k = cells.nearest(d);
    const double height = std::max(d.z, least_height);
    light[k] += l / height;
    solid[k] += w / height;
  });
  for (std::size_t k = 0; k < light.size(); ++k) light[k] = solid[k] > 0 ? light[k] / solid[k] : 0.0;
  Sky out;
  out.model = SkyModel::file;
  out.irradiance = sky.irradiance;
  out.horizon = sky.horizon;
  out.table = std::make_shared<const SkyTable>(directions, std::move(light), "a sky in cells");
  return out;
}

std::vector<double> radiances_along(const Sky& sky, const std::vector<Vec3>& directions) {
  std::vector<double> radiance;
  if (!has_detail(sky)) {
    for (const auto& d : directions) radiance.push_back(sky.relative_radiance(d));
    return radiance;
  }
  std::vector<Vec3> upwards;
  for (const auto& d : directions) upwards.push_back(d.z < 0.0 ? -d : d);
  Sky open = sky;  // all of it, of which a slope hides a part
  open.horizon = {0, 0, 1};
  const Sky cells = in_cells(open, upwards);
  double level = 0;
  for (const auto& d : upwards) {
    radiance.push_back(cells.relative_radiance(d));
    level += radiance.back() * d.z * 2.0 * pi / static_cast<double>(directions.size());
  }
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const bool seen = directions[i].z > 0.0 && glm::dot(directions[i], sky.horizon) > 0.0;
    radiance[i] = seen && level > 0.0 ? radiance[i] / level : 0.0;
  }
  return radiance;
}

Sky blurred(const Sky& sky, double radius) {
  if (!has_detail(sky)) return sky;
  constexpr std::uint32_t columns = 256, rows_up = columns / 4;
  struct Piece {
    double light = 0, solid = 0;
    Vec3 middle{0.0};
  };
  Panorama picture;
  picture.columns = columns;
  picture.rows = columns / 2;
  picture.value.assign(std::size_t{columns} * picture.rows, 0.0f);
  std::vector<Piece> pieces(std::size_t{columns} * rows_up);  // on the same grid
  each_part(sky, std::size_t{1} << 18, [&](const Vec3& d, double light, double level) {
    const double zenith = std::acos(std::min(1.0, d.z)), turns = std::atan2(d.x, d.y) / (2 * pi) + 0.5;
    const auto row = std::min(static_cast<std::uint32_t>(zenith / pi * picture.rows), rows_up - 1);
    const auto column = std::min(static_cast<std::uint32_t>((turns - std::floor(turns)) * columns), columns - 1);
    const double height = std::max(d.z, least_height);
    auto& piece = pieces[row * columns + column];
    piece.light += light / height;
    piece.solid += level / height;
  });
  for (std::uint32_t row = 0; row < rows_up; ++row)
    for (std::uint32_t column = 0; column < columns; ++column)
      pieces[row * columns + column].middle = picture.direction(row + 0.5, column + 0.5);
  const double step = pi / picture.rows, least = std::cos(radius);
  const auto reach = static_cast<std::uint32_t>(std::ceil(radius / step));
  for (std::uint32_t row = 0; row < rows_up; ++row)
    for (std::uint32_t column = 0; column < columns; ++column) {
      const Vec3& towards = pieces[row * columns + column].middle;
      double light = 0, weights = 0;
      for (std::uint32_t r = row - std::min(row, reach); r < std::min(rows_up, row + reach + 1); ++r)
        for (std::uint32_t c = 0; c < columns; ++c) {
          const auto& piece = pieces[r * columns + c];
          const double weight = (glm::dot(piece.middle, towards) - least) / (1.0 - least);
          if (weight > 0) light += weight * piece.light, weights += weight * piece.solid;
        }
      const auto& own = pieces[row * columns + column];
      const double value = weights > 0 ? light / weights : own.solid > 0 ? own.light / own.solid : 0.0;
      picture.at(row, column) = static_cast<float>(value);
    }
  Sky out;
  out.model = SkyModel::image;
  out.irradiance = sky.irradiance;
  out.horizon = sky.horizon;
  out.image = std::make_shared<const SkyImage>(std::move(picture), "a blurred sky");
  return out;
}

}  // namespace sunfleck
