#include "recording/event_text.h"

#include "recording/event_fields.h"

namespace simbench {

std::string to_line(const RecordingEvent& event) {
  std::string line;
  append_event(line, event);
  return line;
}

RecordingEvent from_line(std::string_view line) {
  FieldReader fields(line);
  try {
    return read_event(fields);
  } catch (const TextFieldError& error) {
    throw EventTextError(error.what());
  }
}

}  // namespace simbench
