#include "hardware/node/session.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/bind_cancellation_slot.hpp>
#include <boost/asio/co_spawn.hpp>
#include <ctime>
#include <utility>
#include <vector>

#include "hardware/net/notice.h"
#include "recording/counted.h"
#include "scenarios/frame_limits.h"

namespace simbench::hardware {
namespace {

namespace asio = boost::asio;
using nlohmann::json;

// A cancelled algorithm returns at its next wait; one that does not return in time is abandoned.
constexpr auto kCancelLimit = std::chrono::seconds(2);

std::string time_of_day() {
  const std::time_t now = std::time(nullptr);
  std::tm local = {};
  localtime_r(&now, &local);
  return fmt::format("{:%H:%M:%S}", local);
}

FrameSteering steering_of(const scenarios::Scenario& scenario) {
  return {.limits = scenarios::frame_limits(scenario),
          .insert_stretches = scenario.cameras.frame_control->insert_stretches};
}

}  // namespace

Session::Session(SessionWorld world, SessionPlan plan)
    : world_(std::move(world)),
      plan_(std::move(plan)),
      since_(time_of_day()),
      scored_(plan_.scenario.evaluation.stream),
      journal_(world_.context, world_.journal_folder, plan_.id,
               [this](const std::string& trouble) { note(trouble); }),
      sync_(world_.context),
      alignment_(world_.context) {
  world_.network->clear();
  world_.clock.restart();
  ClockAdjustment present = world_.clock.present(monotonic_now());
  present.host = world_.me;
  journal_.write(present);
  host_ =
      std::make_unique<RealHost>(world_.context, world_.me, world_.clock, *world_.network,
                                 [this](const RecordingEvent& event) { journal_.write(event); });
  feed_ = std::make_shared<CameraFeed>(
      world_.context,
      CameraFeedSink{
          .on_frame = [this](std::uint32_t camera, const CameraFrame& f) { on_frame(camera, f); },
          .on_event = [this](std::uint32_t camera, const CameraEvent& e) { on_event(camera, e); }});
  world_.log(fmt::format("session {} begun by {}: scenario {}, pipeline {}", plan_.id,
                         plan_.conductor, plan_.scenario.name, plan_.pipeline));
}

void Session::require_not_ending() const {
  if (ending_) throw SessionError(fmt::format("session {} is ending", plan_.id));
}

void Session::synchronise(const std::string& role, std::vector<PeerId> slaves) {
  require_not_ending();
  if (role != "master" && role != "slave") {
    throw SessionError(fmt::format("role: found '{}', allowed: master, slave", role));
  }
  if (role == "slave" && world_.me == 0) {
    throw SessionError("role: found 'slave', allowed on the rig's first host: master");
  }
  if (std::find(slaves.begin(), slaves.end(), world_.me) != slaves.end()) {
    throw SessionError(fmt::format("slaves: found {}, allowed: other hosts", world_.me));
  }
  if (sync_was_started_) throw SessionError("host_sync was already started in this session");
  sync_was_started_ = true;
  if (slaves.empty()) slaves = other_hosts();
  HostSync& host_sync = *plan_.algorithms.host_sync;
  Task<void> run = role == "master" ? host_sync.run_master(*host_, std::move(slaves))
                                    : host_sync.run_slave(*host_, 0);
  world_.log(
      fmt::format("session {}: host_sync of {} started as {}", plan_.id, plan_.pipeline, role));
  launch(sync_, std::move(run), &Session::on_synchronised);
}

std::vector<PeerId> Session::other_hosts() const {
  std::vector<PeerId> others;
  others.reserve(world_.hosts);
  for (PeerId host = 0; host < world_.hosts; ++host) {
    if (host != world_.me) others.push_back(host);
  }
  return others;
}

void Session::launch(Run& run, Task<void> coroutine, OnEnd on_end) {
  run.runs = true;
  run.is_cancelled = false;
  asio::co_spawn(
      world_.context, std::move(coroutine),
      asio::bind_cancellation_slot(run.cancel.slot(), [session = shared_from_this(), &run,
                                                       on_end](const std::exception_ptr& failure) {
        run.runs = false;
        run.ended.cancel();
        (*session.*on_end)(failure);
      }));
}

void Session::start_alignment() {
  CaptureAlignment* const alignment = plan_.algorithms.capture_alignment.get();
  if (alignment == nullptr) return;
  if (alignment_.runs) return note("capture_alignment: that of the capture before still runs");
  const bool is_master = world_.me == 0;
  world_.log(fmt::format("session {}: capture_alignment of {} started as {}", plan_.id,
                         plan_.pipeline, is_master ? "master" : "slave"));
  launch(alignment_,
         is_master ? alignment->run_master(*host_, other_hosts()) : alignment->run_slave(*host_, 0),
         &Session::on_aligned);
}

void Session::on_aligned(const std::exception_ptr& failure) {
  if (alignment_.is_cancelled || !failure) return;
  try {
    std::rethrow_exception(failure);
  } catch (const std::exception& exception) {
    note(fmt::format("capture_alignment failed: {}", exception.what()));
  }
}

void Session::on_synchronised(const std::exception_ptr& failure) {
  if (ending_) return;
  json error = nullptr;
  try {
    if (failure) std::rethrow_exception(failure);
    world_.log(fmt::format("session {}: host_sync has ended", plan_.id));
  } catch (const std::exception& exception) {
    error = exception.what();
    world_.log(fmt::format("session {}: host_sync failed: {}", plan_.id, exception.what()));
  }
  world_.notify("synchronised", {{"session", plan_.id}, {"error", error}});
}

CameraSettings Session::camera_settings() const {
  const scenarios::Cameras& cameras = plan_.scenario.cameras;
  CameraSettings settings{.sync_mode = cameras.sync_mode,
                          .streams = cameras.streams,
                          .exposure_ms = cameras.exposure_ms,
                          .auto_exposure = cameras.auto_exposure.is_on(),
                          .trigger_rate_hz = plan_.scenario.trigger.rate_hz};
  if (plan_.algorithms.capture_alignment && cameras.frame_control) {
    settings.steering = steering_of(plan_.scenario);
  }
  return settings;
}

Task<CameraProblems> Session::prepare() {
  require_not_ending();
  if (cameras_ == Cameras::kStarted) throw SessionError("the cameras are running: stop them first");
  const auto self = shared_from_this();
  CameraProblems problems = co_await world_.cameras.prepare(camera_settings());
  const CameraSteerings steerings = co_await world_.cameras.steerings();
  require_not_ending();
  host_->steer(steerings);
  cameras_ = Cameras::kPrepared;
  note_problems(problems);
  co_return problems;
}

Task<CameraProblems> Session::start() {
  require_not_ending();
  if (cameras_ == Cameras::kClosed) throw SessionError("the cameras are not prepared");
  if (cameras_ == Cameras::kStarted) throw SessionError("the cameras are already running");
  const auto self = shared_from_this();
  cameras_ = Cameras::kStarted;
  CameraProblems problems = co_await world_.cameras.start(feed_);
  world_.log(fmt::format("session {}: cameras started", plan_.id));
  note_problems(problems);
  if (!ending_ && cameras_ == Cameras::kStarted) start_alignment();
  co_return problems;
}

Task<CameraProblems> Session::stop() {
  require_not_ending();
  const auto self = shared_from_this();
  CameraProblems problems;
  if (cameras_ != Cameras::kStarted) co_return problems;
  co_await end_run(alignment_, "capture_alignment");
  problems = co_await world_.cameras.stop();
  require_not_ending();
  feed_->drain();
  cameras_ = Cameras::kPrepared;
  note_problems(problems);
  journal_.flush();
  world_.log(fmt::format("session {}: cameras stopped, {} so far", plan_.id,
                         counted(journal_.frames(), "frame")));
  co_return problems;
}

Task<void> Session::end(std::string reason) {
  if (std::exchange(ending_, true)) co_return;
  const auto self = shared_from_this();
  co_await end_run(alignment_, "capture_alignment");
  co_await end_run(sync_, "host_sync");
  const CameraProblems problems = co_await world_.cameras.close();
  feed_->drain();
  note_problems(problems);
  if (feed_->dropped() > 0) {
    note(counted(feed_->dropped(), "frame") + " dropped: the host was too busy");
  }
  if (journal_.frames_not_kept() > 0) {
    note(counted(journal_.frames_not_kept(), "frame") + " not kept");
  }
  feed_->close();
  journal_.close();
  // The next session's host observes the same clock, even while an abandoned algorithm goes on.
  host_->release_clock();
  if (!sync_.runs && !alignment_.runs) host_.reset();
  world_.log(fmt::format("session {} ended ({}): {}, {} not kept", plan_.id, reason,
                         counted(journal_.frames(), "frame"),
                         journal_.frames_not_kept() + feed_->dropped()));
}

Task<void> Session::end_run(Run& run, std::string what) {
  if (!run.runs) co_return;
  run.is_cancelled = true;
  run.ended.expires_after(kCancelLimit);
  run.cancel.emit(asio::cancellation_type::terminal);
  if (!run.runs) co_return;
  co_await ended(run.ended);
  if (run.runs) {
    world_.log(fmt::format("session {}: {} of {} does not end", plan_.id, what, plan_.pipeline));
  }
}

void Session::on_frame(std::uint32_t camera, const CameraFrame& frame) {
  FrameRecord record;
  record.camera = camera;
  record.stream = frame.stream;
  record.domain = frame.domain;
  record.counter = frame.counter;
  record.exposure_us = frame.exposure_us;
  record.sensor = frame.sensor;
  record.frame = frame.frame;
  record.arrival = world_.clock.system_at(frame.arrived);
  record.arrival_steady = world_.clock.steady_at(frame.arrived);
  record.backend = frame.backend ? world_.clock.system_at(*frame.backend) : record.arrival;
  journal_.write(FrameEvent{record, std::nullopt});
  if (frame.stream != scored_ || ending_ || !host_) return;
  host_->deliver({.camera = record.camera,
                  .counter = record.counter,
                  .exposure_us = record.exposure_us,
                  .sensor = record.sensor,
                  .arrival = record.arrival,
                  .arrival_steady = record.arrival_steady});
}

void Session::on_event(std::uint32_t camera, const CameraEvent& event) {
  if (event.kind == CameraEvent::Kind::kEnded) return;
  note(fmt::format("camera {}: {}", world_.cameras.serial_of(camera), event.text));
}

void Session::note_problems(const CameraProblems& problems) {
  for (const CameraProblem& problem : problems) {
    note(fmt::format("camera {}: {}", problem.camera, problem.text));
  }
}

// The journal belongs to one host; the notice and the log name the host.
void Session::note(const std::string& text) {
  journal_.note(text);
  const std::string line = fmt::format("{}: {}", world_.host_name, text);
  world_.notify("note", {{"session", plan_.id}, {"text", line}});
  world_.log(line);
}

}  // namespace simbench::hardware
