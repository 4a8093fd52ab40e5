// In the place of viewer_service.cpp and the server where the build leaves the viewer out (SUNFLECK_VIEWER).
#include <sunfleck/core/error.hpp>
#include <sunfleck/view/viewer.hpp>

namespace sunfleck {

struct ViewerServer::Impl {};

ViewerServer::ViewerServer(const ViewerSettings&) {
  throw UsageError("this sunfleck was built without its viewer (SUNFLECK_VIEWER=OFF); 'render' draws pictures");
}
ViewerServer::~ViewerServer() = default;

int ViewerServer::port() const {
  return 0;
}
std::string ViewerServer::url() const {
  return {};
}
void ViewerServer::run(Progress&) {}

}  // namespace sunfleck
