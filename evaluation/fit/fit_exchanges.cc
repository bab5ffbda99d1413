#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "evaluation/fit/fit.h"
#include "evaluation/statistics/statistics.h"
#include "recording/collected.h"

namespace simbench::evaluation {
namespace {

// One round trip between a host and the master, in ns; times of the host's steady clock.
struct RoundTrip {
  double at_ns;
  double trip_ns;
  double offset_ns;         // master's steady clock less the host's, up to a constant
  double system_offset_ns;  // host's system clock less the master's
  bool before_settings;
};

// The last setting of each clock, to undo the settings.
class Settings {
 public:
  // The first adjustment of a host begins the log and changes nothing.
  void add(const ClockAdjustment& adjustment) {
    const bool is_first = !last_.contains(adjustment.host);
    last_[adjustment.host] = adjustment;
    if (!is_first) set_.insert(adjustment.host);
  }
  bool has_set(std::uint32_t host) const { return set_.contains(host); }

  // Returns the host's steady time at its system time; nothing before the last setting.
  std::optional<double> steady_ns(std::uint32_t host, HostTime time) const {
    const auto found = last_.find(host);
    if (found == last_.end()) return std::nullopt;
    const ClockAdjustment& setting = found->second;
    const double since_ns =
        static_cast<double>((time - setting.after).count()) / (1 + setting.rate_ppb * 1e-9);
    if (since_ns < 0) return std::nullopt;
    return static_cast<double>(setting.at.time_since_epoch().count()) + since_ns;
  }

 private:
  std::map<std::uint32_t, ClockAdjustment> last_;
  std::set<std::uint32_t> set_;
};

bool is_complete(const Exchange& e) { return e.t1 && e.t2 && e.t3 && e.t4; }

std::optional<RoundTrip> round_trip(const ExchangeEvent& event, const Settings& settings) {
  const Exchange& e = event.exchange;
  if (!is_complete(e)) return std::nullopt;
  const auto t1 = settings.steady_ns(event.host, *e.t1);
  const auto t4 = settings.steady_ns(event.host, *e.t4);
  const auto t2 = settings.steady_ns(e.peer, *e.t2);
  const auto t3 = settings.steady_ns(e.peer, *e.t3);
  if (!t1 || !t2 || !t3 || !t4) return std::nullopt;
  const double trip_ns = (*t4 - *t1) - (*t3 - *t2);
  if (trip_ns <= 0 || *t3 < *t2) return std::nullopt;
  RoundTrip trip{
      .at_ns = (*t1 + *t4) / 2,
      .trip_ns = trip_ns,
      .offset_ns = ((*t2 - *t1) + (*t3 - *t4)) / 2,
      .system_offset_ns = -static_cast<double>(((*e.t2 - *e.t1) + (*e.t3 - *e.t4)).count()) / 2,
      .before_settings = !settings.has_set(event.host) && !settings.has_set(e.peer)};
  if (event.host == 0) {  // the master sent the request
    trip.offset_ns = -trip.offset_ns;
    trip.system_offset_ns = -trip.system_offset_ns;
  }
  return trip;
}

std::optional<FittedValue> initial_offset_ms(const std::vector<RoundTrip>& trips) {
  const RoundTrip* quickest = nullptr;
  for (const RoundTrip& trip : trips) {
    if (!trip.before_settings) continue;
    if (quickest == nullptr || trip.trip_ns < quickest->trip_ns) quickest = &trip;
  }
  if (quickest == nullptr) return std::nullopt;
  return FittedValue{quickest->system_offset_ns * 1e-6, quickest->trip_ns / 2 * 1e-6};
}

// Returns nothing if the slope is uncertain by more than kLargestErrorPpm.
std::optional<FittedValue> skew_ppm(const std::vector<RoundTrip>& trips) {
  constexpr double kLargestErrorPpm = 5;
  constexpr std::size_t kFewest = 10;
  const std::vector<double> durations = collected(trips, &RoundTrip::trip_ns);
  const double limit_ns = quantile(durations, 0.25);
  std::vector<double> at;
  std::vector<double> offset;
  for (const RoundTrip& trip : trips) {
    if (trip.trip_ns > limit_ns) continue;
    at.push_back(trip.at_ns);
    offset.push_back(trip.offset_ns);
  }
  if (at.size() < kFewest) return std::nullopt;
  const FittedLine line = fit_line(at, offset);
  double spread = 0;
  double squares = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    spread += (at[i] - line.mean_x) * (at[i] - line.mean_x);
    squares += std::pow(offset[i] - line.at(at[i]), 2);
  }
  const double error_ppm = std::sqrt(squares / static_cast<double>(at.size() - 2) / spread) * 1e6;
  if (!(error_ppm <= kLargestErrorPpm)) return std::nullopt;
  return FittedValue{skew_of_slope_ppm(line.slope), error_ppm, static_cast<double>(at.size() - 2)};
}

// The cells of one way, from the least latency on; round trips have twice as many.
constexpr Eigen::Index kCells = 500;

// The middles of two cells i and j add up to the edge between the round trips' cells i + j and i +
// j + 1; their share belongs to i + j.
Eigen::VectorXd shares_of_cells(const std::vector<double>& round_trips, double shortest,
                                double cell) {
  Eigen::VectorXd shares = Eigen::VectorXd::Zero(2 * kCells - 1);
  for (const double trip : round_trips) {
    const double place = std::round((trip - shortest) / cell - 1);
    shares[static_cast<Eigen::Index>(std::clamp(place, 0.0, 2.0 * kCells - 2))] += 1;
  }
  return shares / static_cast<double>(round_trips.size());
}

// One round of expectation and maximisation: divides each round trip among the pairs of ways that
// add up to it, by their probability in `way`.
Eigen::VectorXd expected_shares(const Eigen::VectorXd& way, const Eigen::VectorXd& trips) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(trips.size());
  for (Eigen::Index i = 0; i < kCells; ++i) sums.segment(i, kCells) += way[i] * way;
  sums = (sums.array() > 0).select(trips.array() / sums.array(), 0.0);
  Eigen::VectorXd result(kCells);
  for (Eigen::Index i = 0; i < kCells; ++i) result[i] = way[i] * way.dot(sums.segment(i, kCells));
  return result / result.sum();
}

}  // namespace

std::vector<double> one_way_table(const std::vector<double>& round_trips) {
  constexpr int kRounds = 40;
  constexpr std::size_t kProbabilities = 100;
  const auto [shortest, longest] = std::minmax_element(round_trips.begin(), round_trips.end());
  const double least = *shortest / 2;
  const double cell = (*longest - *shortest) / static_cast<double>(kCells);
  if (cell <= 0) return {least, least};
  const Eigen::VectorXd trips = shares_of_cells(round_trips, *shortest, cell);
  Eigen::VectorXd way = Eigen::VectorXd::Constant(kCells, 1.0 / static_cast<double>(kCells));
  for (int round = 0; round < kRounds; ++round) way = expected_shares(way, trips);

  std::vector<double> table = {least};
  double below = 0;
  Eigen::Index i = 0;
  for (std::size_t step = 1; step < kProbabilities; ++step) {
    const double wanted = static_cast<double>(step) / kProbabilities;
    while (i + 1 < kCells && below + way[i] < wanted) below += way[i++];
    const double within = way[i] > 0 ? std::clamp((wanted - below) / way[i], 0.0, 1.0) : 0.0;
    table.push_back(least + cell * (static_cast<double>(i) + within));
  }
  table.push_back(*longest - least);  // one way was quick, the other slow
  return table;
}

NetworkFit fit_exchanges(const FitInput& input) {
  Settings settings;
  std::map<std::uint32_t, std::vector<RoundTrip>> with_master;
  NetworkFit fit;
  for (const RecordingEvent& event : input.clock_events) {
    if (const auto* set = std::get_if<ClockAdjustment>(&event)) settings.add(*set);
    const auto* exchange = std::get_if<ExchangeEvent>(&event);
    const auto trip = exchange != nullptr ? round_trip(*exchange, settings) : std::nullopt;
    if (!trip) continue;
    fit.round_trips_ms.push_back(trip->trip_ns * 1e-6);
    const std::uint32_t peer = exchange->exchange.peer;
    if (exchange->host == 0 || peer == 0) {
      with_master[std::max(exchange->host, peer)].push_back(*trip);
    }
  }
  if (fit.round_trips_ms.size() >= kFewestExchanges) {
    fit.latency_quantiles_ms = one_way_table(fit.round_trips_ms);
  }
  for (const auto& [host, trips] : with_master) {
    fit.hosts.push_back(
        {.host = host, .initial_offset_ms = initial_offset_ms(trips), .skew_ppm = skew_ppm(trips)});
  }
  return fit;
}

}  // namespace simbench::evaluation
