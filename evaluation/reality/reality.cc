#include "evaluation/reality/reality.h"

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "scenarios/loader.h"

namespace simbench::evaluation {
namespace {

using scenarios::Override;
using scenarios::RealitySetting;
using scenarios::RealRecording;

// The settings of one scenario share its runs.
struct World {
  std::string scenario;
  std::vector<Override> set;
  std::vector<std::size_t> settings;  // by number in the recording
};

std::vector<World> worlds_of(const RealRecording& recording) {
  std::vector<World> worlds;
  for (std::size_t i = 0; i < recording.settings.size(); ++i) {
    const RealitySetting& setting = recording.settings[i];
    const auto same = std::ranges::find_if(worlds, [&](const World& world) {
      return world.scenario == setting.scenario &&
             std::ranges::equal(world.set, setting.set, [](const Override& a, const Override& b) {
               return a.pointer == b.pointer && a.value == b.value;
             });
    });
    if (same != worlds.end()) {
      same->settings.push_back(i);
    } else {
      worlds.push_back({setting.scenario, setting.set, {i}});
    }
  }
  return worlds;
}

// Residences in the switch of the master's messages, by receiver.
using Residences = std::map<std::size_t, std::vector<double>>;
using ResidencesOfRuns = std::map<std::pair<std::string, std::uint64_t>, Residences>;

// Passes all on, and keeps the residences.
class ResidenceTap final : public ClockSink {
 public:
  explicit ResidenceTap(ClockSink& sink) : sink_(sink) {}

  void on_master(double error_s) override { sink_.on_master(error_s); }
  void on_errors(TrueTime at, std::span<const double> errors_s) override {
    sink_.on_errors(at, errors_s);
  }
  void on_outcome(const SyncOutcome& outcome) override { sink_.on_outcome(outcome); }
  void on_program_failure(const ProgramFailure& failure) override {
    sink_.on_program_failure(failure);
  }
  void on_message(const ObservedMessage& message) override {
    sink_.on_message(message);
    if (message.from != 0 || message.lost) return;
    us[message.to].push_back(to_ns(message.arrived - message.at_switch) * 1e-3);
  }

  Residences us;

 private:
  ClockSink& sink_;
};

// A source of clocks at whose switch a tap stands.
class TappedClocks final : public ClockSource {
 public:
  TappedClocks(std::unique_ptr<ClockSource> clocks, ResidencesOfRuns& runs, std::mutex& mutex)
      : clocks_(std::move(clocks)), runs_(runs), mutex_(mutex) {}

  ClockCost run(const ClockRequest& request, ClockSink& sink) override {
    ResidenceTap tap(sink);
    const ClockCost cost = clocks_->run(request, tap);
    const std::lock_guard lock(mutex_);
    runs_[{request.pipeline, request.seed}] = std::move(tap.us);
    return cost;
  }

 private:
  std::unique_ptr<ClockSource> clocks_;
  ResidencesOfRuns& runs_;
  std::mutex& mutex_;  // guards runs_
};

struct SeedFigures {
  HostTimeErrors errors;
  Residences residences_us;
};

double value_us(const RealitySetting& setting, const SeedFigures& seed) {
  const auto truth = [&] { return seed.errors.to_truth.at(setting.host); };
  const auto pair = [&] { return seed.errors.pairs.at(setting.host); };
  const auto residences = [&] { return seed.residences_us.at(setting.host); };
  switch (setting.quantity) {
    using enum scenarios::RealityQuantity;
    case kMedianAbsTe:
      return 1e3 * truth().median_abs_ms;
    case kP95AbsTe:
      return 1e3 * truth().p95_abs_ms;
    case kPairMedianAbsTe:
      return 1e3 * pair().median_abs_ms;
    case kPairP95AbsTe:
      return 1e3 * pair().p95_abs_ms;
    case kPairSdTe:
      return 1e3 * pair().sd_ms;
    case kResidenceMedian:
      return median(residences());
    case kResidenceMax:
      return std::ranges::max(residences());
  }
  return kNan;
}

bool needs_residences(const World& world, const RealRecording& recording) {
  return std::ranges::any_of(world.settings, [&](std::size_t i) {
    const scenarios::RealityQuantity quantity = recording.settings[i].quantity;
    return quantity == scenarios::RealityQuantity::kResidenceMedian ||
           quantity == scenarios::RealityQuantity::kResidenceMax;
  });
}

class RealityComparison {
 public:
  RealityComparison(const RealRecording& recording, const ClockWorldFactory& make_world,
                    const RealityOptions& options, const Progress& progress)
      : recording_(recording),
        make_world_(make_world),
        options_(options),
        progress_(progress),
        worlds_(worlds_of(recording)) {
    for (const RealitySetting& setting : recording.settings) rows_.push_back({.setting = &setting});
  }

  std::vector<RealityRow> run() {
    plan();
    for (const World& world : worlds_) predict(world);
    if (!options_.spans_unknown) return std::move(rows_);
    for (const World& world : worlds_) {
      for (const scenarios::UnknownParameter& parameter : recording_.unknown) {
        if (!has(world, parameter)) continue;
        for (const std::string& value : parameter.values) span(world, parameter, value);
      }
    }
    return std::move(rows_);
  }

 private:
  // Counts the runs to come.
  void plan() {
    all_ = worlds_.size();
    if (!options_.spans_unknown) return;
    for (const World& world : worlds_) {
      for (const scenarios::UnknownParameter& parameter : recording_.unknown) {
        if (has(world, parameter)) all_ += parameter.values.size();
      }
    }
  }

  // Whether the scenario has that member: a load that is not there has none.
  static bool has(const World& world, const scenarios::UnknownParameter& parameter) {
    if (parameter.pointer.starts_with("/algorithms/")) return true;
    const std::vector<scenarios::ParameterLine> lines =
        describe(scenarios::load_scenario(world.scenario, world.set));
    return std::ranges::any_of(lines, [&](const scenarios::ParameterLine& line) {
      return line.pointer == parameter.pointer || line.pointer.starts_with(parameter.pointer + '/');
    });
  }

  // Runs the world with that on top.
  void run_world(const World& world, const std::vector<Override>& more) {
    std::vector<Override> set = world.set;
    set.insert(set.end(), more.begin(), more.end());
    const scenarios::Scenario scenario = scenarios::load_scenario(world.scenario, set);
    ClockOptions run{.duration_s = recording_.duration_s,
                     .from_s = recording_.from_s,
                     .seeds = options_.seeds > 0 ? options_.seeds : recording_.seeds,
                     .jobs = options_.jobs,
                     .pipelines = {},
                     .pairs_with = recording_.pairs_with,
                     .cancel = options_.cancel};
    for (const std::size_t i : world.settings) {
      const std::string& pipeline = recording_.settings[i].pipeline;
      if (std::ranges::count(run.pipelines, pipeline) == 0) run.pipelines.push_back(pipeline);
    }
    pipelines_ = run.pipelines;
    keep_figures(scenario, run, needs_residences(world, recording_));
    if (progress_) progress_(++done_, all_);
  }

  void keep_figures(const scenarios::Scenario& scenario, const ClockOptions& run, bool is_tapped) {
    ResidencesOfRuns residences;
    std::mutex mutex;
    const auto make_source = [&]() -> std::unique_ptr<ClockSource> {
      std::unique_ptr<ClockSource> clocks = make_world_(scenario);
      if (!is_tapped) return clocks;
      return std::make_unique<TappedClocks>(std::move(clocks), residences, mutex);
    };
    ClockResults results = evaluate_clocks(scenario, make_source, run, nullptr);
    seeds_.clear();
    for (std::size_t row = 0; row < run.pipelines.size(); ++row) {
      std::vector<SeedFigures>& of_row = seeds_.emplace_back();
      for (std::size_t i = 0; i < results.hosts[row].size(); ++i) {
        of_row.push_back({std::move(results.hosts[row][i]),
                          std::move(residences[{run.pipelines[row], run.first_seed + i}])});
      }
    }
  }

  // The values of a setting by seed, in the last runs.
  std::vector<double> values_us(const RealitySetting& setting) const {
    const auto row = static_cast<std::size_t>(std::ranges::find(pipelines_, setting.pipeline) -
                                              pipelines_.begin());
    std::vector<double> values;
    for (const SeedFigures& seed : seeds_.at(row)) values.push_back(value_us(setting, seed));
    return values;
  }

  void predict(const World& world) {
    run_world(world, {});
    for (const std::size_t i : world.settings) {
      rows_[i].predicted_us = values_us(recording_.settings[i]);
    }
  }

  void span(const World& world, const scenarios::UnknownParameter& parameter,
            const std::string& value) {
    run_world(world, {{.pointer = parameter.pointer, .value = value}});
    for (const std::size_t i : world.settings) {
      rows_[i].spans.push_back({.parameter = &parameter,
                                .value = value,
                                .predicted_us = median(values_us(recording_.settings[i]))});
    }
  }

  const RealRecording& recording_;
  const ClockWorldFactory& make_world_;
  const RealityOptions& options_;
  const Progress& progress_;
  std::vector<World> worlds_;
  std::vector<RealityRow> rows_;
  std::vector<std::string> pipelines_;           // of the last runs
  std::vector<std::vector<SeedFigures>> seeds_;  // of the last runs: by row, by seed
  std::size_t done_ = 0;
  std::size_t all_ = 0;
};

}  // namespace

double RealityRow::measured_us() const { return median(setting->measured_us); }
double RealityRow::least_measured_us() const {
  return *std::ranges::min_element(setting->measured_us);
}
double RealityRow::largest_measured_us() const {
  return *std::ranges::max_element(setting->measured_us);
}
double RealityRow::median_us() const { return median(predicted_us); }

bool RealityRow::is_within() const { return std::max(ratio(), 1 / ratio()) <= setting->factor; }

std::vector<RealityRow> compare_with_reality(const RealRecording& recording,
                                             const ClockWorldFactory& make_world,
                                             const RealityOptions& options,
                                             const Progress& progress) {
  return RealityComparison(recording, make_world, options, progress).run();
}

}  // namespace simbench::evaluation
