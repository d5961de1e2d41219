// OpenEXR through its library, where there is one.
#include "environment/panorama.h"

#ifdef LACQUER_OPENEXR
#include <ImfChannelList.h>
#include <ImfCompositeDeepScanLine.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfVersion.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include "environment/openexr_head.h"
#endif

namespace lacquer::environment {

#ifdef LACQUER_OPENEXR

namespace {

constexpr int kLargestTile = 4096;
/// Of a deep picture, whose pixels have as many as its data say, which may be packed a thousandfold.
constexpr int64_t kMostSamples = int64_t{1} << 25;

/// Of a tile, for which the library takes room twice: 4096 by 4096 pixels of four floats.
constexpr uint64_t kLargestTileBytes = uint64_t{1} << 28;

/// A file that is in memory, with another head of at most its length. What reads past its end throws, which
/// the library turns into an error of its own.
class MemoryStream : public Imf::IStream {
public:
  MemoryStream(std::string_view bytes, std::string head)
      : Imf::IStream(""), bytes_(bytes), head_(std::move(head)) {}

  bool read(char* to, int count) override {
    const auto wanted = static_cast<size_t>(count);
    if (count < 0 || wanted > bytes_.size() - at_) throw std::runtime_error("the file ends early");
    std::memcpy(to, bytes_.data() + at_, wanted);
    if (at_ < head_.size()) std::memcpy(to, head_.data() + at_, std::min(wanted, head_.size() - at_));
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
  std::string head_;
  size_t at_ = 0;
};

/// Whether the tiles, where there are some, are no larger than they may be. What lies outside of the picture
/// is not written to.
bool tilesFit(const Imf::Header& header, uint64_t width, uint64_t height) {
  if (!header.hasTileDescription()) return true;
  uint64_t pixel = 0;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it)
    pixel += it.channel().type == Imf::HALF ? 2 : 4;
  const Imf::TileDescription& tile = header.tileDescription();
  return pixel * std::min<uint64_t>(tile.xSize, width) * std::min<uint64_t>(tile.ySize, height) <=
         kLargestTileBytes;
}

/// The part of the file that the colours are in: R, G and B, or Y alone.
Result<Panorama> decode(Imf::InputFile& file, uint64_t most, const Place& place) {
  const Imf::Header& header = file.header();
  const Imath::Box2i window = header.dataWindow();
  const int64_t width = int64_t{window.max.x} - window.min.x + 1;
  const int64_t height = int64_t{window.max.y} - window.min.y + 1;
  if (const Result<void> fits = checkSize(width, height, most, place); !fits)
    return tl::make_unexpected(fits.error());
  if (!tilesFit(header, static_cast<uint64_t>(width), static_cast<uint64_t>(height)))
    return unreadable(place, "the picture's tiles are too large");
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
  Result<std::string> head = checkedOpenExrHead(bytes, place);
  if (!head) return tl::make_unexpected(head.error());
  try {
    // Before any room is taken: for lines and tiles the library takes what the head claims.
    Imf::Header::setMaxImageSize(kLongestSide, kLongestSide);
    Imf::Header::setMaxTileSize(kLargestTile, kLargestTile);
    Imf::CompositeDeepScanLine::setMaximumSampleCount(kMostSamples);
    MemoryStream stream(bytes, *std::move(head));
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
