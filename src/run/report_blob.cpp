#include "run/report_blob.h"

#include <algorithm>

#include "shader/budget.h"

namespace lacquer {

void writeVariants(const std::vector<MaterialTerms::Variant>& variants, BlobWriter& blob) {
  blob.list(variants, [&](const MaterialTerms::Variant& v) {
    blob.text(v.node), blob.text(v.variant);
    blob.list(v.terms, [&](const std::string& term) { blob.text(term); });
    blob.number(v.error), blob.number(v.saved);
  });
}

std::vector<MaterialTerms::Variant> readVariants(BlobReader& blob) {
  std::vector<MaterialTerms::Variant> variants;
  blob.list([&] {
    MaterialTerms::Variant v{};
    v.node = blob.text();
    v.variant = blob.text();
    blob.list([&] { v.terms.push_back(blob.text()); });
    v.error = blob.number<double>();
    v.saved = blob.number<double>();
    variants.push_back(std::move(v));
  });
  return variants;
}

void writeMaterials(std::span<const MaterialReport> materials, BlobWriter& blob) {
  std::vector<const MaterialTerms*> terms;
  const auto place = [&](const MaterialTerms* one) {
    const auto it = std::find(terms.begin(), terms.end(), one);
    if (it != terms.end()) return static_cast<uint64_t>(it - terms.begin());
    terms.push_back(one);
    return static_cast<uint64_t>(terms.size() - 1);
  };
  blob.list(materials, [&](const MaterialReport& m) {
    blob.text(m.name), blob.number<uint64_t>(m.index), blob.number(m.ok), blob.number(place(m.terms.get()));
    blob.list(m.shaders, [&](const std::string& id) { blob.text(id); });
  });
  blob.list(terms, [&](const MaterialTerms* one) {
    blob.list(one->terms, [&](const std::string& term) { blob.text(term); });
    blob.list(one->skipped, [&](const auto& s) { blob.text(s.first), blob.text(s.second); });
    writeVariants(one->variants, blob);
  });
}

void readMaterials(const std::string& file, BlobReader& blob, std::vector<MaterialReport>& materials) {
  const size_t first = materials.size();
  std::vector<uint64_t> places;
  blob.list([&] {
    MaterialReport m;
    m.file = file, m.name = blob.text(), m.index = blob.number<uint64_t>(), m.ok = blob.number<bool>();
    places.push_back(blob.number<uint64_t>());
    blob.list([&] { m.shaders.push_back(blob.text()); });
    materials.push_back(std::move(m));
  });
  std::vector<std::shared_ptr<const MaterialTerms>> terms;
  blob.list([&] {
    auto one = std::make_shared<MaterialTerms>();
    blob.list([&] { one->terms.push_back(blob.text()); });
    blob.list([&] {
      std::string term = blob.text();
      one->skipped.emplace_back(std::move(term), blob.text());
    });
    one->variants = readVariants(blob);
    one->expected_error = expectedError(one->variants);
    terms.push_back(std::move(one));
  });
  for (size_t i = 0; i < places.size(); ++i) {
    if (places[i] >= terms.size()) return blob.refuse();
    materials[first + i].terms = terms[places[i]];
  }
}

}  // namespace lacquer
