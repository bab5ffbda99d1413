#include "hardware/node/protocol.h"

#include <gmock/gmock.h>

#include <random>

#include "tests/hardware/node/node_harness.h"

namespace simbench::hardware {
namespace {

using nlohmann::json;

TEST(Protocol, ARequestIsReadBack) {
  const NodeRequest request = {7, "begin", {{"session", "0123456789abcdef"}, {"n", 3}}};
  const NodeRequest read = parse_request(encode(request));
  EXPECT_EQ(read.id, 7U);
  EXPECT_EQ(read.verb, "begin");
  EXPECT_EQ(read.arguments, request.arguments);
}

TEST(Protocol, AnswersAreReadBack) {
  NodeAnswer reply;
  reply.id = 9;
  reply.details = {{"text", "a\nb"}};
  NodeAnswer read = parse_answer(encode(reply));
  EXPECT_EQ(read.id, 9U);
  EXPECT_EQ(read.error, "");
  EXPECT_EQ(read.details, reply.details);

  NodeAnswer error;
  error.id = 10;
  error.error = "busy";
  read = parse_answer(encode(error));
  EXPECT_EQ(read.id, 10U);
  EXPECT_EQ(read.error, "busy");

  NodeAnswer notice;
  notice.notice = "synchronised";
  notice.details = {{"error", nullptr}};
  read = parse_answer(encode(notice));
  EXPECT_EQ(read.notice, "synchronised");
  EXPECT_EQ(read.details, notice.details);
}

TEST(Protocol, WhatIsNoRequestIsRefused) {
  for (const char* text :
       {"", "{", "[]", "7", "null", "{}", R"({"id":1})", R"({"do":"ping"})",
        R"({"id":-1,"do":"ping"})", R"({"id":1.5,"do":"ping"})", R"({"id":"1","do":"ping"})",
        R"({"id":1,"do":7})", R"({"id":1,"do":null})", "{\"id\":1,\"do\":\"\xff\"}"}) {
    EXPECT_THROW(parse_request(bytes(text)), ProtocolError) << text;
  }
}

TEST(Protocol, WhatIsNoAnswerIsRefused) {
  for (const char* text :
       {"", "[]", "{}", R"({"id":1})", R"({"id":1,"result":7})", R"({"id":1,"error":7})",
        R"({"notice":7})", R"({"notice":""})", R"({"result":{}})"}) {
    EXPECT_THROW(parse_answer(bytes(text)), ProtocolError) << text;
  }
}

TEST(Protocol, BytesThatAreNoTextAreReplacedWhenWritten) {
  NodeAnswer reply;
  reply.id = 1;
  reply.details = {{"text", "\xff"}};
  EXPECT_EQ(parse_answer(encode(reply)).details["text"], "\xef\xbf\xbd");
}

TEST(Protocol, DeepNestingCostsNoStack) {
  const std::string deep(1'000'000, '[');
  EXPECT_THROW(parse_request(bytes(deep)), ProtocolError);
  const std::string closed =
      R"({"id":1,"do":"ping","x":)" + std::string(200'000, '[') + std::string(200'000, ']') + "}";
  EXPECT_EQ(parse_request(bytes(closed)).verb, "ping");
}

TEST(Protocol, AnyDamageIsRefusedOrUnderstood) {
  const unsigned seed = std::random_device()();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  const Bytes good =
      encode(NodeRequest{3, "read", {{"session", "0123456789abcdef"}, {"offset", 17}}});
  std::size_t refused = 0;
  for (int i = 0; i < 20'000; ++i) {
    Bytes damaged = good;
    const std::size_t changes = 1 + random() % 3;
    for (std::size_t change = 0; change < changes; ++change) {
      damaged[random() % damaged.size()] = static_cast<std::byte>(random() & 0xff);
    }
    damaged.resize(damaged.size() - random() % 2);
    try {
      parse_request(damaged);
    } catch (const ProtocolError&) {
      ++refused;
    }
    try {
      parse_answer(damaged);
    } catch (const ProtocolError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 20'000U);
}

TEST(SessionId, IsSixteenHexadecimalDigits) {
  EXPECT_TRUE(is_session_id("0123456789abcdef"));
  EXPECT_FALSE(is_session_id("0123456789ABCDEF"));
  EXPECT_FALSE(is_session_id("0123456789abcde"));
  EXPECT_FALSE(is_session_id("0123456789abcdef0"));
  EXPECT_FALSE(is_session_id("../../etc/passwd"));
  EXPECT_FALSE(is_session_id(""));
}

}  // namespace
}  // namespace simbench::hardware
