// Nagle's algorithm on the streams of the network; the rest of it is in network.cc.
#include <algorithm>
#include <utility>

#include "sim/network/network.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kAckDraws("network: acknowledgement");

}  // namespace

void Network::on_segment_delivered(PathId path_id) {
  NagleState& nagle = *paths_[path_id].nagle;
  ++nagle.delivered;
  if (nagle.owes_ack || parameters_.delayed_ack_ms == 0) {
    acknowledge(path_id);
    return;
  }
  nagle.owes_ack = true;
  nagle.ack_due = engine_.now() + from_ms(parameters_.delayed_ack_ms);
  engine_.schedule(nagle.ack_due, handler_id_, kAckDue, path_id);
}

void Network::acknowledge(PathId path_id) {
  NagleState& nagle = *paths_[path_id].nagle;
  Path& way_back = paths_[path_id ^ 1];
  nagle.owes_ack = false;
  RandomStream draw(run_seed_, kAckDraws, direction_of(way_back.from, way_back.to), nagle.acks++);
  TrueTime left = engine_.now();
  TrueTime arrival = left + way_back.latency.draw(draw, left);
  double timeout_ms = parameters_.retransmit_timeout_ms;
  for (int losses = 0; losses < kMaxRetransmissions && is_cut(way_back, left, arrival);
       ++losses, timeout_ms *= 2) {
    left += from_ms(timeout_ms);
    arrival += from_ms(timeout_ms);
  }
  nagle.last_ack = std::max(nagle.last_ack, arrival);
  nagle.acks_on_the_way.push_back(nagle.delivered);
  engine_.schedule(nagle.last_ack, handler_id_, kAckArrival, path_id);
}

void Network::on_ack(PathId path_id) {
  NagleState& nagle = *paths_[path_id].nagle;
  nagle.acknowledged = nagle.acks_on_the_way.front();
  nagle.acks_on_the_way.pop_front();
  if (nagle.acknowledged == nagle.sent && !nagle.waiting.messages.empty()) {
    send_segment(std::exchange(nagle.waiting, {}));
  }
}

}  // namespace simbench::sim
