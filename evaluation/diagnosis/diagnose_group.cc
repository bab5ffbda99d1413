#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "evaluation/diagnosis/diagnose.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

constexpr double kDeviations = 4;             // of a significant difference
constexpr double kLeastDifferencePpm = 0.02;  // the resolution of stamps in milliseconds
constexpr double kResolutionPpm = 5;
constexpr double kWholeMultiple = 0.02;
constexpr int kLargestMultiple = 64;

struct Candidate {
  std::size_t member = 0;
  double period_ms = 0;  // in host time, divided by the multiple
  double sd_ppm = 0;
};

double tolerance_ppm(const Candidate& a, const Candidate& b) {
  return kDeviations * std::hypot(a.sd_ppm, b.sd_ppm) + kLeastDifferencePpm;
}

bool agree(const Candidate& a, const Candidate& b) {
  return std::abs(a.period_ms / b.period_ms - 1) * 1e6 <= tolerance_ppm(a, b);
}

double resolution_of(double sd_ppm) {
  return std::max(kDeviations * std::sqrt(2.0) * sd_ppm, kLeastDifferencePpm);
}

std::string ppm_text(double ppm) {
  return ppm < 10 ? fmt::format("{:.2g}", ppm) : fmt::format("{:.0f}", ppm);
}

class Group {
 public:
  Group(std::span<const GroupMember> members, std::optional<double> expected_period_ms)
      : members_(members), expected_period_ms_(expected_period_ms) {}

  GroupVerdict judge() {
    find_candidates();
    find_standard();
    if (in_standard_.empty()) return verdict();
    for (const Candidate& candidate : candidates_) place(candidate);
    for (const Candidate& candidate : candidates_) {
      if (in_standard(candidate)) note_phase(candidate);
    }
    return verdict();
  }

 private:
  Standing& standing(const Candidate& candidate) { return *members_[candidate.member].standing; }
  const std::string& host(const Candidate& candidate) const {
    return members_[candidate.member].host;
  }

  static bool is_precise(const Candidate& candidate) {
    return tolerance_ppm(candidate, candidate) <= kResolutionPpm;
  }

  // Cameras whose period in host time is known, at a multiple of the common one.
  void find_candidates() {
    std::vector<double> periods;
    for (const GroupMember& member : members_) {
      if (member.facts->host_period_ms > 0) periods.push_back(member.facts->host_period_ms);
    }
    if (periods.empty()) return;
    // The lower of two: half the rate is a common fault, twice the rate is none.
    std::sort(periods.begin(), periods.end());
    common_ms_ = expected_period_ms_.value_or(periods[(periods.size() - 1) / 2]);
    for (std::size_t i = 0; i < members_.size(); ++i) {
      const StreamFacts& facts = *members_[i].facts;
      if (!(facts.host_period_ms > 0)) continue;
      const double ratio = facts.host_period_ms / common_ms_;
      const double multiple = std::round(ratio);
      if (multiple < 1 || multiple > kLargestMultiple ||
          std::abs(ratio / multiple - 1) > kWholeMultiple) {
        members_[i].standing->follows = Follows::kOtherRate;
        continue;
      }
      members_[i].standing->period_multiple = static_cast<int>(multiple);
      worst_sd_ppm_ = std::max(worst_sd_ppm_, facts.host_period_sd_ppm);
      longest_s_ = std::max(longest_s_, facts.span_s());
      candidates_.push_back({i, facts.host_period_ms / multiple, facts.host_period_sd_ppm});
    }
  }

  void find_standard() {
    std::vector<Candidate> precise;
    std::copy_if(candidates_.begin(), candidates_.end(), std::back_inserter(precise), is_precise);
    if (!precise.empty()) return set_standard(largest_agreeing(std::move(precise)));
    std::vector<Candidate> best = largest_agreeing(candidates_);
    if (best.size() < candidates_.size()) set_standard(best);
  }

  // If several are the largest, the narrowest of them, then that of the shortest period.
  static std::vector<Candidate> largest_agreeing(std::vector<Candidate> sorted) {
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

  void note_phase(const Candidate& candidate) {
    const StreamFacts& facts = *members_[candidate.member].facts;
    Standing& found = standing(candidate);
    const double own_ms = standard_period_ms_ * found.period_multiple;
    std::vector<double> phases;
    phases.reserve(facts.periods.size());
    for (std::size_t i = 0; i < facts.periods.size(); ++i) {
      phases.push_back(facts.arrivals_ms[i] - static_cast<double>(facts.periods[i]) * own_ms);
    }
    const double phase = median(std::move(phases));
    if (candidate.member == in_standard_.front()) zero_phase_ms_ = phase;
    found.phase_ms = std::remainder(phase - zero_phase_ms_, standard_period_ms_);
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

  GroupVerdict verdict() const {
    GroupVerdict verdict;
    if (!in_standard_.empty()) {
      verdict.period_ms = standard_period_ms_;
      verdict.standard = in_standard_.front();
    }
    if (!candidates_.empty()) verdict.resolution_ppm = resolution_of(worst_sd_ppm_);
    const auto result = [&verdict](SyncStatus status, std::string reason) {
      verdict.status = status;
      verdict.reason = std::move(reason);
      return verdict;
    };
    if (members_.size() < 2) {
      return result(SyncStatus::kCannotBeTold, "one camera alone cannot show a common trigger");
    }
    if (count(Follows::kOwnClock) > 0) {
      return result(SyncStatus::kDoesNotWork,
                    fmt::format("free-running, each with a frame period of its own: {}",
                                names(Follows::kOwnClock)));
    }
    if (count(Follows::kOtherRate) > 0) {
      return result(SyncStatus::kDoesNotWork,
                    fmt::format("at a rate that is no whole fraction of {:.3f} Hz: {}",
                                1000 / common_ms_, names(Follows::kOtherRate)));
    }
    if (count(Follows::kHostOrOwn) > 0) {
      return result(
          SyncStatus::kCannotBeTold,
          fmt::format("frame periods differ between hosts, but not within a host: either the "
                      "clocks of the hosts of {} or these cameras are not synchronised",
                      names(Follows::kHostOrOwn)));
    }
    if (count(Follows::kUnknown) > 0) return result(SyncStatus::kCannotBeTold, too_little());
    return result(SyncStatus::kWorks,
                  fmt::format("all {} cameras have one frame period, to {} ppm", members_.size(),
                              ppm_text(verdict.resolution_ppm)));
  }

  std::string too_little() const {
    std::string text =
        fmt::format("too few or too unsteady frames of: {}", names(Follows::kUnknown));
    const double resolution = resolution_of(worst_sd_ppm_);
    if (resolution > kResolutionPpm && longest_s_ > 0) {
      const double needed_s = longest_s_ * std::pow(resolution / kResolutionPpm, 2.0 / 3);
      text += fmt::format(
          "; periods are known to {} ppm, but {:.0f} ppm are needed because free-running "
          "cameras differ by tens: record about {:.0f} s",
          ppm_text(resolution), kResolutionPpm, std::ceil(needed_s));
    }
    if (count(Follows::kTrigger) > 0) {
      text += fmt::format("; the other {} have one frame period", count(Follows::kTrigger));
    }
    return text;
  }

  std::span<const GroupMember> members_;
  std::optional<double> expected_period_ms_;
  double common_ms_ = 0;
  double worst_sd_ppm_ = 0;
  double longest_s_ = 0;
  std::vector<Candidate> candidates_;
  std::vector<std::size_t> in_standard_;  // members, ascending
  double standard_period_ms_ = 0;
  double standard_sd_ppm_ = 0;
  double zero_phase_ms_ = 0;
};

}  // namespace

GroupVerdict judge_group(std::string stream, std::span<const GroupMember> members,
                         std::optional<double> expected_period_ms) {
  GroupVerdict verdict = Group(members, expected_period_ms).judge();
  verdict.stream = std::move(stream);
  return verdict;
}

}  // namespace simbench::evaluation
