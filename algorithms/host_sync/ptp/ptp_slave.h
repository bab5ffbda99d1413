// A slave's end of PTP; see ptp.h.
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_PTP_PTP_SLAVE_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_PTP_PTP_SLAVE_H_

#include <cstdint>
#include <memory>
#include <optional>

#include "algorithms/host_sync/ptp/ptp_clock.h"
#include "algorithms/host_sync/ptp/ptp_message.h"
#include "algorithms/host_sync/ptp/ptp_offset.h"

namespace simbench {

class PtpSlave {
 public:
  PtpSlave(Host& host, PeerId master, PtpSettings settings);

  // Never ends, unless the host has no hardware clock and needs one.
  Task<void> run();

 private:
  // A message that a measurement waits with for the other one of its pair.
  struct Half {
    PtpMessage message;
    std::int64_t stamp = 0;  // arrival, or departure of the own request
  };

  ClockKind clock() const {
    return settings_.has_hardware_stamps ? ClockKind::kHardware : ClockKind::kSystem;
  }
  MessageChannel& channel() { return host_.open_channel(master_, Transport::kDatagram); }
  Task<void> ask();
  Task<void> take(ReceivedMessage received);
  // A copy of a Sync that has been used, or one that another has overtaken.
  bool is_late(std::uint16_t sequence) const;
  Task<void> take_sync();
  void take_delay_response(const PtpMessage& response);
  void take_peer_delay();
  Task<void> correct();
  void report(std::int64_t t1, std::int64_t t2, std::int64_t t3, std::int64_t t4);
  void report_outcome_if_due();

  Host& host_;
  PeerId master_;
  PtpSettings settings_;
  std::unique_ptr<Servo> servo_;
  std::optional<ClockCoupling> coupling_;  // with hardware stamps
  PtpOffset offset_;
  std::uint16_t sequence_ = 0;
  std::optional<Half> request_;
  std::optional<std::uint16_t> last_sync_;  // the last one used
  std::optional<Half> sync_;
  std::optional<PtpMessage> sync_follow_up_;
  std::optional<Half> peer_response_;
  std::optional<PtpMessage> peer_follow_up_;
  bool is_locked_ = false;
  bool is_reported_ = false;
  std::uint32_t corrections_ = 0;
  SteadyTime begin_{};
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_PTP_PTP_SLAVE_H_
