#include "evaluation/certificates/capture_evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

namespace simbench::evaluation {
namespace {

constexpr const char* kGnssClock = "GNSS";
constexpr const char* kPulseClock = "PPS";

// No clock of a rig counts that; sums with it would not fit 64 bits. System clocks and
// some cameras' count from 1970.
constexpr Nanoseconds kYear = std::chrono::hours(24 * 365);
bool is_past_years(Nanoseconds count, Nanoseconds most) { return count > most || count < -most; }
bool is_far(SteadyTime at) { return is_past_years(at.time_since_epoch(), 40 * kYear); }
bool is_far(DeviceTime at) { return is_past_years(Nanoseconds(nanoseconds_of(at)), 80 * kYear); }
bool is_far(HostTime at) { return is_past_years(at.time_since_epoch(), 80 * kYear); }
bool is_far(const std::optional<HostTime>& at) { return at && is_far(*at); }

}  // namespace

void EvidenceCounts::operator+=(const EvidenceCounts& other) {
  messages += other.messages;
  unusable_messages += other.unusable_messages;
  estimated_exchanges += other.estimated_exchanges;
  polls += other.polls;
  pulses += other.pulses;
  unused_pulses += other.unused_pulses;
  logged_outside += other.logged_outside;
}

CaptureEvidence::CaptureEvidence(const Assumptions& assumptions, StreamKind stream)
    : assumptions_(assumptions), stream_(stream) {}

void CaptureEvidence::on_start(const RigLayout& layout) {
  layout_ = layout;
  registers_.assign(layout.cameras.size(), {});
  std::optional<Nanoseconds> estimate_error;
  if (assumptions_.estimated_stamp_ms) estimate_error = from_ms(*assumptions_.estimated_stamp_ms);
  begin_.assign(layout.hosts, {});
  facts_.emplace(layout.hosts, from_ms(assumptions_.host_stamp_ms), estimate_error);
}

void CaptureEvidence::on_frames(std::span<const FrameRecord> frames,
                                std::span<const FrameTruth> truths) {
  for_each_frame(frames, truths, [&](const FrameRecord& frame, const FrameTruth* truth) {
    const DeviceTime sensor = registers_[frame.camera].unwrap(frame.sensor);
    if (frame.stream != stream_) return;
    if (is_far(sensor) || is_far(frame.arrival_steady) ||
        (truth != nullptr && is_past_years(truth->mid_exposure().time_since_epoch(), 80 * kYear))) {
      return note_broken(fmt::format("a frame of camera {}", frame.camera));
    }
    FrameEvidence& kept = frames_.emplace_back();
    kept.camera = frame.camera;
    kept.exposure_us = frame.exposure_us;
    kept.sensor = sensor;
    kept.arrival = frame.arrival_steady;
    note_time(layout_.cameras[frame.camera].host, frame.arrival_steady);
    if (truth != nullptr) kept.truth = truth->mid_exposure();
  });
}

void CaptureEvidence::on_event(const RecordingEvent& event) {
  std::visit(
      Overloaded{
          [&](const ClockAdjustment& adjustment) {
            if (is_far(adjustment.at) || is_far(adjustment.before) || is_far(adjustment.after)) {
              return note_broken(fmt::format("an adjustment of host {}", adjustment.host));
            }
            facts_->add(adjustment);
            note_time(adjustment.host, adjustment.at);
          },
          [&](const PulseSighting& pulse) {
            if (!assumptions_.pulse_late_us) return void(++counts_.unused_pulses);
            if (is_far(HostTime(pulse.gnss)) || is_far(pulse.seen)) {
              return note_broken(fmt::format("a pulse of host {}", pulse.host));
            }
            add_pulse(pulse.host, outside(kGnssClock, true), pulse.gnss, {pulse.seen, pulse.seen});
          },
          [&](const DevicePoll& poll) {
            const DeviceTime device = registers_[poll.camera].unwrap(poll.device);
            if (is_far(device) || is_far(poll.t0_steady) || is_far(poll.t1_steady)) {
              return note_broken(fmt::format("a poll of camera {}", poll.camera));
            }
            ++counts_.polls;
            note_time(layout_.cameras[poll.camera].host, poll.t1_steady);
            polls_.push_back({poll.camera, device, poll.t0_steady, poll.t1_steady});
          },
          [&](const ExchangeEvent& reported) { add_exchange(reported.host, reported.exchange); },
          [](const auto&) {}},
      event);
}

void CaptureEvidence::note_broken(std::string where) {
  if (broken_.empty()) broken_ = std::move(where);
}

void CaptureEvidence::add_exchange(std::uint32_t host, const Exchange& exchange) {
  if (is_far(exchange.t1) || is_far(exchange.t2) || is_far(exchange.t3) || is_far(exchange.t4)) {
    return note_broken(fmt::format("an exchange of host {}", host));
  }
  const ExchangeMessages found = facts_->messages_of(host, exchange);
  counts_.unusable_messages += found.unusable;
  if (found.is_left_out) ++counts_.estimated_exchanges;
  for (const std::optional<HostMessage>& message : found.usable) {
    if (!message) continue;
    messages_.push_back(*message);
    ++counts_.messages;
  }
}

std::uint32_t CaptureEvidence::outside(const std::string& name, bool is_exact) {
  const auto known = std::ranges::find(outside_, name, &OutsideClock::name);
  const auto number = static_cast<std::uint32_t>(known - outside_.begin());
  if (known == outside_.end()) outside_.push_back({name, is_exact});
  return layout_.hosts + number;
}

void CaptureEvidence::add_pulse(std::uint32_t host, std::uint32_t outside, Nanoseconds second,
                                SteadyRange seen) {
  const Nanoseconds error = from_us(assumptions_.pulse_error_us);
  const Nanoseconds late = from_us(*assumptions_.pulse_late_us);
  ++counts_.pulses;
  messages_.push_back({.from = outside,
                       .to = host,
                       .sent = SteadyTime(second - error),
                       .received = seen.last + kSteadyStep,
                       .is_pulse = true});
  messages_.push_back({.from = host,
                       .to = outside,
                       .sent = seen.first - late - kSteadyStep,
                       .received = SteadyTime(second + error),
                       .is_pulse = true});
}

void CaptureEvidence::note_time(std::uint32_t host, SteadyTime at) {
  std::optional<SteadyTime>& begin = begin_[host];
  if (!begin) begin = at;
  longest_ = std::max(longest_, at - *begin);
}

// What a system clock read afterwards is not known: other programs set it.
bool CaptureEvidence::is_of_capture(std::uint32_t host, const SteadyRange& range) const {
  const std::optional<SteadyTime>& begin = begin_[host];
  return begin && range.first >= *begin && range.last - *begin <= longest_;
}

std::optional<CaptureEvidence::PlacedStamp> CaptureEvidence::placed(
    std::uint32_t end, HostTime stamp, const LoggedExchange& exchange) const {
  if (is_far(stamp)) return std::nullopt;
  const Nanoseconds error =
      exchange.error + from_ms(assumptions_.host_stamp_ms +
                               (exchange.is_estimated ? *assumptions_.estimated_stamp_ms : 0));
  const Nanoseconds common = exchange.common_error;
  const auto drift = Nanoseconds(
      static_cast<std::int64_t>(std::ceil(to_ns(common) * assumptions_.host_rate_ppm * 1e-6)));
  if (end >= layout_.hosts) {
    const SteadyTime at(stamp.time_since_epoch());
    return PlacedStamp{{at - error, at + error}, drift};
  }
  const auto range = facts_->when(end, stamp, error);
  if (!range || !is_of_capture(end, *range)) return std::nullopt;
  if (common == Nanoseconds(0)) return PlacedStamp{*range, Nanoseconds(0)};
  const auto before = facts_->when(end, stamp - common, error);
  const auto after = facts_->when(end, stamp + common, error);
  if (!before || !after) return std::nullopt;
  // The system clock against the steady clock: its rate, or a step.
  const Nanoseconds moved = std::max({std::chrono::abs(range->first - before->first - common),
                                      std::chrono::abs(after->first - range->first - common),
                                      std::chrono::abs(range->last - before->last - common),
                                      std::chrono::abs(after->last - range->last - common)});
  return PlacedStamp{*range, drift + moved};
}

void CaptureEvidence::add_logged(std::uint32_t host, std::uint32_t server,
                                 const LoggedExchange& exchange) {
  const auto left = placed(host, exchange.t1, exchange);
  const auto came = placed(server, exchange.t2, exchange);
  const auto answered = placed(server, exchange.t3, exchange);
  const auto back = placed(host, exchange.t4, exchange);
  if (!left || !came || !answered || !back) return void(++counts_.logged_outside);
  counts_.messages += 2;
  messages_.push_back({.from = host,
                       .to = server,
                       .sent = left->range.first,
                       .received = came->range.last,
                       .slack = left->slack + came->slack});
  messages_.push_back({.from = server,
                       .to = host,
                       .sent = answered->range.first,
                       .received = back->range.last,
                       .slack = answered->slack + back->slack});
}

void CaptureEvidence::add(std::uint32_t host, const ExchangeLog& log,
                          const std::map<std::string, std::uint32_t>& host_of_address) {
  for (const LoggedExchange& exchange : log.exchanges) {
    if (exchange.is_estimated && !assumptions_.estimated_stamp_ms) {
      ++counts_.estimated_exchanges;
      continue;
    }
    const auto own = host_of_address.find(exchange.server);
    add_logged(host, own == host_of_address.end() ? outside(exchange.server, false) : own->second,
               exchange);
  }
  for (const LoggedPulse& pulse : log.pulses) {
    const auto seen = is_far(pulse.read) || is_far(HostTime(pulse.second))
                          ? std::nullopt
                          : facts_->when(host, pulse.read, from_ms(assumptions_.host_stamp_ms));
    if (!seen || !is_of_capture(host, *seen)) {
      ++counts_.logged_outside;
    } else if (!assumptions_.pulse_late_us) {
      ++counts_.unused_pulses;
    } else {
      add_pulse(host, outside(kPulseClock, true), pulse.second, *seen);
    }
  }
}

std::string CaptureEvidence::name_of(std::size_t clock) const {
  const std::size_t outside = layout_.hosts + layout_.cameras.size();
  if (clock < layout_.hosts) return fmt::format("host {}", clock);
  if (clock < outside) return fmt::format("camera {}", clock - layout_.hosts);
  return outside_[clock - outside].name;
}

}  // namespace simbench::evaluation
