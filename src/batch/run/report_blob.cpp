#include "run/report_blob.h"

#include <algorithm>
#include <iterator>
#include <unordered_map>

namespace lacquer {

/// Without the file and the terms, which several share.
template <class Archive>
static void fields(Archive& archive, MaterialReport& m) {
  archive(m.name, m.index, m.ok, m.shaders);
}

void writeMaterials(std::span<const MaterialReport> materials, BlobWriter& blob) {
  std::vector<std::shared_ptr<const MaterialTerms>> terms;
  std::vector<uint64_t> places;
  std::unordered_map<const MaterialTerms*, uint64_t> known;  // their order is that of the materials
  for (const MaterialReport& m : materials) {
    const auto [it, fresh] = known.try_emplace(m.terms.get(), terms.size());
    places.push_back(it->second);
    if (fresh) terms.push_back(m.terms);
  }
  blob(materials, places, terms);
}

void readMaterials(const std::string& file, BlobReader& blob, std::vector<MaterialReport>& materials) {
  std::vector<MaterialReport> read;
  std::vector<uint64_t> places;
  std::vector<std::shared_ptr<const MaterialTerms>> terms;
  blob(read, places, terms);
  const bool whole = places.size() == read.size() &&
                     std::all_of(places.begin(), places.end(), [&](uint64_t p) { return p < terms.size(); });
  if (!whole) return blob.refuse();
  for (size_t i = 0; i < read.size(); ++i) read[i].file = file, read[i].terms = terms[places[i]];
  materials.insert(materials.end(), std::make_move_iterator(read.begin()),
                   std::make_move_iterator(read.end()));
}

}  // namespace lacquer
