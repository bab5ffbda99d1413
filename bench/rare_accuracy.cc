// Importance splitting beside brute force in a simulated world of two hosts and four cameras
// (leaderboard_lan, host.ptp_e2e_software, 60 pulses a run): the probability that the spread of a
// set is above a bound.
//
//   rare_accuracy count FIRST_SEED RUNS         plain runs, for bounds from 0.045 to 0.08 ms
//   rare_accuracy split BOUND_MS SEED REPEATS   evaluation/rare/splitting.h
//
// Work: runs times the squared relative error, thus runs for an error of 100 %.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <string>
#include <vector>

#include "app/interrupt.h"
#include "app/rare_sets.h"
#include "evaluation/run/pipeline_choice.h"
#include "evaluation/statistics/statistics.h"
#include "scenarios/loader.h"

namespace {

using namespace simbench;

constexpr const char* kPipeline = "host.ptp_e2e_software";

scenarios::Scenario small_world() {
  return scenarios::load_scenario("leaderboard_lan", {{"/hosts/count", "2"},
                                                      {"/cameras/count", "4"},
                                                      {"/cameras/cameras_per_host", "2"},
                                                      {"/timeline/frames", "60"}});
}

double cpu_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void print_line(double bound_ms, double probability, double error, double runs) {
  fmt::print("above {:.4g} ms: {:.3g}, standard error {:.2g}, work {:.0f} runs\n", bound_ms,
             probability, error, runs * std::pow(error / probability, 2));
}

void count(std::uint64_t first_seed, std::uint64_t runs) {
  constexpr std::array<double, 8> kBoundsMs = {0.045, 0.05, 0.055, 0.06, 0.065, 0.07, 0.075, 0.08};
  const scenarios::Scenario scenario = small_world();
  const auto choice = evaluation::choose_pipelines(scenario, {kPipeline}).front();
  const auto source = app::simulated_world(scenario);
  std::array<double, kBoundsMs.size()> sums{};
  std::array<double, kBoundsMs.size()> squares{};
  for (std::uint64_t i = 0; i < runs; ++i) {
    evaluation::PipelineScorer scorer(evaluation::scorer_setup(scenario, choice));
    const auto score = evaluation::score_run(*source, choice, first_seed + i, scorer, scorer);
    for (std::size_t k = 0; k < kBoundsMs.size(); ++k) {
      double beyond = 0;
      for (const auto& pulse : score.pulses) beyond += pulse.spread_ms > kBoundsMs[k] ? 1 : 0;
      const double share = beyond / static_cast<double>(score.pulses.size());
      sums[k] += share;
      squares[k] += share * share;
    }
  }
  const auto n = static_cast<double>(runs);
  for (std::size_t k = 0; k < kBoundsMs.size(); ++k) {
    print_line(kBoundsMs[k], sums[k] / n, std::sqrt(squares[k]) / n, n);
  }
  fmt::print("{:.2f} ms of CPU a run\n", cpu_ms() / n);
}

void split(double bound_ms, std::uint64_t seed, std::size_t repeats) {
  const scenarios::Scenario scenario = small_world();
  const auto run = app::rare_sets(scenario, kPipeline, app::RareEvent::kSpread, bound_ms);
  const auto estimate = evaluation::estimate_rare(
      run, {.bound = bound_ms, .seed = seed, .repeats = repeats}, nullptr);
  const double runs = static_cast<double>(estimate.runs);
  const double error =
      evaluation::standard_deviation(estimate.repeats) / std::sqrt(static_cast<double>(repeats));
  print_line(bound_ms, estimate.probability, error, runs);
  fmt::print("[{:.3g}, {:.3g}], {} levels, {} runs with the pilot, {:.2f} ms of CPU a run\n",
             estimate.low, estimate.high, estimate.levels.size(), estimate.runs, cpu_ms() / runs);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() == 3 && words[0] == "count") {
    count(std::stoull(words[1]), std::stoull(words[2]));
  } else if (words.size() == 4 && words[0] == "split") {
    split(std::stod(words[1]), std::stoull(words[2]), std::stoull(words[3]));
  } else {
    fmt::print(stderr,
               "usage: rare_accuracy count FIRST_SEED RUNS | split BOUND_MS SEED REPEATS\n");
    return 2;
  }
  return 0;
}
