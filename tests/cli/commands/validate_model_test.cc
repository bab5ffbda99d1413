// `simbench validate-model` and `simbench relay` through the real program; what measures for longer
// is in validate_model_slow_test.cc.
#include <gmock/gmock.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/cli/program.h"
#include "tests/free_port.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;

class ValidateModelCommand : public ProgramTest {
 protected:
  // Five repetitions of one pipeline.
  std::string study(const std::string& scenario = "6node_relay") const {
    Json rows = Json::array();
    Json seeds = Json::array();
    for (int seed = 1; seed <= 5; ++seed) {
      seeds.push_back({{"seed", seed},
                       {"host_error_ms", 2.5},
                       {"amd_ms", 3.0 + 0.1 * seed},
                       {"rmdv_ms", 1.0},
                       {"absolute_error_ms", nullptr}});
    }
    rows.push_back({{"pipeline", "yoon2021_neither"}, {"notes", Json::array()}, {"seeds", seeds}});
    return file("study.json", Json{{"schema_version", 1},
                                   {"date", "2026-01-02"},
                                   {"machine", "an abacus"},
                                   {"scenario", scenario},
                                   {"commit", "abc"},
                                   {"rows", rows}}
                                  .dump());
  }
};

TEST_F(ValidateModelCommand, ComparesAKeptStudyWithTheSimulation) {
  const ProgramResult result = run({"validate-model", "--scenario", "6node_relay", "--measured",
                                    study(), "--seeds", "10", "--format", "json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json root = Json::parse(result.out);
  EXPECT_EQ(root["scenario"], "6node_relay");
  EXPECT_EQ(root["measured_on"]["machine"], "an abacus");
  ASSERT_GE(root["rows"].size(), 2u);
  bool amd = false;
  for (const Json& row : root["rows"]) {
    EXPECT_EQ(row["pipeline"], "yoon2021_neither");
    if (row["metric"] != "amd_ms") continue;
    amd = true;
    EXPECT_DOUBLE_EQ(row["measured"]["median"].get<double>(), 3.3);
    EXPECT_EQ(row["simulated"]["count"], 10);
    EXPECT_GE(row["ks"].get<double>(), 0);
    EXPECT_LE(row["ks"].get<double>(), 1);
  }
  EXPECT_TRUE(amd);
  EXPECT_FALSE(root["evidence"].empty());
}

TEST_F(ValidateModelCommand, TheTableNamesMachineAndRows) {
  const ProgramResult result =
      run({"validate-model", "--scenario", "6node_relay", "--measured", study(), "--seeds", "10"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("an abacus"));
  EXPECT_THAT(result.out, HasSubstr("yoon2021_neither"));
}

TEST_F(ValidateModelCommand, AProgramFileThatIsNotThereIsOneMessage) {
  const ProgramResult none =
      run({"validate-model", "--scenario", "6node_relay", "--program", "mine=none.json"});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("--program mine=none.json: "));
}

TEST_F(ValidateModelCommand, BadInputIsOneMessage) {
  ProgramResult result = run(
      {"validate-model", "--scenario", "6node_relay", "--measured", study("18cam_6host_45fps")});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("18cam_6host_45fps"));
  result = run(
      {"validate-model", "--scenario", "6node_relay", "--measured", study(), "--pipelines", "ntp"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("none of the wanted pipelines is in the study"));
  result = run({"validate-model", "--scenario", "6node_relay", "--repeats", "0"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("--repeats"));
  result = run({"validate-model", "--scenario", "6node_relay", "--set", "/network/nagle=true"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("found true, allowed where a relay imitates the network"));
}

class RelayCommand : public ProgramTest {
 protected:
  // The rig file of node `node` of two, at free ports of loopback.
  std::string rig(int node) const {
    const Json hosts = {{{"name", "host0"},
                         {"address", "127.0.0.1"},
                         {"port", free_port()},
                         {"cameras", Json::array()}},
                        {{"name", "host1"},
                         {"address", "127.0.0.1"},
                         {"port", free_port()},
                         {"cameras", Json::array()}}};
    return file("node" + std::to_string(node) + ".json",
                Json{{"schema_version", 1}, {"name", "pair"}, {"hosts", hosts}}.dump());
  }
};

TEST_F(RelayCommand, EndsAfterItsTimeAndPrintsItsStatistics) {
  const ProgramResult result = run(
      {"relay", "--scenario", "6node_relay", "--nodes", rig(0) + "," + rig(1), "--for", "0.05"});
  ASSERT_EQ(result.status, 0) << result.err;
  ASSERT_THAT(result.out, testing::StartsWith("ready\n"));
  const Json statistics = Json::parse(result.out.substr(6));
  EXPECT_EQ(statistics["datagrams"], 0);
  EXPECT_TRUE(statistics["late_p50_us"].is_null());
}

TEST_F(RelayCommand, BadInputIsOneMessage) {
  ProgramResult result =
      run({"relay", "--scenario", "6node_relay", "--nodes", "nothing.json", "--for", "1"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("nothing.json"));
  result = run({"relay", "--scenario", "6node_relay", "--nodes", rig(0), "--for", "1"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("found 2 hosts, allowed: 1"));
  result = run(
      {"relay", "--scenario", "6node_relay", "--set", "/network/nagle=true", "--nodes", rig(0)});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("nagle"));
}

}  // namespace
}  // namespace simbench
