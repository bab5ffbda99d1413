#include "hardware/relay/relayed_stream.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "hardware/net/wire.h"

namespace simbench::hardware {
namespace {

Bytes filled(std::size_t size, unsigned char with) { return Bytes(size, std::byte{with}); }

Bytes message(std::size_t text_bytes) {
  const FrameHeader header = frame_header(text_bytes);
  Bytes all(header.begin(), header.end());
  all.resize(all.size() + text_bytes + kSealBytes, std::byte{0x55});
  return all;
}

// Gives all of `stream` in chunks of at most `chunk` bytes.
std::vector<Bytes> split(const Bytes& stream, std::size_t chunk) {
  MessageSplitter splitter;
  std::vector<Bytes> messages;
  for (std::size_t at = 0; at < stream.size();) {
    const std::size_t size = std::min({chunk, splitter.needed(), stream.size() - at});
    if (const auto found = splitter.take(std::span(stream).subspan(at, size))) {
      messages.push_back(*found);
    }
    at += size;
  }
  return messages;
}

TEST(MessageSplitter, FindsTheHelloAndEachMessageWhateverTheChunks) {
  const std::vector<Bytes> sent = {filled(kHelloBytes, 0x11), message(0), message(1), message(3000),
                                   message(100)};
  Bytes stream;
  for (const Bytes& each : sent) stream.insert(stream.end(), each.begin(), each.end());
  for (const std::size_t chunk : {1u, 3u, 46u, 100u, 65536u}) {
    EXPECT_EQ(split(stream, chunk), sent) << "chunks of " << chunk;
  }
}

TEST(MessageSplitter, NeverWantsABitOfTheNextMessage) {
  MessageSplitter splitter;
  EXPECT_EQ(splitter.needed(), kHelloBytes);
  splitter.take(filled(kHelloBytes, 0));
  EXPECT_EQ(splitter.needed(), kFrameHeaderBytes);
  const Bytes next = message(10);
  splitter.take(std::span(next).first(kFrameHeaderBytes));
  EXPECT_EQ(splitter.needed(), 10 + kSealBytes);
}

TEST(MessageSplitter, RefusesLengthsThatNoMessageHas) {
  for (const int byte : {0x00, 0xff}) {
    MessageSplitter splitter;
    splitter.take(filled(kHelloBytes, 0));
    EXPECT_THROW(splitter.take(filled(kFrameHeaderBytes, static_cast<unsigned char>(byte))),
                 RelayError);
  }
}

TEST(MessageSplitter, AnyBytesAreSplitOrRefused) {
  const unsigned seed = std::random_device()();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  for (int run = 0; run < 200; ++run) {
    Bytes stream(500);
    for (std::byte& byte : stream) byte = static_cast<std::byte>(random() % 3 == 0 ? random() : 0);
    std::size_t total = 0;
    try {
      for (const Bytes& each : split(stream, 7)) total += each.size();
    } catch (const RelayError&) {
    }
    EXPECT_LE(total, stream.size());
  }
}

}  // namespace
}  // namespace simbench::hardware
