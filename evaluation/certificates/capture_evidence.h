// What a recording says of when its frames were exposed, without any estimate: its frames, its
// polls of cameras' clocks, and the messages of its host synchronisation.
//
// A message ties two hosts: it was received after it was sent, whatever protocol sent it. A stamp
// of a system clock is mapped to the host's steady clock, which nobody sets (stamped_facts.h).
// Messages with a stamp that maps to no instant are left out and counted.
//
//   CaptureEvidence evidence(assumptions_of(scenario), StreamKind::kDepth);
//   KeptRecording().play(evidence);
//   const FactOrder order(evidence);
//
// Memory: 48 bytes a frame, 32 a poll or message. Complexity: O(1) an event.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "algorithms/certificates/stamped_facts.h"
#include "algorithms/device_time/unwrap.h"
#include "evaluation/certificates/assumptions.h"
#include "recording/recording.h"

namespace simbench::evaluation {

struct FrameEvidence {
  std::uint32_t camera = 0;
  std::uint32_t exposure_us = 0;
  DeviceTime sensor{};  // unwrapped
  SteadyTime arrival{};
  std::optional<TrueTime> truth{};  // the middle of its exposure
};

struct ClockPollEvidence {
  std::uint32_t camera = 0;
  DeviceTime device{};  // unwrapped
  SteadyTime t0{};
  SteadyTime t1{};
};

class CaptureEvidence final : public RecordingSink {
 public:
  // Frames of this stream count.
  CaptureEvidence(const Assumptions& assumptions, StreamKind stream);

  void on_start(const RigLayout& layout) override;
  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) override;
  void on_event(const RecordingEvent& event) override;

  const Assumptions& assumptions() const { return assumptions_; }
  const RigLayout& layout() const { return layout_; }
  std::span<const FrameEvidence> frames() const { return frames_; }
  std::span<const ClockPollEvidence> polls() const { return polls_; }
  std::span<const HostMessage> messages() const { return messages_; }
  std::size_t unusable_messages() const { return unusable_messages_; }
  // Exchanges that are left out since nothing says how far their stamps may be off.
  std::size_t estimated_exchanges() const { return estimated_exchanges_; }

 private:
  void add_exchange(std::uint32_t host, const Exchange& exchange);

  Assumptions assumptions_;
  StreamKind stream_;
  RigLayout layout_;
  std::vector<DeviceStampUnwrapper> registers_;  // by camera
  std::optional<StampedFacts> facts_;            // from the start on
  std::vector<FrameEvidence> frames_;
  std::vector<ClockPollEvidence> polls_;
  std::vector<HostMessage> messages_;
  std::size_t unusable_messages_ = 0;
  std::size_t estimated_exchanges_ = 0;
};

}  // namespace simbench::evaluation
