#include "hardware/net/secure_stream.h"

#include <gmock/gmock.h>

#include <boost/asio/io_context.hpp>
#include <memory>
#include <optional>
#include <string>

#include "tests/hardware/net/in_time.h"
#include "tests/hardware/net/stream_pair.h"

namespace simbench::hardware {
namespace {

using testing::HasSubstr;
using Kind = StreamError::Kind;

std::string received_by(boost::asio::io_context& context, SecureStream& stream) {
  return text_of(in_time(context, stream.receive(soon())).bytes);
}

TEST(SecureStream, CarriesMessagesBothWaysInOrder) {
  boost::asio::io_context context;
  const StreamPair pair = stream_pair(context);
  EXPECT_EQ(in_time(context, pair.connected->send(bytes_of("one"))), 0u);
  EXPECT_EQ(in_time(context, pair.connected->send(bytes_of(""))), 1u);
  EXPECT_EQ(in_time(context, pair.connected->send(bytes_of("three"))), 2u);
  in_time(context, pair.accepted->send(bytes_of("back")));
  EXPECT_EQ(received_by(context, *pair.accepted), "one");
  EXPECT_EQ(received_by(context, *pair.accepted), "");
  EXPECT_EQ(received_by(context, *pair.accepted), "three");
  EXPECT_EQ(received_by(context, *pair.connected), "back");
}

TEST(SecureStream, EachSideKnowsTheOther) {
  boost::asio::io_context context;
  const StreamPair pair = stream_pair(context);
  EXPECT_EQ(pair.accepted->peer(), PeerName{1});
  EXPECT_EQ(pair.connected->peer(), PeerName{0});
  EXPECT_THAT(pair.accepted->peer_address(), testing::StartsWith("127.0.0.1:"));
}

TEST(SecureStream, DerivesTheSameKeysOnBothSidesAndOthersForEachPurposeAndSession) {
  boost::asio::io_context context;
  const StreamPair pair = stream_pair(context);
  const StreamPair another = stream_pair(context);
  EXPECT_EQ(pair.accepted->derived_key(1), pair.connected->derived_key(1));
  EXPECT_NE(pair.accepted->derived_key(1), pair.accepted->derived_key(2));
  EXPECT_NE(pair.accepted->derived_key(1), another.accepted->derived_key(1));
}

TEST(SecureStream, AMessageOfTheGreatestLengthArrivesWhole) {
  boost::asio::io_context context;
  const StreamPair pair = stream_pair(context);
  Bytes large(SecureStream::kMaxMessageBytes);
  for (std::size_t i = 0; i < large.size(); ++i) large[i] = static_cast<std::byte>(i % 251);
  in_time(context, pair.connected->send(large));
  EXPECT_EQ(in_time(context, pair.accepted->receive(soon())).bytes, large);
}

TEST(SecureStream, AMessageThatIsTooLongIsNotSentAndTheStreamGoesOn) {
  boost::asio::io_context context;
  const StreamPair pair = stream_pair(context);
  const StreamError error = stream_error(
      [&] { in_time(context, pair.connected->send(Bytes(SecureStream::kMaxMessageBytes + 1))); });
  EXPECT_EQ(error.kind(), Kind::kNotUnderstood);
  EXPECT_THAT(error.what(), HasSubstr("found a message of 4194305 bytes"));
  in_time(context, pair.connected->send(bytes_of("next")));
  EXPECT_EQ(received_by(context, *pair.accepted), "next");
}

TEST(SecureStream, APeerThatDoesNotReadEndsIt) {
  boost::asio::io_context context;
  const StreamPair pair = stream_pair(context);
  std::size_t sent = 0;
  const StreamError error = stream_error([&] {
    // The kernel's buffers on both sides take some MiB beside what is queued.
    for (; sent < 64; ++sent) in_time(context, pair.connected->send(Bytes(1u << 20)));
  });
  EXPECT_EQ(error.kind(), Kind::kUnreachable);
  EXPECT_THAT(error.what(), HasSubstr("does not read what it is sent"));
  EXPECT_GE(sent, SecureStream::kMaxQueuedBytes >> 20);
}

TEST(SecureStream, AReceiveThatTimesOutLosesNothing) {
  boost::asio::io_context context;
  const StreamPair pair = stream_pair(context);
  const MonotonicTime deadline = in_ms(20);
  const StreamError error =
      stream_error([&] { in_time(context, pair.accepted->receive(deadline)); });
  EXPECT_EQ(error.kind(), Kind::kTimeout);
  EXPECT_GE(monotonic_now(), deadline);
  in_time(context, pair.connected->send(bytes_of("later")));
  EXPECT_EQ(received_by(context, *pair.accepted), "later");
}

TEST(SecureStream, WhatIsThereIsReceivedAlsoAfterTheDeadline) {
  boost::asio::io_context context;
  const StreamPair pair = stream_pair(context);
  in_time(context, pair.connected->send(bytes_of("there")));
  pass(context, 50);
  EXPECT_EQ(text_of(in_time(context, pair.accepted->receive(in_ms(-1))).bytes), "there");
}

TEST(SecureStream, StampsLieBetweenTheCallsOfSenderAndReceiver) {
  boost::asio::io_context context;
  const StreamPair pair = stream_pair(context);
  for (int i = 0; i < 20; ++i) {
    const MonotonicTime before = monotonic_now();
    const MessageId id = in_time(context, pair.connected->send(bytes_of("stamp")));
    const auto left = in_time(context, pair.connected->transmit_stamp(id, soon()));
    const StreamMessage message = in_time(context, pair.accepted->receive(soon()));
    const MonotonicTime after = monotonic_now();
    ASSERT_TRUE(left);
    EXPECT_LE(before, *left);
    EXPECT_LE(*left, after);
    EXPECT_LE(before, message.received);
    EXPECT_LE(message.received, after);
  }
}

// The reader sleeps while the message lies in the kernel: a stamp of the read would be later.
TEST(SecureStream, TheReceiveStampIsOfTheArrivalNotOfTheRead) {
  boost::asio::io_context sender_context;
  boost::asio::io_context reader_context;
  Listener listener(reader_context);
  Running accepted(reader_context, listener.accept(key_from_digit('7'), PeerName{0}));
  Running connected(sender_context,
                    SecureStream::connect(sender_context, "127.0.0.1", listener.port(),
                                          key_from_digit('7'), PeerName{1}, soon()));
  until(reader_context, [&] {
    sender_context.restart();
    sender_context.poll();
    return accepted.done() && connected.done();
  });
  const auto writer = connected.get();
  const auto reader = accepted.get();
  // The kernel begins to stamp some time after the first socket has asked for it.
  bool stamped = false;
  for (int message = 0; message < 10 && !stamped; ++message) {
    in_time(sender_context, writer->send(bytes_of("early")));
    pass(sender_context, 100);
    const MonotonicTime first_read = monotonic_now();
    const StreamMessage read = in_time(reader_context, reader->receive(soon()));
    stamped = read.received < first_read - std::chrono::milliseconds(50);
  }
  EXPECT_TRUE(stamped);
}

TEST(SecureStream, NoStampForWhatWasNeverSent) {
  boost::asio::io_context context;
  const StreamPair pair = stream_pair(context);
  EXPECT_EQ(in_time(context, pair.connected->transmit_stamp(99, soon())), std::nullopt);
}

TEST(SecureStream, ClosingEndsPendingCallsOnBothSides) {
  boost::asio::io_context context;
  const StreamPair pair = stream_pair(context);
  Running here(context, pair.connected->receive(soon()));
  Running there(context, pair.accepted->receive(soon()));
  pass(context, 10);
  pair.connected->close();
  EXPECT_EQ(stream_error([&] { here.get(); }).kind(), Kind::kUnreachable);
  EXPECT_EQ(stream_error([&] { there.get(); }).kind(), Kind::kUnreachable);
  EXPECT_EQ(stream_error([&] { in_time(context, pair.connected->send({})); }).kind(),
            Kind::kUnreachable);
  pair.connected->close();
}

TEST(SecureStream, WhatArrivedBeforeTheEndIsStillReceived) {
  boost::asio::io_context context;
  StreamPair pair = stream_pair(context);
  in_time(context, pair.connected->send(bytes_of("last words")));
  pair.connected.reset();
  EXPECT_EQ(received_by(context, *pair.accepted), "last words");
  const StreamError error = stream_error([&] { in_time(context, pair.accepted->receive(soon())); });
  EXPECT_THAT(error.what(), HasSubstr("the other side closed the connection"));
}

TEST(SecureStream, MayGoWhileCallsWait) {
  boost::asio::io_context context;
  StreamPair pair = stream_pair(context);
  Running receiving(context, pair.connected->receive(soon()));
  pass(context, 10);
  pair.connected.reset();
  EXPECT_EQ(stream_error([&] { receiving.get(); }).kind(), Kind::kUnreachable);
}

TEST(SecureStream, MayGoWithItsContextWhileCallsWait) {
  auto context = std::make_unique<boost::asio::io_context>();
  StreamPair pair = stream_pair(*context);
  auto receiving =
      std::make_unique<Running<StreamMessage>>(*context, pair.connected->receive(soon()));
  pass(*context, 10);
  pair = {};
  EXPECT_FALSE(receiving->done());
  receiving.reset();
  context.reset();
}

}  // namespace
}  // namespace simbench::hardware
