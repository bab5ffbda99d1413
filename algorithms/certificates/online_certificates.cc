#include "algorithms/certificates/online_certificates.h"

#include <algorithm>

namespace simbench {
namespace {

std::vector<RateBound> rates_of(const CertifiedRig& rig) {
  std::vector<RateBound> rates(rig.hosts, RateBound(rig.host_rate_ppm));
  rates.resize(rig.hosts + rig.host_of_camera.size(), RateBound(rig.camera_rate_ppm));
  return rates;
}

}  // namespace

OnlineCertificates::OnlineCertificates(const CertifiedRig& rig)
    : rig_(rig),
      graph_(rates_of(rig)),
      facts_(rig.hosts, rig.host_stamp_error, rig.estimate_error) {}

void OnlineCertificates::on_adjustment(const ClockAdjustment& adjustment) {
  facts_.add(adjustment);
}

OnlineCertificates::Instant OnlineCertificates::instant(std::size_t clock, Nanoseconds local) {
  if (graph_.has_begun(clock)) {
    const ClockGraph::Point newest = graph_.newest(clock);
    if (local <= graph_.local_of(newest)) return {newest, local - graph_.local_of(newest)};
  }
  return {graph_.advance(clock, local), Nanoseconds(0)};
}

void OnlineCertificates::happened(const Instant& earlier, const Instant& later) {
  if (is_contradicted_) return;
  const RateBound& rate_before = graph_.rate_of(graph_.clock_of(earlier.point));
  const RateBound& rate_after = graph_.rate_of(graph_.clock_of(later.point));
  // t(earlier.point) + least before <= t(earlier) <= t(later) <= t(later.point) + most after.
  const Picoseconds most =
      rate_after.most(later.from_point) - rate_before.least(earlier.from_point);
  is_contradicted_ = !graph_.bound(later.point, earlier.point, most);
}

void OnlineCertificates::on_poll(std::uint32_t camera, const PollSample& poll) {
  const std::size_t host = rig_.host_of_camera[camera];
  const std::size_t clock = rig_.hosts + camera;
  const Nanoseconds device = poll.device.time_since_epoch();
  const Instant read_least = instant(clock, device);
  const Instant asked = instant(host, poll.t0_steady.time_since_epoch() - kSteadyStep);
  // The register showed `device` until a step later.
  happened(asked, {read_least.point, read_least.from_point + kRegisterStep});
  happened(read_least, instant(host, poll.t1_steady.time_since_epoch() + kSteadyStep));
}

void OnlineCertificates::on_exchange(std::uint32_t host, const Exchange& exchange) {
  for (const std::optional<HostMessage>& message : facts_.messages_of(host, exchange).usable) {
    if (!message) continue;
    const Instant departure = instant(message->from, message->sent.time_since_epoch());
    happened(departure, instant(message->to, message->received.time_since_epoch()));
  }
}

OnlineCertificates::Ticket OnlineCertificates::on_frame(std::uint32_t camera, DeviceTime sensor) {
  const Nanoseconds error = rig_.sensor_stamp_error;
  const Instant at = instant(rig_.hosts + camera, sensor.time_since_epoch());
  graph_.keep(at.point);
  return {at.point, at.from_point - error, at.from_point + error + kRegisterStep, camera};
}

void OnlineCertificates::release(const Ticket& ticket) { graph_.release(ticket.point); }

Picoseconds OnlineCertificates::later_by(const Ticket& from, const Ticket& to) const {
  const Picoseconds points = graph_.most(from.point, to.point);
  const RateBound& rate_from = graph_.rate_of(rig_.hosts + from.camera);
  const Picoseconds after = graph_.rate_of(rig_.hosts + to.camera).most(to.most);
  if (!ClockGraph::is_bounded(points) || !ClockGraph::is_bounded(after)) {
    return ClockGraph::kUnbounded;
  }
  return points + after - rate_from.least(from.least);
}

Picoseconds OnlineCertificates::apart(std::span<const Ticket> frames) const {
  if (is_contradicted_) return ClockGraph::kUnbounded;
  Picoseconds apart{};
  for (std::size_t a = 0; a < frames.size(); ++a) {
    for (std::size_t b = 0; b < frames.size(); ++b) {
      if (a != b) apart = std::max(apart, later_by(frames[a], frames[b]));
    }
  }
  return apart;
}

}  // namespace simbench
