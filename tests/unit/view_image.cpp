#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <iterator>

#include <unistd.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/view/image.hpp>

using namespace sunfleck;

TEST_CASE("a picture is written as PNG, complete or not at all", "[view]") {
  const auto folder = std::filesystem::temp_directory_path() / ("sunfleck_view_image_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  Image image(3, 2, {1, 2, 3});
  image.blend(1, 1, {255, 255, 255}, 1.0);
  image.blend(99, 1, {255, 255, 255}, 1.0);  // outside: nothing
  REQUIRE(image.at(1, 1) == Rgb8{255, 255, 255});
  const std::string file = (folder / "a.PNG").string();
  write_png(image, file);
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  REQUIRE(bytes.substr(0, 8) == "\x89PNG\r\n\x1a\n");
  REQUIRE(bytes.substr(16, 8) == std::string("\0\0\0\3\0\0\0\2", 8));  // width, height

  REQUIRE_THROWS_WITH(write_png(image, (folder / "a.jpg").string()),
                      (folder / "a.jpg").string() + ": found the suffix '.jpg'; expected .png");
  REQUIRE_THROWS_AS(write_png(image, (folder / "none" / "a.png").string()), OutputError);
  std::filesystem::create_directories(folder / "folder.png");
  REQUIRE_THROWS_AS(write_png(image, (folder / "folder.png").string()), OutputError);
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files += entry.is_regular_file();
  REQUIRE(files == 1);  // no temporary is left
  std::filesystem::remove_all(folder);
  REQUIRE_THROWS_AS(Image(0, 10), UsageError);
}
