#include "tests/hardware/conductor/test_rig.h"

#include <unistd.h>

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <chrono>
#include <fstream>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include "tests/free_port.h"

namespace simbench::hardware {
namespace {

constexpr auto kPeriod = std::chrono::microseconds(22222);

// A host_sync that agrees with everybody at once.
class NoSync final : public HostSync {
 public:
  Task<void> run_master(Host& host, std::vector<PeerId> slaves) override {
    for (const PeerId slave : slaves) {
      host.report_outcome({.slave = slave, .synchronised = true, .passes = 1, .message = ""});
    }
    co_return;
  }
  Task<void> run_slave(Host&, PeerId) override { co_return; }
};

class TickingCamera final : public Camera {
 public:
  TickingCamera(std::string serial, bool silent, std::atomic<std::size_t>& delivered)
      : info_{std::move(serial), "ticking", "", ""}, silent_(silent), delivered_(delivered) {}
  ~TickingCamera() override { stop(); }

  const CameraInfo& info() const override { return info_; }
  void configure(const CameraSettings&) override {}
  void start(FrameHandler on_frame, CameraEventHandler) override {
    if (silent_) return;
    thread_ = std::jthread([this, on_frame](const std::stop_token& stopped) {
      const MonotonicTime start = monotonic_now();
      for (std::uint32_t counter = 0; !stopped.stop_requested(); ++counter) {
        std::this_thread::sleep_until(for_timer(start + counter * kPeriod));
        CameraFrame frame;
        frame.counter = counter;
        frame.exposure_us = 1000;
        frame.sensor.us = 1'000'000 + counter * 22'222;
        frame.frame.us = frame.sensor.us + 500;
        frame.arrived = monotonic_now();
        on_frame(frame);
        ++delivered_;
      }
    });
  }
  void stop() override { thread_ = {}; }

 private:
  CameraInfo info_;
  bool silent_;
  std::atomic<std::size_t>& delivered_;
  std::jthread thread_;
};

class TickingDriver final : public CameraDriver {
 public:
  explicit TickingDriver(std::string serial) : serial_(std::move(serial)) {}
  std::vector<CameraInfo> list() override { return {{serial_, "ticking", "", ""}}; }
  std::unique_ptr<Camera> open(const std::string& serial) override {
    if (broken) throw CameraError("does not offer 848x480 at 90 Hz; it offers 640x480 at 30 Hz");
    return std::make_unique<TickingCamera>(serial, silent, delivered);
  }
  std::atomic<bool> broken = false;
  std::atomic<bool> silent = false;
  std::atomic<std::size_t> delivered = 0;

 private:
  std::string serial_;
};

class NoAlignment final : public CaptureAlignment {
 public:
  Task<void> run_master(Host&, std::vector<PeerId>) override { co_return; }
  Task<void> run_slave(Host&, PeerId) override { co_return; }
};

NodePipeline make_pipeline(const scenarios::Scenario&, const std::string& pipeline) {
  if (pipeline == kAlignedPipeline) {
    return {.host_sync = std::make_unique<NoSync>(),
            .capture_alignment = std::make_unique<NoAlignment>()};
  }
  if (pipeline != kTestPipeline) throw scenarios::InputError("no such pipeline: " + pipeline);
  return {.host_sync = std::make_unique<NoSync>()};
}

}  // namespace

scenarios::Scenario small_scenario(const std::vector<scenarios::Override>& more) {
  std::vector<scenarios::Override> overrides = {{"/hosts/count", "2"},
                                                {"/cameras/count", "2"},
                                                {"/cameras/cameras_per_host", "1"},
                                                {"/trigger/rate_hz", "45"},
                                                {"/cameras/streams/0/mode_rate_hz", "90"},
                                                {"/cameras/exposure_ms", "1"},
                                                {"/timeline/wait_before_capture_ms", "20"},
                                                {"/timeline/warm_up_ms", "50"},
                                                {"/timeline/frames", "20"}};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return scenarios::load_scenario("6cam_2host_30fps", overrides);
}

struct TestRig::Host {
  explicit Host(const RigHost& host) : driver(host.cameras.front().serial) {}
  TickingDriver driver;
  double offset_ms = 0;
  std::unique_ptr<boost::asio::io_context> context;
  std::unique_ptr<SoftwareClock> clock;
  std::unique_ptr<Node> node;
  std::thread thread;
};

TestRig::TestRig(std::vector<double> clock_offsets_ms) {
  std::string path = (std::filesystem::temp_directory_path() / "simbench_rig_XXXXXX").string();
  folder_ = mkdtemp(path.data());
  rig_.name = "test";
  rig_.file = "test.json";
  rig_.trigger = RigTrigger{.manual = false, .on_command = "true", .off_command = "true"};
  for (std::size_t host = 0; host < clock_offsets_ms.size(); ++host) {
    RigHost entry;
    entry.name = "host" + std::to_string(host);
    entry.address = "127.0.0.1";
    entry.port = free_port();
    entry.cameras.push_back({.serial = "cam" + std::to_string(host)});
    rig_.hosts.push_back(entry);
    hosts_.push_back(std::make_unique<Host>(entry));
    hosts_.back()->offset_ms = clock_offsets_ms[host];
  }
  for (std::size_t host = 0; host < hosts_.size(); ++host) start(host);
}

TestRig::~TestRig() {
  for (std::size_t host = 0; host < hosts_.size(); ++host) take_away(host);
  std::filesystem::remove_all(folder_);
}

void TestRig::start(std::size_t which) {
  Host& host = *hosts_[which];
  host.context = std::make_unique<boost::asio::io_context>(1);
  host.clock = std::make_unique<SoftwareClock>(
      *host.context, SoftwareClock::Settings{.host = static_cast<std::uint32_t>(which),
                                             .oscillator = {},
                                             .offset = from_ms(host.offset_ms)});
  NodeSettings settings;
  settings.rig = rig_;
  settings.me = static_cast<PeerId>(which);
  settings.journal_folder = folder_ / rig_.hosts[which].name;
  host.node = std::make_unique<Node>(*host.context, settings, *host.clock, host.driver,
                                     make_pipeline, [](const std::string&) {});
  host.node->start();
  host.thread = std::thread([&host] { host.context->run(); });
}

void TestRig::take_away(std::size_t which) {
  Host& host = *hosts_[which];
  if (!host.node) return;
  boost::asio::post(*host.context, [&host] { host.node->stop(); });
  host.thread.join();
  host.node.reset();
  host.clock.reset();
  host.context.reset();
}

std::size_t TestRig::restart(std::size_t host) {
  take_away(host);
  const std::size_t frames = frames_in_journals(host);
  start(host);
  return frames;
}

std::size_t TestRig::frames_in_journals(std::size_t host) const {
  std::size_t frames = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / rig_.hosts[host].name)) {
    std::ifstream journal(entry.path());
    for (std::string line; std::getline(journal, line);) frames += line.starts_with("frame,");
  }
  return frames;
}

void TestRig::break_cameras(std::size_t host) { hosts_[host]->driver.broken = true; }

void TestRig::silence_cameras(std::size_t host) { hosts_[host]->driver.silent = true; }

std::size_t TestRig::frames_delivered(std::size_t host) const {
  return hosts_[host]->driver.delivered;
}

}  // namespace simbench::hardware
