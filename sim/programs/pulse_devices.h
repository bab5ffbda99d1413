// The pulse-per-second line of a host as its programs have it: /dev/pps0, and the external stamps
// of the network card.
//
//  - /dev/pps0, where the host has a line (scenario /hosts/pulse_lines/pps): RFC 2783 by Linux'
//    requests. Its assert events are the pulses of Host::pulse_input(), with the same stamps on the
//    system clock, counted from the host's beginning. There are no clear events, as the scenario
//    says nothing of a pulse's length; no echo, and no kernel consumer.
//  - The card's only pin, SDP0, where the card has a clock too: the line is wired to it. With the
//    pin's function PTP_PF_EXTTS and stamps requested, the card stamps each pulse when it comes, on
//    its clock, with the noise and resolution of its other stamps. Programs are told when the
//    pulse's interrupt is served. One queue for all that have the card open, of the last 127.
//
// A file of /dev/pps0 is ready for reading at the first pulse after it was opened or last fetched
// from, one of the card while stamps wait. No call takes time.
//
// Source: RFC 2783; Linux' drivers/pps/pps.c, drivers/ptp/ptp_chardev.c and igb_ptp.c (a pin must
// have the function before stamps are requested: EBUSY).
//
//   PulseDevices pulses(host);
//   boost::asio::co_spawn(context, pulses.run(), boost::asio::detached);
//   const std::shared_ptr<DeviceFile> file = pulses.open(shim::HostDevice::kPulses);
//   file->on_event = [] { print("a pulse"); };
//   const pps_kinfo last = pulses.fetch(*file);
#pragma once

#include <linux/pps.h>
#include <linux/ptp_clock.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "shim/protocol.h"
#include "sim/engine/virtual_executor.h"
#include "sim/host/sim_host.h"

namespace simbench::sim {

class PulseDevices;

// A device that a program has opened.
struct DeviceFile {
  bool is_ready() const;

  const PulseDevices* devices = nullptr;
  shim::HostDevice device = shim::HostDevice::kCard;
  std::function<void()> on_event = [] {};  // it may be ready
  std::uint32_t fetched = 0;               // which pulse of the line was the last one then
};

class PulseDevices {
 public:
  static constexpr std::size_t kMostStamps = 127;
  // What /dev/pps0 can (PPS_GETCAP).
  static constexpr int kAbilities =
      PPS_CAPTUREASSERT | PPS_OFFSETASSERT | PPS_CANWAIT | PPS_TSFMT_TSPEC;

  // The host must outlive this.
  explicit PulseDevices(SimHost& host);

  bool has_line() const { return line_ != nullptr; }
  // Whether the card has a clock and a pin.
  bool has_pin() const { return has_line() && host_.nic() != nullptr; }

  // Takes the pulses as they come, for ever, where there is a line.
  Task<void> run();

  // Null: the host has no such device.
  std::shared_ptr<DeviceFile> open(shim::HostDevice device);
  bool is_ready(const DeviceFile& file) const;

  const pps_kparams& parameters() const { return parameters_; }
  // These return an errno, or 0.
  int set_parameters(const pps_kparams& wanted);
  pps_kinfo fetch(DeviceFile& file) const;

  // ptp_pin_function.
  unsigned pin() const { return pin_; }
  int set_pin(std::int64_t function, std::int64_t channel);
  int stamp_pulses(bool does);
  // As programs read the card's clock; the oldest first.
  std::vector<std::int64_t> take_stamps(std::size_t most);

 private:
  void assert_pulse(const SimPulseInput::Pulse& pulse);
  void stamp_by_card(const SimPulseInput::Pulse& pulse);
  void tell(shim::HostDevice device);

  SimHost& host_;
  SimPulseInput* line_;
  std::vector<std::weak_ptr<DeviceFile>> files_{};
  pps_kparams parameters_{};
  pps_kinfo last_{};
  unsigned pin_ = PTP_PF_NONE;
  bool does_stamp_ = false;
  std::deque<std::int64_t> stamps_{};
};

}  // namespace simbench::sim
