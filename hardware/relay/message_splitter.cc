#include "hardware/relay/message_splitter.h"

#include <algorithm>
#include <utility>

#include "hardware/net/wire.h"

namespace simbench::hardware {

MessageSplitter::MessageSplitter() : wanted_(kHelloBytes) {}

std::optional<Bytes> MessageSplitter::take(std::span<const std::byte> chunk) {
  buffer_.insert(buffer_.end(), chunk.begin(), chunk.end());
  if (buffer_.size() < wanted_) return std::nullopt;
  if (part_ == Part::kLength) {
    FrameHeader header{};
    std::copy(buffer_.begin(), buffer_.end(), header.begin());
    const std::optional<std::size_t> box = box_bytes(header);
    if (!box) throw RelayError("a stream whose next message has an impossible length");
    part_ = Part::kBox;
    wanted_ += *box;
    return std::nullopt;
  }
  part_ = Part::kLength;
  wanted_ = kFrameHeaderBytes;
  return std::exchange(buffer_, {});
}

}  // namespace simbench::hardware
