#include "evaluation/certificates/certify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "evaluation/certificates/frontier.h"

namespace simbench::evaluation {
namespace {

constexpr std::int64_t kFar = Distances::kFar;
constexpr std::uint32_t kOfNoSet = ~std::uint32_t{0};

std::int64_t sum(std::int64_t a, std::int64_t b) {
  return a >= kFar || b >= kFar ? ClockGraph::kUnbounded.count() : a + b;
}

// A frame of the set that is looked at: how far its two ends are from each point of the frontier.
struct Reach {
  std::vector<std::int64_t> from;  // the point after its least instant, at most
  std::vector<std::int64_t> to;    // its most instant after the point, at most
};

// What the truth says of the frames of a set.
struct TruthMarks {
  explicit TruthMarks(std::size_t frames) : can_be_outside(frames), is_outside(frames) {}

  std::vector<bool> can_be_outside;
  std::vector<bool> is_outside;
};

class Certifier {
 public:
  Certifier(const CaptureEvidence& evidence, const FactOrder& order,
            std::span<const EvidenceSet> sets, Horizon horizon, const PairVisitor& visit)
      : evidence_(evidence),
        order_(order),
        sets_(sets),
        horizon_(horizon),
        visit_(visit),
        past_(order, FrontierWalk::kForward),
        future_(order, FrontierWalk::kBackward),
        frame_points_(evidence.frames().size()),
        frame_of_point_(order.points().size(), kOfNoSet) {
    sort_sets();
    certified_.sets.resize(sets.size());
  }

  CertifiedCapture run() {
    if (!save_futures()) return std::move(certified_);
    for (std::size_t block = 0; block < saved_.size(); ++block) look_at(block);
    return std::move(certified_);
  }

 private:
  std::size_t cut_of(std::size_t set) const {
    std::size_t cut = 0;
    for (const std::size_t frame : sets_[set]) {
      cut = std::max<std::size_t>(cut, order_.points_of(frame).most + 1);
    }
    return cut;
  }

  // By their cuts, in blocks of about the root of their number.
  void sort_sets() {
    std::vector<std::size_t> cuts(sets_.size());
    for (std::size_t set = 0; set < sets_.size(); ++set) {
      cuts[set] = cut_of(set);
      for (const std::size_t frame : sets_[set]) {
        frame_of_point_[order_.points_of(frame).least] = static_cast<std::uint32_t>(frame);
        frame_of_point_[order_.points_of(frame).most] = static_cast<std::uint32_t>(frame);
      }
    }
    by_cut_.resize(sets_.size());
    std::iota(by_cut_.begin(), by_cut_.end(), std::size_t{0});
    std::ranges::stable_sort(by_cut_, {}, [&](std::size_t set) { return cuts[set]; });
    cuts_ = std::move(cuts);
    block_size_ = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(sets_.size()))));
  }

  std::size_t blocks() const {
    return block_size_ == 0 ? 0 : (sets_.size() + block_size_ - 1) / block_size_;
  }
  std::size_t last_of(std::size_t block) const {
    return std::min(sets_.size(), (block + 1) * block_size_) - 1;
  }

  // Walks the whole recording from its end; keeps what each block goes on from. False if the facts
  // contradict each other.
  bool save_futures() {
    saved_.reserve(blocks());
    std::size_t block = blocks();
    const std::size_t points = order_.points().size();
    for (std::size_t first = points; first + 1 > 0; --first) {
      while (block > 0 && cuts_[by_cut_[last_of(block - 1)]] == first) {
        saved_.push_back(future_.save());
        --block;
      }
      if (first == 0) break;
      certified_.contradiction = future_.take_next();
      if (certified_.contradiction) return false;
    }
    std::ranges::reverse(saved_);
    return true;
  }

  void look_at(std::size_t block) {
    const std::size_t first = block * block_size_;
    const std::size_t last = last_of(block);
    std::vector<Frontier> futures(last - first + 1);
    if (horizon_ == Horizon::kWhole) {
      future_.restore(saved_[block]);
      for (std::size_t i = last + 1; i-- > first;) {
        while (future_.taken() < order_.points().size() - cuts_[by_cut_[i]]) {
          (void)future_.take_next();
        }
        futures[i - first] = future_.frontier();
      }
    }
    for (std::size_t i = first; i <= last; ++i) {
      while (past_.next() < cuts_[by_cut_[i]]) take_past();
      look_at_set(by_cut_[i], futures[i - first]);
    }
  }

  // A frame's points are kept until its set has been looked at.
  void take_past() {
    const std::size_t place = past_.next();
    (void)past_.take_next();
    const std::uint32_t frame = frame_of_point_[place];
    if (frame == kOfNoSet) return;
    const ClockGraph::Point point = past_.graph().newest(order_.points()[place].clock);
    past_.graph().keep(point);
    const bool is_least = order_.points_of(frame).least == place;
    (is_least ? frame_points_[frame].least : frame_points_[frame].most) = point;
  }

  void look_at_set(std::size_t set, const Frontier& future) {
    const Frontier past = past_.frontier();
    const Distances joined =
        horizon_ == Horizon::kWhole ? join(order_, past, future) : past.distances;
    const EvidenceSet& frames = sets_[set];
    std::vector<Reach> reaches;
    for (const std::size_t frame : frames) reaches.push_back(reach_of(frame, past, joined));
    SetCertificate& found = certified_.sets[set];
    TruthMarks marks(frames.size());
    bool is_possible = true;
    for (std::size_t a = 0; a < frames.size(); ++a) {
      for (std::size_t b = a + 1; b < frames.size(); ++b) {
        std::optional<PairInterval> pair = interval_of(frames, reaches, a, b);
        const auto& trigger = evidence_.assumptions().trigger;
        if (trigger) pair = narrowed(*pair, *trigger);
        if (!pair) {
          is_possible = false;
          continue;
        }
        judge(set, *pair, marks, found);
      }
    }
    if (!is_possible) ++certified_.impossible_sets;
    found.frames_judged = static_cast<std::size_t>(std::ranges::count(marks.can_be_outside, true));
    found.frames_outside = static_cast<std::size_t>(std::ranges::count(marks.is_outside, true));
    find_weakest(frames, past, joined, reaches, found);
    release(frames);
  }

  void release(const EvidenceSet& frames) {
    for (const std::size_t frame : frames) {
      past_.graph().release(frame_points_[frame].least);
      past_.graph().release(frame_points_[frame].most);
    }
  }

  Reach reach_of(std::size_t frame, const Frontier& past, const Distances& joined) const {
    const std::size_t size = past.places.size();
    Reach reach{std::vector<std::int64_t>(size, ClockGraph::kUnbounded.count()),
                std::vector<std::int64_t>(size, ClockGraph::kUnbounded.count())};
    const FramePoints& points = frame_points_[frame];
    for (std::size_t i = 0; i < size; ++i) {
      const ClockGraph::Point via = past.places[i].point;
      const std::int64_t to_via = past_.graph().most(points.least, via).count();
      const std::int64_t from_via = past_.graph().most(via, points.most).count();
      for (std::size_t j = 0; j < size; ++j) {
        reach.from[j] = std::min(reach.from[j], sum(to_via, joined[i][j]));
        reach.to[j] = std::min(reach.to[j], sum(joined[j][i], from_via));
      }
    }
    return reach;
  }

  std::int64_t most_between(std::size_t from, std::size_t to, const Reach& start,
                            const Reach& end) const {
    std::int64_t most =
        past_.graph().most(frame_points_[from].least, frame_points_[to].most).count();
    for (std::size_t i = 0; i < start.from.size(); ++i) {
      most = std::min(most, sum(start.from[i], end.to[i]));
    }
    return most >= kFar ? ClockGraph::kUnbounded.count() : most;
  }

  PairInterval interval_of(const EvidenceSet& frames, const std::vector<Reach>& reaches,
                           std::size_t a, std::size_t b) const {
    return {a, b,
            Picoseconds(-in_true_time(most_between(frames[b], frames[a], reaches[b], reaches[a]))),
            Picoseconds(in_true_time(most_between(frames[a], frames[b], reaches[a], reaches[b])))};
  }

  // A bound in seconds of host 0, where they count as time, in true ones.
  std::int64_t in_true_time(std::int64_t bound_ps) const {
    const Assumptions& assumed = evidence_.assumptions();
    if (!assumed.observed_margin_ppm || bound_ps >= kFar) return bound_ps;
    const double share = assumed.host_rate_ppm * 1e-6;
    return bound_ps + static_cast<std::int64_t>(
                          std::ceil(std::abs(static_cast<double>(bound_ps)) * share * (1 + share)));
  }

  void judge(std::size_t set, const PairInterval& pair, TruthMarks& marks,
             SetCertificate& found) const {
    if (visit_) visit_(set, pair);
    const auto& first = evidence_.frames()[sets_[set][pair.first]].truth;
    const auto& second = evidence_.frames()[sets_[set][pair.second]].truth;
    std::optional<Nanoseconds> truth;
    if (first && second) {
      truth = *second - *first;
      const auto mark = [&](std::vector<bool>& frames) {
        frames[pair.first] = frames[pair.second] = true;
      };
      if (ClockGraph::is_bounded(pair.most) || ClockGraph::is_bounded(-pair.least)) {
        mark(marks.can_be_outside);
      }
      if (*truth < pair.least || *truth > pair.most) mark(marks.is_outside);
      truth = std::chrono::abs(*truth);
    }
    const Picoseconds apart = std::max(-pair.least, pair.most);
    if (apart <= found.apart) return;
    found.apart = apart;
    found.widest = pair;
    found.truth_apart = truth;
  }

  // Which tie of the widest pair has the widest interval.
  void find_weakest(const EvidenceSet& frames, const Frontier& past, const Distances& joined,
                    const std::vector<Reach>& reaches, SetCertificate& found) const {
    const std::array<std::size_t, 2> ends{found.widest.first, found.widest.second};
    std::array<std::size_t, 2> places{};  // of the hosts' newest points
    std::array<std::uint32_t, 2> hosts{};
    found.weakest.width = Picoseconds(-1);
    const auto offer = [&](LinkKind kind, std::uint32_t first, std::uint32_t second,
                           std::int64_t width) {
      if (Picoseconds(width) <= found.weakest.width) return;
      found.weakest = {kind, first, second, Picoseconds(width)};
    };
    for (std::size_t end = 0; end < 2; ++end) {
      const std::uint32_t camera = evidence_.frames()[frames[ends[end]]].camera;
      hosts[end] = evidence_.layout().cameras[camera].host;
      const auto host = std::ranges::find_if(past.places, [&](const Frontier::Place& place) {
        return !place.is_fact && place.number == hosts[end];
      });
      if (host == past.places.end()) return;  // nothing was heard of the host
      places[end] = static_cast<std::size_t>(host - past.places.begin());
      const Reach& reach = reaches[ends[end]];
      offer(LinkKind::kCamera, camera, hosts[end],
            sum(reach.from[places[end]], reach.to[places[end]]));
    }
    if (hosts[0] == hosts[1]) return;
    offer(LinkKind::kHosts, hosts[0], hosts[1],
          sum(joined[places[0]][places[1]], joined[places[1]][places[0]]));
  }

  const CaptureEvidence& evidence_;
  const FactOrder& order_;
  std::span<const EvidenceSet> sets_;
  Horizon horizon_;
  const PairVisitor& visit_;
  FrontierWalk past_;
  FrontierWalk future_;
  std::vector<FramePoints> frame_points_;  // points of past_.graph(), by frame
  std::vector<std::uint32_t> frame_of_point_;
  std::vector<std::size_t> cuts_;
  std::vector<std::size_t> by_cut_;
  std::size_t block_size_ = 0;
  std::vector<FrontierWalk::Saved> saved_;  // by block
  CertifiedCapture certified_;
};

}  // namespace

CertifiedCapture certify(const CaptureEvidence& evidence, const FactOrder& order,
                         std::span<const EvidenceSet> sets, Horizon horizon,
                         const PairVisitor& visit) {
  return Certifier(evidence, order, sets, horizon, visit).run();
}

std::optional<PairInterval> narrowed(const PairInterval& interval, const CommonTrigger& trigger) {
  if (!ClockGraph::is_bounded(interval.most) || !ClockGraph::is_bounded(-interval.least)) {
    return interval;
  }
  const double spread_ms = trigger.spread_ms;
  const double share = trigger.rate_error_ppm * 1e-6;
  const double least_ms = to_ms(interval.least);
  const double most_ms = to_ms(interval.most);
  // The periods that may lie within, widened so far that rounding leaves none out.
  const double slack = 1 + 2 * share;
  const auto periods = [&](double ms) { return ms / trigger.period_ms * slack; };
  const auto first = static_cast<std::int64_t>(std::floor(periods(least_ms - spread_ms))) - 1;
  const auto last = static_cast<std::int64_t>(std::ceil(periods(most_ms + spread_ms))) + 1;
  std::optional<PairInterval> left;
  const auto part = [&](std::int64_t n) -> std::optional<PairInterval> {
    const double middle = static_cast<double>(n) * trigger.period_ms;
    const double half = spread_ms + std::abs(middle) * share;
    PairInterval found = interval;
    found.least = std::max(
        interval.least, Picoseconds(static_cast<std::int64_t>(std::floor((middle - half) * 1e9))));
    found.most = std::min(interval.most,
                          Picoseconds(static_cast<std::int64_t>(std::ceil((middle + half) * 1e9))));
    if (found.least > found.most) return std::nullopt;
    return found;
  };
  for (std::int64_t n = first; n <= last && !left; ++n) left = part(n);
  for (std::int64_t n = last; left && n >= first; --n) {
    if (const auto high = part(n)) {
      left->most = high->most;
      break;
    }
  }
  return left;
}

}  // namespace simbench::evaluation
