#include "scenarios/load_checks.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/scenarios/support.h"

namespace simbench::scenarios {
namespace {

// Six hosts; the base has a bandwidth.
std::string with_traffic(const std::string& members) {
  return R"("network": {"bandwidth_mbit_per_s": 1000, "traffic": [{)" + members + "}]}";
}

TEST(LoadChecks, AChainEndsAtTheMaster) {
  EXPECT_EQ(load_derived(R"("hosts": {"follows": [0, 0, 1, 2, 0, 4]})").hosts.follows.size(), 6U);
  EXPECT_EQ(error_of(R"("hosts": {"follows": [0, 0, 3, 2, 0, 0]})"),
            "my.json:3: /hosts/follows/2: found 3: host 2 follows a circle of hosts, allowed a "
            "chain or a tree that ends at the master, 0, as 0, 0, 1, 2");
  EXPECT_EQ(error_of(R"("hosts": {"follows": [0, 1, 0, 0, 0, 0]})"),
            "my.json:3: /hosts/follows/1: found 1: host 1 follows a circle of hosts, allowed a "
            "chain or a tree that ends at the master, 0, as 0, 0, 1, 2");
  EXPECT_EQ(error_of(R"("hosts": {"follows": [1, 0, 0, 0, 0, 0]})"),
            "my.json:3: /hosts/follows/0: found 1, allowed 0: the master follows no other host");
  EXPECT_EQ(
      error_of(R"("hosts": {"follows": [0, 0]})"),
      "my.json:3: /hosts/follows: found 2 hosts, allowed none or one for each of the 6 hosts");
  EXPECT_EQ(error_of(R"("hosts": {"follows": [0, 6, 0, 0, 0, 0]})"),
            "my.json:3: /hosts/follows/1: found 6, allowed 0 to 5 (/hosts/count is 6)");
}

TEST(LoadChecks, TrafficStatesWhatItsKindNeeds) {
  const Scenario iperf =
      load_derived(with_traffic(R"("kind": "tcp", "from": 1, "to": 0, "both_ways": true)"));
  ASSERT_EQ(iperf.network.traffic.size(), 1U);
  EXPECT_EQ(iperf.network.traffic[0].connections, 1);
  EXPECT_EQ(error_of(with_traffic(R"("kind": "paced", "from": 1, "to": 0)")),
            "my.json:3: /network/traffic/0/mbit_per_s: found nothing, \"paced\" needs its mean "
            "rate");
  EXPECT_EQ(error_of(with_traffic(R"("kind": "tcp", "from": 1, "to": 0, "mbit_per_s": 100)")),
            "my.json:3: /network/traffic/0/mbit_per_s: found it beside kind \"tcp\", allowed for "
            "\"paced\" and \"random\" (TCP that its program limits is \"paced\" in bursts) only");
  EXPECT_EQ(error_of(with_traffic(
                R"("kind": "random", "from": 1, "to": 0, "mbit_per_s": 1, "connections": 2)")),
            "my.json:3: /network/traffic/0/connections: found it beside kind \"random\", allowed "
            "for \"tcp\" only");
  EXPECT_EQ(error_of(with_traffic(R"("kind": "tcp", "from": 1, "to": 1)")),
            "my.json:3: /network/traffic/0/to: found 1, which sends it, allowed another host");
  EXPECT_EQ(error_of(with_traffic(R"("kind": "tcp", "from": 1, "to": 6)")),
            "my.json:3: /network/traffic/0/to: found 6, allowed 0 to 5 (/hosts/count is 6)");
  EXPECT_EQ(
      error_of(with_traffic(R"("kind": "tcp", "from": 1, "to": 0, "begin_s": 5, "end_s": 4)")),
      "my.json:3: /network/traffic/0/end_s: found 4, allowed more than begin_s, 5");
}

TEST(LoadChecks, ABufferHoldsAFrameAndALineHasARate) {
  EXPECT_EQ(error_of(R"("network": {"buffer_kb": 0})"),
            "my.json:3: /network/buffer_kb: found 0, allowed a number from 2 to 1000000");
  EXPECT_EQ(error_of(R"("network": {"bandwidth_mbit_per_s": 0,
                        "traffic": [{"kind": "tcp", "from": 1, "to": 0}]})"),
            "my.json:4: /network/traffic/0: found traffic, allowed where "
            "/network/bandwidth_mbit_per_s is above 0 (infinite)");
}

}  // namespace
}  // namespace simbench::scenarios
