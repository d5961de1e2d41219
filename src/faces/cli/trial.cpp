#include "cli/trial.h"

#include <cmath>
#include <locale>
#include <map>
#include <sstream>

#include "cli/checks.h"
#include "support/letters.h"

namespace lacquer::cli {

namespace {

/// False for what is no NAME=NUMBER,NUMBER.
bool readParameter(const std::string& text, NamedNumbers& to) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) return false;
  std::istringstream stream(text.substr(equals + 1));
  stream.imbue(std::locale::classic());
  std::vector<double> numbers;
  do {
    double number = 0;
    if (isLetter(static_cast<char>(stream.peek()))) {
      std::string word;
      std::getline(stream, word, ',');
      if (word != "true" && word != "false") return false;
      numbers.push_back(word == "true" ? 1 : 0);
      if (stream.eof()) break;
      stream.unget();
      continue;
    }
    if (!(stream >> number) || !std::isfinite(number)) return false;
    numbers.push_back(number);
  } while (stream.peek() == ',' && stream.get() == ',');
  if (!stream.eof()) return false;
  to.emplace_back(text.substr(0, equals), std::move(numbers));
  return true;
}

}  // namespace

void addParameters(CLI::App& verb, NamedNumbers& parameters) {
  verb.add_option_function<std::vector<std::string>>(
          "--set",
          [&parameters](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) {
              if (!readParameter(text, parameters))
                throw CLI::ValidationError("--set", "'" + text + "' is no NAME=NUMBER,...");
            }
          },
          "NAME=x,y,...: a parameter's value instead of today's, by its name or JSON pointer (may be "
          "repeated)")
      ->allow_extra_args(false);
}

void addClock(CLI::App& verb, double& time, double& frame) {
  constexpr double kLast = 16777216;  // as the templates have it
  verb.add_option("--time", time, "seconds since the animation began, for materials that ask for them")
      ->check(numberFrom(0, kLast));
  verb.add_option("--frame", frame, "the picture's number, for materials that ask for it")
      ->check(numberFrom(0, kLast));
}

void addValueLook(CLI::App& verb, ValueLook& look) {
  using As = ValueLook::As;
  static const std::map<std::string, As> kWays = {
      {"color", As::Color}, {"vector", As::Vector}, {"grey", As::Grey}};
  verb.add_option("--values", look.as, "how values of --node are drawn; as their types want it when absent")
      ->transform(CLI::CheckedTransformer(kWays).description("{color,grey,vector}"))
      ->type_name("TEXT");
  verb.add_option("--scale", look.scale, "what values of --node are multiplied by")->check(kNumber);
}

}  // namespace lacquer::cli
