#include <algorithm>
#include <cstring>
#include <exception>

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>

#include <format/panorama.hpp>

namespace sunfleck {

namespace {

/// ExrBytes in memory as OpenEXR reads a file.
class ExrBytes : public Imf::IStream {
 public:
  ExrBytes(const std::string& bytes, const std::string& name) : Imf::IStream(name.c_str()), bytes_(bytes) {}
  bool read(char to[], int count) override {
    const auto n = static_cast<std::size_t>(std::max(count, 0));
    if (at_ > bytes_.size() || n > bytes_.size() - at_) throw std::runtime_error("its bytes end too early");
    std::memcpy(to, bytes_.data() + at_, n);
    at_ += n;
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t at) override { at_ = at; }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

}  // namespace

Panorama read_exr(const std::string& bytes, const std::string& file) {
  ExrBytes stream(bytes, file);
  try {
    Imf::InputFile in(stream, 0);  // no threads of its own
    const auto window = in.header().dataWindow(), shown = in.header().displayWindow();
    const long long columns = static_cast<long long>(window.max.x) - window.min.x + 1,
                    rows = static_cast<long long>(window.max.y) - window.min.y + 1;
    check_picture_size(columns, rows, file);
    if (window != shown) throw InputError(location(file), "pixels for a part of the picture", "an EXR with all of its pixels");
    const auto& channels = in.header().channels();
    const bool colour = channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B");
    if (!colour && !channels.findChannel("Y")) throw InputError(location(file), "neither R, G, B nor Y", "an EXR with these channels");
    Panorama out;
    out.columns = static_cast<std::uint32_t>(columns);
    out.rows = static_cast<std::uint32_t>(rows);
    const std::size_t pixels = std::size_t{out.columns} * out.rows, of_row = sizeof(float) * out.columns;
    std::vector<std::vector<float>> planes(colour ? 3 : 1, std::vector<float>(pixels));
    Imf::FrameBuffer buffer;
    for (std::size_t k = 0; k < planes.size(); ++k) {
      const char* name = colour ? (k == 0 ? "R" : k == 1 ? "G" : "B") : "Y";
      buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, planes[k].data(), window, sizeof(float), of_row));
    }
    in.setFrameBuffer(buffer);
    in.readPixels(window.min.y, window.max.y);
    out.value = std::move(planes[0]);
    if (colour)
      for (std::size_t i = 0; i < pixels; ++i) out.value[i] = luminance(out.value[i], planes[1][i], planes[2][i]);
    return out;
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw OutOfMemory("the picture " + file);
  } catch (const std::exception& error) {
    throw InputError(location(file), fmt::format("a broken EXR ({})", error.what()), "a picture in OpenEXR");
  }
}

}  // namespace sunfleck
