// A run, a sweep and a comparison of the same captures may be more or less sure, but never say the
// opposite of each other: 200 small worlds, each of random cameras, hosts, network, USB and three
// random pipelines.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <string>
#include <vector>

#include "evaluation/answer/answer.h"
#include "evaluation/run/evaluate.h"
#include "evaluation/sweep/ranking.h"
#include "evaluation/sweep/sweep_standing.h"
#include "reports/archive/archive.h"
#include "reports/comparison/comparison.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"

namespace simbench::app {
namespace {

using evaluation::Answer;
using evaluation::Results;
using evaluation::RowStanding;
using evaluation::Verdict;

constexpr int kWorlds = 200;
constexpr std::uint64_t kSeedsEach = 8;

class RandomWorld {
 public:
  explicit RandomWorld(unsigned seed) : random_(seed) {}

  std::vector<scenarios::Override> sets() {
    const int hosts = 1 + pick(3);
    const int cameras = hosts * (1 + pick(2));
    return {{"/hosts/count", fmt::format("{}", hosts)},
            {"/cameras/count", fmt::format("{}", cameras)},
            {"/cameras/cameras_per_host", fmt::format("{}", cameras / hosts)},
            {"/timeline/frames", fmt::format("{}", 20 + pick(30))},
            {"/timeline/warm_up_ms", "300"},
            {"/network/latency_exponential_ms", value(0, 2)},
            {"/network/asymmetry_sigma_ms", value(0, 0.5)},
            {"/hosts/send_cost_exponential_ms", value(0, 1)},
            {"/cameras/exposure_ms", value(1, 14)},
            {"/cameras/exposure_camera_periods", value(0, 0.2)},
            {"/usb/delivery_jitter_transfers", value(0, 1)},
            {"/pipelines", pipelines()}};
  }

 private:
  int pick(int count) { return boost::random::uniform_int_distribution<>(0, count - 1)(random_); }
  std::string value(double low, double high) {
    return fmt::format("{:.4f}", boost::random::uniform_real_distribution<>(low, high)(random_));
  }
  std::string pipelines() {
    constexpr std::array kHostSync = {"free_running",     "two_way_hull", "yoon2021_both",
                                      "yoon2021_network", "ntp_last_set", "oracle"};
    constexpr std::array kDeviceTime = {"regression_30", "hull_300", "raw_arrival", "minimum_1s",
                                        "regression_30_exposure_corrected"};
    constexpr std::array kGathering = {"yoon2021", "k4a", "epsilon"};
    std::string all;
    for (const char* name : {"a", "b", "c"}) {
      all += fmt::format(
          R"({}{{"name": "{}", "host_sync": "{}", "device_time": "{}", "gathering": "{}"}})",
          all.empty() ? "" : ", ", name, kHostSync.at(static_cast<std::size_t>(pick(6))),
          kDeviceTime.at(static_cast<std::size_t>(pick(5))),
          kGathering.at(static_cast<std::size_t>(pick(3))));
    }
    return "[" + all + "]";
  }

  boost::random::mt19937 random_;
};

Results run(const scenarios::Scenario& scenario, std::uint64_t first_seed, std::uint64_t seeds) {
  return evaluation::evaluate(
      scenario, [&] { return sim::make_simulation(scenario); },
      {.first_seed = first_seed, .seeds = seeds, .jobs = 1, .share_captures = true}, nullptr);
}

// The one point of a sweep: its pipelines in their order, those that it ranks.
struct SweptOrder {
  std::vector<std::string> names;
  std::vector<bool> is_apart;
};
SweptOrder swept(const std::vector<scenarios::Override>& sets,
                 const scenarios::Scenario& scenario) {
  const evaluation::SweepPlan plan = evaluation::make_plan(
      {.scenario = "18cam_6host_45fps_lan", .overrides = sets, .seeds = kSeedsEach});
  std::vector<evaluation::SweepScore> scores(plan.runs());
  for (std::uint64_t seed = 0; seed < kSeedsEach; ++seed) {
    const Results results = run(scenario, 1 + seed, 1);
    for (std::size_t row = 0; row < results.rows.size(); ++row) {
      scores[row * kSeedsEach + seed] = evaluation::sweep_score(results.rows[row]);
    }
  }
  std::vector<evaluation::ResponseRow> rows = evaluation::response(plan, scores);
  const evaluation::RankedBy by = evaluation::ranking_of(plan, rows);
  rows = evaluation::without_failed(std::move(rows), by);
  const evaluation::RankedPoint point =
      evaluation::rank(plan, rows, evaluation::ranked_metric(by)).points.front();
  SweptOrder order{.names = {}, .is_apart = point.is_apart};
  for (const std::size_t i : point.order) order.names.push_back(scenario.pipelines[i].name);
  return order;
}

std::size_t place_of(const SweptOrder& order, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(order.names, name) - order.names.begin());
}

void expect_sweep_agrees(const Answer& answer, const SweptOrder& order) {
  if (!answer.next) return;
  const std::size_t best = place_of(order, answer.best->pipeline);
  const std::size_t next = place_of(order, answer.next->row->pipeline);
  if (next >= best) return;
  for (std::size_t i = next; i < best; ++i) {
    EXPECT_FALSE(order.is_apart.at(i)) << order.names[i] << " apart before the run's best";
  }
}

// A comparison of the best with a row that is worse by the run's test.
void expect_comparison_agrees(const Answer& answer, const reports::Archive& archive) {
  if (!answer.next) return;
  const evaluation::Metric* const ranked = &evaluation::ranked_metric(answer.ranked_by);
  const reports::Comparison comparison =
      reports::compare_pipelines(archive, answer.best->pipeline, answer.next->row->pipeline, {});
  for (std::size_t i = 0; i < comparison.judged.size(); ++i) {
    if (comparison.judged[i] != ranked) continue;
    EXPECT_NE(comparison.pipelines.front().metrics[i].verdict, Verdict::kBetter)
        << "a comparison calls the next better than the best";
  }
}

TEST(Answers, OfRunSweepAndComparisonNeverContradictEachOther) {
  int with_a_next = 0;
  for (int world = 0; world < kWorlds; ++world) {
    SCOPED_TRACE(world);
    const std::vector<scenarios::Override> sets = RandomWorld(static_cast<unsigned>(world)).sets();
    const scenarios::Scenario scenario = scenarios::load_scenario("18cam_6host_45fps_lan", sets);
    const Results results = run(scenario, 1, kSeedsEach);
    const Answer answer = evaluation::answer_of(results);
    if (answer.best == nullptr) continue;
    with_a_next += answer.next ? 1 : 0;
    EXPECT_EQ(evaluation::standing_of(*answer.best, answer.ranked_by).is, RowStanding::kRanked);
    expect_sweep_agrees(answer, swept(sets, scenario));
    expect_comparison_agrees(
        answer, reports::kept_archive("kept", results, scenario, reports::Provenance{}));
  }
  EXPECT_GT(with_a_next, kWorlds / 4) << "in most of these worlds nothing differs: no test";
}

}  // namespace
}  // namespace simbench::app
