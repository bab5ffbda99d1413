#include "algorithms/host_sync/two_way/two_way.h"

#include <memory>
#include <string>
#include <utility>

#include "algorithms/host_sync/clock_service.h"
#include "algorithms/host_sync/join.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

// A request this much older than the last one is not late: its sender has started again.
constexpr std::uint32_t kLateRequests = 64;

// When the message left that send(), called at `begin`, has just returned from: by the host's stamp
// if there is one, else now. A stamp before `begin` is of a coarse clock and does not count.
Task<SteadyTime> departure_of(Host& host, MessageChannel& channel, MessageId id, SteadyTime begin,
                              std::shared_ptr<const SteeredClock> clock) {
  const SteadyTime returned = host.steady_clock().now();
  const std::optional<HostTime> stamp =
      co_await channel.transmit_stamp(id, returned + kStampTimeout);
  if (!stamp) co_return returned;
  const SteadyTime departure = clock->when(*stamp);
  co_return departure < begin ? returned : departure;
}

}  // namespace

Task<void> TwoWayServer::answer(ReceivedMessage received) {
  clock_->observe(received.received, received.received_steady);
  const std::optional<TwoWayMessage> request = decode_two_way_message(received.bytes);
  if (!request || request->kind != TwoWayMessage::Kind::kRequest) co_return;
  const bool is_late =
      request->index <= last_index_ && last_index_ - request->index < kLateRequests;
  if (is_late) co_return;
  MessageChannel& channel = host_.open_channel(client_, Transport::kDatagram);
  TwoWayMessage reply{.kind = TwoWayMessage::Kind::kReply,
                      .index = request->index,
                      .arrived = clock_->at(received.received_steady),
                      .replied_index = 0,
                      .replied = {}};
  if (is_naive_) {
    reply.replied_index = reply.index;
    reply.replied = clock_->at(host_.steady_clock().now());
  }
  for (const Departure& departure : departures_) {
    if (departure.index != request->replied_index) continue;
    reply.replied_index = departure.index;
    reply.replied = departure.at;
  }
  Bytes bytes = encode(reply);
  const SteadyTime begin = host_.steady_clock().now();
  const MessageId id = co_await channel.send(std::move(bytes));
  last_index_ = request->index;
  if (is_naive_) co_return;
  const SteadyTime departure = co_await departure_of(host_, channel, id, begin, clock_);
  departures_.push_back({request->index, clock_->at(departure)});
  if (departures_.size() > kDepartures) departures_.pop_front();
}

Task<std::optional<TwoWayExchange>> TwoWayClient::ask(Nanoseconds timeout) {
  MessageChannel& channel = host_.open_channel(server_, Transport::kDatagram);
  present_ = Open{.index = ++index_, .exchange = {}, .t1 = {}, .t4 = {}};
  const SteadyTime begin = host_.steady_clock().now();
  const std::uint32_t wanted = last_ && !is_naive_ ? last_->index : 0;
  Bytes bytes = encode(TwoWayMessage{.index = index_, .replied_index = wanted});
  const MessageId id = co_await channel.send(std::move(bytes));
  SteadyTime sent = begin;
  if (!is_naive_) sent = co_await departure_of(host_, channel, id, begin, clock_);
  present_.exchange.sent = sent;
  while (true) {
    std::optional<ReceivedMessage> received = co_await channel.receive(begin + timeout);
    if (!received) co_return std::nullopt;
    clock_->observe(received->received, received->received_steady);
    const std::optional<TwoWayMessage> reply = decode_two_way_message(received->bytes);
    if (!reply || reply->kind != TwoWayMessage::Kind::kReply || reply->index != index_) continue;
    ++answered_;
    co_return complete(*reply, received->received_steady);
  }
}

std::optional<TwoWayExchange> TwoWayClient::complete(const TwoWayMessage& reply,
                                                     SteadyTime received) {
  present_.exchange.arrived = reply.arrived;
  present_.exchange.received = received;
  present_.t1 = clock_->at(present_.exchange.sent);
  present_.t4 = clock_->at(received);
  std::optional<TwoWayExchange> completed;
  if (reply.replied_index == present_.index) {
    completed = report(present_, reply.replied);
  } else if (last_ && reply.replied_index == last_->index) {
    completed = report(*last_, reply.replied);
  }
  last_ = present_;
  return completed;
}

TwoWayExchange TwoWayClient::report(Open& open, HostTime replied) {
  open.exchange.replied = replied;
  host_.report_exchange({.peer = server_,
                         .t1 = open.t1,
                         .t2 = open.exchange.arrived,
                         .t3 = replied,
                         .t4 = open.t4,
                         .is_estimated = true});
  return open.exchange;
}

namespace {

Task<void> serve_two_way(Host& host, PeerId client, std::shared_ptr<SteeredClock> clock,
                         bool is_naive) {
  TwoWayServer server(host, client, std::move(clock), is_naive);
  MessageChannel& channel = host.open_channel(client, Transport::kDatagram);
  while (true) {
    std::optional<ReceivedMessage> received =
        co_await channel.receive(host.steady_clock().now() + kIdle);
    if (received) co_await server.answer(std::move(*received));
  }
}

}  // namespace

Task<void> TwoWay::run_master(Host& host, std::vector<PeerId> slaves) {
  auto clock = std::make_shared<SteeredClock>(host, settings_.steering);
  std::vector<Task<void>> servers;
  servers.reserve(slaves.size());
  for (const PeerId slave : slaves) {
    servers.push_back(serve_two_way(host, slave, clock, settings_.is_naive));
  }
  co_await join_all(std::move(servers));
}

Task<void> TwoWay::run_slave(Host& host, PeerId master) {
  TwoWaySlave slave(host, master, settings_, make_estimator_());
  co_await slave.run();
}

namespace {

// Part of an interval by which it is varied.
constexpr double kVariation = 0.1;

Nanoseconds varied(Nanoseconds interval, double uniform) {
  const double factor = 1 + kVariation * (2 * uniform - 1);
  return from_ms(to_ms(interval) * factor);
}

}  // namespace

TwoWaySlave::TwoWaySlave(Host& host, PeerId master, TwoWaySettings settings,
                         std::unique_ptr<TwoWayEstimator> estimator)
    : host_(host),
      master_(master),
      settings_(settings),
      clock_(std::make_shared<SteeredClock>(host, settings.steering)),
      client_(host, master, clock_, settings.is_naive),
      estimator_(std::move(estimator)),
      steer_at_(host.steady_clock().now()),
      outcome_(host) {}

Task<ClockLine> TwoWaySlave::refine(ClockLine line) { co_return line; }

Task<void> TwoWaySlave::run() {
  while (true) {
    const SteadyTime begin = host_.steady_clock().now();
    const Nanoseconds interval = co_await turn();
    const Nanoseconds pause = varied(interval, host_.random_uniform());
    const Nanoseconds taken = host_.steady_clock().now() - begin;
    if (pause > taken) co_await host_.sleep_for(pause - taken);
  }
}

Task<Nanoseconds> TwoWaySlave::turn() {
  const std::optional<TwoWayExchange> exchange = co_await client_.ask(TwoWay::kReplyTimeout);
  const bool is_new = exchange && estimator_->add(*exchange);
  const bool is_burst = client_.answered() < settings_.exchanges;
  const SteadyTime now = host_.steady_clock().now();
  const bool is_due = is_new && now >= steer_at_ && !is_burst;
  if (is_due) {
    steer_at_ = now + settings_.steer_interval;
    const ClockLine line = *estimator_->line();
    const ClockLine refined = co_await refine(line);
    co_await clock_->steer(refined);
  }
  if (is_due) {
    outcome_.synchronised(client_.asked());
  } else if (client_.answered() == 0 && client_.asked() == TwoWay::kPatience) {
    outcome_.failed(client_.asked(), "no reply from host " + std::to_string(master_) + " to " +
                                         std::to_string(client_.asked()) +
                                         " requests; is it running and reachable? Still trying");
  }
  if (is_new && settings_.round_pause.count() > 0) co_return settings_.round_pause;
  co_return is_burst ? settings_.burst_interval : settings_.interval;
}

void TwoWaySettings::bind(ParameterBinder& parameters, TwoWayHull::Settings& estimator) {
  bind_warm_up(parameters, service_time);
  parameters.number("exchanges", exchanges, 1, 1e5,
                    "exchanges of the first burst, and of each round whose minimum is taken",
                    kAssumption);
  parameters.number("burst_interval_ms", burst_interval, 0.1, 1e5, "pace of the first burst",
                    kAssumption);
  parameters.number("interval_ms", interval, 0.1, 1e6, "pace after it, also during the capture",
                    "assumption: 240 exchanges in the window");
  parameters.number("window_s", estimator.window, 1, 1e5,
                    "span of the hulls and of the estimate of the rate",
                    "assumption: short against the wander of a quartz");
  parameters.number("max_rate_ppm", estimator.max_rate_ppm, 1, 1e4,
                    "largest rate between two hosts", "the limit of adjtimex(2)");
  steering.bind(parameters);
  steer_interval = steering.settle;
}

namespace {

// The estimator of a registered form: a hull, or a minimum of that kind.
struct TwoWayForm {
  TwoWaySettings two_way;
  TwoWayHull::Settings hull;
  std::optional<TwoWayMinimum::Kind> minimum;

  void bind(ParameterBinder& parameters) { two_way.bind(parameters, hull); }
};

std::unique_ptr<HostSync> make_two_way(const TwoWayForm& form) {
  if (!form.minimum) {
    return std::make_unique<TwoWay>(
        form.two_way, [settings = form.hull] { return std::make_unique<TwoWayHull>(settings); });
  }
  const TwoWayMinimum::Settings settings{.kind = *form.minimum,
                                         .exchanges = form.two_way.exchanges,
                                         .window = form.hull.window,
                                         .max_rate_ppm = form.hull.max_rate_ppm};
  return std::make_unique<TwoWay>(form.two_way,
                                  [settings] { return std::make_unique<TwoWayMinimum>(settings); });
}

HostSyncEntry two_way(std::string name, std::string summary, std::string source,
                      std::optional<TwoWayMinimum::Kind> minimum, bool is_naive) {
  return with_settings<HostSyncEntry>(
      {.name = std::move(name),
       .family = "two_way",
       .summary = std::move(summary),
       .source = std::move(source)},
      TwoWayForm{.two_way = {.is_naive = is_naive}, .hull = {}, .minimum = minimum}, make_two_way);
}

const char* const kSoftwareSync =
    "google-research/libsoftwaresync, SyncConstants.java and SimpleNetworkTimeProtocol.java";

struct SoftwareSync {
  TwoWaySettings two_way{
      .is_naive = true, .exchanges = 0, .interval = from_ms(10), .round_pause = from_seconds(10)};
  std::size_t exchanges = 300;
  Nanoseconds early_stop = from_ms(1);

  void bind(ParameterBinder& parameters) {
    bind_warm_up(parameters, two_way.service_time);
    parameters.number("exchanges", exchanges, 1, 1e5, "most exchanges of a round", kSoftwareSync);
    parameters.number("early_stop_ms", early_stop, 0, 1e5, "a round trip below this ends the round",
                      kSoftwareSync);
    parameters.number("interval_ms", two_way.interval, 0.1, 1e6, "pace within a round",
                      kAssumption);
    parameters.number("round_pause_s", two_way.round_pause, 0.1, 1e6,
                      "time from one round to the next", kAssumption);
    two_way.steering.bind(parameters);
    two_way.steer_interval = Nanoseconds(0);
  }
};

std::unique_ptr<HostSync> make_software_sync(const SoftwareSync& settings) {
  const TwoWayMinimum::Settings minimum{
      .exchanges = settings.exchanges, .early_stop = settings.early_stop, .estimate_rate = false};
  return std::make_unique<TwoWay>(settings.two_way,
                                  [minimum] { return std::make_unique<TwoWayMinimum>(minimum); });
}

}  // namespace

std::vector<HostSyncEntry> host_sync_two_way() {
  const char* const cristian = "Cristian 1989; docs/reference/host_sync.md section 1";
  const char* const hulls = "MOOS, MOOSSkewFilter; TICSync (Harrison and Newman 2011)";
  return {
      two_way("two_way_min_rtt",
              "best of N round trips, stamped on departure, rate over the rounds", cristian,
              TwoWayMinimum::Kind::kRoundTrip, false),
      two_way("two_way_min_rtt_naive", "the same with clocks read before the send calls", cristian,
              TwoWayMinimum::Kind::kRoundTrip, true),
      with_settings<HostSyncEntry>(
          {.name = "libsoftwaresync",
           .family = "libsoftwaresync",
           .summary = "best of up to 300 naive round trips, but stops at the first below 1 ms; "
                      "offset only",
           .source = kSoftwareSync},
          SoftwareSync{}, make_software_sync),
      two_way("two_way_independent_minima",
              "smallest delay of each direction in N exchanges, rate over the rounds",
              "Jeske 2005; Chaudhari 2010", TwoWayMinimum::Kind::kIndependent, false),
      two_way("two_way_hull",
              "mid-line of the widest corridor between the hulls of both directions' bounds", hulls,
              std::nullopt, false),
      two_way("two_way_hull_naive", "the same with clocks read before the send calls", hulls,
              std::nullopt, true),
  };
}

}  // namespace simbench
