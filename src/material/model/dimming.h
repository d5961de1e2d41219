// Whether what a part makes of a lamp's light is dimmed when that light is: the contract of parts that lie
// under a layer which dims the light itself (`replace base.light with ...`) and not what comes back from
// below.
#pragma once

#include <functional>
#include <map>

#include "lang/scaling.h"
#include "model/model.h"

namespace lacquer::model {

/// Goes through all that lines could be made of, whichever conditions hold.
class Dimming {
public:
  /// `counts`: whether the lines of a part are there; those of the profile and of lods always are.
  Dimming(const Model& model, std::function<bool(uint32_t part)> counts);

  /// Whether the values of an Out are multiplied by k when the light lines are, for every k >= 0, given that
  /// what it reads of a dimmed port below is.
  bool scales(uint32_t line);

private:
  using Scaling = lang::Scaling;
  Scaling line(uint32_t index, std::string_view path);
  Scaling value(const Value& value, std::string_view path, uint32_t part);
  Scaling id(const Value& value, std::string_view path, uint32_t part);
  Scaling below(const Value& value, std::string_view path, uint32_t part);
  Scaling call(const Value& value, std::string_view path, uint32_t part);
  bool there(const Line& line) const;

  const Model& model_;
  std::function<bool(uint32_t)> counts_;
  lang::ScalingOfNodes nodes_;
  std::map<std::pair<uint32_t, std::string_view>, Scaling> lines_;
};

}  // namespace lacquer::model
