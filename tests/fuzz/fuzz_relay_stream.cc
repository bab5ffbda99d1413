// What the relay reads of a stream: any bytes in any pieces are split into messages, none longer
// than what came, or refused with a RelayError.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "hardware/relay/relayed_stream.h"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::size_t piece = 1 + data[0];
  const std::span<const std::byte> stream(reinterpret_cast<const std::byte*>(data) + 1, size - 1);
  simbench::hardware::MessageSplitter splitter;
  std::size_t split = 0;
  try {
    for (std::size_t at = 0; at < stream.size();) {
      const std::size_t taken = std::min({piece, splitter.needed(), stream.size() - at});
      if (const auto message = splitter.take(stream.subspan(at, taken))) split += message->size();
      at += taken;
    }
  } catch (const simbench::hardware::RelayError&) {
  }
  if (split > stream.size()) std::abort();
  return 0;
}
