// OpenEXR through its library, where there is one.
#include "environment/panorama.h"

#ifdef LACQUER_OPENEXR
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfVersion.h>

#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#endif

namespace lacquer::environment {

#ifdef LACQUER_OPENEXR

namespace {

constexpr int kLargestTile = 4096;

/// A file that is in memory. What reads past its end throws, which the library turns into an error of its
/// own.
class MemoryStream : public Imf::IStream {
public:
  explicit MemoryStream(std::string_view bytes) : Imf::IStream(""), bytes_(bytes) {}

  bool read(char* to, int count) override {
    const auto wanted = static_cast<size_t>(count);
    if (count < 0 || wanted > bytes_.size() - at_) throw std::runtime_error("the file ends early");
    std::memcpy(to, bytes_.data() + at_, wanted);
    at_ += wanted;
    return at_ < bytes_.size();
  }
  uint64_t tellg() override { return at_; }
  void seekg(uint64_t position) override {
    if (position > bytes_.size()) throw std::runtime_error("the file ends early");
    at_ = position;
  }

private:
  std::string_view bytes_;
  size_t at_ = 0;
};

/// The part of the file that the colours are in: R, G and B, or Y alone.
Result<Panorama> decode(Imf::InputFile& file, uint64_t most, const Place& place) {
  const Imf::Header& header = file.header();
  const Imath::Box2i window = header.dataWindow();
  const int64_t width = int64_t{window.max.x} - window.min.x + 1;
  const int64_t height = int64_t{window.max.y} - window.min.y + 1;
  if (const Result<void> fits = checkSize(width, height, most, place); !fits)
    return tl::make_unexpected(fits.error());
  const Imf::ChannelList& channels = header.channels();
  const bool colored = channels.findChannel("R") != nullptr && channels.findChannel("G") != nullptr &&
                       channels.findChannel("B") != nullptr;
  const bool grey = !colored && channels.findChannel("Y") != nullptr;
  if (!colored && !grey) return unreadable(place, "the picture has neither R, G and B nor Y");
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
      return unreadable(place, "the picture has channels that are not sampled at each pixel");
  }
  Panorama panorama{static_cast<uint32_t>(width), static_cast<uint32_t>(height), {}};
  panorama.texels.resize(size_t{panorama.width} * panorama.height);
  Imf::FrameBuffer frame;
  constexpr size_t kPixel = sizeof(Rgb);
  const auto slice = [&](const char* name, size_t channel) {
    auto* first = reinterpret_cast<char*>(panorama.texels.data()) + channel * sizeof(float);
    frame.insert(name, Imf::Slice::Make(Imf::FLOAT, first, window, kPixel, kPixel * panorama.width));
  };
  if (colored) {
    slice("R", 0);
    slice("G", 1);
    slice("B", 2);
  } else {
    slice("Y", 0);
  }
  file.setFrameBuffer(frame);
  file.readPixels(window.min.y, window.max.y);
  for (Rgb& color : panorama.texels) {
    if (grey) color = {color[0], color[0], color[0]};
  }
  return panorama;
}

}  // namespace

Result<Panorama> readOpenExr(std::string_view bytes, uint64_t most, const Place& place) {
  try {
    // Before any room is taken: for lines and tiles the library takes what the head claims.
    Imf::Header::setMaxImageSize(kLongestSide, kLongestSide);
    Imf::Header::setMaxTileSize(kLargestTile, kLargestTile);
    MemoryStream stream(bytes);
    Imf::InputFile file(stream);
    return decode(file, most, place);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    // What the library says names its own places.
    return unreadable(place, "the picture is damaged, or of a kind of OpenEXR that is not read");
  }
}

#else

Result<Panorama> readOpenExr(std::string_view, uint64_t, const Place& place) {
  return unreadable(place, "this is OpenEXR, and this build is without its library");
}

#endif

}  // namespace lacquer::environment
