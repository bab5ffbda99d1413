// One session of a node: from a conductor's begin to its end.
//
// Holds what belongs to one session alone: the journal, the real host on which host_sync runs, the
// feed of the cameras. The node lends its clock, sockets and cameras.
// A capture_alignment, if the pipeline has one, runs from start to stop, as master on host 0.
//
//   begun ── synchronise ──► host_sync runs; notice "synchronised" when it returns
//         ── prepare ──► start ──► stop ──► (prepare ...)     cameras
//         ── end ──► host_sync cancelled, cameras closed, journal closed
//
// host_sync and the cameras are independent: a service starts before the capture and runs until
// end(). Calls that do not fit the state throw SessionError and change nothing.
//
// One thread, the context's. Always held by a shared_ptr: the coroutine of host_sync keeps its
// session, and so its host, alive until it has ended.
//
//   const auto session = std::make_shared<Session>(world, std::move(plan));
//   session->synchronise("slave");
//   co_await session->end("its conductor has everything");
#pragma once

#include <boost/asio/cancellation_signal.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <exception>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "algorithms/ports/capture_alignment.h"
#include "algorithms/ports/host_sync.h"
#include "hardware/clock/node_clock.h"
#include "hardware/net/peer_network.h"
#include "hardware/node/camera_bench.h"
#include "hardware/node/journal.h"
#include "hardware/node/real_host.h"
#include "scenarios/scenario.h"

namespace simbench::hardware {

class SessionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The algorithms of a pipeline that run on a node.
struct NodePipeline {
  std::unique_ptr<HostSync> host_sync;
  std::unique_ptr<CaptureAlignment> capture_alignment{};  // null: none
};

// The conductor's request.
struct SessionPlan {
  std::string id;
  std::string conductor;
  scenarios::Scenario scenario;
  std::string pipeline;
  NodePipeline algorithms;
};

// What the node lends to the session; outlives it.
struct SessionWorld {
  boost::asio::io_context& context;
  NodeClock& clock;
  std::shared_ptr<PeerNetwork> network;
  CameraBench& cameras;
  PeerId me = 0;
  PeerId hosts = 0;
  std::string host_name;
  std::string journal_folder;
  std::function<void(const std::string& notice, const nlohmann::json& details)> notify;
  std::function<void(const std::string& line)> log;
};

class Session : public std::enable_shared_from_this<Session> {
 public:
  // Restarts the clock, empties the channels, opens the journal. Throws JournalError.
  Session(SessionWorld world, SessionPlan plan);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  const std::string& id() const { return plan_.id; }
  const std::string& conductor() const { return plan_.conductor; }
  const std::string& since() const { return since_; }  // "14:03:59", local time
  bool ending() const { return ending_; }

  // `role`: "master", or "slave" of host 0. `slaves`: the master's; empty: all other hosts.
  void synchronise(const std::string& role, std::vector<PeerId> slaves = {});
  Task<CameraProblems> prepare();
  Task<CameraProblems> start();
  // When it returns, all frames are on disk.
  Task<CameraProblems> stop();
  // Ends the session, once; `reason` is for the log.
  Task<void> end(std::string reason);

 private:
  // A coroutine of an algorithm.
  struct Run {
    explicit Run(boost::asio::io_context& context) : ended(context) {}
    bool runs = false;
    bool is_cancelled = false;
    boost::asio::cancellation_signal cancel;
    boost::asio::steady_timer ended;
  };
  using OnEnd = void (Session::*)(const std::exception_ptr& failure);

  enum class Cameras : std::uint8_t { kClosed, kPrepared, kStarted };

  void on_frame(std::uint32_t camera, const CameraFrame& frame);
  void on_event(std::uint32_t camera, const CameraEvent& event);
  void on_synchronised(const std::exception_ptr& failure);
  void note(const std::string& text);
  void note_problems(const CameraProblems& problems);
  void require_not_ending() const;
  std::vector<PeerId> other_hosts() const;
  CameraSettings camera_settings() const;
  void start_alignment();
  void on_aligned(const std::exception_ptr& failure);
  // Calls `on_end` when the coroutine has ended.
  void launch(Run& run, Task<void> coroutine, OnEnd on_end);
  // `what` it is, for the log.
  Task<void> end_run(Run& run, std::string what);

  SessionWorld world_;
  SessionPlan plan_;
  std::string since_;
  StreamKind scored_;
  Journal journal_;
  std::unique_ptr<RealHost> host_;
  std::shared_ptr<CameraFeed> feed_;
  Cameras cameras_ = Cameras::kClosed;
  bool ending_ = false;

  bool sync_was_started_ = false;
  Run sync_;
  Run alignment_;
};

}  // namespace simbench::hardware
