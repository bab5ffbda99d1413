// One host's end of the probes between two hosts (huygens.h, steps 2 and 3).
//
// Host a is the one of the lower number. Host b sends it the hull of the probes from a to b, and a
// finds the line.
//
//   ProbeLink link(host, master, HuygensSettings{}, raw);
//   co_await link.probe();
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "algorithms/host_sync/huygens/coded_probes.h"
#include "algorithms/host_sync/huygens/huygens.h"
#include "algorithms/host_sync/huygens/huygens_messages.h"
#include "algorithms/host_sync/huygens/raw_clock.h"
#include "laws/lower_hull.h"

namespace simbench {

class ProbeLink {
 public:
  // Host and clock must outlive this.
  ProbeLink(Host& host, PeerId peer, const HuygensSettings& settings, RawClock& raw);

  // Sends probes for ever, unless the host lacks the stamps.
  Task<void> probe();
  // A probe that has arrived. On b: the hull of a window that this one ends.
  std::optional<BoundsMessage> take(const ProbeMessage& probe, std::int64_t arrived_ns);
  CodedProbes::Count count() const { return probes_.count(); }
  // On a: the line of the window that b's hull is of.
  std::optional<PairLine> take(const BoundsMessage& bounds);

 private:
  // b: points above the line of b's lead over a, of the present window.
  struct Window {
    std::uint32_t number = 0;
    std::size_t points = 0;
    std::int64_t begin_ns = 0;
    std::int64_t end_ns = 0;
    LowerHull hull;
  };

  Task<std::optional<std::int64_t>> send(ProbeMessage probe);
  std::optional<BoundsMessage> add_above(std::uint32_t pair, const CodedProbes::Pair& ways);
  void add_below(const CodedProbes::Pair& ways);

  Host& host_;
  PeerId peer_;
  HuygensSettings settings_;
  RawClock& raw_;
  bool is_a_;
  CodedProbes probes_;
  Window window_;
  std::deque<LinePoint> below_negated_;  // a: of the last windows
};

}  // namespace simbench
