#include "python/src/host_requests.h"

#include <algorithm>
#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/deferred.hpp>
#include <boost/asio/experimental/parallel_group.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cstring>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "python/src/binding.h"

namespace simbench::python {
namespace {

namespace asio = boost::asio;

// Times within it can be subtracted.
constexpr std::int64_t kFarthestNs = 4'000'000'000'000'000'000;
constexpr std::int64_t kLongestNs = 86'400 * 365 * kSecondNs;  // of a wait

Bytes bytes_of(const Object& object) {
  const std::string_view held = bytes_in(object.get());
  Bytes bytes(held.size());
  std::memcpy(bytes.data(), held.data(), bytes.size());
  return bytes;
}

[[noreturn]] void throw_value_error(const std::string& text) {
  throw_error(PyExc_ValueError, text);
}

std::int64_t time_ns(const Object& object) {
  const auto ns = object.as<std::int64_t>();
  if (std::abs(ns) <= kFarthestNs) return ns;
  throw_value_error("found " + std::to_string(ns) + " ns, allowed: within 4e18 of 0");
}

std::int64_t interval_ns(const Object& object) {
  return std::clamp<std::int64_t>(object.as<std::int64_t>(), 0, kLongestNs);
}

}  // namespace

HostPort::HostPort(Host& of_run, std::set<PeerId> peers_of_run, Transport datagrams_of_run)
    : host(&of_run), peers(std::move(peers_of_run)), datagrams(datagrams_of_run), outcome(of_run) {
  if (!steers()) return;
  for (FrameControl* const camera : of_run.frame_controls()) cameras.emplace_back(of_run, *camera);
}

Host& HostPort::get() const {
  if (host == nullptr) throw std::runtime_error("the host's run is over");
  return *host;
}

namespace {

// A question and its answer: 24 bytes, then what the algorithm adds, which comes back.
//
//   0   8  index of the question, from 1; 0: the client has done
//   8   8  answer: when the question was received, the server's clock, ns; else 0
//   16  8  answer: the server's clock before the answer was sent, ns; else 0
struct Question {
  std::uint64_t index = 0;
  std::int64_t t2 = 0;
  std::int64_t t3 = 0;
};
static_assert(sizeof(Question) == 24);

// `added`: what follows, from that byte on.
Bytes encoded(const Question& question, const Bytes& added, std::size_t from = 0) {
  Bytes bytes(sizeof question + added.size() - from);
  std::memcpy(bytes.data(), &question, sizeof question);
  std::copy(added.begin() + static_cast<std::ptrdiff_t>(from), added.end(),
            bytes.begin() + std::ptrdiff_t{sizeof question});
  return bytes;
}

std::optional<Question> decoded(const Bytes& bytes) {
  if (bytes.size() < sizeof(Question)) return std::nullopt;
  Question question;
  std::memcpy(&question, bytes.data(), sizeof question);
  return question;
}

// One receive at a time on a channel, and none after the run.
class Receiving {
 public:
  Receiving(SharedPort port, const HostRequest& request)
      : port_(std::move(port)), place_(request.peer, request.transport) {
    port_->receiving.insert(place_);
  }
  Receiving(const Receiving&) = delete;
  Receiving& operator=(const Receiving&) = delete;
  ~Receiving() { port_->receiving.erase(place_); }

 private:
  SharedPort port_;
  std::pair<PeerId, Transport> place_;
};

Task<HostAnswer> exchanged(HostRequest request, SharedPort port) {
  const Receiving receiving(port, request);
  Host& host = *port->host;
  MessageChannel& channel = host.open_channel(request.peer, request.transport);
  const SteadyTime deadline = host.steady_clock().now() + Nanoseconds(request.ns);
  const Question question{.index = ++port->index};
  HostTime t1 = co_await host.clock().now();
  Bytes bytes = encoded(question, request.bytes);
  const MessageId id = co_await channel.send(std::move(bytes));
  const SteadyTime sent = host.steady_clock().now();
  const std::optional<HostTime> left = co_await channel.transmit_stamp(id, sent + kStampTimeout);
  if (left) t1 = *left;
  for (;;) {
    std::optional<ReceivedMessage> received = co_await channel.receive(deadline);
    if (!received) co_return std::monostate{};
    const std::optional<Question> answer = decoded(received->bytes);
    if (!answer || answer->index != question.index) continue;
    ++port->exchanges;
    const HostTime t2{Nanoseconds(answer->t2)};
    const HostTime t3{Nanoseconds(answer->t3)};
    host.report_exchange(
        {.peer = request.peer, .t1 = t1, .t2 = t2, .t3 = t3, .t4 = received->received});
    received->bytes.erase(received->bytes.begin(),
                          received->bytes.begin() + std::ptrdiff_t{sizeof(Question)});
    co_return ExchangeReply{std::move(received->bytes), t1, t2, t3, received->received};
  }
}

template <class Time>
HostAnswer answer_with(const std::optional<Time>& time) {
  if (!time) return std::monostate{};
  return nanoseconds_of(*time);
}

// One wait at a time for a camera's frames.
class Watching {
 public:
  Watching(SharedPort port, std::uint32_t camera) : port_(std::move(port)), camera_(camera) {
    port_->watching.insert(camera_);
  }
  Watching(const Watching&) = delete;
  Watching& operator=(const Watching&) = delete;
  ~Watching() { port_->watching.erase(camera_); }

 private:
  SharedPort port_;
  std::uint32_t camera_;
};

Nanoseconds ns_of(const HostRequest& request) { return Nanoseconds(request.ns); }

SteadyTime deadline_of(const HostRequest& request, const SharedPort& port) {
  return port->host->steady_clock().now() + ns_of(request);
}

MessageChannel& channel_of(const HostRequest& request, const SharedPort& port) {
  return port->host->open_channel(request.peer, request.transport);
}

// The clock has been adjusted for the first time: from now on it counts as synchronised.
std::monostate adjusted(HostPort& port) {
  if (port.host->id() != 0) port.outcome.synchronised(port.exchanges);
  return {};
}

template <Task<bool> (SteeredCamera::*Control)(Nanoseconds)>
Task<HostAnswer> controlled(HostRequest request, SharedPort port) {
  const bool is_taken = co_await (port->cameras[request.camera].*Control)(ns_of(request));
  co_return is_taken;
}

// Readers of the arguments of requests, which are those of simbench/host.py.
using Arguments = const std::vector<Object>&;

void read_nothing(Arguments, const HostPort&, HostRequest&) {}
void read_time(Arguments all, const HostPort&, HostRequest& made) { made.ns = time_ns(all[1]); }
void read_interval(Arguments all, const HostPort&, HostRequest& made) {
  made.ns = interval_ns(all[1]);
}
void read_rate(Arguments all, const HostPort&, HostRequest& made) {
  made.ppb = all[1].as<double>();
}
void read_slew(Arguments all, const HostPort&, HostRequest& made) {
  made.ns = time_ns(all[1]);
  made.ppb = all[2].as<double>();
}

// The peer, and whether it is the stream.
void read_channel(Arguments all, const HostPort& port, HostRequest& made) {
  made.peer = all[1].as<PeerId>();
  made.transport = all[2].as<bool>() ? Transport::kStream : port.datagrams;
  if (port.steers() && made.transport == Transport::kStream) {
    throw_value_error("channel: found a stream, allowed: of a capture_alignment datagrams");
  }
  if (!port.peers.contains(made.peer)) {
    throw_value_error("channel: found host " + std::to_string(made.peer) +
                      ", allowed: of a slave the master, 0; of the master its slaves");
  }
}
void read_message(Arguments all, const HostPort& port, HostRequest& made) {
  read_channel(all, port, made);
  made.bytes = bytes_of(all[3]);
}
void read_wait(Arguments all, const HostPort& port, HostRequest& made) {
  read_channel(all, port, made);
  made.ns = interval_ns(all[3]);
}
void read_question(Arguments all, const HostPort& port, HostRequest& made) {
  read_message(all, port, made);
  made.ns = interval_ns(all[4]);
}
void read_stamp(Arguments all, const HostPort& port, HostRequest& made) {
  read_channel(all, port, made);
  made.message = all[3].as<MessageId>();
  made.ns = interval_ns(all[4]);
}

void read_camera(Arguments all, const HostPort& port, HostRequest& made) {
  made.camera = all[1].as<std::uint32_t>();
  if (made.camera < port.cameras.size()) return;
  throw_value_error("camera: found the one at place " + std::to_string(made.camera) +
                    ", allowed: those of the host");
}
void read_control(Arguments all, const HostPort& port, HostRequest& made) {
  read_camera(all, port, made);
  made.ns = time_ns(all[2]);
}

// What an operation changes or waits for, which stage or host may refuse.
enum class Touches : std::uint8_t { kNothing, kClock, kCard, kCardsClock, kChannel, kCamera };

}  // namespace

struct HostOperation {
  const char* name;
  std::size_t arguments;
  void (*read)(const std::vector<Object>& all, const HostPort& port, HostRequest& made);
  Task<HostAnswer> (*done)(HostRequest request, SharedPort port);
  Touches touches = Touches::kNothing;
};

namespace {

constexpr HostOperation kOperations[] = {
    {"now", 0, read_nothing,
     [](HostRequest, SharedPort port) -> Task<HostAnswer> {
       const HostTime now = co_await port->host->clock().now();
       co_return nanoseconds_of(now);
     }},
    {"set", 1, read_time,
     [](HostRequest request, SharedPort port) -> Task<HostAnswer> {
       co_await port->host->clock().set(HostTime(ns_of(request)));
       co_return adjusted(*port);
     },
     Touches::kClock},
    {"step", 1, read_time,
     [](HostRequest request, SharedPort port) -> Task<HostAnswer> {
       const HostTime now = co_await port->host->clock().now();
       co_await port->host->clock().set(now + ns_of(request));
       co_return adjusted(*port);
     },
     Touches::kClock},
    {"adjust_frequency", 1, read_rate,
     [](HostRequest request, SharedPort port) -> Task<HostAnswer> {
       co_await port->host->clock().adjust_frequency(request.ppb);
       co_return adjusted(*port);
     },
     Touches::kClock},
    {"slew", 2, read_slew,
     [](HostRequest request, SharedPort port) -> Task<HostAnswer> {
       co_await port->host->clock().slew(ns_of(request), request.ppb);
       co_return adjusted(*port);
     },
     Touches::kClock},
    {"sleep_for", 1, read_interval,
     [](HostRequest request, SharedPort port) -> Task<HostAnswer> {
       co_await port->host->sleep_for(ns_of(request));
       co_return std::monostate{};
     }},
    {"sleep_until", 1, read_time,
     [](HostRequest request, SharedPort port) -> Task<HostAnswer> {
       co_await port->host->sleep_until(HostTime(ns_of(request)));
       co_return std::monostate{};
     }},
    {"send", 3, read_message,
     [](HostRequest request, SharedPort port) -> Task<HostAnswer> {
       const MessageId id = co_await channel_of(request, port).send(std::move(request.bytes));
       co_return static_cast<std::int64_t>(id);
     }},
    {"receive", 3, read_wait,
     [](HostRequest request, SharedPort port) -> Task<HostAnswer> {
       const Receiving receiving(port, request);
       std::optional<ReceivedMessage> received =
           co_await channel_of(request, port).receive(deadline_of(request, port));
       if (!received) co_return std::monostate{};
       co_return std::move(*received);
     },
     Touches::kChannel},
    {"exchange", 4, read_question, exchanged, Touches::kChannel},
    {"transmit_stamp", 4, read_stamp,
     [](HostRequest request, SharedPort port) -> Task<HostAnswer> {
       const std::optional<HostTime> left =
           co_await channel_of(request, port)
               .transmit_stamp(request.message, deadline_of(request, port));
       co_return answer_with(left);
     }},
    {"hardware_transmit_stamp", 4, read_stamp,
     [](HostRequest request, SharedPort port) -> Task<HostAnswer> {
       const std::optional<HardwareTime> left =
           co_await channel_of(request, port)
               .hardware_transmit_stamp(request.message, deadline_of(request, port));
       co_return answer_with(left);
     }},
    {"cross_stamp", 0, read_nothing,
     [](HostRequest, SharedPort port) -> Task<HostAnswer> {
       const CrossStamp stamp = co_await port->host->hardware_clock()->cross_stamp();
       co_return stamp;
     },
     Touches::kCard},
    {"step_card", 1, read_time,
     [](HostRequest request, SharedPort port) -> Task<HostAnswer> {
       co_await port->host->hardware_clock()->step(ns_of(request));
       co_return std::monostate{};
     },
     Touches::kCardsClock},
    {"adjust_card", 1, read_rate,
     [](HostRequest request, SharedPort port) -> Task<HostAnswer> {
       co_await port->host->hardware_clock()->adjust_frequency(request.ppb);
       co_return std::monostate{};
     },
     Touches::kCardsClock},
    {"next_frame", 1, read_camera,
     [](HostRequest request, SharedPort port) -> Task<HostAnswer> {
       const Watching watching(port, request.camera);
       SteeredCamera& camera = port->cameras[request.camera];
       const ExposedFrame frame = co_await camera.next_frame();
       co_return SteeredFrame{frame, camera.is_settled(frame)};
     },
     Touches::kCamera},
    {"adjust_frame", 2, read_control, controlled<&SteeredCamera::adjust_frame>},
    {"insert_frame", 2, read_control, controlled<&SteeredCamera::insert_frame>},
    {"frame_length", 2, read_control, controlled<&SteeredCamera::set_frame_length>},
    {"start_at", 2, read_control, [](HostRequest request, SharedPort port) -> Task<HostAnswer> {
       const bool is_taken =
           co_await port->cameras[request.camera].start_at(HostTime(ns_of(request)));
       co_return is_taken;
     }}};

// What host and stage refuse.
void check_allowed(const HostRequest& request, const HostPort& port) {
  const Touches touches = request.operation->touches;
  if (port.steers() && (touches == Touches::kClock || touches == Touches::kCardsClock)) {
    throw_value_error("a capture_alignment sets no clock; that is the part of host_sync");
  }
  const bool is_on_card = touches == Touches::kCard || touches == Touches::kCardsClock;
  if (is_on_card && port.get().hardware_clock() == nullptr) {
    throw_value_error("the host's network card has no clock (/hosts/nic/hardware_stamps)");
  }
  if (touches == Touches::kChannel && port.receiving.contains({request.peer, request.transport})) {
    throw_value_error("another coroutine of this host waits on this channel");
  }
  if (touches == Touches::kCamera && port.watching.contains(request.camera)) {
    throw_value_error("another coroutine waits for a frame of this camera");
  }
}

}  // namespace

HostRequest host_request(const Object& request, const HostPort& port) {
  std::vector<Object> tuple;
  if (PyTuple_Check(request.get())) tuple = request.as<std::vector<Object>>();
  const bool is_request = !tuple.empty() && PyUnicode_Check(tuple[0].get());
  const std::string name = is_request ? tuple[0].as<std::string>() : "";
  const auto* const found = std::ranges::find_if(
      kOperations, [&name](const HostOperation& operation) { return name == operation.name; });
  if (found == std::end(kOperations) || tuple.size() != found->arguments + 1) {
    throw_error(
        PyExc_TypeError,
        "awaits something that is no operation of its host; asyncio does not run here: "
        "await host.sleep_for(), host.clock.now(), host.channel(peer).receive() and the like");
  }
  HostRequest made{.operation = found};
  found->read(tuple, port, made);
  check_allowed(made, port);
  return made;
}

Task<HostAnswer> answered(HostRequest request, SharedPort port) {
  return request.operation->done(std::move(request), std::move(port));
}

Object python_value(const HostAnswer& answer) {
  const auto record = [](const char* type, const auto&... values) {
    return imported("simbench.host").attribute(type)(values...);
  };
  if (const auto* number = std::get_if<std::int64_t>(&answer)) return to_python(*number);
  if (const auto* is_taken = std::get_if<bool>(&answer)) return to_python(*is_taken);
  if (const auto* message = std::get_if<ReceivedMessage>(&answer)) {
    std::optional<std::int64_t> hardware;
    if (message->received_hardware) hardware = nanoseconds_of(*message->received_hardware);
    return record("Message", python_bytes(message->bytes.data(), message->bytes.size()),
                  nanoseconds_of(message->received), nanoseconds_of(message->received_steady),
                  hardware);
  }
  if (const auto* reply = std::get_if<ExchangeReply>(&answer)) {
    return record("Reply", python_bytes(reply->bytes.data(), reply->bytes.size()),
                  nanoseconds_of(reply->t1), nanoseconds_of(reply->t2), nanoseconds_of(reply->t3),
                  nanoseconds_of(reply->t4));
  }
  if (const auto* stamp = std::get_if<CrossStamp>(&answer)) {
    return record("CrossStamp", nanoseconds_of(stamp->before), nanoseconds_of(stamp->hardware),
                  nanoseconds_of(stamp->after));
  }
  if (const auto* steered = std::get_if<SteeredFrame>(&answer)) {
    const ExposedFrame& frame = steered->frame;
    return record("Exposure", frame.counter, nanoseconds_of(frame.exposed),
                  nanoseconds_of(frame.exposed_steady), nanoseconds_of(frame.arrival),
                  nanoseconds_of(frame.arrival_steady), frame.exposure.count(), steered->settled);
  }
  return Object::none();
}

namespace {

Task<void> answer_on(Host& host, PeerId client, Transport transport) {
  MessageChannel& channel = host.open_channel(client, transport);
  for (;;) {
    std::optional<ReceivedMessage> received =
        co_await channel.receive(host.steady_clock().now() + kIdle);
    if (!received) continue;
    std::optional<Question> question = decoded(received->bytes);
    if (!question) continue;
    if (question->index == 0) co_return;
    question->t2 = nanoseconds_of(received->received);
    const HostTime now = co_await host.clock().now();
    question->t3 = nanoseconds_of(now);
    Bytes answer = encoded(*question, received->bytes, sizeof(Question));
    co_await channel.send(std::move(answer));
  }
}

}  // namespace

Task<void> answer_questions(Host& host, PeerId client) {
  const asio::any_io_executor executor = co_await asio::this_coro::executor;
  const auto spawned = [&](Transport transport) {
    return asio::co_spawn(executor, answer_on(host, client, transport), asio::deferred);
  };
  auto both = asio::experimental::make_parallel_group(spawned(Transport::kDatagram),
                                                      spawned(Transport::kStream));
  const auto [order, first, second] =
      co_await both.async_wait(asio::experimental::wait_for_one(), asio::use_awaitable);
  const std::exception_ptr& failure = order[0] == 0 ? first : second;
  if (failure) std::rethrow_exception(failure);
}

Task<void> say_done(Host& host, PeerId server) {
  MessageChannel& channel = host.open_channel(server, Transport::kStream);
  Bytes bytes = encoded({}, {});
  co_await channel.send(std::move(bytes));
}

namespace {

Object camera_facts(const HostPort& port, std::uint32_t place) {
  const FrameControl& camera = *port.get().frame_controls()[place];
  const SteeredCamera& steered = port.cameras.at(place);
  std::vector<std::string> controls;
  for (std::size_t kind = 0; kind < kFrameControlNames.size(); ++kind) {
    if (camera.limits().allowed[kind]) controls.emplace_back(kFrameControlNames[kind]);
  }
  return dict({{"number", camera.camera()},
               {"frame_length_ns", steered.length().count()},
               {"shortest_ns", steered.shortest().count()},
               {"longest_ns", steered.longest().count()},
               {"granularity_ns", camera.limits().granularity.count()},
               {"latency_frames", camera.limits().latency_frames},
               {"controls", controls}});
}

void report_failure(HostPort& port, const std::string& why) {
  if (port.steers()) throw_value_error("failed(): of a capture_alignment use camera.report()");
  port.get();
  port.outcome.failed(port.exchanges, why);
}

// The members in the order of SessionDelays; the slave is the host.
void report_delays(HostPort& port, std::uint32_t pass, std::array<std::int64_t, 7> ns) {
  if (port.steers()) throw_value_error("report_delays(): of a host_sync alone");
  Host& host = port.get();
  if (host.id() == 0) throw_value_error("report_delays(): of a slave; this is the master");
  if (pass == 0) throw_value_error("pass_number: found 0, allowed: from 1");
  host.report_delays({.slave = host.id(),
                      .pass = pass,
                      .begin = SteadyTime(Nanoseconds(ns[0])),
                      .end = SteadyTime(Nanoseconds(ns[1])),
                      .t_l = Nanoseconds(ns[2]),
                      .t_t = Nanoseconds(ns[3]),
                      .t_d = Nanoseconds(ns[4]),
                      .get = Nanoseconds(ns[5]),
                      .set = Nanoseconds(ns[6])});
}

std::optional<std::pair<double, double>> stored_frequency(const HostPort& port) {
  const std::optional<StoredFrequency> stored = port.get().stored_frequency();
  if (!stored) return std::nullopt;
  return std::pair(stored->ppb, stored->error_ppb);
}

void report_camera(HostPort& port, std::uint32_t place, bool aligned, const std::string& message) {
  port.get();
  port.cameras.at(place).report(aligned, message);
}

}  // namespace

void bind_host_port(const Object& module) {
  add_class<HostPort>(
      module, "simbench._simbench.HostPort",
      {.properties = {property("id", [](const HostPort& port) { return port.get().id(); })},
       .methods = {
           method("steady_ns",
                  [](const HostPort& port) {
                    return nanoseconds_of(port.get().steady_clock().now());
                  }),
           method("random", [](const HostPort& port) { return port.get().random_uniform(); }),
           method("has_card",
                  [](const HostPort& port) { return port.get().hardware_clock() != nullptr; }),
           method("stored_frequency", callable<&stored_frequency>),
           method("failed", callable<&report_failure>),
           method("report_delays", callable<&report_delays>),
           method("camera", callable<&camera_facts>), method("report", callable<&report_camera>)}});
}

}  // namespace simbench::python
