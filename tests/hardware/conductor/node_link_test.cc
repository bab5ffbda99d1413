#include "hardware/conductor/node_link.h"

#include <gmock/gmock.h>

#include <boost/asio/io_context.hpp>
#include <list>

#include "tests/hardware/conductor/cuttable_link.h"
#include "tests/hardware/conductor/test_rig.h"
#include "tests/hardware/net/in_time.h"

namespace simbench::hardware {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr Nanoseconds kLimit = std::chrono::seconds(20);

class NodeLinkTest : public testing::Test {
 protected:
  NodeLink link_to(std::uint16_t port) {
    RigHost host = rig_.rig().hosts[0];
    host.port = port;
    return {context_, host, SecretKey(), [](const NodeAnswer&) {}};
  }
  // How many of several requests, sent before there is a stream, are answered.
  int answered(NodeLink& link, int requests) {
    std::list<Running<json>> running;
    for (int i = 0; i < requests; ++i)
      running.emplace_back(context_, link.ask("hello", {}, kLimit));
    int answers = 0;
    for (Running<json>& request : running) answers += request.get().contains("cameras") ? 1 : 0;
    return answers;
  }

  TestRig rig_{{0}};
  CuttableLink wire_{rig_.rig().hosts[0].port};
  boost::asio::io_context context_;
};

TEST_F(NodeLinkTest, RequestsThatComeBeforeTheStreamWaitForIt) {
  NodeLink link = link_to(rig_.rig().hosts[0].port);
  EXPECT_EQ(answered(link, 5), 5);
}

TEST_F(NodeLinkTest, ABrokenStreamIsOpenedAgainByTheNextRequest) {
  NodeLink link = link_to(wire_.port());
  EXPECT_EQ(answered(link, 1), 1);
  wire_.cut();
  EXPECT_THROW(answered(link, 2), NodeError);
  wire_.mend();  // which another thread does
  const auto is_back = [&] {
    try {
      return answered(link, 3) == 3;
    } catch (const NodeError&) {
      return false;
    }
  };
  EXPECT_TRUE(until(context_, is_back));
}

TEST_F(NodeLinkTest, ARefusalIsTheNodesOwn) {
  NodeLink link = link_to(rig_.rig().hosts[0].port);
  try {
    in_time(context_, link.ask("dance", {}, kLimit));
    FAIL() << "nothing thrown";
  } catch (const NodeError& error) {
    EXPECT_EQ(error.kind(), NodeError::Kind::kRefused);
    EXPECT_THAT(error.what(), HasSubstr(rig_.rig().hosts[0].name + " (127.0.0.1:"));
  }
}

TEST_F(NodeLinkTest, AClosedLinkRefusesAndItsRequestsEnd) {
  NodeLink link = link_to(rig_.rig().hosts[0].port);
  EXPECT_EQ(answered(link, 1), 1);
  Running<json> pending(context_, link.ask("hello", {}, kLimit));
  context_.poll_one();
  link.close();
  EXPECT_THROW(pending.get(), NodeError);
  EXPECT_THROW(answered(link, 1), NodeError);
}

}  // namespace
}  // namespace simbench::hardware
