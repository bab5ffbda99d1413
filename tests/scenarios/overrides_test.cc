// --set /json/pointer=value.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/scenarios/support.h"

namespace simbench::scenarios {
namespace {

Scenario set(const std::string& pointer, const std::string& value) {
  return load_scenario("18cam_6host_45fps", {{pointer, value}});
}

TEST(Set, ReplacesValuesOfAllTypes) {
  EXPECT_EQ(set("/timeline/frames", "100").timeline.frames, 100);
  EXPECT_EQ(set("/timeline/warm_up_ms", "0.5").timeline.warm_up_ms, 0.5);
  EXPECT_EQ(set("/network/stamp_point", "kernel").network.stamp_point, StampPoint::kKernel);
  EXPECT_EQ(set("/network/stamp_point", "\"kernel\"").network.stamp_point, StampPoint::kKernel);
  EXPECT_TRUE(set("/network/nagle", "true").network.nagle);
  EXPECT_EQ(set("/pipelines/0/device_time", "oracle").pipelines[0].device_time, "oracle");
  const Scenario pauses = set("/trigger/pauses", R"([{"at_ms": 1, "duration_ms": 2}])");
  ASSERT_EQ(pauses.trigger.pauses.size(), 1U);
  EXPECT_EQ(pauses.trigger.pauses[0].duration_ms, 2);
}

TEST(Set, LaterOnesCount) {
  const Scenario scenario = load_scenario(
      "18cam_6host_45fps", {{"/trigger/pauses", R"([{"at_ms": 1, "duration_ms": 2}])"},
                            {"/trigger/pauses/0/at_ms", "3"}});
  EXPECT_EQ(scenario.trigger.pauses[0].at_ms, 3);
}

TEST(Set, MayCreateParametersOfAlgorithmsOnly) {
  EXPECT_EQ(std::get<double>(set("/algorithms/new/gain", "2").algorithms.at("new").at("gain")), 2);
  EXPECT_EQ(std::get<std::string>(
                set("/algorithms/yoon2021/a~1b~0", "x").algorithms.at("yoon2021").at("a/b~")),
            "x");
  EXPECT_EQ(error_of_set("/algorithms/new", "{}"),
            "--set /algorithms/new={}: found no \"new\" in /algorithms, allowed w32time, yoon2021");
  EXPECT_EQ(error_of_set("/published/genlock", "{}"),
            "--set /published/genlock={}: found no \"genlock\" in /published, allowed "
            "ntp_last_set, yoon2021_both, yoon2021_network, yoon2021_time");
}

TEST(Set, MayCreateWhatTheSchemaCallsOptional) {
  EXPECT_TRUE(set("/hosts/master_is_exact", "true").hosts.master_is_exact);
  EXPECT_EQ(
      set("/hosts/clock/skew_of_host_ppm", "[0, 1, 2, 3, 4, 5]").hosts.clock.skew_of_host_ppm.at(5),
      5);
  const Scenario linked = load_scenario(
      "18cam_6host_45fps", {{"/network/links", R"([{"host": 2, "asymmetry_ms": 0.1}])"},
                            {"/network/links/0/latency_fixed_ms", "0.3"}});
  EXPECT_EQ(linked.network.links.at(0).latency_fixed_ms, 0.3);
  EXPECT_FALSE(linked.network.links.at(0).latency_exponential_ms.has_value());
  EXPECT_EQ(load_scenario("18cam_6host_45fps").resolved_json(),
            load_scenario("18cam_6host_45fps",
                          {{"/hosts/master_is_exact", "true"}, {"/hosts/master_is_exact", "null"}})
                .resolved_json());
  EXPECT_EQ(error_of_set("/hosts/master_is_exct", "true"),
            "--set /hosts/master_is_exct=true: found no \"master_is_exct\" in /hosts, did you mean "
            "master_is_exact?");
  EXPECT_EQ(error_of_set("/hosts/clock/skew_of_host_ppm/0", "1"),
            "--set /hosts/clock/skew_of_host_ppm/0=1: found no \"0\" in "
            "/hosts/clock/skew_of_host_ppm, which is empty");
  EXPECT_EQ(error_of_set("/base", "x").find("--set /base=x: found no \"base\""), 0U);
}

TEST(Set, NullRemoves) {
  EXPECT_EQ(set("/published/ntp_last_set", "null").published.count("ntp_last_set"), 0U);
  EXPECT_EQ(set("/published", R"({"oracle": null})").published.size(), 0U);
  EXPECT_EQ(set("/algorithms/yoon2021/stamps", "null").algorithms.at("yoon2021").count("stamps"),
            0U);
  EXPECT_EQ(error_of_set("/timeline/frames", "null"),
            "--set /timeline/frames=null: found nothing, allowed a whole number from 1 to "
            "10000000");
}

TEST(Set, PointersThatNameNothing) {
  EXPECT_EQ(error_of_set("/timeline/frmes", "1"),
            "--set /timeline/frmes=1: found no \"frmes\" in /timeline, did you mean frames?");
  EXPECT_EQ(error_of_set("/timline", "1"),
            "--set /timline=1: found no \"timline\" in the scenario, did you mean timeline?");
  EXPECT_EQ(error_of_set("/timeline/xyz", "1"),
            "--set /timeline/xyz=1: found no \"xyz\" in /timeline, allowed frames, "
            "wait_before_capture_ms, warm_up_ms");
  EXPECT_EQ(error_of_set("/timeline/frames/0", "1"),
            "--set /timeline/frames/0=1: found no \"0\" in /timeline/frames, which is a single "
            "value");
  for (const std::string index : {"9", "00", "-1", "99999999999999999999", ""}) {
    EXPECT_EQ(error_of_set(fmt::format("/pipelines/{}", index), "1"),
              fmt::format("--set /pipelines/{0}=1: found no \"{0}\" in /pipelines, allowed 0 to 8",
                          index));
  }
  EXPECT_EQ(error_of_set("/faults/0", "1"),
            "--set /faults/0=1: found no \"0\" in /faults, which is empty");
}

TEST(Set, AMinusAppends) {
  const Scenario scenario =
      load_scenario("6host_star", {{"/pipelines/-",
                                    R"({"name": "mine", "host_sync": "ntp", "device_time": "oracle",
                          "gathering": "oracle"})"},
                                   {"/faults/-", R"({"kind": "link_stops", "host": 1, "at_ms": 0,
                                       "duration_ms": 5})"}});
  EXPECT_EQ(scenario.pipelines.back().name, "mine");
  EXPECT_EQ(scenario.faults.size(), 1U);
}

TEST(Set, WhatIsNoPointer) {
  for (const std::string pointer : {"", "timeline/frames", "/a~2", "/a~"}) {
    EXPECT_EQ(
        error_of_set(pointer, "1"),
        "--set " + pointer + "=1: found no JSON pointer, allowed one such as /timeline/frames");
  }
}

TEST(Set, BytesThatAreNoText) {
  EXPECT_EQ(error_of_set("/algorithms/a\xA0/b", "1"),
            "--set /algorithms/a\uFFFD/b=1: found bytes that are no UTF-8 text");
  EXPECT_EQ(error_of_set("/algorithms/a/b", "\xFF"),
            "--set /algorithms/a/b=\uFFFD: found bytes that are no UTF-8 text");
}

TEST(Set, WrongValues) {
  EXPECT_EQ(error_of_set("/timeline/frames", "0"),
            "--set /timeline/frames=0: found 0, allowed a whole number from 1 to 10000000");
  EXPECT_EQ(error_of_set("/timeline/frames", ""),
            "--set /timeline/frames=: found \"\", allowed a whole number from 1 to 10000000");
  EXPECT_EQ(error_of_set("/timeline/frames", "1e999"),
            "--set /timeline/frames=1e999: the number 1e999 is too large");
  EXPECT_EQ(error_of_set("/hosts/clock", "{}"),
            "--set /hosts/clock={}: /hosts/clock/arrival_quantum_ms: found nothing, allowed a "
            "number from 0 to 1000");
  EXPECT_EQ(
      error_of_set("/faults", R"([{"kind": "flood"}])"),
      "--set /faults=[{\"kind\": \"flood\"}]: /faults/0/kind: found \"flood\", allowed "
      "\"camera_vanishes\", \"late_first_frame\", \"clock_step\", \"host_stops\", \"link_stops\", "
      "\"leap_second\"");
  EXPECT_EQ(error_of_set("/faults", std::string(70, '[')),
            "--set /faults=" + std::string(70, '[') + ": nested more than 64 levels deep");
  EXPECT_LT(error_of_set("/faults", std::string(100000, 'x')).size(), 600U);
}

}  // namespace
}  // namespace simbench::scenarios
