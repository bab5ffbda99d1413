// The client of NtpService on one slave (ntp_service.h says what it does).
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_NTP_CLIENT_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_NTP_CLIENT_H_

#include <cstdint>
#include <optional>
#include <string>

#include "algorithms/host_sync/ntp/ntp_association.h"
#include "algorithms/host_sync/ntp/ntp_clock_filter.h"
#include "algorithms/host_sync/ntp/ntp_discipline.h"
#include "algorithms/host_sync/ntp/ntp_service.h"

namespace simbench {

class NtpClient {
 public:
  static constexpr int kBurst = 8;
  static constexpr Nanoseconds kBurstSpacing{2'000'000'000};
  static constexpr std::uint32_t kPatience = 8;  // polls without reply, then it is an outcome

  // The host must outlive the client, the client its coroutines.
  NtpClient(Host& host, PeerId server, const NtpSettings& settings);

  // Endless, but for a panic.
  Task<void> run();

 private:
  Task<void> run_unicast();
  Task<void> run_broadcast();
  Task<void> poll();
  // The first broadcast, a burst, the next broadcast: what the delay is.
  Task<void> calibrate();
  Task<void> listen();

  // Exchanges up to `count`, at burst spacing; ends early when the first is not answered. Returns
  // the sample to discipline the clock by, if any.
  Task<std::optional<NtpSample>> burst(int count);
  std::optional<NtpSample> add_sample(const NtpSample& sample);
  Task<NtpAction> discipline_by(std::optional<NtpSample> sample);
  Task<void> step(double offset_s);
  Task<void> correct_frequency();
  Task<void> correct_phase();

  double seconds(SteadyTime at) const { return to_seconds(at - start_); }
  SteadyTime now() const { return host_.steady_clock().now(); }
  void note_reply(bool replied);
  void report(bool synchronised, const std::string& message);

  Host& host_;
  PeerId server_;
  NtpSettings settings_;
  NtpAssociation association_;
  NtpClockFilter filter_;
  NtpDiscipline discipline_;
  SteadyTime start_;
  double root_distance_s_ = 0;    // of the server
  double broadcast_delay_s_ = 0;  // one way
  double applied_frequency_ = 0;
  std::uint8_t reach_ = 0;  // one bit per poll, the last one lowest
  std::uint32_t polls_ = 0;
  bool is_slewing_ = false;
  bool reported_ = false;
  bool panicked_ = false;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_NTP_CLIENT_H_
