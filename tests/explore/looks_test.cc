#include "explore/looks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "app/answer.h"
#include "app/interrupt.h"
#include "app/results_text.h"
#include "evaluation/run/evaluate.h"
#include "explore/look.h"
#include "tests/explore/kept_stream.h"

namespace simbench::explore {
namespace {

using nlohmann::json;
using reports::Json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

const PageSubject kSubject{.name = "3cam_1host_30fps"};

// The first picture is of all its seeds, however slow the machine is.
LookRequest request(const std::string& text) {
  LookRequest request = request_of(Json::parse(text), kSubject);
  request.patience_s = 1e9;
  return request;
}

std::shared_ptr<KeptStream> looked_at(const std::string& text) {
  auto stream = std::make_shared<KeptStream>();
  Look look(request(text), kSubject, stream);
  while (look.step()) {
  }
  return stream;
}

// "picture 8" and the like, in their order.
std::vector<std::string> outline(const std::vector<json>& events) {
  std::vector<std::string> lines;
  for (const json& event : events) {
    std::string line = event.at("event");
    if (event.contains("of")) line += ' ' + event.at("of").get<std::string>();
    if (event.contains("seeds")) line += ' ' + std::to_string(event.at("seeds").get<int>());
    lines.push_back(line);
  }
  return lines;
}

TEST(LookTest, FirstTheAnswerOfFewSeedsThenTheFiguresThenMoreSeeds) {
  const auto stream = looked_at(
      R"({"states": [{"scenario": "3cam_1host_30fps", "sets": [{"pointer": "/timeline/frames",
          "value": 60}]}], "seeds": 20, "figures": ["host_clocks", "pulse"], "budget": true})");
  EXPECT_TRUE(stream->has_ended());
  const std::vector<json> events = stream->events();
  EXPECT_THAT(outline(events),
              ElementsAre("worlds", "picture 8", "figures seeds", "tables", "figures run",
                          "figures budget", "picture 16", "figures seeds", "tables", "picture 20",
                          "figures seeds", "tables", "end 20"));
  EXPECT_THAT(events[0]["worlds"][0]["world"].get<std::string>(), HasSubstr("Cameras: 3"));
  EXPECT_FALSE(events[1]["views"][0]["answer"]["lead"].get<std::string>().empty());
  EXPECT_THAT(events[1]["views"][0]["overview"].get<std::string>(),
              HasSubstr("class=\"overview\""));
  EXPECT_TRUE(events[1]["comparison"].is_null());
  EXPECT_THAT(events[4]["data"]["figures"], SizeIs(2));
}

TEST(LookTest, AWorldThatTakesLongIsShownFromItsFirstSeedOn) {
  LookRequest impatient = request(R"({"states": [{"scenario": "3cam_1host_30fps"}], "seeds": 4})");
  impatient.patience_s = 0;
  const auto stream = std::make_shared<KeptStream>();
  Look look(impatient, kSubject, stream);
  while (look.step()) {
  }
  EXPECT_THAT(
      outline(stream->events()),
      ElementsAre("worlds", "picture 1", "figures seeds", "tables", "picture 2", "figures seeds",
                  "tables", "picture 4", "figures seeds", "tables", "end 4"));
}

TEST(LookTest, TwoStatesAreComparedSeedBySeed) {
  const auto stream = looked_at(
      R"({"states": [{"scenario": "3cam_1host_30fps"}, {"scenario": "3cam_1host_30fps", "sets":
          [{"pointer": "/usb/delivery_jitter_transfers", "value": 5}]}], "seeds": 8})");
  const std::vector<json> events = stream->events();
  ASSERT_THAT(outline(events), testing::Contains("picture 8"));
  const json& picture = events[1];
  EXPECT_THAT(picture["views"], SizeIs(2));
  EXPECT_THAT(picture["comparison"]["tables"].get<std::string>(), HasSubstr("<table"));
}

TEST(LookTest, AWorldThatCannotBeIsRefusedWithItsPlace) {
  const auto stream = looked_at(
      R"({"states": [{"scenario": "3cam_1host_30fps"}, {"scenario": "3cam_1host_30fps", "sets":
          [{"pointer": "/usb/spike_probability", "value": 7}]}]})");
  const std::vector<json> events = stream->events();
  ASSERT_THAT(outline(events), ElementsAre("refused"));
  EXPECT_EQ(events[0]["state"], 1);
  EXPECT_EQ(events[0]["pointer"], "/usb/spike_probability");
  EXPECT_TRUE(stream->has_ended());
}

// What a page saves is what the command prints, to the byte, but for the times that it took.
TEST(LookTest, ResultsAreThoseOfTheCommand) {
  const auto without_times = [](const std::string& text) {
    Json results = Json::parse(text);
    results.erase("performance");
    return results.dump();
  };
  const scenarios::Scenario world =
      scenarios::load_scenario("3cam_1host_30fps", {{"/usb/delivery_jitter_transfers", "0.5"}});
  const evaluation::Results results = evaluation::evaluate(
      world, [&] { return app::simulated_world(world); }, {.seeds = 12}, nullptr);
  const reports::ResultsAnswer answer = app::run_answer(results, world, {.levers = false}, nullptr);
  const std::string state =
      R"("states": [{"scenario": "3cam_1host_30fps", "sets": [{"pointer":
         "/usb/delivery_jitter_transfers", "value": 0.5}]}], "seeds": 12)";
  const auto of_page = [&](const std::string& format) {
    return looked_at("{" + state + R"(, "format": ")" + format + "\"}")->text();
  };
  const auto of_command = [&](const std::string& format) {
    return app::results_text(results, world, format, app::Detail::kAll, answer);
  };
  EXPECT_EQ(without_times(of_page("json")), without_times(of_command("json")));
  EXPECT_EQ(of_page("csv"), of_command("csv"));
  EXPECT_EQ(of_page("tidy"), of_command("tidy"));
}

TEST(LookTest, LeversAreThoseOfTheAnswer) {
  const auto stream =
      looked_at(R"({"states": [{"scenario": "3cam_1host_30fps"}], "seeds": 4, "levers": true})");
  const std::vector<json> events = stream->events();
  EXPECT_THAT(outline(events), ElementsAre("worlds", "picture 4", "levers", "end 4"));
  EXPECT_FALSE(events[2]["answer"].is_null());
}

TEST(LookTest, OtherFormsAreRefused) {
  for (const char* const text :
       {"[]", "{}", R"({"states": []})", R"({"states": {}})",
        R"({"states": [{"scenario": "3cam_1host_30fps"}, {"scenario": "3cam_1host_30fps"},
            {"scenario": "3cam_1host_30fps"}]})",
        R"({"states": [{"scenario": "3cam_1host_30fps"}], "format": "latex"})"}) {
    EXPECT_THROW(request(text), StateRefused) << text;
  }
}

template <class Condition>
void wait_until(const Condition& condition) {
  while (!condition()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST(LooksTest, ManyPagesTakeTurns) {
  Looks looks(kSubject);
  std::vector<std::shared_ptr<KeptStream>> streams;
  for (int i = 0; i < 3; ++i) {
    streams.push_back(std::make_shared<KeptStream>());
    looks.add(request(R"({"states": [{"scenario": "3cam_1host_30fps"}], "seeds": 16})"),
              streams.back());
  }
  for (const auto& stream : streams) {
    wait_until([&] { return stream->has_ended(); });
    EXPECT_THAT(outline(stream->events()), testing::Contains("end 16"));
  }
}

// A long computation of a page that has gone ends at once, and another's goes on.
TEST(LooksTest, NothingIsComputedForAPageThatHasGone) {
  Looks looks(kSubject);
  const auto gone = std::make_shared<KeptStream>();
  looks.add(request(R"({"states": [{"scenario": "leaderboard_lan"}], "seeds": 1024})"), gone);
  wait_until([&] { return !gone->events().empty(); });  // it computes its first picture
  gone->close();
  const auto next = std::make_shared<KeptStream>();
  looks.add(request(R"({"states": [{"scenario": "3cam_1host_30fps"}], "seeds": 8})"), next);
  wait_until([&] { return next->has_ended(); });
  const std::uint64_t steps = looks.steps();
  EXPECT_LE(steps, 2u + 6u);  // the world and the picture of the one, all of the other
}

TEST(LooksTest, TooManyPagesAreToldSo) {
  Looks looks(kSubject);
  std::vector<std::shared_ptr<KeptStream>> streams;
  for (std::size_t i = 0; i < kMostLooks + 3; ++i) {
    streams.push_back(std::make_shared<KeptStream>());
    looks.add(request(R"({"states": [{"scenario": "leaderboard_lan"}], "seeds": 1024})"),
              streams.back());
  }
  EXPECT_THAT(streams.back()->text(), HasSubstr("too many pages"));
  for (const auto& stream : streams) stream->close();
}

}  // namespace
}  // namespace simbench::explore
