#include <sunfleck/scene/solution.hpp>

namespace sunfleck {

std::string name_of(SolveStatus status) {
  switch (status) {
    case SolveStatus::converged:
      return "converged";
    case SolveStatus::not_converged:
      return "not_converged";
    case SolveStatus::inaccurate:
      return "inaccurate";
  }
  return {};
}

}  // namespace sunfleck
