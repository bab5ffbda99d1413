// rpi.sync of libcamera on Raspberry Pis: a server tells when its frames are, each client takes the
// whole difference off the length of one of its own.
//
// The server is the master's first camera. Every `sync_period_frames` frames it sends its mean
// frame length D and the time of its newest frame to every client, one way and unconfirmed: a lost
// packet costs a period. A client compares its newest frame with the newest packet:
//
//     delta = own frame - server's frame, k = (delta + D/2) / D towards zero
//     correction = delta - k D, none below the dead band; the frame is shorter by it
//
// Towards zero is the code's conversion to an integer: a frame that is older than the packet's by
// more than D/2 makes a correction beyond half a period, which moves to the same phase; where
// frames come a whole period later than the server's packets, each packet costs a frame. There is
// no feedback but the next packet, 30 frames later, and no estimate of the rate.
//
// Server and clients are ready once the server has had `ready_frame` frames, and report that. A
// correction that the frame's limits cut is reported instead. The other cameras of the server's
// host are clients too.
//
// The packet's fields are libcamera's, little-endian, times in us:
//
//   offset  size  field
//   0       4     D, rounded
//   4       8     frame, system clock: not filled in
//   12      8     frame, wall clock
//   20      8     ready, system clock: not filled in
//   28      8     ready, wall clock
//
// Wall clock of a frame: frame_clock.h, in place of libcamera's fit of the wall clock to the boot
// time, which averages the noise of reading two clocks.

#include <algorithm>
#include <boost/endian/conversion.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/capture_alignment/steered_camera.h"
#include "algorithms/host_sync/join.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

const char* const kRpiSync = "raspberrypi/libcamera, src/ipa/rpi/controller/rpi/sync.cpp";

struct RpiSyncSettings {
  std::uint32_t sync_period = 30;  // frames
  std::uint32_t ready_frame = 100;
  Nanoseconds min_adjustment = from_us(50);

  void bind(ParameterBinder& parameters) {
    parameters.number("sync_period_frames", sync_period, 1, 1e6,
                      "from one packet of the server to the next", kRpiSync);
    parameters.number("ready_frame", ready_frame, 1, 1e6,
                      "of the server, from which all count as ready", kRpiSync);
    parameters.number("min_adjustment_us", min_adjustment, 0, 1e6,
                      "a correction below it is not made", kRpiSync);
  }
};

struct RpiSyncPacket {
  Nanoseconds length{};
  HostTime frame{};
  HostTime ready{};
};

// The newest packet on a host.
struct RpiSyncInbox {
  RpiSyncPacket last{};
  std::uint64_t packets = 0;  // until now
  void put(const RpiSyncPacket& packet) {
    last = packet;
    ++packets;
  }
};

constexpr std::size_t kRpiSyncPacketBytes = 36;
// Times this far from zero can still be subtracted in nanoseconds.
constexpr std::int64_t kLastPacketUs = 4'000'000'000'000'000;

std::int64_t whole_us(Nanoseconds time) { return floor_div(time.count() + 500, 1000); }

Bytes rpi_sync_bytes(const RpiSyncPacket& packet) {
  Bytes bytes(kRpiSyncPacketBytes);
  auto* at = reinterpret_cast<unsigned char*>(bytes.data());
  boost::endian::store_little_u32(at, static_cast<std::uint32_t>(whole_us(packet.length)));
  boost::endian::store_little_s64(at + 12, whole_us(packet.frame.time_since_epoch()));
  boost::endian::store_little_s64(at + 28, whole_us(packet.ready.time_since_epoch()));
  return bytes;
}

std::optional<RpiSyncPacket> rpi_sync_packet(const Bytes& bytes) {
  if (bytes.size() != kRpiSyncPacketBytes) return std::nullopt;
  const auto* at = reinterpret_cast<const unsigned char*>(bytes.data());
  const std::int64_t length_us = boost::endian::load_little_u32(at);
  const std::int64_t frame_us = boost::endian::load_little_s64(at + 12);
  const std::int64_t ready_us = boost::endian::load_little_s64(at + 28);
  const auto is_possible = [](std::int64_t us) {
    return us > -kLastPacketUs && us < kLastPacketUs;
  };
  if (length_us == 0 || !is_possible(frame_us) || !is_possible(ready_us)) return std::nullopt;
  return RpiSyncPacket{.length = Microseconds(length_us),
                       .frame = HostTime(Microseconds(frame_us)),
                       .ready = HostTime(Microseconds(ready_us))};
}

// The server's mean frame length over up to 100 frames; a gap counts as the frames that fit in.
class MeanFrameLength {
 public:
  explicit MeanFrameLength(Nanoseconds nominal) : mean_ns_(to_ns(nominal)) {}

  void add(HostTime exposed) {
    const double passed_ns = previous_ ? to_ns(exposed - *previous_) : 0;
    previous_ = exposed;
    const double frames = std::floor(passed_ns / mean_ns_ + 0.5);
    if (frames < 1) return;
    mean_ns_ += (passed_ns / frames - mean_ns_) / (samples_ + 1);
    samples_ = std::min(samples_ + 1, kMostSamples);
  }
  Nanoseconds mean() const { return from_ns(mean_ns_); }

 private:
  static constexpr double kMostSamples = 99;
  double mean_ns_;
  double samples_ = 0;
  std::optional<HostTime> previous_;
};

Task<void> serve_frames(Host& host, FrameControl& control, std::vector<PeerId> clients,
                        RpiSyncSettings settings, std::shared_ptr<RpiSyncInbox> inbox) {
  SteeredCamera camera(host, control);
  MeanFrameLength length(camera.length());
  for (std::uint32_t frames = 1;; ++frames) {
    const ExposedFrame frame = co_await camera.next_frame();
    length.add(frame.exposed);
    if (frames == settings.ready_frame) camera.report(true);
    if (frames % settings.sync_period != 0) continue;
    const std::uint32_t remaining = settings.ready_frame - std::min(frames, settings.ready_frame);
    const RpiSyncPacket packet{.length = length.mean(),
                               .frame = frame.exposed,
                               .ready = frame.exposed + remaining * length.mean()};
    inbox->put(packet);
    for (const PeerId client : clients) {
      co_await host.open_channel(client, Transport::kAlignment).send(rpi_sync_bytes(packet));
    }
  }
}

Task<void> receive_packets(Host& host, PeerId server, std::shared_ptr<RpiSyncInbox> inbox) {
  MessageChannel& channel = host.open_channel(server, Transport::kAlignment);
  while (true) {
    const std::optional<ReceivedMessage> received =
        co_await channel.receive(host.steady_clock().now() + kIdle);
    if (!received) continue;
    const std::optional<RpiSyncPacket> packet = rpi_sync_packet(received->bytes);
    if (packet) inbox->put(*packet);
  }
}

// By how much the client's frame is late.
Nanoseconds rpi_sync_correction(const RpiSyncPacket& packet, HostTime exposed,
                                Nanoseconds min_adjustment) {
  const Nanoseconds delta = exposed - packet.frame;
  const std::int64_t periods = (delta + packet.length / 2) / packet.length;
  const Nanoseconds correction = delta - periods * packet.length;
  return std::chrono::abs(correction) < min_adjustment ? Nanoseconds(0) : correction;
}

Task<void> follow_server(Host& host, FrameControl& control, RpiSyncSettings settings,
                         std::shared_ptr<const RpiSyncInbox> inbox) {
  SteeredCamera camera(host, control);
  std::uint64_t seen = inbox->packets;
  std::uint32_t frames_without_packet = 0;
  bool is_ready = false;
  std::string problem;
  while (true) {
    const ExposedFrame frame = co_await camera.next_frame();
    if (inbox->packets == 0) {
      if (++frames_without_packet == 2 * settings.ready_frame) {
        camera.report(false,
                      "no packet from the server; does the master have a camera, and is it "
                      "reachable?");
      }
      continue;
    }
    const RpiSyncPacket packet = inbox->last;
    if (std::exchange(seen, inbox->packets) != inbox->packets) {
      const Nanoseconds late = rpi_sync_correction(packet, frame.exposed, settings.min_adjustment);
      const Nanoseconds wanted = camera.length() - late;
      const Nanoseconds made = std::clamp(wanted, camera.shortest(), camera.longest());
      problem =
          made == wanted ? "" : "the frame's limits cut its correction; a lower rate would help";
      if (made != camera.length()) {
        const bool is_taken = co_await camera.adjust_frame(made - camera.length());
        if (!is_taken) co_return;
      }
    }
    is_ready = is_ready || frame.exposed + packet.length / 2 > packet.ready;
    if (is_ready) camera.report(problem.empty(), problem);
  }
}

class RpiSync final : public CaptureAlignment {
 public:
  explicit RpiSync(RpiSyncSettings settings) : settings_(settings) {}

  Task<void> run_master(Host& host, std::vector<PeerId> slaves) override {
    if (host.frame_controls().empty()) co_return;
    auto inbox = std::make_shared<RpiSyncInbox>();
    std::vector<Task<void>> cameras;
    cameras.reserve(host.frame_controls().size());
    cameras.push_back(
        serve_frames(host, *host.frame_controls().front(), std::move(slaves), settings_, inbox));
    for (FrameControl* const client : host.frame_controls().subspan(1)) {
      cameras.push_back(follow_server(host, *client, settings_, inbox));
    }
    co_await join_all(std::move(cameras));
  }

  Task<void> run_slave(Host& host, PeerId master) override {
    if (host.frame_controls().empty()) co_return;
    auto inbox = std::make_shared<RpiSyncInbox>();
    std::vector<Task<void>> tasks;
    tasks.reserve(host.frame_controls().size() + 1);
    tasks.push_back(receive_packets(host, master, inbox));
    for (FrameControl* const client : host.frame_controls()) {
      tasks.push_back(follow_server(host, *client, settings_, inbox));
    }
    co_await join_all(std::move(tasks));
  }

 private:
  RpiSyncSettings settings_;
};

}  // namespace

std::vector<CaptureAlignmentEntry> capture_alignment_rpi_sync() {
  return {with_settings<CaptureAlignmentEntry>(
      {.name = "rpi_sync",
       .family = "rpi_sync",
       .summary = "the master's camera tells the time of a frame each second, the others move to "
                  "it in one",
       .source = kRpiSync,
       .needs = {Need::kFrameControl}},
      RpiSyncSettings{}, kMake<RpiSync>)};
}

}  // namespace simbench
