// What a scene needs before it is solved.
#pragma once

#include <optional>

#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

/// A scene that is checked and whose skies are ready: the given one, or a copy where something had to be computed. The given one must
/// outlive it. Throws InputError.
class PreparedScene {
 public:
  explicit PreparedScene(const Scene& scene);
  const Scene& scene() const { return made_ ? *made_ : given_; }

 private:
  const Scene& given_;
  std::optional<Scene> made_;
};

}  // namespace sunfleck
