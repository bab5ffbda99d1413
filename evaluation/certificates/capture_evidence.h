// What a recording says of when its frames were exposed, without any estimate: its frames, its
// polls of cameras' clocks, and the messages of its host synchronisation.
//
// A message ties two hosts: it was received after it was sent, whatever protocol sent it. A stamp
// of a system clock is mapped to the host's steady clock, which nobody sets (stamped_facts.h).
// Messages with a stamp that maps to no instant are left out and counted.
//
// Clocks outside the rig tie hosts, too: GNSS time by the pulses of PPS lines, and the servers that
// logs of other programs name (exchange_log.h). They are clocks behind those of the cameras; as the
// end of a message they are numbered from the number of hosts on.
//
//   CaptureEvidence evidence(assumptions_of(scenario), StreamKind::kDepth);
//   KeptRecording().play(evidence);
//   evidence.add(0, read_exchange_log("rawstats"), {});
//   const FactOrder order(evidence);
//
// Memory: 48 bytes a frame, 32 a poll or message. Complexity: O(1) an event.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "algorithms/certificates/stamped_facts.h"
#include "algorithms/device_time/unwrap.h"
#include "evaluation/certificates/assumptions.h"
#include "evaluation/stability/exchange_log.h"
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

// What counts as evidence, and what does not.
struct EvidenceCounts {
  std::size_t messages = 0;
  std::size_t unusable_messages = 0;    // with a stamp that its clock never read
  std::size_t estimated_exchanges = 0;  // left out: nothing says how far their stamps may be off
  std::size_t polls = 0;
  std::size_t pulses = 0;
  std::size_t unused_pulses = 0;   // left out: nothing says how late they were seen
  std::size_t logged_outside = 0;  // of logs, from before or after the capture

  void operator+=(const EvidenceCounts& other);
};

// A clock outside the rig.
struct OutsideClock {
  std::string name;       // "GNSS", or the address of a server
  bool is_exact = false;  // its rate is that of true time; else within a host's bound
};

class CaptureEvidence final : public RecordingSink {
 public:
  // Frames of this stream count.
  CaptureEvidence(const Assumptions& assumptions, StreamKind stream);

  void on_start(const RigLayout& layout) override;
  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) override;
  void on_event(const RecordingEvent& event) override;

  // What a program on a host logged while the capture went on, after it was played. A server whose
  // address stands for a host of the rig is that host.
  void add(std::uint32_t host, const ExchangeLog& log,
           const std::map<std::string, std::uint32_t>& host_of_address);

  const Assumptions& assumptions() const { return assumptions_; }
  const RigLayout& layout() const { return layout_; }
  std::span<const FrameEvidence> frames() const { return frames_; }
  std::span<const ClockPollEvidence> polls() const { return polls_; }
  std::span<const HostMessage> messages() const { return messages_; }
  const EvidenceCounts& counts() const { return counts_; }
  std::span<const OutsideClock> outside_clocks() const { return outside_; }

  // How many there are: hosts, cameras, those outside.
  std::size_t clocks() const { return layout_.hosts + layout_.cameras.size() + outside_.size(); }
  // The clock of an end of a message.
  std::size_t clock_of(std::uint32_t end) const {
    return end < layout_.hosts ? end : end + layout_.cameras.size();
  }
  // Where a stamp is that no clock counts ("a frame of camera 3"), the first of them; empty:
  // nowhere.
  const std::string& broken() const { return broken_; }
  // "host 2", "camera 0", or the name of one outside.
  std::string name_of(std::size_t clock) const;

 private:
  void note_broken(std::string where);
  void add_exchange(std::uint32_t host, const Exchange& exchange);
  // A full second of an outside clock that a host saw within `seen`.
  void add_pulse(std::uint32_t host, std::uint32_t outside, Nanoseconds second, SteadyRange seen);
  void add_logged(std::uint32_t host, std::uint32_t server, const LoggedExchange& exchange);
  // The number of the outside clock of that name.
  std::uint32_t outside(const std::string& name, bool is_exact);
  void note_time(std::uint32_t host, SteadyTime at);
  bool is_of_capture(std::uint32_t host, const SteadyRange& range) const;
  // A stamp of an end of a message on its clock; `slack`: by how much that may move against another
  // clock if the stamp is off by the exchange's common error.
  struct PlacedStamp {
    SteadyRange range{};
    Nanoseconds slack{0};
  };
  std::optional<PlacedStamp> placed(std::uint32_t end, HostTime stamp,
                                    const LoggedExchange& exchange) const;

  Assumptions assumptions_;
  StreamKind stream_;
  RigLayout layout_;
  std::vector<DeviceStampUnwrapper> registers_;  // by camera
  std::optional<StampedFacts> facts_;            // from the start on
  std::vector<FrameEvidence> frames_;
  std::vector<ClockPollEvidence> polls_;
  std::vector<HostMessage> messages_;
  EvidenceCounts counts_;
  std::string broken_{};
  std::vector<OutsideClock> outside_;
  std::vector<std::optional<SteadyTime>> begin_;  // of what was recorded, by host
  Nanoseconds longest_{0};                        // from there on, the same for all hosts
};

}  // namespace simbench::evaluation
