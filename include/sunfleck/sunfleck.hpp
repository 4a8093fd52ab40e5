// All that a program needs which makes scenes, solves them and goes on with the light: include this one.
#pragma once

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/progress.hpp>
#include <sunfleck/core/version.hpp>
#include <sunfleck/format/read_plant.hpp>
#include <sunfleck/format/scene_toml.hpp>
#include <sunfleck/light/time.hpp>
#include <sunfleck/plant/build.hpp>
#include <sunfleck/scene/build.hpp>
#include <sunfleck/scene/scene.hpp>
#include <sunfleck/solver/organ_views.hpp>
#include <sunfleck/solver/plan.hpp>
#include <sunfleck/solver/result_file.hpp>
#include <sunfleck/solver/session.hpp>
#include <sunfleck/solver/solution.hpp>
#include <sunfleck/solver/solve.hpp>
