#include <map>
#include <utility>

#include "exchange/pattern_out.h"

namespace lacquer::exchange {

using materialx::Element;

void orderElements(std::vector<Element>& elements, const std::vector<Element>& users) {
  std::map<std::string_view, size_t> places;
  for (size_t i = 0; i < elements.size(); ++i) {
    if (elements[i].category != "nodedef") places.emplace(elements[i].name(), i);
  }
  enum class State : uint8_t { New, Open, Done };
  std::vector<State> states(elements.size(), State::New);
  std::vector<size_t> order;
  std::vector<size_t> open;
  // Sources lie on the stack in reverse, so that the first is the first to be done.
  const auto ask = [&](const Element& user) {
    for (auto input = user.children.rbegin(); input != user.children.rend(); ++input) {
      if (input->category != "input") continue;
      for (const char* attribute : {"nodename", "nodegraph"}) {
        const auto it = places.find(input->get(attribute));
        if (it != places.end() && states[it->second] == State::New) open.push_back(it->second);
      }
    }
  };
  for (const Element& user : users) {
    Element asking = user;
    for (Element& child : asking.children) child.category = "input";
    ask(asking);
    while (!open.empty()) {
      const size_t at = open.back();
      if (states[at] == State::New) {
        states[at] = State::Open;
        ask(elements[at]);
        continue;
      }
      open.pop_back();
      if (std::exchange(states[at], State::Done) == State::Open) order.push_back(at);
    }
  }
  std::vector<Element> sorted;
  const auto isGraph = [](const Element& element) {
    return element.category == "nodedef" || element.category == "nodegraph";
  };
  std::erase_if(order, [&](size_t at) { return isGraph(elements[at]); });
  for (Element& element : elements) {
    if (isGraph(element)) sorted.push_back(std::move(element));
  }
  for (const size_t at : order) sorted.push_back(std::move(elements[at]));
  elements = std::move(sorted);
}

}  // namespace lacquer::exchange
