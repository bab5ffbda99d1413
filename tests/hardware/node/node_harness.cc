#include "tests/hardware/node/node_harness.h"

#include <fmt/format.h>

#include <boost/asio/cancellation_state.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <utility>

#include "recording/event_text.h"
#include "scenarios/loader.h"

namespace simbench::hardware {
namespace {

namespace asio = boost::asio;
using nlohmann::json;

constexpr Nanoseconds kNodePatience = std::chrono::seconds(5);

struct Alive {
  explicit Alive(SyncSeen& which) : seen(which) { ++seen.alive; }
  ~Alive() { --seen.alive; }
  Alive(const Alive&) = delete;
  Alive& operator=(const Alive&) = delete;
  SyncSeen& seen;
};

// Makes the first frame of each camera 1 ms longer, and goes on.
class CountedAlignment final : public CaptureAlignment {
 public:
  CountedAlignment(SyncKind kind, SyncSeen& seen) : kind_(kind), seen_(seen) {}

  Task<void> run_master(Host& host, std::vector<PeerId> /*slaves*/) override {
    ++seen_.masters;
    return run(kind_, seen_, host);
  }
  Task<void> run_slave(Host& host, PeerId /*master*/) override {
    ++seen_.slaves;
    return run(kind_, seen_, host);
  }

 private:
  static Task<void> run(SyncKind kind, SyncSeen& seen, Host& host) {
    const Alive alive(seen);
    if (kind == SyncKind::kThrows) throw std::runtime_error("no grid");
    for (FrameControl* const camera : host.frame_controls()) {
      const FrameControlReply reply = co_await camera->adjust_frame(from_ms(1));
      host.report_alignment(
          {.camera = camera->camera(), .aligned = reply.is_accepted(), .controls = 1});
    }
    while (kind == SyncKind::kGoesOn) co_await host.sleep_for(from_ms(10'000));
  }

  SyncKind kind_;
  SyncSeen& seen_;
};

class CountedSync final : public HostSync {
 public:
  CountedSync(SyncKind kind, SyncSeen& seen) : kind_(kind), seen_(seen) {}

  Task<void> run_master(Host& host, std::vector<PeerId> slaves) override {
    ++seen_.masters;
    return run(kind_, seen_, host, slaves.empty() ? 0 : slaves.front());
  }
  Task<void> run_slave(Host& host, PeerId master) override {
    ++seen_.slaves;
    return run(kind_, seen_, host, master);
  }

 private:
  static Task<void> run(SyncKind kind, SyncSeen& seen, Host& host, PeerId peer) {
    const Alive alive(seen);
    host.report_exchange(
        {.peer = peer, .t1 = HostTime(Nanoseconds(5)), .t2 = {}, .t3 = {}, .t4 = {}});
    co_await host.clock().slew(Nanoseconds(0), 1000);
    if (kind == SyncKind::kThrows) throw std::runtime_error("no way to the master");
    if (kind == SyncKind::kClings) {
      co_await asio::this_coro::reset_cancellation_state(asio::disable_cancellation());
      while (!seen.let_go) co_await host.sleep_for(from_ms(5));
    }
    while (kind == SyncKind::kGoesOn) co_await host.sleep_for(from_ms(10'000));
  }

  SyncKind kind_;
  SyncSeen& seen_;
};

}  // namespace

class MadeUpCameras::MadeUpCamera final : public Camera {
 public:
  MadeUpCamera(MadeUpCameras& driver, CameraInfo info) : driver_(driver), info_(std::move(info)) {}
  ~MadeUpCamera() override { stop(); }

  const CameraInfo& info() const override { return info_; }
  void configure(const CameraSettings& settings) override {
    const std::lock_guard lock(driver_.mutex_);
    driver_.settings_ = settings;
  }
  void start(FrameHandler on_frame, CameraEventHandler on_event) override {
    const std::lock_guard lock(driver_.mutex_);
    driver_.running_[info_.serial] = {std::move(on_frame), std::move(on_event)};
  }
  void stop() override {
    std::this_thread::sleep_for(driver_.stop_takes);
    const std::lock_guard lock(driver_.mutex_);
    driver_.running_.erase(info_.serial);
  }
  std::shared_ptr<CameraSteering> steering() override { return driver_.steering; }

 private:
  MadeUpCameras& driver_;
  CameraInfo info_;
};

std::vector<CameraInfo> MadeUpCameras::list() {
  std::vector<CameraInfo> found;
  for (const std::string& serial : serials_) {
    found.push_back({.serial = serial, .model = "made up", .firmware = "1.0", .connection = ""});
  }
  return found;
}

std::unique_ptr<Camera> MadeUpCameras::open(const std::string& serial) {
  const auto refused = refusals.find(serial);
  if (refused != refusals.end()) throw CameraError(refused->second);
  return std::make_unique<MadeUpCamera>(*this, CameraInfo{serial, "made up", "1.0", ""});
}

bool MadeUpCameras::frame(const std::string& serial, const CameraFrame& frame) {
  const std::lock_guard lock(mutex_);
  const auto found = running_.find(serial);
  if (found == running_.end()) return false;
  found->second.on_frame(frame);
  return true;
}

bool MadeUpCameras::event(const std::string& serial, const CameraEvent& event) {
  const std::lock_guard lock(mutex_);
  const auto found = running_.find(serial);
  if (found == running_.end()) return false;
  found->second.on_event(event);
  return true;
}

bool MadeUpCameras::runs(const std::string& serial) {
  const std::lock_guard lock(mutex_);
  return running_.contains(serial);
}

CameraSettings MadeUpCameras::settings() {
  const std::lock_guard lock(mutex_);
  return settings_;
}

Task<void> TestConductor::connect() {
  const PeerName me;
  stream_ = co_await SecureStream::connect(context_, "127.0.0.1", port_, key_, me,
                                           monotonic_now() + kNodePatience);
}

Task<NodeAnswer> TestConductor::ask(std::string verb, json arguments) {
  const std::uint64_t id = next_id_++;
  NodeRequest request;
  request.id = id;
  request.verb = std::move(verb);
  request.arguments = std::move(arguments);
  Bytes bytes = encode(request);
  co_await stream_->send(std::move(bytes));
  for (;;) {
    const StreamMessage message = co_await stream_->receive(monotonic_now() + kNodePatience);
    NodeAnswer answer = parse_answer(message.bytes);
    if (answer.notice.empty() && answer.id == id) co_return answer;
    notices_.push_back(std::move(answer));
  }
}

Task<json> TestConductor::notice(std::string kind) {
  for (std::size_t next = 0;; ++next) {
    if (next == notices_.size()) {
      const StreamMessage message = co_await stream_->receive(monotonic_now() + kNodePatience);
      notices_.push_back(parse_answer(message.bytes));
    }
    if (notices_[next].notice != kind) continue;
    json details = std::move(notices_[next].details);
    notices_.erase(notices_.begin() + static_cast<std::ptrdiff_t>(next));
    co_return details;
  }
}

Task<void> TestConductor::send_bytes(Bytes bytes) { co_await stream_->send(std::move(bytes)); }

Task<bool> TestConductor::is_closed() {
  try {
    co_await stream_->receive(monotonic_now() + kNodePatience);
  } catch (const StreamError& error) {
    co_return error.kind() == StreamError::Kind::kUnreachable;
  }
  co_return false;
}

NodeHarness::NodeHarness() {
  std::string made = (std::filesystem::temp_directory_path() / "simbench_node_XXXXXX").string();
  root_ = mkdtemp(made.data());
}

NodeHarness::~NodeHarness() {
  if (node_) stop_node();
  std::filesystem::remove_all(root_);
}

void NodeHarness::make_node(const std::string& scenario, PeerId me) {
  scenario_ = scenarios::load_scenario(scenario);
  NodeSettings settings;
  settings.me = me;
  settings.journal_folder = root_ / "journals";
  settings.conductor_silence = silence_;
  settings.rig.name = "test";
  settings.rig.file = "rig.json";
  settings.rig.trigger = RigTrigger{.manual = true, .on_command = "", .off_command = ""};
  for (std::int64_t host = 0; host < scenario_.hosts.count; ++host) {
    settings.rig.hosts.push_back({fmt::format("host{}", host), "127.0.0.1", 0, {}});
  }
  std::vector<std::string> mine;
  for (std::int64_t camera = 0; camera < scenario_.cameras.count; ++camera) {
    const auto host = static_cast<PeerId>(scenario_.host_of(camera));
    const std::string serial = fmt::format("serial{}", camera);
    settings.rig.hosts[host].cameras.push_back({serial, "", "", ""});
    if (host == me) mine.push_back(serial);
  }
  if (!cameras_) cameras_ = std::make_unique<MadeUpCameras>(mine);
  clock_ = std::make_unique<SoftwareClock>(
      context_,
      SoftwareClock::Settings{
          .host = me, .oscillator = {monotonic_now(), SteadyTime{}, 25}, .offset = from_ms(300)});
  node_ = std::make_unique<Node>(
      context_, settings, *clock_, *cameras_,
      [this](const scenarios::Scenario&, const std::string& pipeline) {
        if (pipeline == "unheard_of") throw scenarios::InputError("no such pipeline");
        NodePipeline made{.host_sync = std::make_unique<CountedSync>(sync_, seen_)};
        if (aligns_)
          made.capture_alignment = std::make_unique<CountedAlignment>(alignment_, aligned_);
        return made;
      },
      [this](const std::string& line) { log_.push_back(line); });
  node_->start();
}

void NodeHarness::stop_node() {
  node_->stop();
  context_.restart();
  context_.run_for(std::chrono::seconds(10));
  EXPECT_TRUE(context_.stopped()) << "the node does not come to an end";
  node_.reset();
}

void NodeHarness::run(Task<void> test) {
  bool done = false;
  std::exception_ptr failure;
  asio::co_spawn(context_, std::move(test), [&](std::exception_ptr thrown) {
    done = true;
    failure = std::move(thrown);
  });
  context_.restart();
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (!done && std::chrono::steady_clock::now() < deadline) {
    context_.run_one_for(std::chrono::milliseconds(100));
  }
  ASSERT_TRUE(done) << "the test does not come to an end";
  if (failure) std::rethrow_exception(failure);
}

Task<void> NodeHarness::pause(Nanoseconds interval) {
  asio::steady_timer timer(context_, interval);
  co_await timer.async_wait(asio::use_awaitable);
}

json NodeHarness::terms(const std::string& session) const {
  return {{"session", session},
          {"conductor", "me@here"},
          {"scenario", scenario_.resolved_json()},
          {"pipeline", "free_running"}};
}

std::vector<std::string> NodeHarness::journal(const std::string& session) const {
  std::ifstream in(root_ / "journals" / (session + ".csv"));
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::vector<FrameRecord> NodeHarness::frames_of(const std::vector<std::string>& lines) const {
  std::vector<FrameRecord> frames;
  for (const std::string& line : lines) {
    if (!line.starts_with("frame,")) continue;
    frames.push_back(std::get<FrameEvent>(from_line(line)).record);
  }
  return frames;
}

std::string NodeHarness::logged() const {
  std::string text;
  for (const std::string& line : log_) text += line + "\n";
  return text;
}

}  // namespace simbench::hardware
