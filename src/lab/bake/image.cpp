#include "bake/image.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include <stb/stb_image_write.h>

#include "support/jobs.h"
#include "texture/container.h"

namespace lacquer::baking {

namespace {

using Texel = std::array<float, 4>;

constexpr uint32_t kAlphaChannel = 3;

/// The places of a row of texels, quad by quad: a quad's points lie beside and below each other.
std::vector<eval::Point> pointsOf(uint32_t y, uint32_t size, uint32_t samples) {
  std::vector<eval::Point> points;
  points.reserve(size_t{size} * samples * samples);
  const double step = 1.0 / (double{1} * size * samples);
  for (uint32_t x = 0; x < size; ++x) {
    for (uint32_t row = 0; row < samples; row += 2) {
      for (uint32_t column = 0; column < samples; column += 2) {
        for (uint32_t k = 0; k < 4; ++k) {
          eval::Point& point = points.emplace_back();
          const double u = (double{1} * x * samples + column + k % 2 + 0.5) * step;
          const double v = (double{1} * y * samples + row + k / 2 + 0.5) * step;
          point.uv.fill({u, v});
          point.position = {u, v, 0};
        }
      }
    }
  }
  return points;
}

uint8_t byteOf(float x, bool encoded) {
  const double inside = std::clamp(x, 0.0F, 1.0F);
  return encoded ? preview::encodeSrgb(inside) : static_cast<uint8_t>(std::lround(inside * 255));
}

std::string bytesOf(const Image& image, bool srgb) {
  std::string bytes;
  bytes.reserve(image.texels.size() * 4);
  for (const Texel& texel : image.texels) {
    for (size_t c = 0; c < 4; ++c) bytes += static_cast<char>(byteOf(texel[c], srgb && c < kAlphaChannel));
  }
  return bytes;
}

std::string halvesOf(const Image& image) {
  constexpr float kMost = 65504;
  std::string bytes;
  bytes.reserve(image.texels.size() * 8);
  for (const Texel& texel : image.texels) {
    for (const float x : texel) {
      const uint32_t sign = std::signbit(x) ? 0x8000U : 0U;
      texture::append(bytes, sign | texture::halfBits(std::min(std::abs(x), kMost)), 2);
    }
  }
  return bytes;
}

std::string pngOf(const Image& image, bool srgb) {
  const std::string texels = bytesOf(image, srgb);
  std::string file;
  const auto append = [](void* to, void* data, int count) {
    static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<size_t>(count));
  };
  const auto side = static_cast<int>(image.size);
  stbi_write_png_to_func(append, &file, side, side, 4, texels.data(), side * 4);
  return file;
}

/// R8G8B8A8 or R16G16B16A16_SFLOAT (Vulkan), with what the data format descriptor says of them.
texture::TexelFormat formatOf(uint32_t bits, bool srgb) {
  constexpr uint32_t kAlpha = 15;
  constexpr uint32_t kLinear = 0x10;
  constexpr uint32_t kSignedFloat = 0xC0;
  constexpr uint32_t kMinusOne = 0xBF800000;
  constexpr uint32_t kOne = 0x3F800000;
  texture::TexelFormat format;
  format.vulkan = bits == 16 ? 97 : srgb ? 43 : 37;
  format.type_size = bits / 8;
  format.bytes = bits / 2;
  format.srgb = srgb && bits == 8;
  for (uint32_t i = 0; i < 4; ++i) {
    const uint32_t id = i == kAlphaChannel ? kAlpha : i;
    if (bits == 16) {
      format.channels.push_back({16 * i, 16, id | kSignedFloat, kMinusOne, kOne});
    } else {
      const uint32_t linear = format.srgb && i == kAlphaChannel ? kLinear : 0;
      format.channels.push_back({8 * i, 8, id | linear, 0, 255});
    }
  }
  return format;
}

std::string ktx2Of(const std::vector<Image>& levels, uint32_t bits, bool srgb) {
  texture::Levels made;
  made.size = levels[0].size;
  for (const Image& level : levels) made.bytes.push_back(bits == 16 ? halvesOf(level) : bytesOf(level, srgb));
  return texture::ktx2File(formatOf(bits, srgb), made);
}

/// The parts of the texels before that the texel `i` of `to` lies over, along one axis.
struct Span {
  uint32_t first = 0;
  std::vector<float> weights;
};
std::vector<Span> spansOf(uint32_t from, uint32_t to) {
  std::vector<Span> spans(to);
  for (uint32_t i = 0; i < to; ++i) {
    // In units of 1 / to of a texel before, so that all numbers are whole.
    const uint64_t begin = uint64_t{i} * from;
    const uint64_t end = begin + from;
    spans[i].first = static_cast<uint32_t>(begin / to);
    for (uint64_t k = begin / to; k * to < end; ++k) {
      const uint64_t over = std::min(end, (k + 1) * to) - std::max(begin, k * to);
      spans[i].weights.push_back(static_cast<float>(over) / static_cast<float>(from));
    }
  }
  return spans;
}

}  // namespace

Image imageOf(const preview::Shading& shading, const Sampling& how, const Rows& rows) {
  constexpr double kMost = 3e38;  // of a float
  Image image{how.size, std::vector<Texel>(size_t{how.size} * how.size)};
  const size_t places = size_t{how.samples} * how.samples;
  std::mutex one_at_a_time;
  inParallel(how.size, [&](size_t row) {
    const auto y = static_cast<uint32_t>(row);
    const std::vector<std::array<double, 4>> values = shading(pointsOf(y, how.size, how.samples));
    for (uint32_t x = 0; x < how.size; ++x) {
      Texel& texel = image.texels[size_t{y} * how.size + x];
      for (size_t c = 0; c < 4; ++c) {
        const size_t from = how.components == 1 && c < kAlphaChannel ? 0 : c;
        double sum = 0;
        for (size_t k = 0; k < places; ++k) {
          const double value = values[x * places + k][from];
          if (std::isfinite(value)) sum += how.clamp ? std::clamp(value, 0.0, 1.0) : value;
        }
        texel[c] = static_cast<float>(std::clamp(sum / static_cast<double>(places), -kMost, kMost));
      }
      if (how.components < 4) texel[kAlphaChannel] = 1;
    }
    if (!rows) return;
    const std::lock_guard lock(one_at_a_time);
    rows(1);
  });
  return image;
}

std::vector<Image> withLevels(Image image) {
  std::vector<Image> levels;
  levels.push_back(std::move(image));
  while (levels.back().size > 1) {
    const Image& from = levels.back();
    const uint32_t size = from.size / 2;
    Image to{size, std::vector<Texel>(size_t{size} * size)};
    const std::vector<Span> spans = spansOf(from.size, size);
    inParallel(size, [&](size_t y) {
      for (uint32_t x = 0; x < size; ++x) {
        Texel& sum = to.texels[size_t{y} * size + x];
        for (size_t j = 0; j < spans[y].weights.size(); ++j) {
          const Texel* row = &from.texels[size_t{spans[y].first + j} * from.size + spans[x].first];
          for (size_t i = 0; i < spans[x].weights.size(); ++i) {
            for (size_t c = 0; c < 4; ++c) sum[c] += row[i][c] * spans[x].weights[i] * spans[y].weights[j];
          }
        }
      }
    });
    levels.push_back(std::move(to));
  }
  return levels;
}

Result<Strings> filesOf(const std::vector<Image>& levels, Texels format, uint32_t bits, bool srgb) {
  Strings files;
  switch (format) {
    case Texels::Png:
      for (const Image& level : levels) files.push_back(pngOf(level, srgb));
      break;
    case Texels::Ktx2: files.push_back(ktx2Of(levels, bits, srgb)); break;
    case Texels::Exr: {
      Result<std::string> made = openExrOf(levels, bits);
      if (!made) return tl::make_unexpected(std::move(made.error()));
      files.push_back(std::move(*made));
      break;
    }
  }
  return files;
}

}  // namespace lacquer::baking
