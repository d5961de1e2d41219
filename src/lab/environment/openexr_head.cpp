#include "environment/openexr_head.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace lacquer::environment {

namespace {

/// An attribute that the library is to understand.
struct Understood {
  std::string_view name, type;
  size_t size;  ///< 0 where the type has none
};

constexpr std::array kUnderstood{
    Understood{"channels", "chlist", 0},
    Understood{"compression", "compression", 1},
    Understood{"dataWindow", "box2i", 16},
    Understood{"displayWindow", "box2i", 16},
    Understood{"lineOrder", "lineOrder", 1},
    Understood{"pixelAspectRatio", "float", 4},
    Understood{"screenWindowCenter", "v2f", 8},
    Understood{"screenWindowWidth", "float", 4},
    Understood{"tiles", "tiledesc", 9},
    Understood{"chunkCount", "int", 4},
    Understood{"version", "int", 4},
    Understood{"name", "string", 0},
    Understood{"type", "string", 0},
};

/// Takes from the front of bytes; nothing where they are too few.
class Front {
public:
  explicit Front(std::string_view bytes) : bytes_(bytes) {}

  size_t at() const { return at_; }
  size_t left() const { return bytes_.size() - at_; }

  std::optional<std::string_view> take(size_t count) {
    if (count > left()) return std::nullopt;
    at_ += count;
    return bytes_.substr(at_ - count, count);
  }
  std::optional<uint32_t> number() {
    const std::optional<std::string_view> taken = take(4);
    if (!taken) return std::nullopt;
    uint32_t number = 0;
    for (size_t i = 4; i-- > 0;) number = number << 8 | static_cast<unsigned char>((*taken)[i]);
    return number;
  }
  /// Up to a NUL, which goes too.
  std::optional<std::string_view> name() {
    constexpr size_t kLongest = 255;
    const size_t length = bytes_.substr(at_, kLongest + 1).find('\0');
    if (length == std::string_view::npos) return std::nullopt;
    return take(length + 1)->substr(0, length);
  }

private:
  std::string_view bytes_;
  size_t at_ = 0;
};

/// How many channels a list has, which ends where its attribute does.
std::optional<size_t> channelsOf(std::string_view list) {
  constexpr size_t kChannel = 16;
  Front front(list);
  for (size_t count = 0;; ++count) {
    const std::optional<std::string_view> name = front.name();
    if (!name) return std::nullopt;
    if (name->empty()) return front.left() == 0 ? std::optional(count) : std::nullopt;
    if (!front.take(kChannel)) return std::nullopt;
  }
}

class HeadWalk {
public:
  explicit HeadWalk(std::string_view bytes) : bytes_(bytes), front_(bytes) {}

  /// What is wrong, or nothing.
  std::string parts() {
    constexpr uint32_t kManyParts = 0x1000;
    front_.number();  // the format's
    const std::optional<uint32_t> version = front_.number();
    if (!version) return kDamaged;
    const bool many = (*version & kManyParts) != 0;
    do {
      attributes_ = channels_ = 0;
      if (std::string wrong = attributes(); !wrong.empty()) return wrong;
      // A part without attributes is behind the last one.
    } while (many && attributes_ > 0);
    return {};
  }

  std::string head() && {
    head_ += bytes_.substr(head_.size(), front_.at() - head_.size());
    return std::move(head_);
  }

private:
  static constexpr const char* kDamaged = "the picture's head is damaged";

  /// Those of a part.
  std::string attributes() {
    for (;; ++attributes_) {
      const std::optional<std::string_view> name = front_.name();
      if (name && name->empty()) return {};
      const std::optional<std::string_view> type = name ? front_.name() : std::nullopt;
      const std::optional<uint32_t> size = type ? front_.number() : std::nullopt;
      const std::optional<std::string_view> value = size ? front_.take(*size) : std::nullopt;
      if (!value) return kDamaged;
      if (std::string wrong = attribute(*name, *type, *value); !wrong.empty()) return wrong;
    }
  }

  std::string attribute(std::string_view name, std::string_view type, std::string_view value) {
    const auto* const it = std::find_if(kUnderstood.begin(), kUnderstood.end(), [&](const Understood& row) {
      return row.name == name && row.type == type;
    });
    if (it == kUnderstood.end()) {
      hide(type);
      return {};
    }
    if (it->size != 0 && it->size != value.size()) return kDamaged;
    if (name != "channels") return {};
    const std::optional<size_t> channels = channelsOf(value);
    if (!channels) return kDamaged;
    // The library joins lists where there are several.
    channels_ += *channels;
    if (channels_ <= kMostChannels) return {};
    return fmt::format("the picture has more than {} channels", kMostChannels);
  }

  /// No type's name begins with a question mark, and one without letters is none anyway.
  void hide(std::string_view type) {
    if (type.empty()) return;
    const auto at = static_cast<size_t>(type.data() - bytes_.data());
    head_ += bytes_.substr(head_.size(), at - head_.size());
    head_ += '?';
  }

  std::string_view bytes_;
  Front front_;
  std::string head_;  ///< up to the last type that is hidden
  size_t attributes_ = 0, channels_ = 0;
};

}  // namespace

Result<std::string> checkedOpenExrHead(std::string_view bytes, const Place& place) {
  HeadWalk walk(bytes);
  if (std::string wrong = walk.parts(); !wrong.empty()) return unreadable(place, std::move(wrong));
  return std::move(walk).head();
}

}  // namespace lacquer::environment
