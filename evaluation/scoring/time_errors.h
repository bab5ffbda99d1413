// The time errors (TE) of the slaves of a rig, in summary: system clock minus the master's.
//
//   max |TE|     the largest of any host at any instant
//   RMS TE       over all slaves and instants
//   constant TE  the mean of a host's TE, of the host where it is largest
//   dynamic TE   the range (peak to peak) of a host's TE, of the host where it is largest; not
//                low-pass filtered
//
// NaN: no slave, or no instant. Memory: per host. Source of the terms: ITU-T G.8260 and G.8273.2,
// where the constant TE is a mean over 1000 s and the dynamic TE is filtered below 0.1 Hz.
//
//   TimeErrors errors(/*hosts=*/6);
//   errors.add(/*host=*/1, -0.003);
//   errors.add_to(seed_score);
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "evaluation/scoring/metrics.h"

namespace simbench::evaluation {

class TimeErrors {
 public:
  explicit TimeErrors(std::size_t hosts) : hosts_(hosts) {}

  // One more instant of a slave, 1 to hosts - 1.
  void add(std::size_t host, double te_ms) {
    Host& of = hosts_[host];
    if (of.count == 0) of.least = of.greatest = te_ms;
    of.least = std::min(of.least, te_ms);
    of.greatest = std::max(of.greatest, te_ms);
    of.sum += te_ms;
    of.squares += te_ms * te_ms;
    ++of.count;
  }

  // The mean of each host; 0 of one without instants, as the master.
  std::vector<double> means_ms() const {
    std::vector<double> means;
    for (const Host& host : hosts_) {
      means.push_back(host.count == 0 ? 0 : host.sum / static_cast<double>(host.count));
    }
    return means;
  }

  // Sets the score's max_te_ms, rms_te_ms, constant_te_ms and dynamic_te_ms.
  void add_to(MetricValues<double>& score) const {
    double squares = 0;
    std::int64_t count = 0;
    for (const Host& host : hosts_) {
      if (host.count == 0) continue;
      squares += host.squares;
      count += host.count;
      const auto larger = [](double a, double b) { return std::fmax(a, b); };  // NaN is nothing
      score.max_te_ms =
          larger(score.max_te_ms, std::max(std::abs(host.least), std::abs(host.greatest)));
      score.constant_te_ms =
          larger(score.constant_te_ms, std::abs(host.sum / static_cast<double>(host.count)));
      score.dynamic_te_ms = larger(score.dynamic_te_ms, host.greatest - host.least);
    }
    if (count > 0) score.rms_te_ms = std::sqrt(squares / static_cast<double>(count));
  }

 private:
  struct Host {
    double least = 0;
    double greatest = 0;
    double sum = 0;
    double squares = 0;
    std::int64_t count = 0;
  };
  std::vector<Host> hosts_;
};

}  // namespace simbench::evaluation
