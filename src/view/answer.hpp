// What a request to the viewer gets, whatever carries it.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace sunfleck {

struct Answer {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers = {};
};

}  // namespace sunfleck
