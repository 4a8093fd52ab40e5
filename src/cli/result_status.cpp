#include "cli/result_status.hpp"

#include <fmt/format.h>

namespace sunfleck {

void say_status(const Result& result, Progress& progress) {
  const auto& status = result.header().status;
  if (status == "converged") return;
  progress.line(fmt::format("note: {} has status '{}'{}", result.file(), status,
                            status == "inaccurate"      ? ": its own certificate contradicts it ('sunfleck info' shows it)"
                            : status == "not_converged" ? ": it is not as accurate as was asked"
                                                        : ""));
}

}  // namespace sunfleck
