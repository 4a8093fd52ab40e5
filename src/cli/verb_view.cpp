#include <cstdio>

#include <fmt/format.h>

#include <sunfleck/cli/verbs.hpp>
#include <sunfleck/view/viewer.hpp>

namespace sunfleck {

int verb_view(const ViewOptions& options, Progress& progress) {
  ViewerSettings settings;
  settings.results = {options.result};
  if (options.other) settings.results.push_back(*options.other);
  settings.listen = options.listen, settings.token = options.token, settings.port = options.port;
  ViewerServer server(settings);
  fmt::print("{}\n", server.url());
  std::fflush(stdout);
  server.run(progress);
  return 0;  // to be stopped is how a viewer ends
}

}  // namespace sunfleck
