#include <sunfleck/view/layers.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include <ImfChannelList.h>
#include <ImfCompression.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <half.h>

#include <fmt/core.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/replaced_file.hpp>

namespace sunfleck {

namespace {

/// Where OpenEXR writes: memory, because its destructor goes back to the head of the file and cannot tell of a full disk.
class Bytes : public Imf::OStream {
 public:
  explicit Bytes(const std::string& name) : Imf::OStream(name.c_str()) {}
  void write(const char text[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (bytes_.size() < at_ + size) bytes_.resize(at_ + size);
    std::copy_n(text, size, bytes_.begin() + static_cast<std::ptrdiff_t>(at_));
    at_ += size;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t at) override { at_ = at; }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

}  // namespace

void write_exr(const PictureLayers& layers, const std::string& file) {
  std::string suffix = std::filesystem::path(file).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (suffix != ".exr") throw UsageError(fmt::format("{}: found the suffix '{}'; expected .exr", file, suffix));

  const auto width = static_cast<std::size_t>(layers.width);
  Imf::Header header(layers.width, layers.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer buffer;
  const auto add = [&](const char* name, Imf::PixelType type, const void* data, std::size_t bytes) {
    header.channels().insert(name, Imf::Channel(type));
    buffer.insert(name, Imf::Slice(type, const_cast<char*>(static_cast<const char*>(data)), bytes, bytes * width));
  };
  const auto halves = [](const std::vector<float>& from) {
    std::vector<half> out;
    out.reserve(from.size());
    for (const float v : from) out.emplace_back(std::min(v, 65504.0f));  // the largest half
    return out;
  };
  const auto red = halves(layers.red), green = halves(layers.green), blue = halves(layers.blue), alpha = halves(layers.alpha);
  add("R", Imf::HALF, red.data(), sizeof(half)), add("G", Imf::HALF, green.data(), sizeof(half));
  add("B", Imf::HALF, blue.data(), sizeof(half)), add("A", Imf::HALF, alpha.data(), sizeof(half));
  add("Z", Imf::FLOAT, layers.depth.data(), sizeof(float));
  add("organ.id", Imf::UINT, layers.organ.data(), sizeof(std::uint32_t));
  add("facet.id", Imf::UINT, layers.facet.data(), sizeof(std::uint32_t));
  if (!layers.value.empty()) add("value", Imf::FLOAT, layers.value.data(), sizeof(float));

  Bytes bytes(file);
  try {
    Imf::OutputFile out(bytes, header, 0);  // no threads of its own
    out.setFrameBuffer(buffer);
    out.writePixels(layers.height);
  } catch (const std::exception& error) {
    throw OutputError(fmt::format("{}: the picture could not be encoded: {}", file, error.what()));
  }
  ReplacedFile out(file);
  out.write(bytes.bytes());
  out.commit();
}

}  // namespace sunfleck
