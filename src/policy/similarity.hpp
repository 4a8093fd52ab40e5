// The similarity that takes one list of facets to another; rotations in maps and frames.
#pragma once

#include <optional>
#include <vector>

#include <sunfleck/core/similarity.hpp>
#include <sunfleck/policy/policy.hpp>

namespace sunfleck {

/// The similarity that takes facet i of `from` to facet i of `to` for all i, corners in order (where it mirrors, corners 1 and 2 swapped,
/// as copies have them), each corner within `tolerance` times the root mean squared distance from the centre. Nothing if there is none, or
/// if the facets do not fix it. Least squares: Umeyama 1991, doi:10.1109/34.88573.
std::optional<Similarity> find_similarity(const std::vector<Triangle>& from, const std::vector<Triangle>& to, double tolerance);

/// The scale of a linear map that is a rotation or mirror times a uniform scale (to 1e-9); nothing if it shears or stretches.
std::optional<double> uniform_scale(const Mat3& linear);

/// The rotation nearest to a linear map (in the sense of least squares); mirrors if the map does.
Mat3 nearest_rotation(const Mat3& linear);

/// The rotation that is laid on another structure's: the frame's own, or a turn about the vertical that takes +x to the azimuth of its axis
/// (of its x where the axis is vertical).
Mat3 alignment(Alignment align, const Affine& frame);

}  // namespace sunfleck
