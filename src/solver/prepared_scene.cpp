#include "solver/prepared_scene.hpp"

#include <cstddef>

#include <sunfleck/core/error.hpp>
#include <sunfleck/scene/slope.hpp>

namespace sunfleck {

PreparedScene::PreparedScene(const Scene& scene) : given_(scene) {
  for (std::size_t s = 0; s < scene.states.size(); ++s) {
    const auto& sky = scene.states[s].sky;
    if (!sky || is_prepared(*sky)) continue;
    if (!made_) made_ = scene;
    const auto& name = scene.states[s].name;
    prepare_sky(*made_->states[s].sky, location(scene.file, 0, name.empty() ? "sky" : "sky of state \"" + name + '"'));
  }
  if (lies_on_slope(this->scene())) {
    if (!made_) made_ = scene;
    for (auto& note : lay_on_slope(*made_)) made_->notes.push_back(std::move(note));
  }
  check_scene(this->scene());
}

}  // namespace sunfleck
