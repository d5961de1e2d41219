// OpenEXR through its library, where there is one.
#include "bake/image.h"

#ifdef LACQUER_OPENEXR
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>

#include <cstring>
#include <exception>
#include <string>
#endif

namespace lacquer::baking {

#ifdef LACQUER_OPENEXR

namespace {

class MemoryOut : public Imf::OStream {
public:
  MemoryOut() : Imf::OStream("") {}

  void write(const char* from, int count) override {
    const auto size = static_cast<size_t>(count);
    if (at_ + size > bytes_.size()) bytes_.resize(at_ + size);
    std::memcpy(bytes_.data() + at_, from, size);
    at_ += size;
  }
  uint64_t tellp() override { return at_; }
  void seekp(uint64_t position) override { at_ = position; }
  std::string take() { return std::move(bytes_); }

private:
  std::string bytes_;
  size_t at_ = 0;
};

constexpr const char* kChannels[] = {"R", "G", "B", "A"};

/// The texels as they lie in memory, in halves or floats.
struct Texels4 {
  Texels4(const Image& image, bool halves) {
    if (!halves) {
      floats = image.texels.data();
      return;
    }
    half_texels.reserve(image.texels.size());
    constexpr float kMost = 65504;
    for (const std::array<float, 4>& texel : image.texels) {
      auto& made = half_texels.emplace_back();
      for (size_t c = 0; c < 4; ++c) made[c] = Imath::half(std::clamp(texel[c], -kMost, kMost));
    }
  }
  Imf::FrameBuffer frame(const Image& image) const {
    const bool halves = floats == nullptr;
    const size_t number = halves ? sizeof(Imath::half) : sizeof(float);
    const void* first = halves ? static_cast<const void*>(half_texels.data()) : floats;
    // The library reads what it writes, through a pointer that it shares with its readers.
    auto* bytes = const_cast<char*>(static_cast<const char*>(first));  // NOLINT
    Imf::FrameBuffer frame;
    for (size_t c = 0; c < 4; ++c) {
      frame.insert(kChannels[c], Imf::Slice(halves ? Imf::HALF : Imf::FLOAT, bytes + c * number, 4 * number,
                                            4 * number * image.size));
    }
    return frame;
  }
  std::vector<std::array<Imath::half, 4>> half_texels;
  const std::array<float, 4>* floats = nullptr;
};

}  // namespace

Result<std::string> openExrOf(const std::vector<Image>& levels, uint32_t bits) {
  const bool halves = bits == 16;
  const auto side = static_cast<int>(levels[0].size);
  try {
    Imf::Header header(side, side);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const char* name : kChannels)
      header.channels().insert(name, Imf::Channel(halves ? Imf::HALF : Imf::FLOAT));
    MemoryOut out;
    if (levels.size() == 1) {
      const Texels4 texels(levels[0], halves);
      Imf::OutputFile file(out, header, 0);
      file.setFrameBuffer(texels.frame(levels[0]));
      file.writePixels(side);
    } else {
      constexpr unsigned kTile = 64;
      header.setTileDescription(Imf::TileDescription(kTile, kTile, Imf::MIPMAP_LEVELS, Imf::ROUND_DOWN));
      Imf::TiledOutputFile file(out, header, 0);
      for (size_t i = 0; i < levels.size(); ++i) {
        const auto level = static_cast<int>(i);
        const Texels4 texels(levels[i], halves);
        file.setFrameBuffer(texels.frame(levels[i]));
        file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
      }
    }
    return out.take();
  } catch (const std::exception& error) {
    return fail("file-unwritable", {}, std::string("OpenEXR's library: ") + error.what(), {});
  }
}

#else

Result<std::string> openExrOf(const std::vector<Image>&, uint32_t) {
  return fail("no-openexr", {}, "this build is without OpenEXR's library", "write .ktx2 or .png");
}

#endif

}  // namespace lacquer::baking
