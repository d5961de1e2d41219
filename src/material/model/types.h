// What the values of lines are, before there is a material: by it lines are checked where they stand.
#pragma once

#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "model/model.h"

namespace lacquer::model {

class Types {
public:
  /// The model's lines are placed.
  Types(const lang::Library& library, const Model& model);

  /// Nothing where it depends on the material or on the template.
  std::optional<ir::Type> of(const Value& value) const { return of(value, 0); }
  /// Of the port of that name in the first template that has one.
  std::optional<ir::Type> port(std::string_view name) const;
  std::vector<std::string_view> ports() const;

private:
  std::optional<ir::Type> of(const Value& value, int depth) const;
  std::optional<ir::Type> id(uint32_t id, std::string_view path, int depth) const;
  std::optional<ir::Type> agreed(uint32_t id, std::string_view path, int depth) const;
  std::optional<ir::Type> call(const Value& value, std::string_view path) const;
  std::optional<ir::Type> role(const Value& value) const;
  std::optional<ir::Type> given(const Value& value) const;

  const Model& model_;
  std::vector<const lang::TemplateDecl*> templates_;
  std::map<std::string_view, ir::Type> ports_;
  /// What was found of an id's path. Lines that need each other are asked while they are looked at: nothing
  /// is known then.
  mutable std::map<std::pair<uint32_t, std::string_view>, std::optional<ir::Type>> known_;
};

}  // namespace lacquer::model
