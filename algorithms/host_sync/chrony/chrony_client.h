// The client of ChronyService on one slave (chrony_service.h says what it does).
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_CLIENT_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_CLIENT_H_

#include <cstdint>
#include <optional>

#include "algorithms/host_sync/chrony/chrony_poll.h"
#include "algorithms/host_sync/chrony/chrony_reference.h"
#include "algorithms/host_sync/chrony/chrony_service.h"
#include "algorithms/host_sync/chrony/chrony_source_stats.h"
#include "algorithms/host_sync/ntp/ntp_association.h"

namespace simbench {

// What a slew has still to add, at any time from its start on.
struct UnfinishedSlew {
  double offset_s = 0;
  double rate = 0;  // as a fraction
  double start_s = 0;
  double duration_s = 0;  // of the part of it that was begun

  double left_s(double at_s) const;
};

class ChronyClient {
 public:
  static constexpr int kBurst = 4;
  static constexpr Nanoseconds kBurstSpacing{2'000'000'000};
  static constexpr Nanoseconds kMaxDelay{3'000'000'000};
  static constexpr std::uint32_t kPatience = 8;  // polls without reply, then it is an outcome

  // The host must outlive the client, the client its coroutines.
  ChronyClient(Host& host, PeerId server, const ChronySettings& settings);

  // Endless.
  Task<void> run();

 private:
  Task<void> poll();
  // Whether there is an estimate to correct the clock by.
  bool use(const NtpMeasurement& measurement);
  Task<void> correct();
  // Adds `offset_s` at a rate, as a fraction; in parts, each as long as is sure to be needed.
  Task<void> slew(double offset_s, double rate);
  // The measurement as seen by the clock that has finished its slew.
  ChronySample sample_of(const NtpMeasurement& measurement) const;

  double seconds(SteadyTime at) const { return to_seconds(at - start_); }
  double now_s() const { return seconds(host_.steady_clock().now()); }
  void report(bool synchronised);

  Host& host_;
  PeerId server_;
  ChronySettings settings_;
  NtpAssociation association_;
  ChronySourceStats stats_;
  ChronyReference reference_;
  ChronyPoll poll_;
  UnfinishedSlew slew_;
  SteadyTime start_;
  std::uint32_t polls_ = 0;
  std::uint32_t replies_ = 0;
  int good_samples_ = 0;
  bool reported_ = false;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_CLIENT_H_
