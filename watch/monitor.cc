#include "watch/monitor.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "evaluation/diagnosis/diagnose.h"
#include "evaluation/stability/mask_verdict.h"
#include "reports/recordings/diagnose_answer.h"
#include "reports/stability/verdict_text.h"
#include "reports/text/answer_json.h"
#include "watch/folder_text.h"
#include "watch/pipe_text.h"

namespace simbench::watch {
namespace {

using reports::Json;

// Alarms that a later event takes back.
constexpr std::array kClosing = {"silent",       "losing",       "drifts", "clock_off",
                                 "stands_still", "beyond_limit", "gone",   "unreadable"};

bool closes(const std::string& kind) { return std::ranges::count(kClosing, kind) > 0; }

std::string name_of(const WatchedLog& log) {
  const std::string host =
      log.host.empty() ? std::filesystem::path(log.path).filename().string() : log.host;
  return "clock of " + host;
}

std::unique_ptr<GrowingText> text_of(const std::string& path, bool is_command) {
  if (is_command) return std::make_unique<PipeText>(PipeText::of_command(path));
  if (path == "-") return std::make_unique<PipeText>(PipeText::of_standard_input());
  return std::make_unique<Tail>(path);
}

GrownFrames frames_of(const std::string& path, const std::optional<RecordingColumns>& columns) {
  std::error_code failed;
  if (std::filesystem::is_directory(path, failed)) {
    return {std::make_unique<FolderText>(path), FolderText::columns()};
  }
  return {text_of(path, false), columns};
}

const char* state_of(const WatchedCamera& camera) {
  if (camera.is_silent) return "silent";
  if (camera.is_losing) return "losing";
  if (camera.drifts) return "drifts";
  return camera.phase.is_known() ? "in order" : "learning";
}

Json camera_json(const WatchedCamera& camera) {
  return {{"camera", camera.camera},
          {"host", camera.host},
          {"stream", camera.stream},
          {"rate_hz", 1000 / camera.period_ms},
          {"phase_ms", camera.phase.phase_ms()},
          {"moved_ms", camera.phase.moved_ms()},
          {"scatter_ms", camera.phase.scatter_ms()},
          {"frames", camera.frames},
          {"lost", camera.counts ? Json(camera.lost) : Json()},
          {"lost_share", camera.lost_share},
          {"slips", camera.slips},
          {"state", state_of(camera)}};
}

}  // namespace

Monitor::Monitor(const WatchOptions& options) : masks_(options.clock_masks) {
  for (const std::string& path : options.recordings) {
    recordings_.push_back(std::make_unique<Recording>(Recording{
        .grown = frames_of(path, options.columns), .source = {.path = path, .stall_s = kStallS}}));
  }
  for (const WatchedLog& log : options.clock_logs) {
    clocks_.push_back(std::make_unique<Clock>(
        Clock{.grown = GrownClock(text_of(log.path, log.is_command), options.clock),
              .watch = ClockWatch(name_of(log), options.clock_limit_ms),
              .source = {.path = log.path, .stall_s = options.clock_stall_s}}));
  }
}

void Monitor::tell(WatchEvent event) {
  keep(event);
  news_.push_back(std::move(event));
}

void Monitor::keep(const WatchEvent& event) {
  events_.push_back(event);
  if (events_.size() > kKeptEvents) events_.pop_front();
  std::erase_if(alarms_, [&event](const Alarm& alarm) {
    return alarm.event.kind == event.kind && alarm.event.subject == event.subject;
  });
  if (!event.is_alarm) return;
  had_alarm_ = true;
  alarms_.push_back({.event = event, .since_s = now_s_, .closes = closes(event.kind)});
}

void Monitor::end_old_alarms() {
  std::erase_if(alarms_, [this](const Alarm& alarm) {
    return !alarm.closes && now_s_ - alarm.since_s > kRecentS;
  });
}

void Monitor::look_at_source(const GrownState& found, bool has_grown, Source& source) {
  const auto tell_of = [&](const char* kind, bool is_alarm, std::string text) {
    tell({.kind = kind,
          .subject = source.path,
          .at_s = now_s_ - begin_s_,
          .is_alarm = is_alarm,
          .text = std::move(text)});
  };
  if (found.is_there != source.is_there) {
    source.is_there = found.is_there;
    tell_of("gone", !found.is_there, source.path + (found.is_there ? " is back" : " is not there"));
  }
  if (found.problem.empty() != source.problem.empty()) {
    tell_of("unreadable", !found.problem.empty(),
            found.problem.empty() ? source.path + " can be read again" : found.problem);
    source.problem = found.problem;
  }
  if (has_grown) {
    source.grew_s = now_s_;
    source.has_grown = true;
  }
  const bool stands_still =
      source.has_grown && source.is_there && now_s_ - source.grew_s > source.stall_s;
  if (stands_still == source.stands_still) return;
  source.stands_still = stands_still;
  tell_of("stands_still", stands_still,
          source.path + (stands_still ? fmt::format(" has not grown for {:.0f} s", source.stall_s)
                                      : " grows again"));
}

void Monitor::poll_recording(Recording& recording) {
  const GrownFrames::Found found = recording.grown.poll();
  const bool has_grown = std::ranges::any_of(
      found.streams, [](const RecordedStream& stream) { return !stream.frames.empty(); });
  rig_.add(found.streams);
  look_at_source(found, has_grown, recording.source);
}

void Monitor::poll_clock(Clock& clock) {
  const GrownClock::Found found = clock.grown.poll();
  if (found.begins_anew) clock.watch.begin_anew();
  for (const WatchEvent& event : clock.watch.add(found.points)) tell(event);
  look_at_source(found, !found.points.empty(), clock.source);
}

void Monitor::diagnose() {
  if (recordings_.empty() || now_s_ - diagnosed_s_ < kDiagnoseS) return;
  const std::vector<RecordedStream> kept = rig_.kept();
  if (kept.empty()) return;
  diagnosed_s_ = now_s_;
  diagnosis_ = reports::answer_json(reports::diagnose_answer(evaluation::diagnose(kept, {})));
}

void Monitor::judge(Clock& clock) {
  const std::optional<evaluation::Stability> stability = clock.watch.stability();
  if (!stability) return;
  clock.is_beyond.resize(masks_.size());
  for (std::size_t i = 0; i < masks_.size(); ++i) {
    const evaluation::MaskVerdict verdict = evaluation::judge(*stability, masks_[i]);
    const bool is_beyond = verdict.judgement == evaluation::Judgement::kFails;
    if (is_beyond == clock.is_beyond[i]) continue;
    clock.is_beyond[i] = is_beyond;
    tell({.kind = "beyond_limit",
          .subject = fmt::format("{} by {}", clock.watch.subject(), verdict.title),
          .at_s = clock.watch.last_s(),
          .is_alarm = is_beyond,
          .text =
              fmt::format("{}: {}", clock.watch.subject(), reports::mask_verdict_text(verdict))});
  }
}

void Monitor::judge_clocks() {
  if (masks_.empty() || now_s_ - judged_s_ < kJudgeS) return;
  judged_s_ = now_s_;
  for (const auto& clock : clocks_) judge(*clock);
}

std::vector<WatchEvent> Monitor::poll(double now_s) {
  if (std::isnan(begin_s_)) {
    begin_s_ = since_s_ = diagnosed_s_ = now_s;
    judged_s_ = now_s - kJudgeS;
  }
  now_s_ = now_s;
  ++polls_;
  const bool had = has_alarm();
  for (const auto& recording : recordings_) poll_recording(*recording);
  for (const auto& clock : clocks_) poll_clock(*clock);
  for (const WatchEvent& event : rig_.look()) tell(event);
  judge_clocks();
  end_old_alarms();
  if (has_alarm() != had) since_s_ = now_s;
  diagnose();
  return std::exchange(news_, {});
}

Json Monitor::snapshot() const {
  const auto of_machine = [this](double at_s) { return at_s - begin_s_; };
  Json alarms = Json::array();
  for (const Alarm& alarm : alarms_) {
    alarms.push_back({{"kind", alarm.event.kind},
                      {"subject", alarm.event.subject},
                      {"text", alarm.event.text},
                      {"since_s", of_machine(alarm.since_s)}});
  }
  Json events = Json::array();
  for (const WatchEvent& event : events_) events.push_back(event_json(event));
  Json cameras = Json::array();
  for (const WatchedCamera& camera : rig_.cameras()) cameras.push_back(camera_json(camera));
  Json clocks = Json::array();
  for (const auto& clock : clocks_) {
    const std::optional<evaluation::TimeErrorSummary> error = clock->watch.time_error();
    clocks.push_back({{"subject", clock->watch.subject()},
                      {"file", clock->grown.path()},
                      {"error_ms", clock->watch.error_ms()},
                      {"max_te_ms", error ? Json(error->max_te_ms) : Json()},
                      {"rms_te_ms", error ? Json(error->rms_te_ms) : Json()},
                      {"steps", clock->watch.steps()},
                      {"samples", clock->watch.samples()}});
  }
  const bool is_nothing = cameras.empty() && std::ranges::all_of(clocks_, [](const auto& clock) {
                            return clock->watch.samples() == 0;
                          });
  const char* const status = has_alarm() ? "alarm" : is_nothing ? "nothing yet" : "in order";
  return {{"status", status},
          {"text", has_alarm() ? alarms_.back().event.text : std::string(status)},
          {"since_s", of_machine(since_s_)},
          {"now_s", of_machine(now_s_)},
          {"polls", polls_},
          {"alarms", std::move(alarms)},
          {"events", std::move(events)},
          {"cameras", std::move(cameras)},
          {"clocks", std::move(clocks)},
          {"diagnosis", diagnosis_}};
}

}  // namespace simbench::watch
