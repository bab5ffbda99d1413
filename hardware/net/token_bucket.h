// A rate limit: `per_second` in the long run, `burst` at once. Pure.
//
// SourceBuckets has a fixed number of buckets for all sources, so that a flood from one source
// spends its own tokens and those of the few that share its bucket. Pass port 0 for connections,
// whose port means nothing.
#pragma once

#include <algorithm>
#include <array>
#include <boost/asio/ip/address.hpp>
#include <cstdint>
#include <functional>

#include "hardware/clock/monotonic_time.h"

namespace simbench::hardware {

class TokenBucket {
 public:
  // False if there is no token.
  bool take(MonotonicTime now, double per_second, double burst) {
    if (!used_) tokens_ = burst;
    if (used_ && now > last_) {
      tokens_ = std::min(burst, tokens_ + to_seconds(now - last_) * per_second);
    }
    last_ = now;
    used_ = true;
    if (tokens_ < 1) return false;
    tokens_ -= 1;
    return true;
  }

 private:
  bool used_ = false;
  double tokens_ = 0;
  MonotonicTime last_{};
};

class SourceBuckets {
 public:
  SourceBuckets(double per_second, double burst) : per_second_(per_second), burst_(burst) {}

  bool take(const boost::asio::ip::address& source, std::uint16_t port, MonotonicTime now) {
    const std::size_t of_address = std::hash<boost::asio::ip::address>()(source);
    return buckets_[(of_address + port) % buckets_.size()].take(now, per_second_, burst_);
  }

 private:
  double per_second_;
  double burst_;
  std::array<TokenBucket, 61> buckets_;
};

}  // namespace simbench::hardware
