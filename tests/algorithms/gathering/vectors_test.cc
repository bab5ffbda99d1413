// The policies against the vectors of ROS, ROS 2, the Azure Kinect and librealsense
// (tests/data/README.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "algorithms/gathering/gatherers.h"
#include "tests/algorithms/gathering/collected_sets.h"
#include "tests/data/test_data.h"

namespace simbench {
namespace {

using Json = nlohmann::json;
using Sets = std::vector<std::vector<double>>;

// The stamps in seconds of the sets of messages [stamp_s, topic].
Sets gathered(Gatherer& gatherer, const Json& input) {
  CollectedSets out;
  for (const Json& message : input) {
    gatherer.push(frame_at(message[1].get<std::uint32_t>(), message[0].get<double>() * 1000, 0),
                  out);
  }
  Sets sets;
  for (const std::vector<GatherFrame>& set : out.sets) {
    sets.emplace_back();
    for (const GatherFrame& frame : set) {
      sets.back().push_back(to_seconds(frame.stamp.time_since_epoch()));
    }
  }
  return sets;
}

TEST(GatheringVectors, RosApproximateTimeAllFourteen) {
  const Json vectors = test_data_json("vectors/ros_approximate_time.json");
  ASSERT_EQ(vectors.at("cases").size(), 14U);
  for (const Json& entry : vectors.at("cases")) {
    ApproximateTimeOptions options;
    options.age_penalty = entry.at("age_penalty");
    options.queue = entry.at("queue_size");
    const std::uint32_t topics = entry.at("topics");
    if (const Json& bound = entry.at("inter_message_lower_bound"); !bound.empty()) {
      options.lower_bounds.assign(topics, Nanoseconds::zero());
      for (std::uint32_t topic = 0; topic < topics; ++topic) {
        if (bound[0] == "all" || bound[0] == topic) {
          options.lower_bounds[topic] = from_ms(bound[1].get<double>() * 1000);
        }
      }
    }
    const auto gatherer = make_approximate_time_gatherer({.sources = topics}, options);
    EXPECT_EQ(gathered(*gatherer, entry.at("input_arrival_order")),
              entry.at("expected_sets_in_order").get<Sets>())
        << entry.at("name");
  }
}

// Another policy, so not all sets agree; docs/reference/gathering.md section 2 lists in which they
// do.
TEST(GatheringVectors, AlgorithmThreeAgreesWithRosInFiveOfFourteen) {
  const Json vectors = test_data_json("vectors/ros_approximate_time.json");
  const std::vector<std::string> agreeing = {"ExactMatch", "ImperfectMatch", "DoublePublish",
                                             "RateBound_2", "RateBoundAll_2"};
  for (const Json& entry : vectors.at("cases")) {
    const std::string name = entry.at("name");
    const auto gatherer = make_yoon2021_gatherer(
        {.sources = entry.at("topics"), .period = from_ms(3000), .interval = from_ms(1500)});
    const bool agrees = gathered(*gatherer, entry.at("input_arrival_order")) ==
                        entry.at("expected_sets_in_order").get<Sets>();
    EXPECT_EQ(agrees, std::ranges::count(agreeing, name) > 0) << name;
  }
}

TEST(GatheringVectors, Ros2EpsilonAllThree) {
  const Json vectors = test_data_json("vectors/ros2_approximate_epsilon_time.json");
  ASSERT_EQ(vectors.at("cases").size(), 3U);
  EXPECT_EQ(kRosQueue, vectors.at("queue_size"));
  for (const Json& entry : vectors.at("cases")) {
    const auto gatherer =
        make_epsilon_gatherer({.sources = 2,
                               .interval = from_ms(entry.at("epsilon").get<double>() * 1000),
                               .queue_limit = vectors.at("queue_size").get<std::uint32_t>()});
    EXPECT_EQ(gathered(*gatherer, entry.at("input")), entry.at("expected").get<Sets>())
        << entry.at("name");
  }
}

TEST(GatheringVectors, AzureKinectAllNine) {
  const Json vectors = test_data_json("vectors/k4a_capturesync.json");
  ASSERT_EQ(vectors.at("cases").size(), 9U);
  EXPECT_EQ(kK4aQueue, vectors.at("queue_default_size"));
  for (const Json& entry : vectors.at("cases")) {
    const auto gatherer = make_k4a_gatherer(
        {.sources = 2, .period = Microseconds(vectors.at("period_us").get<int>())},
        Microseconds(vectors.at("depth_delay_off_color_usec").get<int>()));
    CollectedSets out;
    for (const Json& sample : entry.at("input_us")) {
      const std::int64_t at_us = sample[0];
      gatherer->push({.source = sample[1] == "color" ? 0U : 1U,
                      .stamp = GlobalTime(Microseconds(at_us)),
                      .tag = at_us},
                     out);
    }
    EXPECT_EQ(
        out.tags(),
        entry.at("expected_pairs_color_depth_us").get<std::vector<std::vector<std::int64_t>>>())
        << entry.at("name");
  }
}

// Two of four scripts apply: diff_fps_100_10 needs a rate per stream, and desync_2 one per frame
// (ACTUAL_FPS metadata); GatheringSetup has one period for all.
TEST(GatheringVectors, LibrealsenseScriptsOfOneRate) {
  const Json vectors = test_data_json("vectors/librealsense_syncer.json");
  int applied = 0;
  for (const Json& entry : vectors.at("cases")) {
    const std::string name = entry.at("name");
    if (name != "same_fps_60" && name != "desync") continue;
    ++applied;
    const auto gatherer = make_librealsense_gatherer(
        {.sources = 2, .period = from_ms(1000 / entry.at("fps")[0].get<double>())});
    CollectedSets out;
    std::size_t taken = 0;
    for (const Json& step : entry.at("steps")) {
      const std::string kind = step[0];
      if (kind == "N") {
        EXPECT_EQ(out.all.size(), taken) << name;
      } else if (kind == "X") {
        ASSERT_LT(taken, out.all.size()) << name << " lacks " << step[1];
        std::string id;
        for (const GatherFrame& frame : out.all[taken++]) {
          id.append(frame.source == 0 ? "D" : "C").append(std::to_string(frame.tag));
        }
        EXPECT_EQ(id, step[1]) << name;
      } else {
        gatherer->push(frame_at(kind == "D" ? 0 : 1, step[2], step[1]), out);
      }
    }
  }
  EXPECT_EQ(applied, 2);
}

}  // namespace
}  // namespace simbench
