// glslang: GLSL and HLSL text to SPIR-V, and its log as diagnostics.
#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "check/check.h"
#include "support/letters.h"
#include "targets/target.h"

namespace lacquer::check {
namespace {

constexpr std::string_view kCode = "glslang";

bool isWordByte(char c) { return isLetterOrDigit(c) || c == '_'; }

std::string_view trim(std::string_view text) {
  const size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") + 1 - begin);
}

/// Removes a decimal number from the front of `text` and puts it into `value`; false when there is none.
bool takeNumber(std::string_view& text, uint32_t& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) return false;
  text.remove_prefix(static_cast<size_t>(end - text.data()));
  return true;
}

bool takePrefix(std::string_view& text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return false;
  text.remove_prefix(prefix.size());
  return true;
}

/// The byte range of a line (1-based) without its newline, or nothing when the text is shorter.
std::optional<std::pair<size_t, size_t>> lineRange(std::string_view text, uint32_t line) {
  size_t begin = 0;
  for (uint32_t i = 1; i < line; ++i) {
    const size_t newline = text.find('\n', begin);
    if (newline == std::string_view::npos) return std::nullopt;
    begin = newline + 1;
  }
  return std::pair(begin, std::min(text.find('\n', begin), text.size()));
}

/// Where `word` stands in `line` as a whole word; npos when it does not.
size_t findWord(std::string_view line, std::string_view word) {
  if (word.empty()) return std::string_view::npos;
  for (size_t at = line.find(word); at != std::string_view::npos; at = line.find(word, at + 1)) {
    const bool joined_left = at > 0 && isWordByte(line[at - 1]) && isWordByte(word.front());
    const size_t end = at + word.size();
    const bool joined_right = end < line.size() && isWordByte(line[end]) && isWordByte(word.back());
    if (!joined_left && !joined_right) return at;
  }
  return std::string_view::npos;
}

/// glslang gives a line and, in quotes at the start of its message, the token: points there, or at the whole
/// line when the token is not in it (some messages quote a rule or a type instead).
void pointAt(Diagnostic& diagnostic, std::string_view text, uint32_t line, uint32_t column) {
  diagnostic.place.line = line;
  const auto range = lineRange(text, line);
  if (!range) return;
  const auto [begin, end] = *range;
  const std::string_view bytes = text.substr(begin, end - begin);
  if (column != 0) return locate(diagnostic, text, std::min(begin + column - 1, end));

  const std::string_view message = diagnostic.message;
  const size_t close = message.find("' : ");
  if (message.starts_with('\'') && close != std::string_view::npos) {
    const std::string_view token = message.substr(1, close - 1);
    const size_t at = findWord(bytes, token);
    if (at != std::string_view::npos) return locate(diagnostic, text, begin + at, token.size());
  }
  const std::string_view inner = trim(bytes);
  if (inner.empty()) return locate(diagnostic, text, begin);
  locate(diagnostic, text, begin + static_cast<size_t>(inner.data() - bytes.data()), inner.size());
}

/// The line of the log as a diagnostic; nothing for lines that say nothing of their own (totals, blank
/// lines). The forms are `ERROR: 0:12: 'token' : message`, `ERROR: message` and, from the HLSL parser,
/// `(12): error at column 3, message`.
std::optional<Diagnostic> diagnosticOf(std::string_view line, std::string_view text,
                                       const std::string& name) {
  line = trim(line);
  if (line.empty() || line.ends_with("No code generated.") || line.ends_with("'' : compilation terminated")) {
    return std::nullopt;
  }
  Diagnostic diagnostic;
  diagnostic.code = kCode;
  diagnostic.place.file = name;
  if (takePrefix(line, "WARNING: ")) {
    diagnostic.severity = Severity::Warning;
  } else if (takePrefix(line, "NOTE: ")) {
    diagnostic.severity = Severity::Note;
  } else {
    takePrefix(line, "INTERNAL ");
    takePrefix(line, "ERROR: ");
  }

  std::string_view rest = line;
  uint32_t string_index = 0;  // which of the strings given to glslang: there is only one
  uint32_t number = 0;
  uint32_t column = 0;
  bool placed = false;
  if (takeNumber(rest, string_index) && takePrefix(rest, ":")) {
    placed = takeNumber(rest, number) && takePrefix(rest, ":");
  } else if (takePrefix(rest, "(")) {
    placed = takeNumber(rest, number) && takePrefix(rest, "): error at column ") &&
             takeNumber(rest, column) && takePrefix(rest, ",");
  }
  diagnostic.message = trim(placed ? rest : line);
  if (placed && number != 0) pointAt(diagnostic, text, number, column);
  return diagnostic;
}

void appendLog(Diagnostics& list, std::string_view log, std::string_view text, const std::string& name) {
  while (!log.empty()) {
    const size_t end = std::min(log.find('\n'), log.size());
    const std::string_view line = log.substr(0, end);
    log.remove_prefix(std::min(end + 1, log.size()));
    if (line.starts_with(' ') && !list.empty() &&
        !trim(line).empty()) {  // the linker goes on in the next line
      list.back().message.append(" ").append(trim(line));
    } else if (auto diagnostic = diagnosticOf(line, text, name)) {
      list.push_back(std::move(*diagnostic));
    }
  }
}

/// The log after a failure: at least one error, whatever glslang said.
Diagnostics errorsOf(std::string_view log, std::string_view text, const std::string& name) {
  Diagnostics list;
  appendLog(list, log, text, name);
  if (!hasError(list)) {
    list.push_back(
        {std::string(kCode), Severity::Error, {name, 0, 0, {}}, "failed without an error", {}, {}});
  }
  return list;
}

bool isGlslang(targets::Checker checker) {
  return checker == targets::Checker::Vulkan || checker == targets::Checker::OpenGl ||
         checker == targets::Checker::Es || checker == targets::Checker::Direct3d;
}

/// The shader must be of the target it is checked as: glslang takes whatever dialect the text announces.
std::optional<Diagnostic> wrongVersion(std::string_view text, const targets::Row& row,
                                       const std::string& name) {
  if (!isGlslang(row.checker))
    return fail(std::string(kCode), {name, 0, 0, {}}, "glslang does not know the target").value()[0];
  const std::string_view wanted = row.version;
  if (wanted.empty()) return std::nullopt;
  size_t at = text.starts_with("#version") ? 0 : text.find("\n#version");
  if (at != std::string_view::npos && text[at] == '\n') ++at;
  Diagnostic diagnostic;
  diagnostic.code = kCode;
  diagnostic.place.file = name;
  diagnostic.message = fmt::format("the shader does not start with `{}`", wanted);
  if (at == std::string_view::npos) return diagnostic;
  const std::string_view line = trim(text.substr(at, text.find('\n', at) - at));
  const bool es = row.checker == targets::Checker::Es;
  if (line == wanted || (!es && line == fmt::format("{} core", wanted))) return std::nullopt;
  locate(diagnostic, text, at, line.size());
  return diagnostic;
}

/// DXC's macros of the shader model; a text may define others. And a function that glslang
/// does not know: of a number that differs among the fragments.
constexpr const char* kShaderModel =
    "#define __SHADER_TARGET_MAJOR 6\n#define __SHADER_TARGET_MINOR 0\n"
    "#define NonUniformResourceIndex(number) (number)\n";

/// The one place that knows glslang's HLSL front end, which is deprecated there: whatever replaces it goes
/// here. SPIR-V made from HLSL is legalized by glslang itself, because opaque values pass through functions.
EShMessages setUpHlsl(glslang::TShader& shader, EShLanguage stage) {
  shader.setEnvInput(glslang::EShSourceHlsl, stage, glslang::EShClientVulkan, 100);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_1);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_3);
  shader.setSourceEntryPoint("main");
  shader.setPreamble(kShaderModel);
  shader.setShiftBinding(glslang::EResUbo, kHlslBufferShift);
  shader.setShiftBinding(glslang::EResTexture, kHlslTextureShift);
  shader.setShiftBinding(glslang::EResSsbo,
                         kHlslTextureShift);  // structured buffers are among the t registers
  shader.setShiftBinding(glslang::EResSampler, kHlslSamplerShift);
  // HLSL packs a float3 right behind a float, std140 does not: keep HLSL's offsets, so that the difference
  // shows.
  return static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules | EShMsgReadHlsl | EShMsgHlslOffsets);
}

/// Not for Checker::Es, whose texts never become SPIR-V.
EShMessages setUp(glslang::TShader& shader, targets::Checker checker, EShLanguage stage) {
  shader.setEntryPoint("main");
  if (checker == targets::Checker::Direct3d) return setUpHlsl(shader, stage);
  if (checker == targets::Checker::OpenGl) {
    shader.setEnvInput(glslang::EShSourceGlsl, stage, glslang::EShClientOpenGL, 100);
    shader.setEnvClient(glslang::EShClientOpenGL, glslang::EShTargetOpenGL_450);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_0);
    return EShMsgSpvRules;
  }
  shader.setEnvInput(glslang::EShSourceGlsl, stage, glslang::EShClientVulkan, 100);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_1);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_3);
  return static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
}

/// Parses and links as a driver of OpenGL (ES) does that is given text: what exists only for SPIR-V, such as
/// specialization constants, does not pass here.
Diagnostics checkAsText(std::string_view text, EShLanguage stage, const std::string& name) {
  glslang::TShader shader(stage);
  const char* strings[] = {text.data()};
  const int lengths[] = {static_cast<int>(text.size())};
  shader.setStringsWithLengths(strings, lengths, 1);
  if (!shader.parse(GetDefaultResources(), 100, false, EShMsgDefault)) {
    return errorsOf(shader.getInfoLog(), text, name);
  }
  glslang::TProgram program;  // after the shader: it must be destroyed first
  program.addShader(&shader);
  if (!program.link(EShMsgDefault)) return errorsOf(program.getInfoLog(), text, name);
  return {};
}

Result<Spirv> compileToSpirv(std::string_view text, targets::Checker checker, EShLanguage stage,
                             const std::string& name) {
  glslang::TShader shader(stage);
  const char* strings[] = {text.data()};
  const int lengths[] = {static_cast<int>(text.size())};
  shader.setStringsWithLengths(strings, lengths, 1);
  const EShMessages messages = setUp(shader, checker, stage);
  if (!shader.parse(GetDefaultResources(), 100, false, messages)) {
    return tl::make_unexpected(errorsOf(shader.getInfoLog(), text, name));
  }
  glslang::TProgram program;
  program.addShader(&shader);
  if (!program.link(messages) || !program.mapIO()) {
    return tl::make_unexpected(errorsOf(program.getInfoLog(), text, name));
  }
  Spirv words;
  spv::SpvBuildLogger logger;
  glslang::SpvOptions options;
  options.disableOptimizer = false;  // only HLSL has anything done to it: the legalization
  glslang::GlslangToSpv(*program.getIntermediate(stage), words, &logger, &options);
  const std::string log = logger.getAllMessages();
  if (words.empty() || log.find("error: ") != std::string::npos) {
    return tl::make_unexpected(errorsOf(log, text, name));
  }
  return words;
}

}  // namespace

Result<Spirv> compile(std::string_view text, Target target, Stage stage, const std::string& name) {
  // Once per process, by the first caller; the tables live as long as the process.
  static const bool kReady = glslang::InitializeProcess();
  if (!kReady) return fail(std::string(kCode), {name, 0, 0, {}}, "glslang could not be initialized");
  const targets::Row& row = targets::row(target);
  if (auto wrong = wrongVersion(text, row, name)) return tl::make_unexpected(Diagnostics{std::move(*wrong)});

  const EShLanguage shader_stage = stage == Stage::Vertex ? EShLangVertex : EShLangFragment;
  const bool es = row.checker == targets::Checker::Es;
  if (es || row.checker == targets::Checker::OpenGl) {
    if (Diagnostics errors = checkAsText(text, shader_stage, name); !errors.empty()) {
      return tl::make_unexpected(std::move(errors));
    }
  }
  if (es) return Spirv{};
  return compileToSpirv(text, row.checker, shader_stage, name);
}

}  // namespace lacquer::check
