// The master's end of PTP towards one slave; see ptp.h.
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_PTP_PTP_MASTER_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_PTP_PTP_MASTER_H_

#include <cstdint>
#include <memory>

#include "algorithms/host_sync/ptp/ptp_clock.h"
#include "algorithms/host_sync/ptp/ptp_message.h"

namespace simbench {

class PtpMaster {
 public:
  // Sync is sent while *is_ready.
  PtpMaster(Host& host, PeerId slave, PtpSettings settings, std::shared_ptr<const bool> is_ready)
      : host_(host), slave_(slave), settings_(settings), is_ready_(std::move(is_ready)) {}

  // Never ends.
  Task<void> run();

 private:
  ClockKind clock() const {
    return settings_.has_hardware_stamps ? ClockKind::kHardware : ClockKind::kSystem;
  }
  MessageChannel& channel() { return host_.open_channel(slave_, Transport::kDatagram); }
  Task<void> send_sync();
  Task<void> answer(ReceivedMessage received);
  Task<void> answer_peer_delay(PtpMessage request, std::int64_t arrival);

  Host& host_;
  PeerId slave_;
  PtpSettings settings_;
  std::shared_ptr<const bool> is_ready_;
  std::uint16_t sequence_ = 0;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_PTP_PTP_MASTER_H_
