// Where the messages of a SecureStream end, without the key: for a relay, which delays each whole.
//
// A direction of such a stream is a hello of fixed size and then messages: a length of four bytes
// and as many bytes of sealed box (hardware/net/secure_stream.h). The relay looks at nothing but
// the length.
//
// Contract: tell take() what was read, and it says when a message is complete. needed() is how much
// may be read so that the next message is never touched. A length of nothing or beyond the largest
// message throws RelayError: the stream is then no SecureStream, and ends.
//
//   MessageSplitter splitter;
//   while (read(splitter.needed(), chunk)) {
//     if (auto message = splitter.take(chunk)) forward(*message);
//   }
#ifndef SIMBENCH_HARDWARE_RELAY_MESSAGE_SPLITTER_H_
#define SIMBENCH_HARDWARE_RELAY_MESSAGE_SPLITTER_H_

#include <cstddef>
#include <optional>
#include <span>
#include <stdexcept>

#include "algorithms/ports/host.h"

namespace simbench::hardware {

class RelayError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class MessageSplitter {
 public:
  MessageSplitter();

  // Bytes that are missing to the end of what is being read now; never 0.
  std::size_t needed() const { return wanted_ - buffer_.size(); }
  // At most needed() bytes, in order. The message with its length, if they complete one.
  std::optional<Bytes> take(std::span<const std::byte> chunk);

 private:
  enum class Part : unsigned char { kHello, kLength, kBox };
  Part part_ = Part::kHello;
  std::size_t wanted_;
  Bytes buffer_;
};

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_RELAY_MESSAGE_SPLITTER_H_
