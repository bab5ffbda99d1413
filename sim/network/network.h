// The network of the rig: every host on one switch, messages as datagrams or on streams.
//
// A message that leaves a host's stack reaches its card, passes the host's port to its switch, the
// port of each switch on the way and that to the receiver, each of which serves in order of
// arrival, and then takes the latency of its direction of the link: propagation, the residence in
// the switches, and what the scenario adds. All this lies between the two cards; the way through
// the hosts is theirs (sim/host/message_stack.h). All random numbers of a message are keyed by
// (link, direction, transport, number of the message), so more messages change no other's numbers.
//
// Switches stand in a line (network/switch_of_host); a trunk between two neighbours has a port at
// either end and no length. Foreign frames that load every switch port are not simulated one by
// one: a message waits as a stationary M/D/1 queue lets it, drawn anew for each port.
//
// Datagrams may be lost, duplicated (the copy has a latency of its own) and reordered (delayed
// while others pass); otherwise they keep their order. Streams are in order and complete: a lost
// segment arrives a retransmission timeout later, doubled each time, and delays those behind it.
// After 15 retransmissions the stream is broken and nothing arrives any more.
//
// Under Nagle's algorithm (sim/network/nagle.h) small messages of a stream arrive together, as
// separate messages. Acknowledgements have the latency of their direction and no size; without
// Nagle they change nothing and are not simulated.
//
// In a wireless cell (sim/network/wifi.h) stations have no ports: their messages pass the air
// first, then the access point and the receiver's port or the air again, and then take the latency
// of the link. A broadcast that the cell loses is lost for all stations.
//
// Hosts and links may stop (sim/faults/faults.h): datagrams to or from them are lost, streams
// retransmit. A switch with PTP (sim/network/switch_clock.h) corrects datagrams that are event
// messages for their time in the switch.
//
// A datagram to a group of hosts (sim/network/groups.h) leaves its host once, passes the host's
// port and each trunk once, and is replicated in the switches towards the members' ports. From
// there on each copy is a datagram like others, with a number of its own on its path.
//
// CrossTraffic between hosts (network/traffic; sim/traffic/traffic.h) passes the same ports: a
// message waits in its host's own queue and at each switch port for what is there. Where a buffer
// overflows it may be lost, a datagram for good, a segment of a stream until its timeout.
//
// A message costs the wire its bytes and /network/overhead_bytes, which stand for the heads of
// Ethernet, IP and TCP or UDP and what the line needs between frames. Datagrams of programs state
// what they cost, by their heads (sim/programs/packet.h).
//
// Capture traffic: the frames that a host sends on pass its port like messages, in the order of
// their delivery and each in one piece, towards a storage whose own port is not modelled. Messages
// of the host wait behind it; those to the host do not. A frame that finds more than a second of
// traffic queued is not sent, so that the queue stays bounded.
//
// Links are made when first used: memory grows with the links in use, not with hosts squared.
// Cost: one event per message, two with a bandwidth; no allocation of its own in steady state.
// Source: docs/design.md section 7; docs/reference/calibration.md sections 2 and 5 (H9).
//
//   SimNetwork network(engine, scenario.network, seed, host_count, load, outages);
//   PathId path = network.open(0, 3, Transport::kStream, endpoint);
//   network.send(path, 0, std::move(bytes));  // leaves host 0 now
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "algorithms/ports/host.h"
#include "recording/world_observer.h"
#include "scenarios/scenario.h"
#include "sim/engine/engine.h"
#include "sim/engine/slots.h"
#include "sim/faults/faults.h"
#include "sim/network/groups.h"
#include "sim/network/link_latency.h"
#include "sim/network/load.h"
#include "sim/network/nagle.h"
#include "sim/network/port.h"
#include "sim/network/switch_clock.h"
#include "sim/network/wifi.h"
#include "sim/traffic/traffic.h"

namespace simbench::sim {

// An arrived message that was not received yet.
struct ArrivedMessage {
  Bytes bytes;
  TrueTime at;  // the card
  MessageId id = 0;
  std::optional<TrueTime> stamped{};  // by software, once the receiving host knows when
};
using Inbox = std::deque<ArrivedMessage>;

// When a message left its host: the kernel's stamp, behind the host's own queue, and when its last
// bit passes the card; both now or later.
struct HostDeparture {
  TrueTime stamped;
  TrueTime passed;
};

// One end of a channel, notified at the virtual time of each event.
class Endpoint {
 public:
  virtual ~Endpoint() = default;
  // A message has been added to the inbox.
  virtual void on_arrival() = 0;
  // How long a segment that leaves now, from message `first` on, takes to the card.
  virtual Nanoseconds to_card(MessageId /*first*/) { return Nanoseconds(0); }
  // Messages `first` to `first + count - 1` have left the program.
  virtual void on_left(MessageId first, std::size_t count, const HostDeparture& departure) = 0;
};

class SimNetwork : private EventHandler {
 public:
  // `engine`, `parameters` and `outages` must outlive the network.
  SimNetwork(Engine& engine, const scenarios::Network& parameters, std::uint64_t run_seed,
             std::size_t hosts, const RunLoad& load, const Outages& outages);
  SimNetwork(const SimNetwork&) = delete;
  SimNetwork& operator=(const SimNetwork&) = delete;
  ~SimNetwork() override = default;

  // The path from `from` to `to`. `endpoint` is notified of messages that leave on this path and of
  // those that arrive on the way back; it must outlive the network's events. Messages that arrive
  // before the receiver has opened its end wait in the inbox.
  PathId open(PeerId from, PeerId to, Transport transport, Endpoint& endpoint);

  // Message `id` leaves the host now; ids count from 0 on each path. `bytes_on_wire` is what ports
  // and the air count of a datagram beside overhead_bytes, where that is not its size.
  void send(PathId path, MessageId id, Bytes message,
            std::optional<double> bytes_on_wire = std::nullopt);

  // Where a copy of a message to a group goes, and its number there.
  struct Recipient {
    PathId path = 0;
    MessageId id = 0;
  };
  // Message `id` to a group leaves host `from` now, towards these; `sender` is notified of it
  // alone.
  void send_to_group(PeerId from, MessageId id, std::vector<Recipient> recipients, Bytes message,
                     Endpoint& sender, std::optional<double> bytes_on_wire = std::nullopt);
  Groups& groups() { return groups_; }

  // Notifies `observer`, which must outlive the network's events, of every message when its arrival
  // is known: as it leaves the sender or, with a bandwidth, the sender's port. Duplicates and
  // capture traffic are not reported.
  void observe(WorldObserver& observer) { observer_ = &observer; }

  // The messages of which an observer would have been notified until now.
  std::uint64_t messages() const { return messages_; }

  // `from` sends `bytes` of capture traffic at `at`, not after now, in order of time.
  void send_capture_traffic(PeerId from, double bytes, TrueTime at);
  // Is called before a message comes to a port or is reported: what has to come before it may be
  // made up for then.
  void before_messages(std::function<void()> catch_up) { catch_up_ = std::move(catch_up); }

  // Messages meet this traffic, which must outlive the network's events.
  void meet(CrossTraffic& traffic) { traffic_ = &traffic; }

  // The messages from the peer that have arrived at the host that opened `path`.
  Inbox& inbox(PathId path) { return path_of(path ^ 1).inbox; }

 private:
  using SegmentId = std::uint32_t;
  // The two paths of a link and transport have numbers 2n and 2n + 1.
  struct Path {
    Path(const SimNetwork& network, PeerId from_host, PeerId to_host, Transport kind);

    PeerId from;
    PeerId to;
    Transport transport;
    KeyedStreams draws;  // of its messages
    LinkLatency latency;
    TrueTime last_arrival = TrueTime::min();
    bool is_broken = false;
    Endpoint* sender = nullptr;
    Endpoint* receiver = nullptr;
    Inbox inbox;
    std::optional<Nagle> nagle;  // streams under Nagle's algorithm only
  };
  enum EventKind : std::uint16_t {
    kAtSwitch,
    kArrival,
    kAckDue,
    kAckArrival,
    kGroupAtSwitch,
    kAtCell,
    kGroupAtCell
  };
  // A message to a group on its way to the last switch; its segment has no path yet.
  struct GroupMessage {
    Segment segment;
    std::vector<Recipient> recipients;
  };

  void handle(Event event) override;

  Path& path_of(PathId id) { return *paths_[id]; }
  const Path& path_of(PathId id) const { return *paths_[id]; }

  Nanoseconds on_the_line(const Segment& segment) const {
    return rate_.duration(segment.bytes + parameters_.overhead_bytes);
  }

  // Whether an outage loses a message that leaves and would arrive then.
  bool is_cut(const Path& path, TrueTime left, TrueTime arrival) const {
    return outages_.unreachable(path.from, left) || outages_.unreachable(path.to, arrival);
  }
  std::int64_t switch_of(PeerId host) const {
    return parameters_.switch_of_host.empty() ? 0 : parameters_.switch_of_host[host];
  }
  // The last bit leaves the port of the host's own, for a message that leaves the program now.
  HostDeparture leave_host(PeerId from, bool passes_a_port, Nanoseconds to_card,
                           const Segment& segment);
  // When a message that comes to the port at `at` has passed it.
  TrueTime pass_behind(const TrafficPassage& traffic, Port& port, TrueTime at,
                       Nanoseconds duration) {
    return port.pass(at + traffic.wait, duration);
  }
  TrafficPassage traffic_at(PeerId to, TrueTime at) {
    return traffic_ == nullptr ? TrafficPassage{} : traffic_->at_switch(to, at);
  }
  TrafficPassage traffic_at_trunk(std::int64_t switch_number, bool is_up, TrueTime at) {
    return traffic_ == nullptr
               ? TrafficPassage{}
               : traffic_->at_trunk(static_cast<std::size_t>(switch_number), is_up, at);
  }
  // Whether a full buffer drops the segment at this switch of its way.
  bool is_dropped(const TrafficPassage& traffic, const Segment& segment) const;
  void drop(SegmentId id);
  // The segment, which is at switch `number` of its way, has come to its next port.
  void pass_switch(SegmentId id, TrueTime at);
  // The message, which is at switch `number` of its way, goes to the members' ports there and on to
  // its neighbours.
  void replicate(const GroupMessage& message, TrueTime at);
  // It comes to its next switch, or to the cell, at `at`.
  void forward(GroupMessage message, TrueTime at, EventKind where = kGroupAtSwitch);

  // Whether a message passes the air.
  bool is_wireless(PeerId from, PeerId to) const {
    return cell_ != nullptr && (cell_->is_station(from) || cell_->is_station(to));
  }
  bool is_wireless(PeerId from, const std::vector<Recipient>& recipients) const;
  // Whether it passes a port of that end of its way, which may have a radio in its place.
  bool passes_port(PeerId host, bool is_wireless) const {
    return !rate_.is_infinite() && !(is_wireless && cell_->has_radio(host));
  }
  // The message goes up to the access point or, from there on, down to its station.
  void enter_cell(SegmentId id);
  void enter_cell_as_group(std::uint32_t id);
  // It has passed the cell, up or down, or was lost in it.
  void leave_cell(SegmentId id, bool is_lost);
  void leave_cell_as_group(std::uint32_t id, bool is_lost);
  // The copy for one of the members; the first one counts.
  static Segment copy_for(const Recipient& recipient, GroupMessage& message);

  void deliver(SegmentId id, TrueTime arrival, std::uint32_t copy);
  // Counts the segment's messages and reports to the observer that they arrive then, or never.
  void report(const Segment& segment, std::optional<TrueTime> arrival);

  SegmentId keep(Segment&& segment);
  Segment release(SegmentId id);

  void send_segment(Segment&& segment);
  // The segment is through the switch at `at`.
  void travel(SegmentId id, TrueTime at);
  void travel_as_datagram(SegmentId id, TrueTime at);
  void travel_on_stream(SegmentId id, TrueTime at);
  void arrive(SegmentId id);
  void acknowledge(PathId path);

  Engine& engine_;
  const scenarios::Network& parameters_;
  DatagramLaw datagram_law_;
  std::uint64_t run_seed_;
  RunLoad load_;
  const Outages& outages_;
  WorldObserver* observer_ = nullptr;
  CrossTraffic* traffic_ = nullptr;  // null: none
  std::function<void()> catch_up_;
  std::uint64_t messages_ = 0;
  SwitchClock switch_clock_;
  LineRate rate_;
  HandlerId handler_id_;
  std::vector<Port> host_ports_;
  std::vector<Port> switch_ports_;
  std::unique_ptr<WifiCell> cell_;  // null: all hosts are wired
  std::vector<Port> trunk_ports_;   // of switch s: 2 s towards s - 1, 2 s + 1 towards s + 1
  std::vector<std::unique_ptr<Path>> paths_;
  std::unordered_map<std::uint64_t, PathId> path_ids_[3];  // by transport, then direction
  Slots<Segment> segments_;
  Slots<GroupMessage> group_messages_;
  Groups groups_;
};

}  // namespace simbench::sim
