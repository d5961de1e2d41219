#include "lacquer/targets.h"

#include <utility>

#include "setting/messages.h"
#include "targets/registered.h"

namespace lacquer {

bool addTarget(const TargetDescription& description, Target& target, Messages& messages) {
  targets::Registered registered{description.name,
                                 description.extension,
                                 description.prose,
                                 description.like,
                                 description.words,
                                 description.opening,
                                 {}};
  if (description.check) {
    registered.check = [check = description.check](const std::string& text, ir::Stage stage) {
      Diagnostics wrong;
      for (std::string& said : check(text, stage == ir::Stage::Vertex))
        wrong.push_back({"target-check", Severity::Error, {}, std::move(said), {}, {}});
      return wrong;
    };
  }
  const Result<Target> made = targets::registerTarget(std::move(registered));
  if (made) {
    target = *made;
    return true;
  }
  report(made.error(), {}, messages);
  return false;
}

}  // namespace lacquer
