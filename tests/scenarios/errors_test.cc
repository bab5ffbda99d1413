// What the schema and the checks refuse: exact messages.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/scenarios/support.h"

namespace simbench::scenarios {
namespace {

using testing::HasSubstr;

TEST(SchemaErrors, TypeRangeAndChoice) {
  EXPECT_EQ(error_of_text("[]"), "my.json:1: found an array of 0, allowed an object");
  EXPECT_EQ(error_of(R"("timeline": {"frames": "many"})"),
            "my.json:3: /timeline/frames: found \"many\", allowed a whole number from 1 to "
            "10000000");
  EXPECT_EQ(error_of(R"("timeline": {"frames": 1.5})"),
            "my.json:3: /timeline/frames: found 1.5, allowed a whole number from 1 to 10000000");
  EXPECT_EQ(error_of(R"("timeline": {"frames": 18446744073709551615})"),
            "my.json:3: /timeline/frames: found 1.8446744073709552e+19, allowed a whole number "
            "from 1 to 10000000");
  EXPECT_EQ(error_of("\"usb\": {\"spike_probability\":\n 1.5}"),
            "my.json:4: /usb/spike_probability: found 1.5, allowed a number from 0 to 1");
  EXPECT_EQ(error_of(R"("evaluation": {"gathering_interval_periods": 0})"),
            "my.json:3: /evaluation/gathering_interval_periods: found 0, allowed a number above 0 "
            "and at most 10");
  EXPECT_EQ(error_of(R"("evaluation": {"gathering_queue_frames": 0})"),
            "my.json:3: /evaluation/gathering_queue_frames: found 0, allowed a whole number from 1 "
            "to 10000 or null");
  EXPECT_EQ(error_of(R"("cameras": {"sync_mode": "slav"})"),
            "my.json:3: /cameras/sync_mode: found \"slav\", allowed \"default\", \"master\", "
            "\"slave\", \"full_slave\", \"genlock\"");
  EXPECT_EQ(error_of(R"("network": {"nagle": 1})"),
            "my.json:3: /network/nagle: found 1, allowed true or false");
  EXPECT_EQ(error_of(R"("hosts": 6)"), "my.json:3: /hosts: found 6, allowed an object");
  EXPECT_EQ(error_of(R"("hosts": {"count": null})"),
            "my.json:3: /hosts/count: found null, allowed a whole number from 1 to 100000");
  EXPECT_EQ(error_of(R"("pipelines": [])"),
            "my.json:3: /pipelines: found an array of 0, allowed an array of 1 to 1000");
  EXPECT_EQ(error_of(R"("algorithms": {"a": {"b": []}})"),
            "my.json:3: /algorithms/a/b: found an array of 0, allowed a number or true or false or "
            "text or null");
  EXPECT_EQ(error_of(R"("schema_version": 2)"),
            "my.json:3: /schema_version: found 2, allowed a whole number equal to 1");
}

TEST(SchemaErrors, UnknownKeys) {
  EXPECT_EQ(error_of(R"("hosts": {"cuont": 6})"),
            "my.json:3: /hosts/cuont: found an unknown key, did you mean count?");
  EXPECT_EQ(error_of(R"("evaluation": {"xyz": 6})"),
            "my.json:3: /evaluation/xyz: found an unknown key, allowed gathering_interval_periods, "
            "gathering_queue_frames, rmdv_median, stream, table");
  EXPECT_EQ(error_of(R"("trigger": {"pauses": [{"at_ms": 1, "duration_ms": 2, "a/b": 3}]})"),
            "my.json:3: /trigger/pauses/0/a~1b: found an unknown key, allowed at_ms, duration_ms");
}

TEST(SchemaErrors, TheFirstLineCounts) {
  EXPECT_EQ(error_of("\"usb\": {\"sharing\": 1},\n \"hosts\": {\"count\": 0},\n \"z\": 1"),
            "my.json:3: /usb/sharing: found 1, allowed \"dedicated\", \"fair\", \"fifo\"");
}

TEST(SchemaErrors, MissingMembers) {
  EXPECT_EQ(error_of_text("{\"name\": \"a\"}"),
            "my.json:1: /summary: found nothing, allowed text of 1 to 4000 characters");
  EXPECT_EQ(error_of_text("{\"name\": \"a\", \"summary\": \"b\"}"),
            "my.json:1: /algorithms: found nothing, allowed an object");
  EXPECT_EQ(error_of("\"pipelines\": [\n {\"name\": \"a\", \"host_sync\": \"b\",\n"
                     " \"gathering\": \"c\"}]"),
            "my.json:4: /pipelines/0/device_time: found nothing, allowed text of 1 to 100 "
            "characters");
}

TEST(Checks, Names) {
  EXPECT_EQ(error_of_text(R"({"base": "18cam_6host_45fps", "name": "a b", "summary": "s"})"),
            "my.json:1: /name: found \"a b\", allowed letters, digits, '_', '-' and '.', no '-' in "
            "front");
  EXPECT_EQ(error_of_set("/pipelines/1/name", "ntp_last_set"),
            "--set /pipelines/1/name=ntp_last_set: found a second \"ntp_last_set\", allowed a name "
            "for each pipeline");
  EXPECT_EQ(error_of(R"("published": {"yoon2021_bot": {"amd_ms": 1, "rmdv_ms": 1}})"),
            "my.json:3: /published/yoon2021_bot: found no such pipeline, did you mean "
            "yoon2021_both?");
}

TEST(Errors, TablesAscendAndAreWhole) {
  EXPECT_EQ(
      error_of(R"("usb": {"delivery_quantiles_ms": [0.5]})"),
      "my.json:3: /usb/delivery_quantiles_ms: found 1 number, allowed none or 2 to 1001, from "
      "the least to the largest");
  EXPECT_EQ(error_of("\"network\": {\"latency_quantiles_ms\": [0.1, 0.3,\n 0.2]}"),
            "my.json:4: /network/latency_quantiles_ms/2: found 0.2, allowed at least 0.3, the "
            "number before it: a table of quantiles ascends");
  EXPECT_EQ(error_of(R"("usb": {"delivery_quantiles_ms": [-1, 0]})"),
            "my.json:3: /usb/delivery_quantiles_ms/0: found -1, allowed a number from 0 to "
            "1000000");
  EXPECT_EQ(error_of(R"("usb": {"delivery_correlation": 0.5})"),
            "my.json:3: /usb/delivery_correlation: found 0.5, allowed 0 without "
            "/usb/delivery_quantiles_ms");
  EXPECT_EQ(error_of(R"("timeline": {"frames": 2000000})"),
            "my.json:3: /timeline/frames: found 2000000, allowed at most 1388888 of 18 cameras (of "
            "all together 25000000)");
  EXPECT_EQ(error_of(R"("cameras": {"skew_of_camera_ppm": [1, 2]})"),
            "my.json:3: /cameras/skew_of_camera_ppm: found 2 skews, allowed none or one for each "
            "of the 18 cameras");
  EXPECT_EQ(error_of(R"("usb": {"delivery_quantiles_ms": [0, 0], "delivery_correlation": -0.5})"),
            "");
}

TEST(Checks, CamerasAndHosts) {
  EXPECT_EQ(error_of(R"("hosts": {"count": 5})"),
            place_in_base("/cameras/cameras_per_host") +
                ": found 3, which puts camera 17 "
                "on host 5, allowed hosts are 0 to 4 (/hosts/count is 5)");
  EXPECT_EQ(error_of(R"("cameras": {"count": 2, "host_of_camera": [0]})"),
            "my.json:3: /cameras/host_of_camera: found 1 hosts, allowed none or one for each of "
            "the 2 cameras");
  EXPECT_EQ(error_of("\"cameras\": {\"count\": 2, \"host_of_camera\": [0,\n 6]}"),
            "my.json:4: /cameras/host_of_camera/1: found 6, allowed 0 to 5 (/hosts/count is 6)");
}

TEST(Checks, ValuesOfHosts) {
  for (const std::string count : {"5", "7"}) {
    const std::string values = count == "5" ? "[0, 1, 2, 3, 4]" : "[0, 1, 2, 3, 4, 5, 6]";
    EXPECT_EQ(error_of(R"("hosts": {"clock": {"skew_of_host_ppm": )" + values + "}}"),
              "my.json:3: /hosts/clock/skew_of_host_ppm: found " + count +
                  " skews, allowed none or one for each of the 6 hosts");
    EXPECT_EQ(error_of(R"("hosts": {"clock": {"initial_offset_of_host_ms": )" + values + "}}"),
              "my.json:3: /hosts/clock/initial_offset_of_host_ms: found " + count +
                  " offsets, allowed none or one for each of the 6 hosts");
  }
  EXPECT_EQ(error_of("\"hosts\": {\"master_is_exact\": true,\n"
                     "\"clock\": {\"skew_of_host_ppm\": [1, 1, 2, 3, 4, 5]}}"),
            "my.json:4: /hosts/clock/skew_of_host_ppm/0: found 1, allowed 0: the master is exact "
            "(/hosts/master_is_exact)");
  EXPECT_EQ(error_of(R"("hosts": {"clock": {"initial_offset_of_host_ms": [2, 1, 2, 3, 4, 5]}})"),
            "my.json:3: /hosts/clock/initial_offset_of_host_ms/0: found 2, allowed 0: the "
            "master's clock is the reference, it reads 0 at true zero");
  EXPECT_EQ(error_of(R"("hosts": {"clock": {"skew_of_host_ppm": [1, 1, 2, 3, 4, 5]}})"), "");
  EXPECT_EQ(error_of(R"("hosts": {"clock": {"skew_of_host_ppm": [], "initial_offset_of_host_ms":
                     []}})"),
            "");
}

// The message about these links.
std::string error_of_links(const std::string& links, const std::string& others = "") {
  return error_of("\"network\": {" + others + "\"links\": [\n" + links + "]}");
}

TEST(Checks, StacksAndSwitches) {
  const auto error_on_lan = [](const std::string& members) {
    return error_of_text(
        "{\"base\": \"18cam_6host_45fps_lan\",\n \"name\": \"my\", \"summary\": "
        "\"s\",\n " +
        members + "}\n");
  };
  const auto error_of_receive = [&](const std::string& law) {
    return error_on_lan(R"("hosts": {"stack": {"receive": {)" + law + "}}}");
  };
  EXPECT_EQ(error_of_receive(R"("quantiles_us": [1, -2])"),
            "my.json:3: /hosts/stack/receive/quantiles_us/1: found -2, allowed a number from 0 to "
            "1000000");
  EXPECT_EQ(error_of_receive(R"("quantiles_us": [3, 2])"),
            "my.json:3: /hosts/stack/receive/quantiles_us/1: found 2, allowed at least 3, the "
            "number before it: a table of quantiles ascends");
  EXPECT_EQ(error_of_receive(R"("common_share": 0.5, "common_time_ms": 0)"),
            "my.json:3: /hosts/stack/receive/common_time_ms: found 0 or nothing, allowed more than "
            "0 where common_share is above 0");
  EXPECT_EQ(error_on_lan(R"("network": {"switch_of_host": [0, 1]})"),
            "my.json:3: /network/switch_of_host: found 2 switches, allowed none or one for each of "
            "the 6 hosts");
  EXPECT_EQ(error_on_lan(R"("network": {"bandwidth_mbit_per_s": 0, "cross_traffic_share": 0.5})"),
            "my.json:3: /network/cross_traffic_share: found 0.5, allowed 0 where "
            "/network/bandwidth_mbit_per_s is 0 (infinite)");
}

TEST(Checks, TemperaturesAndDriftFiles) {
  const std::string temperature =
      R"("day_amplitude_k": 3, "day_period_h": 24, "load_amplitude_k": 5, "load_period_s": 1200,
         "load_time_constant_s": 180, "fan_amplitude_k": 0.5)";
  const auto stated = [&](const std::string& more) {
    return R"("hosts": {"temperature": {)" + temperature + more + "}}";
  };
  EXPECT_EQ(error_of(stated(R"(, "fan_period_s": 90)")), "");
  EXPECT_EQ(error_of(stated("")),
            "my.json:3: /hosts/temperature/fan_period_s: found nothing, allowed a number from "
            "0.001 to 100000000");
  EXPECT_EQ(error_of(stated(R"(, "fan_period_s": 0)")),
            "my.json:4: /hosts/temperature/fan_period_s: found 0, allowed a number from 0.001 to "
            "100000000");
  EXPECT_EQ(error_of(R"("hosts": {"temperature": 3})"),
            "my.json:3: /hosts/temperature: found 3, allowed an object or null");
  EXPECT_EQ(error_of(R"("hosts": {"drift_file": {"age_h": -1, "error_ppb": 1}})"),
            "my.json:3: /hosts/drift_file/age_h: found -1, allowed a number from 0 to 100000");
  EXPECT_EQ(error_of(R"("hosts": {"drift_file": {"age_h": 1}})"),
            "my.json:3: /hosts/drift_file/error_ppb: found nothing, allowed a number from 0 to "
            "500000");
}

TEST(Checks, LeapSeconds) {
  const auto fault = [](const std::string& members) {
    return R"("faults": [{"kind": "leap_second", )" + members + "}]";
  };
  EXPECT_EQ(error_of(fault(R"("at_ms": 1, "smear_ms": 0, "inserted": true)")), "");
  EXPECT_EQ(error_of(fault(R"("at_ms": 1, "smear_ms": 10000, "inserted": false)")), "");
  EXPECT_EQ(error_of(fault(R"("at_ms": 1, "smear_ms": 9999, "inserted": false)")),
            "my.json:3: /faults/0/smear_ms: found 9999, allowed 0 (a step) or at least 10000");
  EXPECT_EQ(error_of(fault(R"("at_ms": 1, "smear_ms": 0)")),
            "my.json:3: /faults/0/inserted: found nothing, \"leap_second\" needs at_ms, smear_ms, "
            "inserted");
  EXPECT_EQ(error_of(fault(R"("at_ms": 1, "smear_ms": 0, "inserted": true, "host": 2)")),
            "my.json:3: /faults/0/host: found 2, \"leap_second\" uses at_ms, smear_ms, inserted "
            "alone");
}

TEST(Checks, LinksOfSlavesWithTheMaster) {
  EXPECT_EQ(error_of_links(R"({"host": 1}, {"host": 5, "asymmetry_ms": -0.2})"), "");
  for (const std::string host : {"0", "6", "999999"}) {
    EXPECT_EQ(error_of_links("{\"host\": " + host + "}"),
              "my.json:4: /network/links/0/host: found " + host +
                  ", allowed a slave, whose link with the master (host 0) this is: from 1 on and "
                  "below /hosts/count, 6");
  }
  EXPECT_EQ(error_of_links("{\"host\": 2},\n{\"host\": 2}"),
            "my.json:5: /network/links/1/host: found a second link of host 2, allowed one of each "
            "slave with the master");
  EXPECT_EQ(error_of_links(R"({"asymmetry_ms": 0.1})"),
            "my.json:4: /network/links/0/host: found nothing, allowed a whole number from 0 to "
            "999999");
  EXPECT_EQ(error_of_links(R"({"host": 2, "latency_ms": 1})"),
            "my.json:4: /network/links/0/latency_ms: found an unknown key, allowed asymmetry_ms, "
            "host, latency_exponential_ms, latency_fixed_ms");
}

TEST(Checks, LinksAgreeWithTheirNetwork) {
  EXPECT_EQ(error_of_links(R"({"host": 2, "asymmetry_ms": 0.3})"),
            "my.json:4: /network/links/0/asymmetry_ms: found 0.3, allowed from -0.2 to 0.2, twice "
            "the least latency of the link");
  EXPECT_EQ(error_of_links(R"({"host": 2, "asymmetry_ms": 0.3, "latency_fixed_ms": 0.15})"), "");
  const std::string table = "\"latency_quantiles_ms\": [0.2, 0.3], ";
  EXPECT_EQ(error_of_links(R"({"host": 2, "asymmetry_ms": 0.4})", table), "");
  EXPECT_EQ(error_of_links(R"({"host": 2, "latency_fixed_ms": 1})", table),
            "my.json:4: /network/links/0/latency_fixed_ms: found 1, allowed nothing where "
            "/network/latency_quantiles_ms has the latency of every link");
  EXPECT_EQ(error_of_links(R"({"host": 2, "latency_exponential_ms": 1})", table),
            "my.json:4: /network/links/0/latency_exponential_ms: found 1, allowed nothing where "
            "/network/latency_quantiles_ms has the latency of every link");
}

std::string stream(const std::string& kind, int width, int height, int rate_hz) {
  return fmt::format(
      R"({{"kind": "{}", "width": {}, "height": {}, "bytes_per_pixel": 2, "mode_rate_hz": {},
           "pipeline_latency_ms": 8, "latency_mode_periods": 0, "shutter": "global", "readout_ms": 0}})",
      kind, width, height, rate_hz);
}

// The last line of a scenario's members.
std::string streams(const std::vector<std::string>& streams,
                    const std::string& sync_mode = "genlock") {
  return fmt::format(R"("cameras": {{"sync_mode": "{}", "streams": [{}]}})", sync_mode,
                     fmt::join(streams, ", "));
}

TEST(Checks, Profiles) {
  EXPECT_EQ(error_of(streams({stream("depth", 848, 480, 45)})),
            "my.json:3: /cameras/streams/0/mode_rate_hz: found 45, allowed 15, 30, 60, 90 "
            "(profiles of the RealSense D455 for depth 848x480)");
  EXPECT_EQ(error_of(streams({stream("colour", 640, 480, 30)})),
            place_in_base("/evaluation/stream") +
                ": found \"depth\", allowed \"colour\", the "
                "captured streams");
  EXPECT_EQ(
      error_of(streams({stream("depth", 800, 600, 30)})),
      "my.json:3: /cameras/streams/0/width: found depth 800x600, allowed 1280x720, 848x480, "
      "848x100, 640x480, 640x360, 480x270, 424x240, 256x144 (profiles of the RealSense D455)");
  EXPECT_EQ(error_of(streams({stream("depth", 848, 480, 90), stream("depth", 640, 480, 90)})),
            "my.json:4: /cameras/streams/1/kind: found a second \"depth\", allowed one stream of a "
            "kind");
}

TEST(Checks, CameraModels) {
  EXPECT_EQ(error_of_set("/cameras/model", "d999"),
            "--set /cameras/model=d999: found \"d999\", allowed astra_plus, astra_s, azure_kinect, "
            "basler_aca1440_220uc, basler_aca1440_73gm, basler_aca1920_155um, basler_aca2040_55uc, "
            "d435, d455, esp32_camera, flir_bfs_pge_31s4, flir_bfs_u3_16s2, flir_bfs_u3_31s4, "
            "gige_ace, l515, oak_4, pixel_phone, raspberry_camera_v3, raspberry_hq (simbench list "
            "cameras)");
  EXPECT_EQ(
      error_of_set("/cameras/model", "azure_kinect"),
      place_in_base("/cameras/sync_mode") +
          ": found \"genlock\", allowed \"default\", \"master\", \"slave\" (sync modes of the "
          "Azure Kinect DK)");
  EXPECT_EQ(error_of("\"cameras\": {\"model\": \"d435\",\n \"sync_mode\": \"full_slave\"}"),
            "my.json:4: /cameras/sync_mode: found \"full_slave\", allowed \"default\", \"master\", "
            "\"slave\", \"genlock\" (sync modes of the RealSense D435)");
  EXPECT_EQ(error_of_set("/cameras/model", "d435"), "");
}

TEST(Checks, ListsOfCamerasHaveAValueForEach) {
  EXPECT_EQ(
      error_of_set("/trigger/delay_of_camera_us", "[1, 2]"),
      "--set /trigger/delay_of_camera_us=[1, 2]: found 2 delays, allowed none or one for each "
      "of the 18 cameras");
  EXPECT_THAT(error_of_set("/cameras/stamp_epoch_of_camera_s", "[37]"),
              HasSubstr("found 1 epochs, allowed none or one for each of the 18 cameras"));
  EXPECT_THAT(
      error_of_set("/cameras/stamp_epoch_of_camera_s", "[37,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0]"),
      HasSubstr("allowed none where /cameras/stamp_clock is \"camera\""));
}

TEST(Checks, RatesOfTheSyncModes) {
  EXPECT_EQ(error_of_set("/trigger/rate_hz", "90"), "") << "half the rate, with a warning";
  EXPECT_EQ(error_of_set("/cameras/sync_mode", "slave"),
            place_in_base("/trigger/rate_hz") +
                ": found 45 Hz, allowed 89.1 to 90.9 Hz in sync mode \"slave\" with a 90 Hz mode");
  EXPECT_EQ(
      error_of(R"("trigger": {"rate_hz": 120}, "cameras": {"sync_mode": "slave"})"),
      "my.json:3: /trigger/rate_hz: found 120 Hz, allowed 89.1 to 90.9 Hz in sync mode "
      "\"slave\" with a 90 Hz mode: what a slave does with faster pulses is not documented; no "
      "mode of 848x480 is as fast, and genlock answers a part of any pulses");
  EXPECT_THAT(error_of("\"trigger\": {\"rate_hz\": 60},\n" +
                       streams({stream("depth", 848, 480, 30)}, "slave")),
              HasSubstr("; a mode of 60 Hz would follow, and genlock"));
  EXPECT_EQ(error_of_set("/cameras/sync_mode", "default"),
            place_in_base("/trigger/rate_hz") +
                ": found 45 Hz, allowed 89.1 to 90.9 Hz in sync mode \"default\" with a 90 Hz "
                "mode");
  EXPECT_EQ(error_of(R"("trigger": {"rate_hz": 90.9}, "cameras": {"sync_mode": "slave"})"), "");
  EXPECT_EQ(error_of("\"trigger\": {\"rate_hz\": 100},\n" +
                     streams({stream("depth", 848, 100, 100)}, "full_slave")),
            "my.json:4: /cameras/streams/0/mode_rate_hz: found 100, allowed 6, 15, 30, 60, 90 in "
            "sync mode \"full_slave\"");
  // Free-running cameras take any profile, and only the scored stream must keep the rate.
  EXPECT_EQ(error_of("\"trigger\": {\"rate_hz\": 100},\n" +
                     streams({stream("depth", 848, 100, 100), stream("colour", 848, 480, 30)},
                             "default")),
            "");
}

TEST(Checks, Shutters) {
  EXPECT_EQ(error_of_set("/cameras/streams/0/readout_ms", "5"),
            "--set /cameras/streams/0/readout_ms=5: found 5, allowed 0: a global shutter exposes "
            "all rows at once");
}

TEST(Checks, AutoExposure) {
  EXPECT_EQ(error_of_set("/cameras/auto_exposure/min_ms", "9"),
            "--set /cameras/auto_exposure/min_ms=9: found 9, allowed at most "
            "/cameras/auto_exposure/max_ms, 8");
  EXPECT_EQ(error_of_set("/cameras/auto_exposure/step_interval_exponential_ms", "0.5"),
            "--set /cameras/auto_exposure/step_interval_exponential_ms=0.5: found 0.5, allowed 0 "
            "(no auto-exposure) or at least 1");
}

TEST(Checks, Faults) {
  EXPECT_EQ(error_of("\"faults\": [{\"kind\": \"clock_step\", \"host\": 1,\n \"at_ms\": 1}]"),
            "my.json:3: /faults/0/step_ms: found nothing, \"clock_step\" needs host, at_ms, "
            "step_ms");
  EXPECT_EQ(error_of(R"("faults": [{"kind": "late_first_frame", "camera": 1, "duration_ms": 5,
                        "at_ms": 7}])"),
            "my.json:4: /faults/0/at_ms: found 7, \"late_first_frame\" uses camera, duration_ms "
            "alone");
  EXPECT_EQ(error_of(R"("faults": [{"kind": "late_first_frame", "camera": 18, "duration_ms": 5}])"),
            "my.json:3: /faults/0/camera: found 18, allowed 0 to 17 (/cameras/count is 18)");
  EXPECT_EQ(error_of(R"("faults": [{"kind": "clock_step", "host": 6, "at_ms": 5, "step_ms": -1}])"),
            "my.json:3: /faults/0/host: found 6, allowed 0 to 5 (/hosts/count is 6)");
}

TEST(Checks, FailAtNamesThePlace) {
  const Scenario scenario = load_derived(R"("usb": {"sharing": "fair"})", {{"/hosts/count", "7"}});
  const auto message = [&scenario](const std::string& pointer) -> std::string {
    try {
      fail_at(scenario, pointer, "found X, allowed Y");
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(message("/usb/sharing"), "my.json:3: /usb/sharing: found X, allowed Y");
  EXPECT_EQ(message("/usb/unheard_of"), "my.json:3: /usb/unheard_of: found X, allowed Y");
  EXPECT_EQ(message("/hosts/count"), "--set /hosts/count=7: found X, allowed Y");
}

}  // namespace
}  // namespace simbench::scenarios
