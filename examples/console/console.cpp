#include "console.h"

namespace {

/// A studio calls its console's compiler here. This looks for what that compiler would not know.
lacquer::Strings check(const std::string& text, bool vertex) {
  lacquer::Strings wrong;
  for (const char* word : {"cbuffer", "SV_"})
    if (text.find(word) != std::string::npos) wrong.push_back(std::string("the console has no ") + word);
  if (vertex && text.find("S_POSITION") == std::string::npos) wrong.push_back("no vertex is put anywhere");
  return wrong;
}

}  // namespace

bool addConsole(lacquer::Target& target, lacquer::Messages& messages) {
  lacquer::TargetDescription console;
  console.name = "console";
  console.extension = "cgx";
  console.prose = "the console's language";
  console.like = lacquer::Target::Hlsl;
  console.words = {{"cbuffer", "ConstantBuffer"}, {"StructuredBuffer", "RegularBuffer"},
                   {"SampleLevel", "SampleLOD"},  {"SampleCmpLevelZero", "SampleCmpLOD0"},
                   {"SV_Position", "S_POSITION"}, {"SV_IsFrontFace", "S_FRONT_FACE"}};
  for (const char digit : std::string("01234567"))
    console.words[std::string("SV_Target") + digit] = std::string("S_TARGET_OUTPUT") + digit;
  console.opening = "#pragma console(fast_math, off)";
  console.check = check;
  return lacquer::addTarget(console, target, messages);
}
