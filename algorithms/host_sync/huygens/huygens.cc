#include "algorithms/host_sync/huygens/huygens.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <variant>

#include "algorithms/host_sync/huygens/huygens_messages.h"
#include "algorithms/host_sync/huygens/network_effect.h"
#include "algorithms/host_sync/huygens/probe_link.h"
#include "algorithms/host_sync/huygens/raw_clock.h"
#include "algorithms/host_sync/join.h"
#include "algorithms/host_sync/outcome.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

// A line of an older window says nothing of the present one.
constexpr int kWindowsOfALine = 3;
// A point this far from where a rate could lead means that a clock has jumped.
constexpr double kJumpNs = 1e6;
// A slave without a line for so long reports that.
constexpr Nanoseconds kHuygensPatience{30'000'000'000};

Task<void> send_to(Host& host, PeerId peer, Bytes bytes) {
  co_await host.open_channel(peer, Transport::kDatagram).send(std::move(bytes));
}

// What master and slaves do alike: probe, and listen to probes.
class HuygensHost {
 public:
  HuygensHost(Host& host, const HuygensSettings& settings)
      : host_(host), settings_(settings), raw_(host, settings.stamps, settings.steering) {}
  virtual ~HuygensHost() = default;

 protected:
  Host& host() { return host_; }
  const Host& host() const { return host_; }
  const HuygensSettings& settings() const { return settings_; }
  RawClock& raw() { return raw_; }

  void add_link(PeerId peer) { links_.try_emplace(peer, host_, peer, settings_, raw_); }
  std::vector<Task<void>> probing() {
    std::vector<Task<void>> tasks;
    tasks.reserve(links_.size());
    for (auto& [peer, link] : links_) tasks.push_back(link.probe());
    return tasks;
  }

  // The pairs of probes of all peers.
  CodedProbes::Count pairs() const {
    CodedProbes::Count all;
    for (const auto& [peer, link] : links_) {
      all.complete += link.count().complete;
      all.pure += link.count().pure;
    }
    return all;
  }

  // Takes what comes from the peer, for ever.
  Task<void> listen(PeerId peer) {
    MessageChannel& channel = host_.open_channel(peer, Transport::kDatagram);
    while (true) {
      std::optional<ReceivedMessage> received =
          co_await channel.receive(host_.steady_clock().now() + kIdle);
      if (!received) continue;
      const std::optional<std::int64_t> arrived = raw_.arrival(*received);
      const std::optional<HuygensMessage> message = decode_huygens_message(received->bytes);
      if (!message) continue;
      if (const auto* probe = std::get_if<ProbeMessage>(&*message)) {
        // Nearly all messages; few of them have an answer.
        const std::optional<BoundsMessage> bounds = take_probe(peer, *probe, arrived);
        if (!bounds) continue;
        Bytes bytes = encode(*bounds);
        co_await send_to(host_, peer, std::move(bytes));
      } else {
        HuygensMessage taken = *message;
        co_await take(peer, std::move(taken));
      }
    }
  }

  // This host, as a, has found the line of its pair with b.
  virtual Task<void> found(PeerId b, PairLine line) = 0;
  // Messages that are not of a link.
  virtual Task<void> take_other(PeerId peer, HuygensMessage message) = 0;

 private:
  std::optional<BoundsMessage> take_probe(PeerId peer, const ProbeMessage& probe,
                                          std::optional<std::int64_t> arrived) {
    const auto link = links_.find(peer);
    if (link == links_.end() || !arrived) return std::nullopt;
    return link->second.take(probe, *arrived);
  }
  Task<void> take(PeerId peer, HuygensMessage message) {
    if (const auto* bounds = std::get_if<BoundsMessage>(&message)) {
      const auto link = links_.find(peer);
      if (link == links_.end()) co_return;
      const std::optional<PairLine> line = link->second.take(*bounds);
      if (line) co_await found(peer, *line);
    } else {
      co_await take_other(peer, std::move(message));
    }
  }

  Host& host_;
  HuygensSettings settings_;
  RawClock raw_;
  std::map<PeerId, ProbeLink> links_;
};

class HuygensMaster : public HuygensHost {
 public:
  HuygensMaster(Host& host, std::vector<PeerId> slaves, const HuygensSettings& settings)
      : HuygensHost(host, settings), slaves_(std::move(slaves)) {
    hosts_ = 1 + (slaves_.empty() ? 0 : *std::max_element(slaves_.begin(), slaves_.end()));
    const auto uniform = [&host] { return host.random_uniform(); };
    for (const auto& [a, b] : probed_pairs(hosts_, settings.neighbours, uniform)) {
      peers_[a].push_back(b);
      peers_[b].push_back(a);
    }
  }

  Task<void> run() {
    // The slaves report that they lack the stamps too, or that nothing comes.
    if (!raw().lacking().empty()) co_return;
    for (const PeerId peer : peers_[host().id()]) add_link(peer);
    std::vector<Task<void>> tasks = probing();
    tasks.reserve(tasks.size() + slaves_.size() + 2);
    for (const PeerId slave : slaves_) tasks.push_back(listen(slave));
    tasks.push_back(raw().watch());
    tasks.push_back(steer_all());
    co_await join_all(std::move(tasks));
  }

 private:
  struct Seen {
    PairLine line;
    SteadyTime at{};
  };

  Task<void> found(PeerId b, PairLine line) override {
    lines_[{host().id(), b}] = {line, host().steady_clock().now()};
    co_return;
  }

  Task<void> take_other(PeerId peer, HuygensMessage message) override {
    const auto* const found = std::get_if<LineMessage>(&message);
    if (found == nullptr || found->b >= hosts_ || found->b <= peer) co_return;
    lines_[{peer, found->b}] = {found->line, host().steady_clock().now()};
  }

  // Every window: who is to probe whom, to those that have not begun; then a point for each.
  Task<void> steer_all() {
    while (raw().lacking().empty()) {
      for (const PeerId slave : slaves_) {
        if (steered_.contains(slave)) continue;
        Bytes bytes = encode(RosterMessage{peers_[slave]});
        co_await send_to(host(), slave, std::move(bytes));
      }
      co_await host().sleep_for(settings().window);
      if (!raw().system().is_known()) co_await raw().system().look();
      for (const auto& [slave, point] : points()) {
        steered_.insert(slave);
        Bytes bytes = encode(point);
        co_await send_to(host(), slave, std::move(bytes));
      }
    }
  }

  // The lines of the last windows.
  PairLines recent_lines() const {
    const SteadyTime oldest = host().steady_clock().now() - kWindowsOfALine * settings().window;
    PairLines lines;
    for (const auto& [pair, seen] : lines_) {
      if (seen.at >= oldest) lines.emplace(pair, seen.line);
    }
    return lines;
  }

  // The middle of the windows of the lines with the master's own clock.
  static std::optional<std::int64_t> middle_of(const PairLines& lines) {
    std::vector<std::int64_t> middles;
    for (const auto& [pair, line] : lines) {
      if (pair.first == 0) middles.push_back(line.x_ns);
    }
    if (middles.empty()) return std::nullopt;
    std::int64_t sum_ns = 0;
    for (const std::int64_t middle : middles) sum_ns += middle - middles.front();
    return middles.front() + sum_ns / static_cast<std::int64_t>(middles.size());
  }

  std::map<PeerId, SteerMessage> points() {
    const PairLines lines = recent_lines();
    const std::optional<std::int64_t> x_ns = middle_of(lines);
    if (!x_ns) return {};
    const std::optional<SteadyTime> at = raw().steady_at(*x_ns);
    if (!at) return {};
    const HostTime master = raw().system().at(*at);
    const auto leads = loop_corrected_leads(lines, *x_ns, hosts_);
    std::map<PeerId, SteerMessage> result;
    for (const PeerId slave : slaves_) {
      if (leads[slave]) result[slave] = {.raw_ns = *x_ns + *leads[slave], .master = master};
    }
    return result;
  }

  std::vector<PeerId> slaves_;
  std::size_t hosts_ = 1;
  std::map<PeerId, std::vector<PeerId>> peers_;
  std::map<std::pair<PeerId, PeerId>, Seen> lines_;
  std::set<PeerId> steered_;
};

class HuygensSlave : public HuygensHost {
 public:
  HuygensSlave(Host& host, PeerId master, const HuygensSettings& settings)
      : HuygensHost(host, settings),
        master_(master),
        begin_(host.steady_clock().now()),
        outcome_(host) {}

  Task<void> run() {
    const std::optional<RosterMessage> roster = co_await wait_for_roster();
    if (!roster) co_return;
    for (const PeerId peer : roster->peers) {
      if (peer != host().id()) add_link(peer);
    }
    std::vector<Task<void>> tasks = probing();
    tasks.reserve(tasks.size() + roster->peers.size() + 3);
    tasks.push_back(listen(master_));
    for (const PeerId peer : roster->peers) {
      if (peer != master_ && peer != host().id()) tasks.push_back(listen(peer));
    }
    tasks.push_back(raw().watch());
    tasks.push_back(report_failure());
    co_await join_all(std::move(tasks));
  }

 private:
  struct Point {
    SteadyTime at{};
    HostTime master{};
  };

  // Nothing if the host lacks the stamps.
  Task<std::optional<RosterMessage>> wait_for_roster() {
    MessageChannel& channel = host().open_channel(master_, Transport::kDatagram);
    while (true) {
      report_failure_if_due();
      if (!raw().lacking().empty()) co_return std::nullopt;
      std::optional<ReceivedMessage> received =
          co_await channel.receive(host().steady_clock().now() + settings().window);
      if (!received) continue;
      const std::optional<HuygensMessage> message = decode_huygens_message(received->bytes);
      if (!message) continue;
      if (const auto* roster = std::get_if<RosterMessage>(&*message)) co_return *roster;
    }
  }

  Task<void> found(PeerId b, PairLine line) override {
    Bytes bytes = encode(LineMessage{.b = b, .line = line});
    co_await send_to(host(), master_, std::move(bytes));
  }

  Task<void> take_other(PeerId peer, HuygensMessage message) override {
    const auto* const steer = std::get_if<SteerMessage>(&message);
    if (steer == nullptr || peer != master_) co_return;
    const std::optional<SteadyTime> at = raw().steady_at(steer->raw_ns);
    if (!at) co_return;
    const bool is_old = !points_.empty() && *at <= points_.back().at;
    if (is_old) co_return;
    if (has_jumped({*at, steer->master})) points_.clear();
    points_.push_back({*at, steer->master});
    if (points_.size() > settings().points) points_.pop_front();
    co_await raw().system().steer(line());
    outcome_.synchronised(++steered_);
  }

  // Whether no rate that is possible leads to the point.
  bool has_jumped(Point point) const {
    if (points_.empty()) return false;
    const double since_ns = to_ns(point.at - points_.back().at);
    const double off_ns = to_ns(point.master - line().read(point.at));
    return std::abs(off_ns) > kJumpNs + settings().max_rate_ppm * 1e-6 * since_ns;
  }

  // The least-squares line through the points.
  ClockLine line() const {
    const Point last = points_.back();
    LineSums sums(points_.size());
    for (const Point& point : points_) {
      const Nanoseconds since = point.at - last.at;
      sums.add({.x = since.count(), .y = (point.master - last.master - since).count()});
    }
    const Line fit = sums.line();
    const double limit_ppb = settings().max_rate_ppm * 1e3;
    return {.at = last.at,
            .value = last.master + from_ns(fit.at(0)),
            .rate_ppb = std::clamp(fit.slope * 1e9, -limit_ppb, limit_ppb)};
  }

  void report_failure_if_due() {
    if (outcome_.is_reported()) return;
    if (const std::string lacking = raw().lacking(); !lacking.empty()) {
      return outcome_.failed(0, lacking);
    }
    if (host().steady_clock().now() - begin_ < kHuygensPatience) return;
    const std::string no_line = "no line from host " + std::to_string(master_);
    const CodedProbes::Count pairs = this->pairs();
    if (pairs.complete == 0) {
      return outcome_.failed(
          0, no_line + "; is it running and reachable, and do the hosts stamp their messages?");
    }
    outcome_.failed(
        0, no_line + ": " + std::to_string(pairs.pure) + " of " + std::to_string(pairs.complete) +
               " pairs of probes came as far apart as they had left (purity_us); queues "
               "or late stamps parted the others. Take the load off the network, use the "
               "cards' stamps, allow a larger purity_us, or take another host_sync");
  }

  Task<void> report_failure() {
    while (!outcome_.is_reported()) {
      co_await host().sleep_for(settings().window);
      report_failure_if_due();
    }
  }

  PeerId master_;
  SteadyTime begin_;
  std::deque<Point> points_;
  std::uint32_t steered_ = 0;
  OutcomeReport outcome_;
};

}  // namespace

Task<void> serve_huygens(Host& host, std::vector<PeerId> slaves, HuygensSettings settings) {
  HuygensMaster master(host, std::move(slaves), settings);
  co_await master.run();
}

Task<void> follow_huygens(Host& host, PeerId master, HuygensSettings settings) {
  HuygensSlave slave(host, master, settings);
  co_await slave.run();
}

namespace {

const char* const kHuygensPaper = "Geng et al., NSDI 2018";

}  // namespace

void HuygensSettings::bind(ParameterBinder& parameters) {
  bind_warm_up(parameters, service_time);
  parameters.number("neighbours", neighbours, 2, 100, "hosts that each host probes, on average",
                    kHuygensPaper);
  parameters.number("probe_interval_ms", probe_interval, 0.1, 1e6,
                    "pace of the pairs of probes to each peer",
                    "assumption: fifty pairs in a window");
  parameters.number("spacing_us", spacing, 0, 1e6, "time between the two probes of a pair",
                    "assumption: longer than an interrupt is held back");
  parameters.number("purity_us", purity, 0, 1e6,
                    "how much their spacing may change on the way in a pure pair",
                    "assumption: some times the noise of a stamp");
  parameters.number("window_s", window, 0.1, 1e4, "span of the probes of a line", kHuygensPaper);
  parameters.number("points", points, 1, 1e3,
                    "windows whose corrected leads the clock is steered by",
                    "assumption: 16 s, short against the wander of a quartz");
  parameters.number("max_rate_ppm", max_rate_ppm, 1, 5e3, "largest rate between two hosts",
                    "the limit of adjtimex(2)");
  steering.bind(parameters);
  bind_software_stamps(parameters, stamps);
}

namespace {

HostSyncEntry huygens(std::string name, std::string summary, HuygensSettings settings) {
  return with_settings<HostSyncEntry>({.name = std::move(name),
                                       .family = "huygens",
                                       .summary = std::move(summary),
                                       .source = kHuygensPaper,
                                       .needs = needs_of(settings.stamps)},
                                      settings, kMake<Huygens>);
}

}  // namespace

std::vector<HostSyncEntry> host_sync_huygens() {
  return {
      huygens("huygens_software",
              "Huygens with software stamps: coded probes of all pairs, corrected around loops",
              {}),
      huygens("huygens_hardware",
              "Huygens with the network cards' stamps, on their clocks left to themselves",
              {.stamps = StampSource::kCard, .purity = from_us(0.1)}),
  };
}

}  // namespace simbench
