// Materials under digests of a few bits, in which the keys of their structures meet: each is to have what it
// has under the whole ones.
#include <fmt/format.h>

#include "feeds.h"
#include "run/source_file.h"
#include "setting/language.h"

namespace lacquer::fuzz {

namespace {

/// A file's structures in a run of their own.
class Alone {
public:
  Alone(const std::string& path, const Options& options, const Language& language, size_t bits)
      : setting_{options, language, {}}, structures_(setting_) {
    setting_.keys = std::make_shared<Keys>(bits);
    result_ = makeInput(path, InputKind::ByName, {}, setting_, structures_);
  }

  const FileResult& result() const { return result_; }
  const std::string& graphOf(const Key& key) { return structures_.known(key)->graph; }
  std::string contentOf(const Key& key) const { return setting_.keys->contentOf(key); }

private:
  Setting setting_;
  Structures structures_;
  FileResult result_;
};

std::string compare(Alone& whole, Alone& weak) {
  const std::vector<Key>& keys = whole.result().structures;
  const std::vector<Key>& few = weak.result().structures;
  if (keys.size() != few.size()) return "structures have become one";
  for (size_t i = 0; i < keys.size(); ++i) {
    if (whole.contentOf(keys[i]) != weak.contentOf(few[i]))
      return fmt::format("structure {} has another's key", i);
    if (whole.graphOf(keys[i]) != weak.graphOf(few[i])) return fmt::format("structure {} is another", i);
  }
  return whole.result().text == weak.result().text ? "" : "the manifest tells something else";
}

}  // namespace

std::string feedAddresses(std::string_view bytes) {
  const std::string path = put("addresses.gltf", bytes);
  Options options = optionsOf(bytes);
  options.unused = true;
  const Result<std::shared_ptr<const Language>> language = libraryFor(options);
  if (!language) return "the node library is refused";
  if (!resolveNames(**language, options)) return "";
  Alone whole(path, options, **language, Keys::kAll);
  for (const size_t bits : {size_t{0}, size_t{2}}) {
    Alone weak(path, options, **language, bits);
    if (std::string wrong = compare(whole, weak); !wrong.empty())
      return fmt::format("with {} bits: {}", bits, wrong);
  }
  return "";
}

}  // namespace lacquer::fuzz
