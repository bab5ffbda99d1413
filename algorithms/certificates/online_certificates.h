// Certificates while a capture runs: from what has been reported until now.
//
// The ClockGraph of a rig, fed event by event. A frame gets a ticket; apart() bounds how far the
// frames of some tickets can be from each other, and release() ends a ticket. What is reported
// late, an exchange whose stamps lie before its clock's newest point, is taken at the newest point
// with its distance in between bounded by the clock's rate: sure, and wider by that drift (0.1 us
// for 1 ms).
//
//   OnlineCertificates rig({.hosts = 2, .host_of_camera = {0, 1}});
//   rig.on_poll(0, {});
//   const std::array frames = {rig.on_frame(0, DeviceTime()), rig.on_frame(1, DeviceTime())};
//   const bool is_sure = rig.apart(frames) < Picoseconds(from_ms(11));
//
// After a contradiction (is_contradicted()) nothing is sure any more: apart() is unbounded.
//
// Complexity: a frame O(n) for n live points, which are a clock each and a ticket each; a poll or
// an exchange O(n^2) where it tells something new; apart() O(tickets^2). No allocation in steady
// state. Source: clock_graph.h; Ostrovsky and Patt-Shamir, PODC 1999.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "algorithms/certificates/clock_graph.h"
#include "algorithms/certificates/stamped_facts.h"
#include "algorithms/device_time/device_time.h"
#include "algorithms/ports/exchange.h"

namespace simbench {

struct CertifiedRig {
  std::uint32_t hosts = 0;
  std::vector<std::uint32_t> host_of_camera{};
  double host_rate_ppm = 50;
  double camera_rate_ppm = 100;
  Nanoseconds host_stamp_error{101};  // of a stamp of a host's system clock, either way
  // And of one that a protocol estimated (Exchange::is_estimated); empty: these do not count.
  std::optional<Nanoseconds> estimate_error{};
  Nanoseconds sensor_stamp_error{17'000};  // of a sensor stamp from the middle of its exposure
};

class OnlineCertificates {
 public:
  explicit OnlineCertificates(const CertifiedRig& rig);

  void on_adjustment(const ClockAdjustment& adjustment);
  void on_exchange(std::uint32_t host, const Exchange& exchange);
  void on_poll(std::uint32_t camera, const PollSample& poll);

  // A frame whose middle of the exposure its camera stamped so. It is live until it is released.
  struct Ticket {
    ClockGraph::Point point{};
    Nanoseconds least{};  // from the point's count to those that the frame may have
    Nanoseconds most{};
    std::uint32_t camera = 0;
  };
  Ticket on_frame(std::uint32_t camera, DeviceTime sensor);
  void release(const Ticket& ticket);

  // No two of the frames are further apart; ClockGraph::kUnbounded if that is not known.
  Picoseconds apart(std::span<const Ticket> frames) const;
  bool is_contradicted() const { return is_contradicted_; }

 private:
  // An instant of a clock, as a point that is live and a distance from it.
  struct Instant {
    ClockGraph::Point point{};
    Nanoseconds from_point{};
  };

  Instant instant(std::size_t clock, Nanoseconds local);
  // earlier <= later.
  void happened(const Instant& earlier, const Instant& later);
  Picoseconds later_by(const Ticket& from, const Ticket& to) const;

  CertifiedRig rig_;
  ClockGraph graph_;
  StampedFacts facts_;
  bool is_contradicted_ = false;
};

}  // namespace simbench
