#include <fmt/format.h>

#include "c/handles.h"
#include "setting/messages.h"

namespace lacquer::c {

const char* give(const std::string& text, size_t* size) noexcept {
  if (size != nullptr) *size = text.size();
  return text.c_str();
}

lacquer_text* textFrom(std::string text) {
  return text.empty() ? nullptr : new lacquer_text{std::move(text)};
}

void sayError(lacquer_messages* messages, const char* code, std::string_view what,
              std::string_view help) noexcept {
  if (messages == nullptr) return;
  try {
    report(fail(code, {}, std::string(what), std::string(help)).value(), {}, messages->list);
  } catch (...) {
    return;  // no memory for the message that there is none
  }
}

bool isEnumerator(int value, int last, const char* what, lacquer_messages* messages) {
  if (value >= 0 && value <= last) return true;
  sayError(messages, "unknown-enumerator", fmt::format("the {} is {}, which is no enumerator", what, value),
           fmt::format("they are 0 to {}", last));
  return false;
}

namespace {

const Message* messageOf(const lacquer_messages* messages, size_t index) {
  return messages != nullptr && index < messages->list.size() ? &messages->list[index] : nullptr;
}

const std::string& partOf(const Message& message, int part) {
  static const std::string kNone;
  switch (part) {
    case LACQUER_MESSAGE_CODE: return message.code;
    case LACQUER_MESSAGE_FILE: return message.file;
    case LACQUER_MESSAGE_POINTER: return message.pointer;
    case LACQUER_MESSAGE_WHAT: return message.message;
    case LACQUER_MESSAGE_HELP: return message.help;
    case LACQUER_MESSAGE_TEXT: return message.text;
    default: return kNone;
  }
}

}  // namespace

}  // namespace lacquer::c

using namespace lacquer::c;

uint32_t lacquer_c_version(void) { return LACQUER_C_VERSION; }
const char* lacquer_version(void) {
  static const std::string kVersion(lacquer::version());
  return kVersion.c_str();
}

const char* lacquer_text_data(const lacquer_text* text) { return text == nullptr ? "" : text->text.c_str(); }
size_t lacquer_text_size(const lacquer_text* text) { return text == nullptr ? 0 : text->text.size(); }
void lacquer_text_free(lacquer_text* text) { delete text; }

lacquer_messages* lacquer_messages_new(void) { return new (std::nothrow) lacquer_messages; }
void lacquer_messages_free(lacquer_messages* messages) { delete messages; }
void lacquer_messages_clear(lacquer_messages* messages) {
  if (messages != nullptr) messages->list.clear();
}
size_t lacquer_messages_count(const lacquer_messages* messages) {
  return messages == nullptr ? 0 : messages->list.size();
}
int lacquer_messages_have_error(const lacquer_messages* messages) {
  return messages != nullptr && lacquer::hasError(messages->list) ? 1 : 0;
}
int lacquer_message_level(const lacquer_messages* messages, size_t index) {
  const lacquer::Message* message = messageOf(messages, index);
  return message == nullptr ? -1 : static_cast<int>(message->level);
}
const char* lacquer_message_part(const lacquer_messages* messages, size_t index, int part, size_t* size) {
  static const std::string kNone;
  const lacquer::Message* message = messageOf(messages, index);
  return give(message == nullptr ? kNone : partOf(*message, part), size);
}
uint32_t lacquer_message_line(const lacquer_messages* messages, size_t index) {
  const lacquer::Message* message = messageOf(messages, index);
  return message == nullptr ? 0 : message->line;
}
uint32_t lacquer_message_column(const lacquer_messages* messages, size_t index) {
  const lacquer::Message* message = messageOf(messages, index);
  return message == nullptr ? 0 : message->column;
}
