// The viewer's page, style and scripts, taken into the program at build time from src/view/web.
#pragma once

#include <string_view>

namespace sunfleck {

struct WebFile {
  std::string_view name;  ///< "index.html"
  std::string_view type;  ///< Content-Type
  std::string_view content;
};

/// Null if there is none of that name.
const WebFile* web_file(std::string_view name);

}  // namespace sunfleck
