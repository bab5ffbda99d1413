// Huygens' network effect: the offsets between hosts that agree best with all pairs' lines.
//
// Around a loop of hosts the true leads of one clock over the next add up to zero; measured ones do
// not. The least change of all measured leads that closes every loop, the paper's minimum-norm
// correction, is the projection onto the leads that come from offsets of single hosts: so it is the
// least-squares fit of those offsets.
//
// An error of a pair's own is shared out: with independent errors of variance v on E pairs of n
// hosts the corrected ones have variance v (n - 1) / E on average, 2 v / n in a full mesh, and a
// single pair's error e leaves 2 e / n on its pair. An error that is a difference of something of
// each host (the asymmetry of its port or of its stack) closes every loop already, and all of it
// stays.
//
// Source: Geng et al., NSDI 2018, section on the network effect [theory, derived here]; docs/
// reference/host_sync.md section 1 (Huygens).
//
//   const auto offsets = loop_corrected({{0, 1, 5.0}, {1, 2, 5.0}, {0, 2, 13.0}}, 3);
//   // 0, 6, 12
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "algorithms/host_sync/huygens/coded_probes.h"
#include "algorithms/ports/exchange.h"

namespace simbench {

// What b leads a by, measured.
struct PairLead {
  PeerId a = 0;
  PeerId b = 0;
  double lead_ns = 0;
};

// The lead of each host over host 0; nothing for a host that no pairs connect with it. Hosts of the
// pairs are below `hosts`. Complexity: O(hosts^3).
std::vector<std::optional<double>> loop_corrected(const std::vector<PairLead>& pairs,
                                                  std::size_t hosts);

using PairLines = std::map<std::pair<PeerId, PeerId>, PairLine>;  // by (a, b), a < b

// Corrects the leads that lines give at time `x_ns` of host 0's raw clock. Each line is evaluated
// at its own clock's reading of that instant.
std::vector<std::optional<std::int64_t>> loop_corrected_leads(const PairLines& lines,
                                                              std::int64_t x_ns, std::size_t hosts);

// Which pairs probe each other: all of them if each host has at most `neighbours` others, else a
// ring through all hosts and random pairs, until a host has `neighbours` on average. `uniform`
// draws from [0, 1). Pairs are (a, b), a < b, sorted.
std::vector<std::pair<PeerId, PeerId>> probed_pairs(std::size_t hosts, std::size_t neighbours,
                                                    const std::function<double()>& uniform);

}  // namespace simbench
