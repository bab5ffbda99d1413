#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>
#include <vector>

#include "evaluation/diagnosis/common_mode.h"
#include "evaluation/diagnosis/diagnose.h"
#include "recording/counted.h"

namespace simbench::evaluation {
namespace {

constexpr double kDeviations = 4;             // of a period that is known to some ppm
constexpr double kFalseAlarm = 1e-3;          // that cameras of one period differ, in a group
constexpr double kLeastDifferencePpm = 0.02;  // the resolution of stamps in milliseconds
constexpr double kResolutionPpm = 5;
constexpr double kWholeMultiple = 0.02;
constexpr int kLargestMultiple = 64;

constexpr double kMostFreedom = 30;
constexpr double kLeastSpreadMs = 0.001;  // less is said of no stamps
constexpr double kOffsetSigmas = 3;
constexpr double kNamedShare = 0.03;  // of a period, from half or a whole one
constexpr double kLongestAdviceS = 3600;
constexpr Nanoseconds kEpochStamp = std::chrono::hours(24 * 365 * 20);

struct Candidate {
  std::size_t member = 0;
  double period_ms = 0;  // divided by the multiple
  double sd_ppm = 0;
};

bool counts_from_epoch(const GroupMember& member) {
  return member.scale->kind != ScaleKind::kOwnClock ||
         (member.facts->one_clock && member.facts->first_stamp > kEpochStamp);
}

// Two cameras of one host whose stamps differ from their arrivals by the same.
bool are_of_one_boot(const GroupMember& a, const GroupMember& b) {
  const double apart_ms = a.facts->delay.median_ms - b.facts->delay.median_ms;
  return a.host == b.host && !a.facts->realsense && !b.facts->realsense &&
         std::abs(apart_ms) < kSameBootS * 1e3;
}

// The rate of a camera's stamps against its arrivals.
Candidate own_rate(const StreamFacts& facts) {
  return {.member = 0,
          .period_ms = facts.host_period.period_ms / facts.stamp_period.period_ms,
          .sd_ppm = std::hypot(facts.host_period.sd_ppm, facts.stamp_period.sd_ppm)};
}

std::string ppm_text(double ppm) {
  return ppm < 10 ? fmt::format("{:.2g}", ppm) : fmt::format("{:.0f}", ppm);
}

// Within half a period; half a period earlier is half a period later.
double within_half(double phase_ms, double period_ms) {
  const double phase = std::remainder(phase_ms, period_ms);
  return phase < -(0.5 - kNamedShare) * period_ms ? phase + period_ms : phase;
}

class Group {
 public:
  Group(std::span<const GroupMember> members, std::optional<double> expected_period_ms)
      : members_(members), expected_period_ms_(expected_period_ms) {}

  GroupVerdict judge() {
    deviations_ = significant_deviations();
    by_stamps_ = have_common_stamps();
    find_candidates();
    compare_on_one_host();
    find_standard();
    if (in_standard_.empty()) return verdict();
    for (const Candidate& candidate : candidates_) place(candidate);
    note_phases();
    return verdict();
  }

 private:
  Standing& standing(const Candidate& candidate) const {
    return *members_[candidate.member].standing;
  }
  const std::string& host(const Candidate& candidate) const {
    return members_[candidate.member].host;
  }

  // Standard deviations of a difference that is none, for the few batches that these are known from
  // and the number of cameras that are compared.
  double significant_deviations() const {
    double freedom = kMostFreedom;
    for (const GroupMember& member : members_) {
      const double own = member.facts->host_period.freedom;
      if (own > 0) freedom = std::min(freedom, own);
    }
    const auto others = static_cast<double>(std::max<std::size_t>(1, members_.size() - 1));
    return student_t_exceeded(kFalseAlarm / 2 / others, freedom);
  }

  double tolerance_ppm(const Candidate& a, const Candidate& b) const {
    return deviations_ * std::hypot(a.sd_ppm, b.sd_ppm) + kLeastDifferencePpm;
  }

  bool agree(const Candidate& a, const Candidate& b) const {
    return std::abs(a.period_ms / b.period_ms - 1) * 1e6 <= tolerance_ppm(a, b);
  }

  double resolution_of(double sd_ppm) const {
    return std::max(kDeviations * std::sqrt(2.0) * sd_ppm, kLeastDifferencePpm);
  }

  bool is_precise(const Candidate& candidate) const {
    return resolution_of(candidate.sd_ppm) <= kResolutionPpm;
  }

  // Whether all stamps are of one clock: of one epoch or boot, at one rate against the arrivals.
  bool have_common_stamps() const {
    const GroupMember* first = nullptr;
    for (const GroupMember& member : members_) {
      if (!(member.facts->stamp_period.period_ms > 0)) continue;
      if (first == nullptr) first = &member;
      const bool epoch = counts_from_epoch(*first) && counts_from_epoch(member);
      if (!epoch && !are_of_one_boot(*first, member)) return false;
      const Candidate rate = own_rate(*member.facts);
      const Candidate first_rate = own_rate(*first->facts);
      if (!epoch && !(is_precise(rate) && is_precise(first_rate))) return false;
      if (rate.period_ms > 0 && first_rate.period_ms > 0 && !agree(rate, first_rate)) return false;
    }
    return first != nullptr;
  }

  const PeriodEstimate& period_of(const GroupMember& member) const {
    return by_stamps_ ? member.facts->stamp_period : member.facts->host_period;
  }

  // Cameras whose period is known, at a multiple of the common one.
  void find_candidates() {
    std::vector<double> periods;
    for (const GroupMember& member : members_) {
      const bool usable = period_of(member).period_ms > 0 && member.facts->has_grid;
      if (usable) periods.push_back(period_of(member).period_ms);
    }
    if (periods.empty()) return;
    // The lower of two: half the rate is a common fault, twice the rate is none.
    std::sort(periods.begin(), periods.end());
    common_ms_ = expected_period_ms_.value_or(periods[(periods.size() - 1) / 2]);
    for (std::size_t i = 0; i < members_.size(); ++i) {
      const PeriodEstimate& own = period_of(members_[i]);
      if (!(own.period_ms > 0) || !members_[i].facts->has_grid) continue;
      const double ratio = own.period_ms / common_ms_;
      const double multiple = std::round(ratio);
      if (multiple < 1 || multiple > kLargestMultiple ||
          std::abs(ratio / multiple - 1) > kWholeMultiple) {
        members_[i].standing->follows = Follows::kOtherRate;
        continue;
      }
      members_[i].standing->period_multiple = static_cast<int>(multiple);
      worst_sd_ppm_ = std::max(worst_sd_ppm_, own.sd_ppm);
      longest_s_ = std::max(longest_s_, members_[i].facts->span_s());
      worst_scatter_ms_ = std::max(worst_scatter_ms_, members_[i].facts->delay.scatter_ms);
      candidates_.push_back({i, own.period_ms / multiple, own.sd_ppm});
    }
  }

  // On one clock the differences of periods may be known better than the periods.
  void compare_on_one_host() {
    if (by_stamps_ || more_hosts_than_one()) return;
    std::vector<const StreamFacts*> facts;
    std::vector<int> multiples;
    for (const Candidate& candidate : candidates_) {
      facts.push_back(members_[candidate.member].facts);
      multiples.push_back(standing(candidate).period_multiple);
    }
    const auto periods = relative_periods(facts, multiples);
    if (!periods) return;
    const double worst_ppm = std::ranges::max(*periods, {}, &PeriodEstimate::sd_ppm).sd_ppm;
    if (worst_ppm >= worst_sd_ppm_) return;
    worst_sd_ppm_ = worst_ppm;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      candidates_[i].period_ms = (*periods)[i].period_ms;
      candidates_[i].sd_ppm = (*periods)[i].sd_ppm;
    }
  }

  void find_standard() {
    std::vector<Candidate> precise;
    std::copy_if(candidates_.begin(), candidates_.end(), std::back_inserter(precise),
                 [this](const Candidate& candidate) { return is_precise(candidate); });
    if (!precise.empty()) return set_standard(largest_agreeing(std::move(precise)));
    std::vector<Candidate> best = largest_agreeing(candidates_);
    if (best.size() < candidates_.size()) set_standard(best);
  }

  // If several are the largest, the narrowest of them, then that of the shortest period.
  std::vector<Candidate> largest_agreeing(std::vector<Candidate> sorted) const {
    std::sort(sorted.begin(), sorted.end(), [](const Candidate& a, const Candidate& b) {
      return std::pair(a.period_ms, a.member) < std::pair(b.period_ms, b.member);
    });
    double narrowest_ms = 0;
    std::vector<Candidate> best;
    for (std::size_t begin = 0, end = 0; begin < sorted.size(); ++begin) {
      end = std::max(end, begin + 1);
      while (end < sorted.size() && agree(sorted[begin], sorted[end])) ++end;
      const double width_ms = sorted[end - 1].period_ms - sorted[begin].period_ms;
      const std::size_t size = end - begin;
      if (size < best.size() || (size == best.size() && width_ms >= narrowest_ms)) continue;
      narrowest_ms = width_ms;
      best.assign(sorted.begin() + static_cast<std::ptrdiff_t>(begin),
                  sorted.begin() + static_cast<std::ptrdiff_t>(end));
    }
    return best;
  }

  void set_standard(const std::vector<Candidate>& best) {
    double sum = 0;
    double weights = 0;
    for (const Candidate& candidate : best) {
      const double weight = 1 / std::max(candidate.sd_ppm * candidate.sd_ppm, 1e-12);
      sum += weight * candidate.period_ms;
      weights += weight;
      in_standard_.push_back(candidate.member);
    }
    standard_period_ms_ = sum / weights;
    standard_sd_ppm_ = std::sqrt(1 / weights);
    std::sort(in_standard_.begin(), in_standard_.end());
  }

  bool in_standard(const Candidate& candidate) const {
    return std::binary_search(in_standard_.begin(), in_standard_.end(), candidate.member);
  }

  void place(const Candidate& candidate) {
    Standing& found = standing(candidate);
    found.rate_ppm = (candidate.period_ms / standard_period_ms_ - 1) * 1e6;
    found.rate_sd_ppm =
        in_standard(candidate) ? candidate.sd_ppm : std::hypot(candidate.sd_ppm, standard_sd_ppm_);
    found.moves_ms_per_minute = found.rate_ppm * 1e-6 * 60'000;
    found.follows = follows(candidate);
  }

  Follows follows(const Candidate& candidate) const {
    const bool has_standard = in_standard_.size() > 1;
    if (has_standard && in_standard(candidate)) {
      return is_precise(candidate) ? Follows::kTrigger : Follows::kUnknown;
    }
    const Candidate standard = {0, standard_period_ms_, standard_sd_ppm_};
    const bool uncertain = !is_precise(candidate) && !in_standard(candidate);
    if (uncertain && agree(candidate, standard)) return Follows::kUnknown;
    // Compares with others on the same clock: if they differ, the camera differs; if all on that
    // clock agree, the cause may be the clock.
    bool others = false;
    for (const Candidate& other : candidates_) {
      if (other.member == candidate.member || host(other) != host(candidate)) continue;
      others = true;
      if (!agree(other, candidate)) return Follows::kOwnClock;
    }
    if (candidates_.size() == 1) return Follows::kUnknown;
    if (more_hosts_than_one()) return Follows::kHostOrOwn;
    // On one clock: it agrees with others that are too uncertain to be a standard.
    return others ? Follows::kUnknown : Follows::kOwnClock;
  }

  bool more_hosts_than_one() const {
    return std::any_of(members_.begin(), members_.end(), [this](const GroupMember& member) {
      return member.host != members_.front().host;
    });
  }

  // The first camera of the standard whose phase never steps, or the first.
  const Candidate& reference() const {
    const Candidate* found = nullptr;
    for (const Candidate& candidate : candidates_) {
      if (!in_standard(candidate)) continue;
      if (found == nullptr) found = &candidate;
      if (members_[candidate.member].facts->steps.empty()) return candidate;
    }
    return *found;
  }

  // Phases relative to the reference, whose own period they are counted in: it stays level.
  void note_phases() {
    const Candidate& zero = reference();
    reference_ = zero.member;
    const double zero_ms = segments_of(zero, zero).front().phase_ms;
    for (const Candidate& candidate : candidates_) {
      if (!in_standard(candidate)) continue;
      Standing& found = standing(candidate);
      found.segments = segments_of(candidate, zero);
      for (PhaseSegment& segment : found.segments) {
        segment.phase_ms = within_half(segment.phase_ms - zero_ms, zero.period_ms);
      }
      found.phase_ms = found.segments.back().phase_ms;
      const double scatter_ms =
          members_[candidate.member].facts->scatter_ms + members_[zero.member].facts->scatter_ms;
      found.is_offset = by_stamps_ && std::abs(found.phase_ms) > kOffsetShare * zero.period_ms &&
                        std::abs(found.phase_ms) > kOffsetSigmas * scatter_ms &&
                        is_of_exposure(candidate);
    }
  }

  // Stamps of a program's arrivals show no exposure.
  bool is_of_exposure(const Candidate& candidate) const {
    return !members_[candidate.member].facts->stamped_on_arrival &&
           !members_[reference_].facts->stamped_on_arrival;
  }

  std::vector<PhaseSegment> segments_of(const Candidate& candidate, const Candidate& zero) const {
    const GroupMember& member = members_[candidate.member];
    const StreamFacts& facts = *member.facts;
    const std::vector<double>& times = by_stamps_ ? facts.stamps_ms : facts.arrivals_ms;
    double begin_ms = 0;
    if (by_stamps_) {
      const GroupMember& other = members_[zero.member];
      begin_ms = to_ms(facts.first_stamp - other.facts->first_stamp) -
                 (member.scale->shift_s - other.scale->shift_s) * 1e3;
    }
    const double own_ms = zero.period_ms * member.standing->period_multiple;
    std::vector<PhaseSegment> segments;
    for (std::size_t part = 0; part <= facts.steps.size(); ++part) {
      const std::size_t begin = part == 0 ? 0 : facts.steps[part - 1].frame;
      const std::size_t end = part == facts.steps.size() ? times.size() : facts.steps[part].frame;
      std::vector<double> phases;
      phases.reserve(end - begin);
      for (std::size_t i = begin; i < end; ++i) {
        phases.push_back(begin_ms + times[i] - static_cast<double>(facts.periods[i]) * own_ms);
      }
      segments.push_back({.from_s = part == 0 ? 0 : facts.steps[part - 1].at_s,
                          .phase_ms = median(std::move(phases))});
    }
    return segments;
  }

  std::size_t count(Follows follows) const {
    return static_cast<std::size_t>(std::count_if(
        members_.begin(), members_.end(),
        [follows](const GroupMember& member) { return member.standing->follows == follows; }));
  }

  // "front, left and 3 more"
  std::string names(Follows follows) const {
    constexpr std::size_t kMostNames = 4;
    std::string text;
    std::size_t found = 0;
    const std::size_t all = count(follows);
    for (const GroupMember& member : members_) {
      if (member.standing->follows != follows) continue;
      if (found++ == kMostNames) return text + fmt::format(" and {} more", all - kMostNames);
      text += (text.empty() ? "" : ", ") + member.camera;
    }
    return text;
  }

  const std::string& reference_name() const { return members_[reference_].camera; }

  double spread_ms() const {
    double low = 0;
    double high = 0;
    for (const Candidate& candidate : candidates_) {
      if (!in_standard(candidate) || !is_of_exposure(candidate)) continue;
      low = std::min(low, standing(candidate).phase_ms);
      high = std::max(high, standing(candidate).phase_ms);
    }
    return high - low;
  }

  // " (half a period)" of a phase that is.
  std::string share_text(double phase_ms) const {
    const double share = std::abs(phase_ms) / common_ms_;
    if (std::abs(share - 0.5) < kNamedShare) return " (half a period)";
    return share < kNamedShare ? "" : fmt::format(" ({:.2f} of a period)", share);
  }

  std::string offset_text(const Candidate& candidate) const {
    const double phase_ms = standing(candidate).phase_ms;
    return fmt::format("{} is {:.3g} ms {} than {}{}",
                       called_camera(members_[candidate.member].camera), std::abs(phase_ms),
                       phase_ms > 0 ? "later" : "earlier", called_camera(reference_name()),
                       share_text(phase_ms));
  }

  // Up to three, then how many more.
  std::string offsets_text() const {
    constexpr std::size_t kMostShown = 3;
    std::string text;
    std::size_t found = 0;
    for (const Candidate& candidate : candidates_) {
      if (!standing(candidate).is_offset || ++found > kMostShown) continue;
      text += (text.empty() ? "" : ", ") + offset_text(candidate);
    }
    return found > kMostShown ? text + fmt::format(" and {} more", found - kMostShown) : text;
  }

  bool has_offsets() const {
    return std::ranges::any_of(
        members_, [](const GroupMember& member) { return member.standing->is_offset; });
  }

  bool has_steps() const {
    return std::ranges::any_of(candidates_, [this](const Candidate& candidate) {
      return in_standard(candidate) && !members_[candidate.member].facts->steps.empty();
    });
  }

  // "16.7 ms (half a period), from 23.3 s on 0.00 ms"
  std::string segments_text(const Candidate& candidate) const {
    constexpr std::size_t kMostShown = 4;
    const std::vector<PhaseSegment>& segments = members_[candidate.member].standing->segments;
    std::string text;
    for (std::size_t i = 0; i < std::min(segments.size(), kMostShown); ++i) {
      const double phase_ms = segments[i].phase_ms;
      text += i == 0 ? "" : fmt::format(", from {:.1f} s on ", segments[i].from_s);
      text +=
          fmt::format("{:.2f} ms{}", std::round(phase_ms * 100) / 100 + 0.0, share_text(phase_ms));
    }
    return segments.size() > kMostShown
               ? text + fmt::format(" and {} more", segments.size() - kMostShown)
               : text;
  }

  std::string steps_text() const {
    for (const Candidate& candidate : candidates_) {
      const GroupMember& member = members_[candidate.member];
      if (!in_standard(candidate) || member.facts->steps.empty()) continue;
      return fmt::format("{} steps {} against {} at one rate ({:+.2g} +- {:.2g} ppm): it is {}",
                         called_camera(member.camera), times(member.facts->steps.size()),
                         called_camera(reference_name()), member.standing->rate_ppm,
                         member.standing->rate_sd_ppm, segments_text(candidate));
    }
    return "";
  }

  GroupVerdict verdict() const {
    GroupVerdict verdict;
    verdict.by_stamps = by_stamps_;
    if (!in_standard_.empty()) {
      verdict.period_ms = standard_period_ms_;
      verdict.standard = reference_;
      if (by_stamps_) verdict.spread_ms = spread_ms();
    }
    if (!candidates_.empty()) verdict.resolution_ppm = resolution_of(worst_sd_ppm_);
    std::tie(verdict.status, verdict.reason) = status_and_reason(verdict);
    return verdict;
  }

  std::pair<SyncStatus, std::string> status_and_reason(const GroupVerdict& verdict) const {
    if (members_.size() < 2) {
      return {SyncStatus::kCannotBeTold, "one camera alone cannot show a common trigger"};
    }
    if (count(Follows::kOwnClock) > 0) {
      return {SyncStatus::kDoesNotWork,
              fmt::format("free-running, each with a frame period of its own: {}",
                          names(Follows::kOwnClock))};
    }
    if (count(Follows::kOtherRate) > 0) {
      return {SyncStatus::kDoesNotWork,
              fmt::format("at a rate that is no whole fraction of {:.3f} Hz: {}", 1000 / common_ms_,
                          names(Follows::kOtherRate))};
    }
    if (has_steps()) return {SyncStatus::kSlips, steps_text()};
    if (count(Follows::kHostOrOwn) > 0) {
      return {SyncStatus::kCannotBeTold,
              fmt::format("frame periods differ between hosts, but not within a host: either the "
                          "clocks of the hosts of {} or these cameras are not synchronised",
                          names(Follows::kHostOrOwn))};
    }
    if (count(Follows::kUnknown) > 0) return {SyncStatus::kCannotBeTold, too_little()};
    std::string one_period = fmt::format("all {} cameras have one frame period, to {} ppm",
                                         members_.size(), ppm_text(verdict.resolution_ppm));
    if (has_offsets()) {
      return {SyncStatus::kWorksWithOffset,
              fmt::format("{}, but {}, all the time", one_period, offsets_text())};
    }
    if (by_stamps_ && members_.size() == in_standard_.size()) {
      one_period += fmt::format(", and their stamps are within {:.2g} ms of each other",
                                std::max(verdict.spread_ms, kLeastSpreadMs));
    }
    return {SyncStatus::kWorks, one_period};
  }

  std::string too_little() const {
    const bool vary = std::ranges::any_of(members_, [](const GroupMember& member) {
      return member.facts->period_ms > 0 && !member.facts->has_grid;
    });
    if (vary && candidates_.empty())
      return "their intervals vary by themselves: there is no period to compare";
    std::string text =
        fmt::format("too few or too unsteady frames of: {}", names(Follows::kUnknown));
    const double resolution = resolution_of(worst_sd_ppm_);
    if (resolution > kResolutionPpm && longest_s_ > 0) {
      text += fmt::format(
          "; periods are known to {} ppm, but {:.0f} ppm are needed because free-running "
          "cameras differ by tens: {}",
          ppm_text(resolution), kResolutionPpm, needed_text(resolution));
    }
    if (count(Follows::kTrigger) > 0) {
      text += fmt::format("; the other {} have one frame period", count(Follows::kTrigger));
    }
    return text;
  }

  // The error of a period falls with the length of a recording to the power of 3/2.
  std::string needed_text(double resolution_ppm) const {
    const double needed_s =
        std::ceil(longest_s_ * std::pow(resolution_ppm / kResolutionPpm, 2.0 / 3));
    if (needed_s <= kLongestAdviceS) return fmt::format("record about {:.0f} s", needed_s);
    return fmt::format(
        "no recording of reasonable length shows that with {} that scatter by {:.2g} ms; record "
        "stamps that the cameras make",
        by_stamps_ ? "stamps" : "arrivals", worst_scatter_ms_);
  }

  std::span<const GroupMember> members_;
  std::optional<double> expected_period_ms_;
  double deviations_ = 0;
  bool by_stamps_ = false;
  std::size_t reference_ = 0;  // a member
  double common_ms_ = 0;
  double worst_scatter_ms_ = 0;
  double worst_sd_ppm_ = 0;
  double longest_s_ = 0;
  std::vector<Candidate> candidates_;
  std::vector<std::size_t> in_standard_;  // members, ascending
  double standard_period_ms_ = 0;
  double standard_sd_ppm_ = 0;
};

}  // namespace

GroupVerdict judge_group(std::string stream, std::span<const GroupMember> members,
                         std::optional<double> expected_period_ms) {
  GroupVerdict verdict = Group(members, expected_period_ms).judge();
  verdict.stream = std::move(stream);
  return verdict;
}

}  // namespace simbench::evaluation
