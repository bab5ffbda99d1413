// What a certificate costs a program that makes it while it captures (algorithms/certificates): a
// pulse of a rig of 6 hosts with 3 cameras each, 45 times a second; time per frame.
//
// "frames": the frames of a pulse, the bound of their set, and their release. "polls": a poll of
// each camera's clock besides, at every pulse. "exchanges": and an exchange of every slave, ten
// times as often as the quickest protocol. "yoon2021": what its gatherer takes for the same frames,
// to compare with.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "algorithms/certificates/online_certificates.h"
#include "algorithms/gathering/gatherers.h"

namespace simbench {
namespace {

constexpr std::uint32_t kHosts = 6;
constexpr std::uint32_t kCameras = 18;
constexpr Microseconds kPeriod{22'222};
constexpr Microseconds kWay{400};  // of a poll or a message

struct Load {
  bool polls = false;
  bool exchanges = false;
};

CertifiedRig rig() {
  CertifiedRig made{.hosts = kHosts};
  for (std::uint32_t camera = 0; camera < kCameras; ++camera) {
    made.host_of_camera.push_back(camera % kHosts);
  }
  return made;
}

void poll_all(OnlineCertificates& certificates, Microseconds at) {
  for (std::uint32_t camera = 0; camera < kCameras; ++camera) {
    certificates.on_poll(camera, {.device = DeviceTime(at),
                                  .t0_steady = SteadyTime(at - kWay),
                                  .t1_steady = SteadyTime(at + kWay)});
  }
}

void exchange_all(OnlineCertificates& certificates, Microseconds at) {
  const HostTime now(at);
  for (std::uint32_t host = 1; host < kHosts; ++host) {
    certificates.on_exchange(
        host, {.peer = 0, .t1 = now - 2 * kWay, .t2 = now - kWay, .t3 = now - kWay, .t4 = now});
  }
}

void certify(benchmark::State& state, const Load& load) {
  OnlineCertificates certificates(rig());
  for (std::uint32_t host = 0; host < kHosts; ++host) certificates.on_adjustment({.host = host});
  std::vector<OnlineCertificates::Ticket> tickets;
  Microseconds at = kPeriod;
  exchange_all(certificates, at);
  poll_all(certificates, at);
  for (auto iteration : state) {
    at += kPeriod;
    tickets.clear();
    for (std::uint32_t camera = 0; camera < kCameras; ++camera) {
      tickets.push_back(certificates.on_frame(camera, DeviceTime(at)));
    }
    if (load.polls) poll_all(certificates, at + kWay);
    if (load.exchanges) exchange_all(certificates, at + 3 * kWay);
    benchmark::DoNotOptimize(certificates.apart(tickets));
    for (const OnlineCertificates::Ticket& ticket : tickets) certificates.release(ticket);
  }
  state.SetItemsProcessed(state.iterations() * kCameras);
}

class NoSets final : public FrameSetSink {
 public:
  void on_set(std::span<const GatherFrame> set) override { benchmark::DoNotOptimize(set.data()); }
};

void gather(benchmark::State& state) {
  const std::unique_ptr<Gatherer> gatherer =
      make_yoon2021_gatherer({.sources = kCameras, .period = kPeriod, .interval = kPeriod / 2});
  NoSets sink;
  Microseconds at = kPeriod;
  for (auto iteration : state) {
    at += kPeriod;
    for (std::uint32_t camera = 0; camera < kCameras; ++camera) {
      gatherer->push({.source = camera,
                      .stamp = GlobalTime(at),
                      .arrival = GlobalTime(at),
                      .sensor = DeviceTime(at)},
                     sink);
    }
  }
  state.SetItemsProcessed(state.iterations() * kCameras);
}

BENCHMARK_CAPTURE(certify, frames, Load{});
BENCHMARK_CAPTURE(certify, polls, Load{.polls = true});
BENCHMARK_CAPTURE(certify, exchanges, Load{.polls = true, .exchanges = true});
BENCHMARK(gather)->Name("gather/yoon2021");

}  // namespace
}  // namespace simbench
