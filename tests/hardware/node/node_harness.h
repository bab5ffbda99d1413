// A node with made-up cameras and a made-up host_sync, and conductors that speak to it over real
// streams on 127.0.0.1.
#pragma once

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "hardware/clock/software_clock.h"
#include "hardware/net/secure_stream.h"
#include "hardware/node/node.h"
#include "hardware/node/protocol.h"
#include "recording/event.h"

// At -O1 g++ 12 puts one half of the pair that Asio allocates coroutines with in place, and then
// sees a mismatch with the other.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"

namespace simbench::hardware {

// Arguments of requests, and bytes that may be none.
inline nlohmann::json role(const std::string& name) { return {{"role", name}}; }
inline nlohmann::json in_session(const std::string& session) { return {{"session", session}}; }
inline Bytes bytes(const std::string& text) {
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

// What the test says and sees of its cameras; any thread.
class MadeUpCameras final : public CameraDriver {
 public:
  explicit MadeUpCameras(std::vector<std::string> serials) : serials_(std::move(serials)) {}

  std::vector<CameraInfo> list() override;
  std::unique_ptr<Camera> open(const std::string& serial) override;

  // Frames and events as a camera's own thread would hand them over; false if it does not run.
  bool frame(const std::string& serial, const CameraFrame& frame);
  bool event(const std::string& serial, const CameraEvent& event);
  bool runs(const std::string& serial);
  // Settings of the camera that was set last.
  CameraSettings settings();

  // open() throws this for the camera of that name.
  std::map<std::string, std::string> refusals;
  // All cameras have this one; null: they have none.
  std::shared_ptr<CameraSteering> steering;
  // What stopping a camera takes, as real ones do.
  std::chrono::milliseconds stop_takes{0};

 private:
  class MadeUpCamera;
  struct Running {
    FrameHandler on_frame;
    CameraEventHandler on_event;
  };

  std::vector<std::string> serials_;
  std::mutex mutex_;
  std::map<std::string, Running> running_;
  CameraSettings settings_;
};

// kClings: goes on after it was cancelled, until SyncSeen::let_go.
enum class SyncKind : std::uint8_t { kReturns, kThrows, kGoesOn, kClings };

// What the host_sync did, and is told; outlives it.
struct SyncSeen {
  int masters = 0;
  int slaves = 0;
  int alive = 0;  // coroutines that have begun and not ended
  bool let_go = false;
};

// A conductor's end of a stream.
class TestConductor {
 public:
  TestConductor(boost::asio::io_context& context, std::uint16_t port, SecretKey key = {})
      : context_(context), port_(port), key_(key) {}

  Task<void> connect();
  // The reply, errors included. Notices that come before it are kept.
  Task<NodeAnswer> ask(std::string verb, nlohmann::json arguments = nlohmann::json::object());
  // The next notice of this kind, if it comes within 5 s.
  Task<nlohmann::json> notice(std::string kind);
  Task<void> send_bytes(Bytes bytes);
  // Nothing more comes: the node has closed the stream (within 5 s).
  Task<bool> is_closed();
  void close() { stream_.reset(); }

 private:
  boost::asio::io_context& context_;
  std::uint16_t port_;
  SecretKey key_;
  std::unique_ptr<SecureStream> stream_;
  std::uint64_t next_id_ = 1;
  std::vector<NodeAnswer> notices_;
};

class NodeHarness : public testing::Test {
 public:
  static constexpr const char* kSession = "0123456789abcdef";

  NodeHarness();
  ~NodeHarness() override;

 protected:
  // A rig of the scenario's shape: cameras "serial0", ...; `me` is the node's host.
  void make_node(const std::string& scenario, PeerId me = 0);
  void stop_node();
  // Runs the context until the test's coroutine has ended; what it throws is a failure.
  void run(Task<void> test);
  // Also what it takes the node to do something by itself.
  Task<void> pause(Nanoseconds interval);

  nlohmann::json terms(const std::string& session = kSession) const;
  std::vector<std::string> journal(const std::string& session = kSession) const;
  std::vector<FrameRecord> frames_of(const std::vector<std::string>& lines) const;
  std::string logged() const;
  TestConductor conductor() { return {context_, node_->port()}; }

  std::filesystem::path root_;
  boost::asio::io_context context_;
  std::unique_ptr<SoftwareClock> clock_;
  std::unique_ptr<MadeUpCameras> cameras_;
  scenarios::Scenario scenario_;
  SyncKind sync_ = SyncKind::kReturns;
  SyncSeen seen_;
  bool aligns_ = false;  // the pipeline has a capture_alignment, of this kind
  SyncKind alignment_ = SyncKind::kGoesOn;
  SyncSeen aligned_;
  Nanoseconds silence_ = kConductorSilence;
  std::vector<std::string> log_;
  std::unique_ptr<Node> node_;
};

}  // namespace simbench::hardware
