#include "tests/sim/traffic/packet_tcp.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <random>

namespace simbench {
namespace {

constexpr double kNoEvent = std::numeric_limits<double>::infinity();
constexpr double kDataBytes = 1538;
constexpr double kAckBytes = 84;
constexpr double kTimeoutNs = 200e6;
constexpr double kProbeNs = 10e6;
constexpr double kDelayedAckNs = 40e6;
constexpr std::size_t kRing = 1 << 15;
constexpr double kLargestWindow = 16'000;

struct Packet {
  std::uint32_t connection = 0;
  std::uint32_t hop = 0;
  bool is_ack = false;
  std::int64_t number = 0;        // a segment's, or the next expected one
  std::int64_t selective = -1;    // an acknowledgement: the segment that caused it
  std::int64_t transmission = 0;  // of the segment, as a time stamp would tell
};

// Packets on their way, in order of their times.
struct Pipe {
  std::deque<std::pair<double, Packet>> packets;
  double last_ns = 0;
};

// The earliest of a fixed number of times: a tournament.
class EarliestTime {
 public:
  explicit EarliestTime(std::size_t count) {
    while (leaves_ < count) leaves_ *= 2;
    times_.assign(leaves_, kNoEvent);
    winners_.assign(2 * leaves_, 0);
    for (std::size_t i = 0; i < leaves_; ++i) winners_[leaves_ + i] = i;
    for (std::size_t i = leaves_ - 1; i > 0; --i) decide(i);
  }
  void set(std::size_t leaf, double time) {
    times_[leaf] = time;
    for (std::size_t i = (leaves_ + leaf) / 2; i > 0; i /= 2) decide(i);
  }
  std::size_t first() const { return winners_[1]; }
  double time() const { return times_[winners_[1]]; }

 private:
  void decide(std::size_t i) {
    const std::size_t a = winners_[2 * i];
    const std::size_t b = winners_[2 * i + 1];
    winners_[i] = times_[b] < times_[a] ? b : a;
  }
  std::size_t leaves_ = 2;
  std::vector<double> times_;
  std::vector<std::size_t> winners_;
};

struct SentSegment {
  bool is_delivered = false;
  bool is_lost = false;
  std::int64_t transmission = -1;
};

struct Sender {
  double window = 10;
  double threshold = kLargestWindow;
  std::int64_t next = 0;
  std::int64_t unacknowledged = 0;
  std::int64_t transmissions = 0;
  std::int64_t newest_delivered = -1;
  int in_flight = 0;
  std::vector<SentSegment> ring = std::vector<SentSegment>(kRing);
  std::deque<std::pair<std::int64_t, std::int64_t>> in_order;  // transmission, segment
  std::deque<std::int64_t> to_repeat;
  double queued_bytes = 0;  // in the own host
  bool is_window_limited = true;
  bool is_recovering = false;
  std::int64_t recovery_end = 0;
  double recovery_flight = 1;
  double recovery_delivered = 0;
  double recovery_sent = 0;
  double round_trip_ns = 1e6;
  double timer_ns = kNoEvent;
  bool was_probed = false;
  // CUBIC
  double window_max = 0;
  double epoch_ns = -1;
  double k_s = 0;
  double friendly_window = 0;
  SentSegment& at(std::int64_t number) { return ring[static_cast<std::size_t>(number) % kRing]; }
};

struct Receiver {
  std::int64_t expected = 0;
  std::vector<char> has = std::vector<char>(kRing, 0);
  int unacknowledged = 0;
  double ack_due_ns = kNoEvent;
  std::int64_t last_segment = 0;
  std::int64_t last_transmission = 0;
  bool has_hole = false;
  std::int64_t highest = -1;
};

class Simulation {
 public:
  explicit Simulation(const PacketWorld& world)
      : world_(world),
        ports_(world.ports.size()),
        connections_(world.connections.size()),
        pipes_(ports_ + 2 * connections_),
        earliest_(ports_ + 5 * connections_),
        free_ns_(ports_, 0),
        queued_bytes_(ports_, 0),
        arrived_(ports_, 0),
        dropped_(ports_, 0),
        senders_(connections_),
        receivers_(connections_),
        words_(world.seed) {
    for (std::size_t c = 0; c < connections_; ++c) {
      earliest_.set(ports_ + 4 * connections_ + c, world.connections[c].begin_ns);
    }
    result_.delays_ns.resize(ports_);
    result_.reductions.assign(connections_, 0);
    result_.timeouts.assign(connections_, 0);
  }

  PacketResult run(double from_ns, double to_ns, double step_ns) {
    double sample_ns = from_ns;
    while (sample_ns < to_ns) {
      if (earliest_.time() > sample_ns) {
        for (std::size_t p = 0; p < ports_; ++p) {
          result_.delays_ns[p].push_back(std::max(0.0, free_ns_[p] - sample_ns));
        }
        sample_ns += step_ns;
        continue;
      }
      now_ns_ = earliest_.time();
      on_event(earliest_.first());
    }
    for (std::size_t p = 0; p < ports_; ++p) {
      result_.loss_share.push_back(arrived_[p] > 0 ? dropped_[p] / arrived_[p] : 0);
    }
    for (const Receiver& receiver : receivers_) {
      result_.segments.push_back(static_cast<double>(receiver.expected));
    }
    return result_;
  }

 private:
  void on_event(std::size_t which) {
    if (which < pipes_.size()) {
      Pipe& pipe = pipes_[which];
      const Packet packet = pipe.packets.front().second;
      pipe.packets.pop_front();
      earliest_.set(which, pipe.packets.empty() ? kNoEvent : pipe.packets.front().first);
      if (which < ports_) {
        queued_bytes_[which] -= packet.is_ack ? kAckBytes : kDataBytes;
        leave_port(packet);
      } else if (packet.is_ack) {
        on_ack(packet);
      } else {
        on_segment(packet);
      }
      return;
    }
    const std::size_t kind = (which - ports_) / connections_;
    const std::size_t c = (which - ports_) % connections_;
    if (kind == 2) send_ack(c, receivers_[c].last_segment, receivers_[c].last_transmission);
    if (kind == 3) on_timer(c);
    if (kind == 4) {
      earliest_.set(which, kNoEvent);
      send_what_may_be(c);
    }
  }

  void put(std::size_t pipe_number, double at_ns, const Packet& packet) {
    Pipe& pipe = pipes_[pipe_number];
    pipe.last_ns = std::max(at_ns, pipe.last_ns);
    pipe.packets.emplace_back(pipe.last_ns, packet);
    if (pipe.packets.size() == 1) earliest_.set(pipe_number, pipe.last_ns);
  }

  double host_delay_ns() {
    return world_.host_delay_max_ns * static_cast<double>(words_() >> 11) * 0x1p-53;
  }

  const std::vector<std::size_t>& way(const Packet& packet) const {
    const PacketConnection& connection = world_.connections[packet.connection];
    return packet.is_ack ? connection.ack_ports : connection.data_ports;
  }

  void enter_port(const Packet& packet) {
    const std::size_t p = way(packet)[packet.hop];
    const PacketPort& port = world_.ports[p];
    const double bytes = packet.is_ack ? kAckBytes : kDataBytes;
    if (!packet.is_ack) ++arrived_[p];
    // A frame takes its room until its last bit is out.
    if (port.buffer_bytes != 0 && queued_bytes_[p] + bytes > port.buffer_bytes) {
      if (!packet.is_ack) ++dropped_[p];
      return;
    }
    queued_bytes_[p] += bytes;
    free_ns_[p] = std::max(free_ns_[p], now_ns_) + bytes * port.ns_per_byte;
    put(p, free_ns_[p], packet);
  }

  void leave_port(Packet packet) {
    const std::uint32_t c = packet.connection;
    if (packet.hop == 0 && !packet.is_ack) {
      senders_[c].queued_bytes -= kDataBytes;
      Packet next = packet;
      ++next.hop;
      go_on(next);
      send_what_may_be(c);
      return;
    }
    ++packet.hop;
    go_on(packet);
  }

  void go_on(const Packet& packet) {
    if (packet.hop < way(packet).size()) {
      enter_port(packet);
    } else {
      put(ports_ + 2 * packet.connection + (packet.is_ack ? 1 : 0),
          now_ns_ + world_.connections[packet.connection].fixed_ns + host_delay_ns(), packet);
    }
  }

  void on_segment(const Packet& packet) {
    const std::size_t c = packet.connection;
    Receiver& receiver = receivers_[c];
    const bool is_in_order = packet.number == receiver.expected && !receiver.has_hole;
    if (packet.number >= receiver.expected) {
      receiver.has[static_cast<std::size_t>(packet.number) % kRing] = 1;
      receiver.highest = std::max(receiver.highest, packet.number);
    }
    while (receiver.has[static_cast<std::size_t>(receiver.expected) % kRing] != 0) {
      receiver.has[static_cast<std::size_t>(receiver.expected) % kRing] = 0;
      ++receiver.expected;
    }
    receiver.has_hole = receiver.highest >= receiver.expected;
    receiver.last_segment = packet.number;
    receiver.last_transmission = packet.transmission;
    if (++receiver.unacknowledged >= 2 || !is_in_order) {
      send_ack(c, packet.number, packet.transmission);
    } else {
      earliest_.set(ports_ + 2 * connections_ + c, now_ns_ + kDelayedAckNs);
    }
  }

  void send_ack(std::size_t c, std::int64_t selective, std::int64_t transmission) {
    Receiver& receiver = receivers_[c];
    receiver.unacknowledged = 0;
    earliest_.set(ports_ + 2 * connections_ + c, kNoEvent);
    enter_port({.connection = static_cast<std::uint32_t>(c),
                .hop = 0,
                .is_ack = true,
                .number = receiver.expected,
                .selective = selective,
                .transmission = transmission});
  }

  // Whether it was new.
  static bool deliver(Sender& sender, std::int64_t number) {
    SentSegment& segment = sender.at(number);
    if (segment.is_delivered) return false;
    segment.is_delivered = true;
    if (!segment.is_lost) --sender.in_flight;
    return true;
  }

  void on_ack(const Packet& packet) {
    const std::size_t c = packet.connection;
    Sender& sender = senders_[c];
    double delivered = 0;
    for (; sender.unacknowledged < packet.number; ++sender.unacknowledged) {
      if (deliver(sender, sender.unacknowledged)) ++delivered;
    }
    if (packet.selective >= sender.unacknowledged && deliver(sender, packet.selective)) ++delivered;
    sender.newest_delivered = std::max(sender.newest_delivered, packet.transmission);
    if (delivered > 0) {
      sender.was_probed = false;
      set_timer(c, now_ns_ + 2 * sender.round_trip_ns + kProbeNs);
    }
    const bool has_lost = find_lost(sender);
    if (sender.is_recovering && sender.unacknowledged >= sender.recovery_end) {
      sender.is_recovering = false;
      sender.window = sender.threshold;
    }
    if (has_lost && !sender.is_recovering) reduce(c);
    if (sender.is_recovering) {
      recover(sender, delivered);
    } else if (sender.is_window_limited) {
      grow(c, delivered);
    }
    send_what_may_be(c);
  }

  static bool find_lost(Sender& sender) {
    const std::int64_t later = sender.in_flight < 5 ? 1 : 3;
    bool has_lost = false;
    while (!sender.in_order.empty() &&
           sender.in_order.front().first + later <= sender.newest_delivered) {
      const auto [transmission, number] = sender.in_order.front();
      sender.in_order.pop_front();
      if (number < sender.unacknowledged) continue;
      SentSegment& segment = sender.at(number);
      if (segment.is_delivered || segment.is_lost || segment.transmission != transmission) continue;
      segment.is_lost = true;
      --sender.in_flight;
      sender.to_repeat.push_back(number);
      has_lost = true;
    }
    return has_lost;
  }

  void reduce(std::size_t c) {
    Sender& sender = senders_[c];
    ++result_.reductions[c];
    const bool is_cubic = world_.connections[c].is_cubic;
    const double beta = is_cubic ? 0.7 : 0.5;
    sender.recovery_flight =
        std::max<double>(1, sender.in_flight + static_cast<double>(sender.to_repeat.size()));
    // RFC 9438 section 4.7, fast convergence.
    sender.window_max =
        sender.window < sender.window_max ? sender.window * (1 + beta) / 2 : sender.window;
    sender.threshold = std::max(2.0, sender.window * beta);
    sender.epoch_ns = -1;
    sender.is_recovering = true;
    sender.recovery_end = sender.next;
    sender.recovery_delivered = 0;
    sender.recovery_sent = 0;
  }

  // RFC 6937, proportional rate reduction.
  static void recover(Sender& sender, double delivered) {
    sender.recovery_delivered += delivered;
    double count = 0;
    if (sender.in_flight > sender.threshold) {
      count = std::ceil(sender.recovery_delivered * sender.threshold / sender.recovery_flight) -
              sender.recovery_sent;
    } else {
      const double limit =
          std::max(sender.recovery_delivered - sender.recovery_sent, delivered) + 1;
      count = std::min(sender.threshold - sender.in_flight, limit);
    }
    if (sender.recovery_sent == 0) count = std::max(count, 1.0);
    sender.window = sender.in_flight + std::max(0.0, count);
  }

  void grow(std::size_t c, double acknowledged) {
    Sender& sender = senders_[c];
    if (sender.window < sender.threshold) {
      sender.window = std::min(sender.window + acknowledged, kLargestWindow);
      return;
    }
    if (!world_.connections[c].is_cubic) {
      sender.window = std::min(sender.window + acknowledged / sender.window, kLargestWindow);
      return;
    }
    if (sender.epoch_ns < 0) {
      sender.epoch_ns = now_ns_;
      sender.window_max = std::max(sender.window_max, sender.window);
      sender.k_s = std::cbrt((sender.window_max - sender.window) / 0.4);
      sender.friendly_window = sender.window;
    }
    sender.friendly_window += 3 * 0.3 / 1.7 * acknowledged / sender.window;
    const double since_s = (now_ns_ - sender.epoch_ns + sender.round_trip_ns) * 1e-9 - sender.k_s;
    const double target = std::clamp(0.4 * since_s * since_s * since_s + sender.window_max,
                                     sender.window, 1.5 * sender.window);
    sender.window += acknowledged * (target - sender.window) / sender.window;
    sender.window = std::min(std::max(sender.window, sender.friendly_window), kLargestWindow);
  }

  void send_what_may_be(std::size_t c) {
    Sender& sender = senders_[c];
    const double limit_bytes = world_.connections[c].connection_bytes;
    while (true) {
      if (sender.in_flight + 1 > sender.window) {
        sender.is_window_limited = true;
        return;
      }
      if (sender.queued_bytes + kDataBytes > limit_bytes) {
        sender.is_window_limited = false;
        return;
      }
      transmit(c);
    }
  }

  void transmit(std::size_t c) {
    Sender& sender = senders_[c];
    while (!sender.to_repeat.empty() && (sender.to_repeat.front() < sender.unacknowledged ||
                                         sender.at(sender.to_repeat.front()).is_delivered)) {
      sender.to_repeat.pop_front();
    }
    std::int64_t number = sender.next;
    if (sender.to_repeat.empty()) {
      ++sender.next;
    } else {
      number = sender.to_repeat.front();
      sender.to_repeat.pop_front();
    }
    const std::int64_t transmission = sender.transmissions++;
    sender.at(number) = {.is_delivered = false, .is_lost = false, .transmission = transmission};
    sender.in_order.emplace_back(transmission, number);
    ++sender.in_flight;
    if (sender.is_recovering) ++sender.recovery_sent;
    sender.queued_bytes += kDataBytes;
    if (sender.timer_ns == kNoEvent) set_timer(c, now_ns_ + 2 * sender.round_trip_ns + kProbeNs);
    enter_port({.connection = static_cast<std::uint32_t>(c),
                .hop = 0,
                .is_ack = false,
                .number = number,
                .selective = -1,
                .transmission = transmission});
  }

  void set_timer(std::size_t c, double at_ns) {
    senders_[c].timer_ns = at_ns;
    earliest_.set(ports_ + 3 * connections_ + c, at_ns);
  }

  // Nothing was acknowledged for long: a probe first, then all is taken as lost.
  void on_timer(std::size_t c) {
    Sender& sender = senders_[c];
    set_timer(c, now_ns_ + kTimeoutNs);
    if (!sender.was_probed) {
      sender.was_probed = true;
      transmit(c);
      return;
    }
    ++result_.timeouts[c];
    sender.threshold = std::max(2.0, sender.window / 2);
    sender.window = 1;
    sender.in_flight = 0;
    sender.is_recovering = false;
    sender.epoch_ns = -1;
    sender.to_repeat.clear();
    for (std::int64_t i = sender.unacknowledged; i < sender.next; ++i) {
      if (sender.at(i).is_delivered) continue;
      sender.at(i).is_lost = true;
      sender.to_repeat.push_back(i);
    }
    send_what_may_be(c);
  }

  const PacketWorld& world_;
  std::size_t ports_;
  std::size_t connections_;
  // The ports', then for each connection of its segments and its acknowledgements.
  std::vector<Pipe> pipes_;
  // The pipes, then acknowledgements that are due, timers and begins of the connections.
  EarliestTime earliest_;
  std::vector<double> free_ns_;
  std::vector<double> queued_bytes_;
  std::vector<double> arrived_;
  std::vector<double> dropped_;
  std::vector<Sender> senders_;
  std::vector<Receiver> receivers_;
  std::mt19937_64 words_;
  double now_ns_ = 0;
  PacketResult result_;
};

}  // namespace

PacketResult run_packets(const PacketWorld& world, double from_s, double to_s, double step_s) {
  return Simulation(world).run(from_s * 1e9, to_s * 1e9, step_s * 1e9);
}

}  // namespace simbench
