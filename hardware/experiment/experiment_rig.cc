#include "hardware/experiment/experiment_rig.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "hardware/experiment/network_sandbox.h"
#include "recording/shell_quoted.h"

namespace simbench::hardware {
namespace {

using boost::asio::ip::tcp;
using boost::asio::ip::udp;

// Much longer than a machine with fewer cores than nodes needs.
constexpr Nanoseconds kReadyLimit = std::chrono::seconds(20);
constexpr Nanoseconds kRelayPatience = std::chrono::seconds(2);

double cut(double value, double limit) { return std::clamp(value, -limit, limit); }

void write_text(const std::string& path, const std::string& text) {
  std::ofstream out(path);
  out << text;
  out.close();
  if (!out) throw std::runtime_error(path + ": cannot be written");
}

// Ports of loopback that are free for TCP and UDP, all at once.
std::vector<std::uint16_t> free_ports(std::size_t count) {
  boost::asio::io_context context;
  const auto loopback = boost::asio::ip::address_v4::loopback();
  std::vector<tcp::acceptor> acceptors;
  std::vector<udp::socket> sockets;
  std::vector<std::uint16_t> ports;
  for (std::size_t tries = 0; ports.size() < count; ++tries) {
    if (tries > 20 * count) throw std::runtime_error("too few free ports on 127.0.0.1");
    tcp::acceptor acceptor(context, tcp::endpoint(loopback, 0));
    const std::uint16_t port = acceptor.local_endpoint().port();
    udp::socket socket(context, udp::v4());
    boost::system::error_code taken;
    socket.bind(udp::endpoint(loopback, port), taken);
    acceptors.push_back(std::move(acceptor));
    if (taken) continue;
    sockets.push_back(std::move(socket));
    ports.push_back(port);
  }
  return ports;
}

// The monotonic clock less /proc/uptime, which a shell can read. They differ if this machine has
// slept, or is a container that counts from its own start.
double monotonic_ahead_of_uptime_s() {
  std::ifstream in("/proc/uptime");
  double uptime_s = 0;
  if (!(in >> uptime_s)) throw std::runtime_error("/proc/uptime: cannot be read");
  return to_seconds(monotonic_now().time_since_epoch()) - uptime_s;
}

std::string on_command(const TemporaryFolder& folder) {
  const double ahead_s = monotonic_ahead_of_uptime_s() + to_seconds(ExperimentRig::kTriggerLead);
  return fmt::format(
      "awk '{{ printf \"%.0f\", ($1 + {:.3f}) * 1e9 }}' /proc/uptime > {} && cp {} {} && mv {} {}",
      ahead_s, shell_quoted(folder.file("zero.new")), shell_quoted(folder.file("zero.new")),
      shell_quoted(folder.file("zero")), shell_quoted(folder.file("zero.new")),
      shell_quoted(folder.file("trigger")));
}

}  // namespace

std::vector<ClockStart> draw_clock_starts(const scenarios::Scenario& scenario, std::uint64_t seed) {
  const scenarios::HostClockModel& clock = scenario.hosts.clock;
  std::vector<ClockStart> starts;
  for (std::int64_t host = 0; host < scenario.hosts.count; ++host) {
    boost::random::mt19937_64 generator(seed * 1'000'003 + static_cast<std::uint64_t>(host));
    boost::random::normal_distribution<double> normal;
    const auto value_or = [host](const std::vector<double>& stated, double drawn) {
      return stated.empty() ? drawn : stated[static_cast<std::size_t>(host)];
    };
    const double skew_ppm =
        value_or(clock.skew_of_host_ppm, normal(generator) * clock.oscillator.skew_sigma_ppm);
    const double offset_ms = value_or(clock.initial_offset_of_host_ms,
                                      normal(generator) * clock.initial_offset_sigma_ms);
    const bool is_exact = host == 0 && scenario.hosts.master_is_exact;
    ClockStart start;
    start.skew_ppm = is_exact ? 0 : cut(skew_ppm, kMaxSkewPpm);
    start.offset_ms = host == 0 ? 0 : cut(offset_ms, kMaxOffsetMs);
    start.set_cost_factor = std::exp(normal(generator) * clock.set_cost_session_log_sigma);
    starts.push_back(start);
  }
  return starts;
}

ExperimentRig::ExperimentRig(ExperimentSettings settings) : settings_(std::move(settings)) {
  const auto hosts = static_cast<std::size_t>(settings_.scenario->hosts.count);
  place(hosts);
  SecretKey::create_file(folder_.file("rig.key"));
  key_ = SecretKey::from_file(folder_.file("rig.key"));
  write_text(folder_.file("scenario.json"), settings_.scenario->resolved_json());
  write_text(folder_.file("rig.json"), rig_text(std::nullopt));
  conductor_ = load_rig(folder_.file("rig.json"));
  std::vector<std::string> files;
  for (unsigned node = 0; node < hosts; ++node) {
    files.push_back(folder_.file(fmt::format("node{}.json", node)));
    write_text(files.back(), rig_text(node));
  }
  for (unsigned node = 0; node < hosts; ++node) start_node(node, files[node]);
  // After the nodes: connecting them makes the relay's addresses in the hub.
  start_relay(files);
  const MonotonicTime deadline = monotonic_now() + kReadyLimit;
  for (const auto& node : nodes_) node->read_line(deadline);
  relay_->read_line(deadline);
}

void ExperimentRig::place(std::size_t hosts) {
  places_.assign(hosts, std::vector<Place>(hosts));
  const std::vector<std::uint16_t> ports =
      settings_.namespaces ? std::vector<std::uint16_t>() : free_ports(hosts * hosts);
  for (unsigned node = 0; node < hosts; ++node) {
    for (unsigned host = 0; host < hosts; ++host) {
      Place& place = places_[node][host];
      if (!settings_.namespaces) {
        place = {"127.0.0.1", ports[node * hosts + host]};
      } else if (node == host) {
        place = {NetworkSandbox::member_address(node), kDefaultPort};
      } else {
        place = {NetworkSandbox::hub_address(node),
                 static_cast<std::uint16_t>(kDefaultPort + 1 + host)};
      }
    }
  }
}

// The rig file of a node; without one, of the conductor.
std::string ExperimentRig::rig_text(std::optional<unsigned> node) const {
  nlohmann::ordered_json rig = {{"schema_version", 1}, {"name", "experiment"}};
  std::int64_t camera = 0;
  for (unsigned host = 0; host < places_.size(); ++host) {
    const Place& place = places_[node.value_or(host)][host];
    nlohmann::ordered_json entry = {
        {"name", fmt::format("host{}", host)}, {"address", place.address}, {"port", place.port}};
    entry["cameras"] = nlohmann::ordered_json::array();
    for (; camera < settings_.scenario->cameras.count &&
           settings_.scenario->host_of(camera) == static_cast<std::int64_t>(host);
         ++camera) {
      entry["cameras"].push_back({{"serial", fmt::format("camera{}", camera)},
                                  {"recording", settings_.recording},
                                  {"trigger_file", folder_.file("trigger")}});
    }
    rig["hosts"].push_back(std::move(entry));
  }
  rig["trigger"] = {{"on_command", on_command(folder_)},
                    {"off_command", "rm -f " + shell_quoted(folder_.file("trigger"))}};
  return rig.dump(1);
}

void ExperimentRig::start_node(unsigned node, const std::string& file) {
  const ClockStart& clock = settings_.clocks.at(node);
  const scenarios::HostClockModel& interface = settings_.scenario->hosts.clock;
  const std::string name = fmt::format("host{}", node);
  std::vector<std::string> arguments = {
      "node",
      "--rig",
      file,
      "--name",
      name,
      "--key-file",
      folder_.file("rig.key"),
      "--journal",
      folder_.file("journal-" + name),
      fmt::format("--clock-offset-ms={}", clock.offset_ms),
      fmt::format("--clock-skew-ppm={}", clock.skew_ppm),
      fmt::format("--clock-set-cost-ms={}", interface.set_cost_ms * clock.set_cost_factor),
      fmt::format("--clock-set-log-sigma={}", interface.set_cost_call_log_sigma),
      fmt::format("--clock-set-effective={}", interface.set_effective_fraction)};
  if (settings_.programs) {
    arguments.insert(arguments.end(), {"--programs-on", NetworkSandbox::kWireInterface});
  }
  if (settings_.programs && !settings_.program_log.empty()) {
    arguments.insert(arguments.end(), {"--program-log", settings_.program_log});
  }
  nodes_.push_back(std::make_unique<ChildProcess>(ChildProcess::Settings{
      .program = settings_.program,
      .leading = settings_.leading,
      .arguments = std::move(arguments),
      .log = folder_.file(name + ".log"),
      .sandbox_member = settings_.namespaces ? std::optional(node) : std::nullopt,
      .has_wire = settings_.programs}));
}

void ExperimentRig::start_relay(const std::vector<std::string>& node_files) {
  std::vector<std::string> arguments = {"relay",
                                        "--scenario",
                                        folder_.file("scenario.json"),
                                        "--seed",
                                        std::to_string(settings_.seed & 0xffffffff),
                                        "--nodes",
                                        fmt::format("{}", fmt::join(node_files, ","))};
  if (settings_.programs) {
    std::vector<std::string> wires;
    for (unsigned node = 0; node < places_.size(); ++node) {
      wires.push_back(NetworkSandbox::wire(node));
    }
    arguments.insert(arguments.end(), {"--wires", fmt::format("{}", fmt::join(wires, ","))});
  }
  relay_ = std::make_unique<ChildProcess>(ChildProcess::Settings{.program = settings_.program,
                                                                 .leading = settings_.leading,
                                                                 .arguments = std::move(arguments),
                                                                 .log = folder_.file("relay.log"),
                                                                 .sandbox_member = std::nullopt});
}

std::optional<MonotonicTime> ExperimentRig::trigger_zero() const {
  std::ifstream in(folder_.file("zero"));
  std::int64_t ns = 0;
  if (!(in >> ns)) return std::nullopt;
  return MonotonicTime(Nanoseconds(ns));
}

std::string ExperimentRig::end_relay() {
  if (!relay_) return "";
  std::string statistics = relay_->end(kRelayPatience);
  relay_.reset();
  return statistics;
}

}  // namespace simbench::hardware
