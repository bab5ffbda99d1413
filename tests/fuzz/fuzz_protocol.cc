// What a conductor and its nodes say to each other, and the notes of journals: any bytes are either
// refused or read, and what was read is written and read again as the same.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>

#include "hardware/node/journal.h"
#include "hardware/node/protocol.h"

namespace {

using simbench::hardware::NodeAnswer;
using simbench::hardware::NodeRequest;
using simbench::hardware::ProtocolError;

void require(bool condition) {
  if (!condition) std::abort();
}

void try_request(std::span<const std::byte> message) {
  NodeRequest request;
  try {
    request = simbench::hardware::parse_request(message);
  } catch (const ProtocolError&) {
    return;
  }
  const NodeRequest again = simbench::hardware::parse_request(simbench::hardware::encode(request));
  require(again.id == request.id && again.verb == request.verb);
  require(again.arguments == request.arguments);
}

void try_answer(std::span<const std::byte> message) {
  NodeAnswer answer;
  try {
    answer = simbench::hardware::parse_answer(message);
  } catch (const ProtocolError&) {
    return;
  }
  const NodeAnswer again = simbench::hardware::parse_answer(simbench::hardware::encode(answer));
  require(again.id == answer.id && again.notice == answer.notice);
  require(again.error == answer.error && again.details == answer.details);
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> message(reinterpret_cast<const std::byte*>(data), size);
  try_request(message);
  try_answer(message);
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto note = simbench::hardware::note_of_line(text)) {
    require(simbench::hardware::note_line(*note) == text);
  }
  require(simbench::hardware::note_of_line(simbench::hardware::note_line(text)) == text);
  return 0;
}
