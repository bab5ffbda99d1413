#include "evaluation/run/capture_groups.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "algorithms/ports/host_sync.h"
#include "recording/forked_sink.h"
#include "scenarios/schema_walk.h"

namespace simbench::evaluation {
namespace {

bool meets_load(const scenarios::Scenario& scenario, const PipelineChoice& choice) {
  return scenario.draws_load() && !choice.host_sync.make()->is_idle();
}

bool have_same_capture(const scenarios::Scenario& scenario, const PipelineChoice& a,
                       const PipelineChoice& b) {
  if (a.pipeline.programs || b.pipeline.programs) return false;
  return a.host_sync.is_same(b.host_sync) && a.capture_alignment.is_same(b.capture_alignment) &&
         (a.pipeline.name == b.pipeline.name || !meets_load(scenario, a));
}

}  // namespace

bool is_scoring_alone(std::string_view pointer) {
  return scenarios::schema_says("x-scoring", pointer);
}

CaptureGroups capture_groups(const scenarios::Scenario& scenario,
                             const std::vector<PipelineChoice>& choices) {
  CaptureGroups groups;
  for (std::size_t place = 0; place < choices.size(); ++place) {
    const auto found = std::ranges::find_if(groups, [&](const std::vector<std::size_t>& group) {
      return have_same_capture(scenario, choices[group.front()], choices[place]);
    });
    if (found == groups.end()) {
      groups.push_back({place});
    } else {
      found->push_back(place);
    }
  }
  return groups;
}

CaptureGroups single_captures(const std::vector<PipelineChoice>& choices) {
  CaptureGroups groups;
  for (std::size_t place = 0; place < choices.size(); ++place) groups.push_back({place});
  return groups;
}

SharedCapture::SharedCapture(const scenarios::Scenario& scenario,
                             const std::vector<PipelineChoice>& choices,
                             const std::vector<std::size_t>& group, std::uint64_t seed,
                             const std::optional<Assumptions>& certify)
    : recorded_(choices[group.front()]), seed_(seed) {
  for (const std::size_t place : group) {
    Member member;
    const PipelineChoice& choice = choices[place];
    const ScorerSetup setup = scorer_setup(scoring_scenario(scenario, choice), choice);
    member.scorer = std::make_unique<PipelineScorer>(setup);
    member.sink = member.scorer.get();
    if (certify) {
      member.certified = std::make_unique<CertifiedScoring>(*member.scorer, *certify, setup.stream);
      member.sink = member.certified.get();
    }
    if (choice.view) {
      member.view = choice.view(*member.sink);
      member.sink = member.view.get();
    }
    members_.push_back(std::move(member));
  }
}

void SharedCapture::record(RecordingSource& source, const ShareDone& share_done) {
  std::vector<RecordingSink*> sinks;
  for (const Member& member : members_) sinks.push_back(member.sink);
  ForkedSink fork(sinks);
  std::exception_ptr failure;
  try {
    cost_ = record_run(source, recorded_, seed_, fork, nullptr, share_done);
  } catch (...) {
    failure = std::current_exception();
  }
  for (std::size_t i = 0; i < members_.size(); ++i) {
    members_[i].failure = fork.failure(i) ? fork.failure(i) : failure;
  }
}

SeedScore SharedCapture::score(std::size_t member) {
  if (members_[member].failure) std::rethrow_exception(members_[member].failure);
  SeedScore score = captured_score(*members_[member].scorer, cost_, seed_);
  if (members_[member].certified) members_[member].certified->add_to(score);
  return score;
}

}  // namespace simbench::evaluation
