#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "algorithms/gathering/fronts.h"
#include "algorithms/gathering/gatherers.h"
#include "algorithms/ports/assert.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

class ApproximateTimeGatherer final : public Gatherer {
 public:
  ApproximateTimeGatherer(const GatheringSetup& setup, const ApproximateTimeOptions& options)
      : sources_(setup.sources),
        limit_(setup.queue_limit.value_or(options.queue)),
        age_factor_(1 + options.age_penalty),
        max_interval_(options.max_interval.count()),
        queues_(setup.sources, limit_ + 1),
        fronts_(setup.sources),
        aside_(setup.sources),
        has_dropped_(setup.sources) {
    SIMBENCH_ASSERT(limit_ > 0, "a queue needs room for one frame");
    SIMBENCH_ASSERT(options.age_penalty >= 0, "an older candidate is no worse than a later one");
    for (std::uint32_t source = 0; source < sources_; ++source) {
      const bool own = source < options.lower_bounds.size();
      lower_bounds_.push_back((own ? options.lower_bounds[source] : options.lower_bound).count());
    }
    steps_.reserve(sources_);
    dropped_.reserve(sources_);
  }

  void push(const GatherFrame& frame, FrameSetSink& sink) override {
    const std::uint32_t source = frame.source;
    if (undecided_until_ && may_decide(frame)) undecided_until_.reset();
    queues_.push(frame);
    if (has_front_one(source)) {
      ++with_front_;
      fronts_.set(source, front_key(source));
      if (with_front_ == sources_) search(sink);
    }
    if (queues_.size(source) > limit_) drop_oldest(source, sink);
  }

  std::uint64_t discarded() const override { return discarded_; }

 private:
  struct Candidate {
    std::int64_t start = 0;
    std::int64_t end = 0;
    std::uint32_t pivot = 0;
    std::int64_t pivot_time = 0;
  };

  // A queue is the frames that stepped aside, then those still ahead; the first of these is its
  // front. The frames of the candidate are the oldest of their queues.
  bool has_front(std::uint32_t source) const { return queues_.size(source) > aside_[source]; }
  bool has_front_one(std::uint32_t source) const {
    return queues_.size(source) == aside_[source] + 1;
  }
  std::int64_t front_key(std::uint32_t source) const {
    return gather_key(queues_.at(source, aside_[source]));
  }

  void search(FrameSetSink& sink) {
    while (with_front_ == sources_) {
      const std::uint32_t first = fronts_.earliest();
      const std::uint32_t last = fronts_.latest();
      const std::int64_t start = fronts_.key(first);
      const std::int64_t end = fronts_.key(last);
      forgive_drops(last);
      if (!candidate_) {
        if ((max_interval_ > 0 && end - start > max_interval_) || has_dropped_[last] != 0) {
          give_up_front(first);
          continue;
        }
        candidate_ = {.start = start, .end = end, .pivot = last, .pivot_time = end};
      } else if (is_better(start, end)) {
        undecided_until_.reset();
        give_up_stepped_aside();
        candidate_->start = start;
        candidate_->end = end;
      }
      step_aside(first);
      const bool proven = first == candidate_->pivot || is_best(end);
      if (proven || (with_front_ < sources_ && !undecided_until_ && search_virtually())) {
        emit(sink);
      }
    }
  }

  double later_by(std::int64_t end) const {
    return static_cast<double>(end - candidate_->end) * age_factor_;
  }
  bool is_better(std::int64_t start, std::int64_t end) const {
    return later_by(end) < static_cast<double>(start - candidate_->start);
  }
  // Whether no later set can be better: all hold the pivot, and end here or later.
  bool is_best(std::int64_t end) const {
    return later_by(end) >= static_cast<double>(candidate_->pivot_time - candidate_->start);
  }

  // Continues as if each frame to come came as early as it can. True if the candidate is the best
  // even so; else all steps are undone.
  bool search_virtually() {
    const std::size_t real_steps = steps_.size();
    note_virtual_front(steps_.back());
    undecided_until_ = fronts_.key(fronts_.latest());
    for (;;) {
      const std::uint32_t first = fronts_.earliest();
      const std::int64_t end = fronts_.key(fronts_.latest());
      if (is_best(end)) return true;
      if (is_better(fronts_.key(first), end)) break;
      step_aside(first);
      note_virtual_front(first);
    }
    take_back_steps(real_steps);
    return false;
  }

  // The earliest stamp of the source's next frame that matters to the search.
  std::int64_t virtual_key(std::uint32_t source) const {
    const std::int64_t newest = gather_key(queues_.at(source, queues_.size(source) - 1));
    return std::max(std::min(newest + lower_bounds_[source], kFarthestKey), candidate_->pivot_time);
  }

  void note_virtual_front(std::uint32_t source) {
    if (!has_front(source)) fronts_.set(source, virtual_key(source));
  }

  // A virtual search that decided nothing would repeat the same steps and decide nothing, as long
  // as frames come no earlier than it assumed and no later than its latest front: steps are of
  // fronts before the pivot, and the end of each of its ranges stays the same.
  bool may_decide(const GatherFrame& frame) const {
    SIMBENCH_ASSERT(frame.source < sources_, "a frame of a source that does not exist");
    const std::int64_t key = gather_key(frame);
    return key < virtual_key(frame.source) || key > *undecided_until_;
  }

  void step_aside(std::uint32_t source) {
    ++aside_[source];
    steps_.push_back(source);
    settle_front(source);
  }

  // After the front of a source has changed.
  void settle_front(std::uint32_t source) {
    if (has_front(source)) {
      fronts_.set(source, front_key(source));
    } else {
      --with_front_;
    }
  }

  void take_back_steps(std::size_t left) {
    while (steps_.size() > left) {
      const std::uint32_t source = steps_.back();
      steps_.pop_back();
      if (!has_front(source)) ++with_front_;
      --aside_[source];
      fronts_.set(source, front_key(source));
    }
  }

  void give_up_front(std::uint32_t source) {
    queues_.pop(source);
    ++discarded_;
    settle_front(source);
  }

  // The frames that stepped aside are older than a new candidate's.
  void give_up_stepped_aside() {
    for (const std::uint32_t source : steps_) {
      queues_.pop(source);
      --aside_[source];
      ++discarded_;
    }
    steps_.clear();
  }

  void emit(FrameSetSink& sink) {
    candidate_.reset();
    undecided_until_.reset();
    steps_.clear();
    sink.on_set(queues_.take_fronts());
    fronts_.forget();
    with_front_ = 0;
    for (std::uint32_t source = 0; source < sources_; ++source) {
      aside_[source] = 0;
      if (!has_front(source)) continue;
      ++with_front_;
      fronts_.set(source, front_key(source));
    }
  }

  void drop_oldest(std::uint32_t source, FrameSetSink& sink) {
    take_back_steps(0);
    give_up_front(source);
    if (has_dropped_[source] == 0) dropped_.push_back(source);
    has_dropped_[source] = 1;
    if (!candidate_) return;
    candidate_.reset();
    undecided_until_.reset();
    search(sink);
  }

  // No frame that sources other than `latest` dropped was a better one: they may be pivots again.
  void forgive_drops(std::uint32_t latest) {
    if (dropped_.empty()) return;
    const bool keep = has_dropped_[latest] != 0;
    for (const std::uint32_t source : dropped_) has_dropped_[source] = 0;
    dropped_.clear();
    if (!keep) return;
    has_dropped_[latest] = 1;
    dropped_.push_back(latest);
  }

  std::uint32_t sources_;
  std::uint32_t limit_;
  double age_factor_;
  std::int64_t max_interval_;
  std::vector<std::int64_t> lower_bounds_;  // by source
  FrameQueues queues_;
  FrontTournament fronts_;
  std::uint32_t with_front_ = 0;      // sources that have a front
  std::vector<std::uint32_t> aside_;  // by source: frames that stepped aside
  std::vector<std::uint32_t> steps_;  // the sources of these, in order
  std::optional<Candidate> candidate_;
  // The end of the last virtual search's first range, if that search decided nothing and would not
  // now.
  std::optional<std::int64_t> undecided_until_;
  std::vector<char> has_dropped_;       // by source: an overflow since it last was harmless
  std::vector<std::uint32_t> dropped_;  // the sources of which that is true
  std::uint64_t discarded_ = 0;
};

}  // namespace

std::unique_ptr<Gatherer> make_approximate_time_gatherer(const GatheringSetup& setup,
                                                         const ApproximateTimeOptions& options) {
  return std::make_unique<ApproximateTimeGatherer>(setup, options);
}

namespace {

const char* const kRos = "ros_comm message_filters sync_policies/approximate_time.h";

// Options whose times count in frame periods.
struct ApproximateTimeSettings {
  ApproximateTimeOptions options{};
  double lower_bound_periods = 0;
  double max_interval_periods = 0;
  bool is_bounded = false;  // by T_int, which is no parameter then

  void bind(ParameterBinder& parameters) {
    parameters.number("age_penalty", options.age_penalty, 0, 1e3,
                      "how much narrower a later set must be, as a share of its lateness", kRos);
    parameters.number("lower_bound_periods", lower_bound_periods, 0, 1,
                      "least time between two frames of a source, in frame periods; 0: none", kRos);
    parameters.number("queue", options.queue, 1, 1e4, "frames that may wait per source", kRos);
    if (is_bounded) return;
    parameters.number("max_interval_periods", max_interval_periods, 0, 1e3,
                      "largest range of a set, in frame periods; 0: any", kRos);
  }
};

std::unique_ptr<Gatherer> make_approximate_time(ApproximateTimeSettings settings,
                                                const GatheringSetup& setup) {
  const double period_ns = to_ns(setup.period);
  settings.options.lower_bound = from_ns(period_ns * settings.lower_bound_periods);
  settings.options.max_interval =
      settings.is_bounded ? setup.interval : from_ns(period_ns * settings.max_interval_periods);
  return make_approximate_time_gatherer(setup, settings.options);
}

GatheringEntry approximate_time(const char* name, const char* summary,
                                const ApproximateTimeSettings& settings) {
  return with_settings<GatheringEntry>(
      {.name = name, .family = "approximate_time", .summary = summary, .source = kRos}, settings,
      make_approximate_time);
}

}  // namespace

std::vector<GatheringEntry> gathering_approximate_time() {
  return {approximate_time("approximate_time",
                           "the narrowest sets around a pivot, of any width (ROS)", {}),
          approximate_time("approximate_time_bounded",
                           "the same with sets up to T_int and frames half a period apart",
                           {.lower_bound_periods = 0.5, .is_bounded = true})};
}

}  // namespace simbench
