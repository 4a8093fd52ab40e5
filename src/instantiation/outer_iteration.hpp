// The light between copies: a fixed point, accelerated.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>

#include "instantiation/scene_light.hpp"

namespace sunfleck {

struct OuterIteration {
  /// What all copies and the ground send when `in` (null = nothing) comes in, with sun and sky where `direct`.
  std::function<void(const Light* in, bool direct, Light& out)> pass;
  std::function<void(std::uint32_t passes, double residual)> say;
  double tolerance = 1e-3;  ///< |b + A x - x| over |b|, worst column
};

/// Steps that are combined at most before the next begin from the true residual, where each takes so many bytes.
inline std::size_t most_steps_of(std::size_t bytes) {
  constexpr std::size_t basis_bytes = std::size_t{256} << 20;
  return std::clamp<std::size_t>(basis_bytes / std::max<std::size_t>(bytes, 1), 3, 10);
}

struct OuterReport {
  Light light;
  bool converged = false;
  std::size_t bytes = 0;  ///< held at most
};

/// x = b + A x, where A is a pass without direct light. Steps d_k = A^k r from the residual r are kept, a few, and combined so that the
/// residual |r - sum c_k (d_k - d_{k+1})| is least, column by column: GMRES on the power basis (reduced rank extrapolation, Sidi 1991,
/// doi:10.1016/0377-0427(91)90013-A), which is well enough conditioned for so few. Then again from the true residual.
OuterReport iterate(const SceneLight& s, const OuterIteration& iteration);

}  // namespace sunfleck
