#include "reports/results/json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "recording/version.h"
#include "reports/text/json_node.h"
#include "tests/reports/sample_results.h"

namespace simbench::reports {
namespace {

TEST(ResultsJson, SaysWhatItIs) {
  const Json root = Json::parse(json(sample_results()));
  EXPECT_EQ(root["schema_version"], 1);
  EXPECT_EQ(root["version"], version());
  EXPECT_EQ(root["commit"], commit());
  EXPECT_EQ(root["scenario"], "sample");
  EXPECT_EQ(root["seeds"], Json::parse(R"({"first": 1, "count": 2})"));
  EXPECT_EQ(root["warnings"], Json::parse(R"(["a host was not synchronised"])"));
}

TEST(ResultsJson, ARowHasEverything) {
  const Json row = Json::parse(json(sample_results()))["rows"][0];
  EXPECT_EQ(row, Json::parse(R"json({
    "pipeline": "yoon2021_both", "host_sync": "yoon2021_both",
    "device_time": "regression_30", "gathering": "yoon2021", "offline": false,
    "amd_ms": {"median": 2.0, "p05": 1.5, "p95": 2.5, "values": [1.5, 2.5]},
    "rmdv_ms": {"median": 0.75, "p05": 0.5, "p95": 1.0, "values": [0.5, 1.0]},
    "absolute_error_ms": {"median": 29.0, "p05": 28.0, "p95": 30.0, "values": [28.0, 30.0]},
    "bias_ms": {"median": -29.0, "p05": -28.0, "p95": -30.0, "values": [-28.0, -30.0]},
    "host_error_ms": {"median": 0.5, "p05": 0.25, "p95": 0.75, "values": [0.25, 0.75]},
    "max_te_ms": {"median": 1.5, "p05": 1.0, "p95": 2.0, "values": [1.0, 2.0]},
    "rms_te_ms": {"median": 0.625, "p05": 0.5, "p95": 0.75, "values": [0.5, 0.75]},
    "constant_te_ms": {"median": 0.375, "p05": 0.25, "p95": 0.5, "values": [0.25, 0.5]},
    "dynamic_te_ms": {"median": 2.0, "p05": 1.5, "p95": 2.5, "values": [1.5, 2.5]},
    "packets_per_s": {"median": 30.0, "p05": 20.0, "p95": 40.0, "values": [20.0, 40.0]},
    "exposure_spread_ms": {"median": 0.0625, "p05": 0.0, "p95": 0.125, "values": [0.0, 0.125]},
    "gathering_score": {
      "precision": 1.0, "recall": 0.75, "margin_ms": 8.5,
      "seed_precision": {"median": 1.0, "p05": 1.0, "p95": 1.0, "values": [1.0, 1.0]},
      "seed_recall": {"median": 0.75, "p05": 0.5, "p95": 1.0, "values": [0.5, 1.0]},
      "sets": 720, "pure_sets": 720, "complete_pulses": 960, "due_pulses": 0, "exposed_pulses": 0, "partial_sets": 4, "index_errors": 0, "discarded_frames": 21,
      "set_amd_ms": {"median": 1.75, "p05": 1.25, "p95": 2.25, "values": [1.25, 2.25]},
      "set_absolute_error_ms": {"median": 28.0, "p05": 27.0, "p95": 29.0, "values": [27.0, 29.0]},
      "emission_latency_ms": {"median": 0.25, "p05": 0.0, "p95": 0.5, "values": [0.0, 0.5]},
      "emission_latency_max_ms": 6.0},
    "frames": {"expected": 34560, "delivered": 34557, "dropped": 3},
    "evaluated_pulses": 960, "unsynchronised_hosts": 1,
    "exposure_spread_median_ms": {"median": null, "p05": null, "p95": null, "values": [null, null]},
    "exposure_spread_p95_ms": {"median": null, "p05": null, "p95": null, "values": [null, null]},
    "aligned_1_ms_s": {"median": null, "p05": null, "p95": null, "values": [null, null]},
    "aligned_0_1_ms_s": {"median": null, "p05": null, "p95": null, "values": [null, null]},
    "aligned_0_01_ms_s": {"median": null, "p05": null, "p95": null, "values": [null, null]},
    "disturbed_frames": {"median": null, "p05": null, "p95": null, "values": [null, null]},
    "exposure_drift_ppm": {"median": null, "p05": null, "p95": null, "values": [null, null]},
    "wrong_locks": {"median": null, "p05": null, "p95": null, "values": [null, null]},
    "rmdv_printed_sqrt_ms": {"median": 0.5, "p05": 0.25, "p95": 0.75, "values": [0.25, 0.75]},
    "rmdv_printed_share": {"median": 0.25, "p05": 0.0, "p95": 0.5, "values": [0.0, 0.5]},
    "colour_offset_ms": {"median": null, "p05": null, "p95": null, "values": [null, null]},
    "colour_offset_spread_ms": {"median": null, "p05": null, "p95": null, "values": [null, null]},
    "t_l_ms": {"median": null, "p05": null, "p95": null, "values": [null, null]},
    "t_t_ms": {"median": null, "p05": null, "p95": null, "values": [null, null]},
    "t_d_ms": {"median": null, "p05": null, "p95": null, "values": [null, null]},
    "session_passes": {"median": null, "p05": null, "p95": null, "values": [null, null]},
    "get_time_ms": {"median": null, "p05": null, "p95": null, "values": [null, null]},
    "set_time_ms": {"median": null, "p05": null, "p95": null, "values": [null, null]},
    "message_time_ms": {"median": null, "p05": null, "p95": null, "values": [null, null]},
    "certified_ms": {"median": null, "p05": null, "p95": null, "values": [null, null]},
    "scored_seeds": 2, "ground_truth": "simulation", "verified": true, "notes": [],
    "standing": "failed", "failed": "hosts were not synchronised (1 over all seeds)",
    "published": {
    "amd_ms" : 2.438, "rmdv_ms" : 1.8044, "amd_inside" : true,
                                                         "rmdv_inside" : false,
                                                                         "rmdv_attainable"
        : false,
          "amd_percentile" : 50.0,
          "amd_percentile_interval" : [ 32.25, 67.75 ],
                                      "rmdv_percentile" : 100.0,
                                      "rmdv_percentile_interval" : [ 95.25, 100.0 ]}
})json"));
}

TEST(ResultsJson, SteeredExposuresSayWhatSteersThem) {
  evaluation::Results results = sample_results();
  set_steered(results.rows[0]);
  const Json rows = Json::parse(json(results))["rows"];
  EXPECT_EQ(rows[0]["capture_alignment"], "nudge");
  EXPECT_EQ(rows[0]["disturbed_frames"],
            Json::parse(R"({"median": 12.5, "p05": 10.0, "p95": 15.0, "values": [10.0, 15.0]})"));
  EXPECT_FALSE(rows[1].contains("capture_alignment"));
}

TEST(ResultsJson, SessionsHaveTheirDelays) {
  evaluation::Results results = sample_results();
  set_sessions(results.rows[0]);
  const Json row = Json::parse(json(results))["rows"][0];
  EXPECT_EQ(row["t_l_ms"],
            Json::parse(R"({"median": 3.5, "p05": 3.0, "p95": 4.0, "values": [3.0, 4.0]})"));
  EXPECT_EQ(row["session_passes"]["median"], 1.5);
  EXPECT_EQ(row["message_time_ms"]["values"], Json::parse("[3.5, 4.5]"));
}

TEST(ResultsJson, WhatDoesNotExistIsNull) {
  const Json row = Json::parse(json(sample_results()))["rows"][1];
  EXPECT_TRUE(row["published"].is_null());
  EXPECT_EQ(row["host_error_ms"],
            Json::parse(R"({"median": null, "p05": null, "p95": null, "values": [null, null]})"));
  const Json nothing =
      Json::parse(R"({"median": null, "p05": null, "p95": null, "values": [null, null]})");
  const Json& gathering = row["gathering_score"];
  EXPECT_TRUE(gathering["precision"].is_null());
  EXPECT_EQ(gathering["recall"], 0.0);
  EXPECT_TRUE(gathering["margin_ms"].is_null());
  EXPECT_EQ(gathering["set_amd_ms"], nothing);
  EXPECT_EQ(gathering["emission_latency_ms"], nothing);
  EXPECT_TRUE(gathering["emission_latency_max_ms"].is_null());
}

TEST(ResultsJson, ClaimsThatNeedAnotherScenarioHoldInNone) {
  const Json claims = Json::parse(json(sample_results()))["claims"];
  EXPECT_EQ(claims, Json::parse(R"([
    {"id": "C1", "holds_fraction": 0.5, "text": "none is worst", "needs": null,
     "decided_seeds": 2},
    {"id": "C4", "holds_fraction": null, "text": "lower at 45 than at 15 FPS",
     "needs": "18cam_6host_15fps", "decided_seeds": 0}])"));
}

TEST(ResultsJson, OnlyPerformanceDiffersBetweenEqualRuns) {
  evaluation::Results slower = sample_results();
  slower.performance.wall_seconds = 9;
  slower.performance.events_per_second = 137174.1;
  auto a = nlohmann::ordered_json::parse(json(sample_results()));
  auto b = nlohmann::ordered_json::parse(json(slower));
  EXPECT_NE(a["performance"], b["performance"]);
  EXPECT_EQ(a["performance"]["events"], 1234567);
  EXPECT_EQ(a["performance"]["simulated_seconds_per_second"], 256.0);
  a.erase("performance");
  b.erase("performance");
  EXPECT_EQ(a.dump(), b.dump());
}

TEST(ResultsJson, DoublesReadBackAsTheSame) {
  evaluation::Results results = sample_results();
  const double value = 0.1 + 0.2;
  results.rows[0].amd_ms.median = value;
  const std::string text = json(results);
  EXPECT_EQ(Json::parse(text)["rows"][0]["amd_ms"]["median"].get<double>(), value);
  EXPECT_NE(text.find("0.30000000000000004"), std::string::npos);
}

}  // namespace
}  // namespace simbench::reports
