#include "evaluation/scoring/session_scores.h"

#include <variant>
#include <vector>

#include "evaluation/statistics/statistics.h"
#include "laws/saturate.h"

namespace simbench::evaluation {
namespace {

// Stamps of a recording may be anything.
double time_between_ms(HostTime begin, HostTime end) {
  return to_double(Int128{nanoseconds_of(end)} - nanoseconds_of(begin)) * 1e-6;
}

}  // namespace

void SessionScores::add(const RecordingEvent& event) {
  if (const auto* delays = std::get_if<SessionDelays>(&event)) {
    if (delays->slave < slaves_.size()) slaves_[delays->slave].last = *delays;
  } else if (const auto* exchange = std::get_if<ExchangeEvent>(&event)) {
    const Exchange& found = exchange->exchange;
    if (exchange->host != 0 || found.peer >= slaves_.size() || !found.t1 || !found.t4) return;
    slaves_[found.peer].round_trip_ms = time_between_ms(*found.t1, *found.t4);
  }
}

void SessionScores::add_to(SeedScore& score) const {
  std::vector<double> messages_ms;
  for (const Slave& slave : slaves_) {
    if (!slave.last) continue;
    const SessionDelays& last = *slave.last;
    score.sessions.push_back(last);
    messages_ms.push_back((slave.round_trip_ms - to_ms(last.get) - to_ms(last.set)) / 2);
  }
  const auto mean_ms = [&score](Nanoseconds SessionDelays::*delay) {
    std::vector<double> all;
    for (const SessionDelays& session : score.sessions) all.push_back(to_ms(session.*delay));
    return mean_of_existing(all);
  };
  std::vector<double> passes;
  for (const SessionDelays& session : score.sessions) passes.push_back(session.pass);
  score.t_l_ms = mean_ms(&SessionDelays::t_l);
  score.t_t_ms = mean_ms(&SessionDelays::t_t);
  score.t_d_ms = mean_ms(&SessionDelays::t_d);
  score.session_passes = mean_of_existing(passes);
  score.get_time_ms = mean_ms(&SessionDelays::get);
  score.set_time_ms = mean_ms(&SessionDelays::set);
  score.message_time_ms = mean_of_existing(messages_ms);
}

}  // namespace simbench::evaluation
