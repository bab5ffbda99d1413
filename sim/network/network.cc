#include "sim/network/network.h"

#include <algorithm>
#include <utility>

#include "algorithms/ports/assert.h"
#include "scenarios/network_laws.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kDatagramDraws("network: datagram");
constexpr ComponentKey kStreamDraws("network: stream");
constexpr ComponentKey kAlignmentDraws("network: capture alignment");
constexpr ComponentKey kBufferDraws("network: full buffers");
constexpr ComponentKey kAckDraws("network: acknowledgement");
constexpr ComponentKey kGroupCellDraws("network: message to a group in the cell");

KeyedStreams draws_of(std::uint64_t run_seed, Transport kind) {
  if (kind == Transport::kAlignment) return KeyedStreams(run_seed, kAlignmentDraws);
  return KeyedStreams(run_seed, kind == Transport::kDatagram ? kDatagramDraws : kStreamDraws);
}

// The buffers of the sending program are bounded.
constexpr Nanoseconds kMaxCaptureBacklog = std::chrono::seconds(1);

}  // namespace

SimNetwork::Path::Path(const SimNetwork& network, PeerId from_host, PeerId to_host, Transport kind)
    : from(from_host),
      to(to_host),
      transport(kind),
      draws(draws_of(network.run_seed_, kind).of(direction_of(from, to))),
      latency(network.parameters_, network.run_seed_, from, to,
              network.load_.session(from, to).latency_ms) {
  if (network.parameters_.nagle && transport == Transport::kStream) {
    nagle.emplace(from_ms(network.parameters_.delayed_ack_ms));
  }
}

SimNetwork::SimNetwork(Engine& engine, const scenarios::Network& parameters, std::uint64_t run_seed,
                       std::size_t hosts, const RunLoad& load, const Outages& outages)
    : engine_(engine),
      parameters_(parameters),
      datagram_law_(scenarios::datagram_law(parameters)),
      run_seed_(run_seed),
      load_(load),
      outages_(outages),
      switch_clock_(parameters, run_seed),
      rate_(parameters.bandwidth_mbit_per_s),
      handler_id_(engine.attach(*this)),
      host_ports_(hosts),
      switch_ports_(hosts) {
  if (parameters.wifi) {
    // Segments and messages to groups have numbers of their own.
    cell_ = std::make_unique<WifiCell>(
        engine, *parameters.wifi, run_seed, hosts, [this](std::uint32_t ticket, bool is_lost) {
          const std::uint32_t id = ticket / 2;
          ticket % 2 == 0 ? leave_cell(id, is_lost) : leave_cell_as_group(id, is_lost);
        });
  }
  const std::vector<std::int64_t>& switches = parameters.switch_of_host;
  if (switches.empty()) return;
  trunk_ports_.resize(2 * static_cast<std::size_t>(*std::ranges::max_element(switches)) + 2);
}

PathId SimNetwork::open(PeerId from, PeerId to, Transport transport, Endpoint& endpoint) {
  SIMBENCH_ASSERT(from != to && std::max(from, to) < host_ports_.size(), "no such link");
  auto& ids = path_ids_[static_cast<std::size_t>(transport)];
  const auto [found, is_new] =
      ids.try_emplace(direction_of(from, to), static_cast<PathId>(paths_.size()));
  const PathId path = found->second;
  if (is_new) {
    ids.emplace(direction_of(to, from), path + 1);
    paths_.push_back(std::make_unique<Path>(*this, from, to, transport));
    paths_.push_back(std::make_unique<Path>(*this, to, from, transport));
  }
  path_of(path).sender = &endpoint;
  path_of(path ^ 1).receiver = &endpoint;
  return path;
}

void SimNetwork::send(PathId path_id, MessageId id, Bytes message,
                      std::optional<double> bytes_on_wire) {
  Path& path = path_of(path_id);
  if (path.nagle) {
    std::optional<Segment> segment = path.nagle->add(path_id, id, std::move(message));
    if (segment) send_segment(*std::move(segment));
    return;
  }
  const auto size = static_cast<double>(message.size());
  Segment segment{.path = path_id, .first = id, .bytes = bytes_on_wire.value_or(size)};
  segment.messages.push_back(std::move(message));
  send_segment(std::move(segment));
}

void SimNetwork::send_segment(Segment&& segment) {
  const PathId path_id = segment.path;
  Path& path = path_of(path_id);
  const MessageId first = segment.first;
  if (catch_up_) catch_up_();
  const bool wireless = is_wireless(path.from, path.to);
  const HostDeparture departure =
      leave_host(path.from, passes_port(path.from, wireless), path.sender->to_card(first), segment);
  const TrueTime passed = departure.passed;
  segment.left = engine_.now();
  segment.at_switch = passed;
  segment.switch_number = switch_of(path.from);
  const std::size_t count = segment.messages.size();
  const SegmentId id = keep(std::move(segment));
  if (path.nagle) {
    path.nagle->on_left();
    // An acknowledgement that the sender owes leaves with its data.
    if (path_of(path_id ^ 1).nagle->owes_ack()) acknowledge(path_id ^ 1);
  }
  if (wireless) {
    engine_.schedule(passed, handler_id_, kAtCell, id);
  } else if (rate_.is_infinite()) {
    travel(id, passed);
  } else {
    engine_.schedule(passed, handler_id_, kAtSwitch, id);
  }
  path.sender->on_left(first, count, departure);
}

HostDeparture SimNetwork::leave_host(PeerId from, bool passes_a_port, Nanoseconds to_card,
                                     const Segment& segment) {
  const TrueTime now = engine_.now();
  const HostWait wait = traffic_ == nullptr ? HostWait{} : traffic_->at_host(from, now);
  const TrueTime stamped = now + wait.in_queue;
  // What is before it in the ring leaves while it is on its way to the card.
  const TrueTime at_card = stamped + std::max(to_card, wait.in_ring);
  return {
      .stamped = stamped,
      .passed = passes_a_port ? host_ports_[from].pass(at_card, on_the_line(segment)) : at_card};
}

bool SimNetwork::is_dropped(const TrafficPassage& traffic, const Segment& segment) const {
  if (traffic.loss_share <= 0) return false;
  const Path& path = path_of(segment.path);
  RandomStream draw = KeyedStreams(run_seed_, kBufferDraws)
                          .of(direction_of(path.from, path.to))
                          .of(segment.first)
                          .stream(static_cast<std::uint64_t>(segment.switch_number));
  return draw.chance(traffic.loss_share);
}

void SimNetwork::drop(SegmentId id) {
  report(segments_[id], std::nullopt);
  release(id);
}

void SimNetwork::send_to_group(PeerId from, MessageId id, std::vector<Recipient> recipients,
                               Bytes message, Endpoint& sender,
                               std::optional<double> bytes_on_wire) {
  const auto size = static_cast<double>(message.size());
  Segment segment{.first = id, .bytes = bytes_on_wire.value_or(size)};
  if (catch_up_) catch_up_();
  const bool wireless = is_wireless(from, recipients);
  const HostDeparture departure =
      leave_host(from, passes_port(from, wireless), sender.to_card(id), segment);
  const TrueTime passed = departure.passed;
  segment.left = engine_.now();
  segment.at_switch = passed;
  segment.switch_number = switch_of(from);
  segment.messages.push_back(std::move(message));
  GroupMessage to_all{std::move(segment), std::move(recipients)};
  if (wireless) {
    forward(std::move(to_all), passed, kGroupAtCell);
  } else if (rate_.is_infinite()) {
    replicate(to_all, passed);
  } else {
    forward(std::move(to_all), passed);
  }
  sender.on_left(id, 1, departure);
}

void SimNetwork::replicate(const GroupMessage& message, TrueTime at) {
  const std::int64_t here = message.segment.switch_number;
  const Nanoseconds duration = on_the_line(message.segment);
  bool is_counted = message.segment.is_counted;
  GroupMessage down{message.segment, {}};
  GroupMessage up{message.segment, {}};
  for (const Recipient& recipient : message.recipients) {
    const PeerId to = path_of(recipient.path).to;
    if (!rate_.is_infinite() && switch_of(to) != here) {
      (switch_of(to) > here ? up : down).recipients.push_back(recipient);
      continue;
    }
    Segment copy = message.segment;
    copy.path = recipient.path;
    copy.first = recipient.id;
    copy.is_counted = std::exchange(is_counted, false);
    const TrafficPassage traffic = traffic_at(to, at);
    const bool is_lost = is_dropped(traffic, copy);
    const SegmentId id = keep(std::move(copy));
    if (is_lost) {
      drop(id);
    } else {
      travel(id, rate_.is_infinite() ? at : pass_behind(traffic, switch_ports_[to], at, duration));
    }
  }
  down.segment.switch_number = here - 1;
  up.segment.switch_number = here + 1;
  const auto ports = 2 * static_cast<std::size_t>(here);
  if (!down.recipients.empty()) {
    down.segment.is_counted = std::exchange(is_counted, false);
    const TrafficPassage traffic = traffic_at_trunk(here, false, at);
    forward(std::move(down), pass_behind(traffic, trunk_ports_[ports], at, duration));
  }
  if (!up.recipients.empty()) {
    up.segment.is_counted = is_counted;
    const TrafficPassage traffic = traffic_at_trunk(here, true, at);
    forward(std::move(up), pass_behind(traffic, trunk_ports_[ports + 1], at, duration));
  }
}

void SimNetwork::forward(GroupMessage message, TrueTime at, EventKind where) {
  const std::uint32_t id = group_messages_.add();
  group_messages_[id] = std::move(message);
  engine_.schedule(at, handler_id_, where, id);
}

bool SimNetwork::is_wireless(PeerId from, const std::vector<Recipient>& recipients) const {
  if (cell_ == nullptr) return false;
  return std::ranges::any_of(recipients, [this, from](const Recipient& recipient) {
    return is_wireless(from, path_of(recipient.path).to);
  });
}

void SimNetwork::enter_cell(SegmentId id) {
  const Segment& segment = segments_[id];
  const Path& path = path_of(segment.path);
  const bool is_up = cell_->is_station(path.from) && !segment.is_at_access_point;
  const bool is_stream = path.transport == Transport::kStream;
  cell_->send({.ticket = 2 * id,
               .station = is_up ? path.from : path.to,
               .is_up = is_up,
               .bytes = segment.bytes + parameters_.overhead_bytes,
               .retransmissions = is_stream ? kMaxRetransmissions : 0,
               .timeout_ms = parameters_.retransmit_timeout_ms,
               .in_order = segment.path},
              path.draws.of(segment.first).stream(is_up ? 0 : 1));
}

void SimNetwork::leave_cell(SegmentId id, bool is_lost) {
  Segment& segment = segments_[id];
  Path& path = path_of(segment.path);
  if (is_lost) {
    path.is_broken = path.transport == Transport::kStream;
    report(segment, std::nullopt);
    release(id);
    return;
  }
  const bool is_at_end = segment.is_at_access_point || !cell_->is_station(path.from);
  segment.is_at_access_point = true;
  if (!is_at_end && cell_->is_station(path.to)) return enter_cell(id);
  const TrueTime now = engine_.now();
  travel(id,
         passes_port(path.to, true) ? switch_ports_[path.to].pass(now, on_the_line(segment)) : now);
}

Segment SimNetwork::copy_for(const Recipient& recipient, GroupMessage& message) {
  Segment copy = message.segment;
  copy.path = recipient.path;
  copy.first = recipient.id;
  message.segment.is_counted = false;
  return copy;
}

void SimNetwork::enter_cell_as_group(std::uint32_t id) {
  GroupMessage& message = group_messages_[id];
  const PeerId from = path_of(message.recipients.front().path).from;
  const bool is_up = cell_->is_station(from) && !message.segment.is_at_access_point;
  WifiHop hop{.ticket = 2 * id + 1,
              .station = from,
              .is_up = is_up,
              .is_group = !is_up,
              .bytes = message.segment.bytes + parameters_.overhead_bytes};
  if (!is_up) {
    // Those without a radio have it from the access point's switch.
    const TrueTime now = engine_.now();
    std::erase_if(message.recipients, [&](const Recipient& recipient) {
      const PeerId to = path_of(recipient.path).to;
      if (cell_->is_station(to)) return false;
      const TrueTime at =
          passes_port(to, true) ? switch_ports_[to].pass(now, on_the_line(message.segment)) : now;
      travel(keep(copy_for(recipient, message)), at);
      return true;
    });
    if (message.recipients.empty()) return group_messages_.release(id);
  }
  const KeyedStreams draws =
      KeyedStreams(run_seed_, kGroupCellDraws).of(direction_of(from, Groups::kEveryone));
  cell_->send(hop, draws.of(message.segment.first).stream(is_up ? 0 : 1));
}

void SimNetwork::leave_cell_as_group(std::uint32_t id, bool is_lost) {
  GroupMessage& message = group_messages_[id];
  const PeerId from = path_of(message.recipients.front().path).from;
  const bool is_up = cell_->is_station(from) && !message.segment.is_at_access_point;
  if (is_up && !is_lost) {
    message.segment.is_at_access_point = true;
    return enter_cell_as_group(id);
  }
  for (const Recipient& recipient : message.recipients) {
    Segment copy = copy_for(recipient, message);
    if (is_lost) {
      report(copy, std::nullopt);
    } else {
      travel(keep(std::move(copy)), engine_.now());
    }
  }
  group_messages_.release(id);
}

void SimNetwork::send_capture_traffic(PeerId from, double bytes, TrueTime at) {
  if (rate_.is_infinite() || outages_.unreachable(from, at)) return;
  Port& port = host_ports_[from];
  if (port.backlog(at) > kMaxCaptureBacklog) return;
  port.pass(at, rate_.duration(bytes));
}

void SimNetwork::handle(Event event) {
  switch (static_cast<EventKind>(event.kind)) {
    case kAtSwitch:
      pass_switch(event.subject, event.time);
      break;
    case kGroupAtSwitch:
      group_messages_.release(event.subject);
      replicate(std::exchange(group_messages_[event.subject], {}), event.time);
      break;
    case kAtCell:
      enter_cell(event.subject);
      break;
    case kGroupAtCell:
      enter_cell_as_group(event.subject);
      break;
    case kArrival:
      arrive(event.subject);
      break;
    case kAckDue:
      if (path_of(event.subject).nagle->is_ack_due(event.time)) acknowledge(event.subject);
      break;
    case kAckArrival: {
      std::optional<Segment> segment = path_of(event.subject).nagle->on_ack();
      if (segment) send_segment(*std::move(segment));
      break;
    }
  }
}

void SimNetwork::pass_switch(SegmentId id, TrueTime at) {
  Segment& segment = segments_[id];
  const Path& path = path_of(segment.path);
  const Nanoseconds duration = on_the_line(segment);
  const std::int64_t here = segment.switch_number;
  const bool is_last = here == switch_of(path.to);
  const bool is_up = switch_of(path.to) > here;
  const TrafficPassage traffic =
      is_last ? traffic_at(path.to, at) : traffic_at_trunk(here, is_up, at);
  if (is_dropped(traffic, segment)) {
    if (path.transport != Transport::kStream) return drop(id);
    segment.sent_again_after += from_ms(parameters_.retransmit_timeout_ms);
  }
  if (is_last) {
    travel(id, pass_behind(traffic, switch_ports_[path.to], at, duration));
    return;
  }
  const auto port = 2 * static_cast<std::size_t>(here) + (is_up ? 1 : 0);
  segment.switch_number += is_up ? 1 : -1;
  engine_.schedule(pass_behind(traffic, trunk_ports_[port], at, duration), handler_id_, kAtSwitch,
                   id);
}

void SimNetwork::travel(SegmentId id, TrueTime at) {
  if (path_of(segments_[id].path).transport != Transport::kStream) {
    travel_as_datagram(id, at);
  } else {
    travel_on_stream(id, at);
  }
}

void SimNetwork::travel_as_datagram(SegmentId id, TrueTime at) {
  const Segment& segment = segments_[id];
  Path& path = path_of(segment.path);
  RandomStream draw = path.draws.stream(segment.first);
  const TrueTime arrival = at + path.latency.draw(draw, segment.left);
  TrueTime copy_arrival = arrival;
  DatagramFate fate;
  if (!datagram_law_.is_none()) {
    copy_arrival = at + path.latency.draw(draw, segment.left);
    fate = datagram_law_.draw(draw);
  }
  if (fate.is_lost || outages_.unreachable(path.from, segment.left)) {
    report(segment, std::nullopt);
    release(id);
    return;
  }
  const auto arrives = fate.arrivals(arrival, copy_arrival, path.last_arrival);
  report(segment, outages_.unreachable(path.to, arrives.first) ? std::nullopt
                                                               : std::optional(arrives.first));
  // Before the message itself is corrected.
  const SegmentId duplicate = fate.is_duplicated ? keep(Segment(segment)) : id;
  deliver(id, arrives.first, 0);
  if (fate.is_duplicated) deliver(duplicate, arrives.copy, 1);
}

// Schedules the arrival of a datagram, corrected for its time in the switch.
void SimNetwork::deliver(SegmentId id, TrueTime arrival, std::uint32_t copy) {
  Segment& segment = segments_[id];
  const Path& path = path_of(segment.path);
  Bytes& message = segment.messages.front();
  if (switch_clock_.corrects(message)) {
    const Nanoseconds residence = arrival - segment.at_switch - path.latency.cable();
    switch_clock_.correct(message,
                          {.from = path.from, .to = path.to, .id = segment.first, .copy = copy},
                          residence, arrival);
  }
  engine_.schedule(arrival, handler_id_, kArrival, id);
}

void SimNetwork::travel_on_stream(SegmentId id, TrueTime at) {
  const Segment& segment = segments_[id];
  Path& path = path_of(segment.path);
  RandomStream draw = path.draws.stream(segment.first);
  TrueTime left = segment.left;
  TrueTime arrival = at + path.latency.draw(draw, left) + segment.sent_again_after;
  double timeout_ms = parameters_.retransmit_timeout_ms;
  for (int losses = 0; draw.chance(parameters_.loss_probability) || is_cut(path, left, arrival);
       timeout_ms *= 2) {
    if (++losses > kMaxRetransmissions) path.is_broken = true;
    if (path.is_broken) break;
    left += from_ms(timeout_ms);
    arrival += from_ms(timeout_ms);
  }
  if (path.is_broken) {
    report(segment, std::nullopt);
    release(id);
    return;
  }
  path.last_arrival = std::max(path.last_arrival, arrival);
  report(segment, path.last_arrival);
  engine_.schedule(path.last_arrival, handler_id_, kArrival, id);
}

void SimNetwork::arrive(SegmentId id) {
  Segment segment = release(id);
  Path& path = path_of(segment.path);
  if (path.transport != Transport::kStream && outages_.unreachable(path.to, engine_.now())) {
    return;
  }
  MessageId message_id = segment.first;
  for (Bytes& message : segment.messages) {
    path.inbox.push_back({std::move(message), engine_.now(), message_id++});
  }
  if (path.nagle) {
    const std::optional<TrueTime> due = path.nagle->on_arrival(engine_.now());
    if (due) {
      engine_.schedule(*due, handler_id_, kAckDue, segment.path);
    } else {
      acknowledge(segment.path);
    }
  }
  if (path.receiver != nullptr) path.receiver->on_arrival();
}

void SimNetwork::acknowledge(PathId path_id) {
  Nagle& nagle = *path_of(path_id).nagle;
  Path& way_back = path_of(path_id ^ 1);
  RandomStream draw(run_seed_, kAckDraws, direction_of(way_back.from, way_back.to),
                    nagle.acknowledge());
  TrueTime left = engine_.now();
  TrueTime arrival = left + way_back.latency.draw(draw, left);
  double timeout_ms = parameters_.retransmit_timeout_ms;
  for (int losses = 0; losses < kMaxRetransmissions && is_cut(way_back, left, arrival);
       ++losses, timeout_ms *= 2) {
    left += from_ms(timeout_ms);
    arrival += from_ms(timeout_ms);
  }
  engine_.schedule(nagle.ack_in_order(arrival), handler_id_, kAckArrival, path_id);
}

void SimNetwork::report(const Segment& segment, std::optional<TrueTime> arrival) {
  if (segment.is_counted) messages_ += segment.messages.size();
  if (observer_ == nullptr) return;
  if (catch_up_) catch_up_();
  const Path& path = path_of(segment.path);
  MessageId id = segment.first;
  const bool is_stream = path.transport == Transport::kStream;
  for (const Bytes& message : segment.messages) {
    observer_->on_message(
        {.from = path.from,
         .to = path.to,
         .stream = is_stream,
         .id = id++,
         .bytes = is_stream ? message.size() : static_cast<std::size_t>(segment.bytes),
         .left = segment.left,
         .at_switch = segment.at_switch,
         .arrived = arrival.value_or(TrueTime{}),
         .lost = !arrival,
         .copy = !segment.is_counted});
  }
}

SimNetwork::SegmentId SimNetwork::keep(Segment&& segment) {
  const SegmentId id = segments_.add();
  segments_[id] = std::move(segment);
  return id;
}

Segment SimNetwork::release(SegmentId id) {
  segments_.release(id);
  return std::move(segments_[id]);
}

}  // namespace simbench::sim
