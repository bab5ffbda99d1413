#include <boost/circular_buffer.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "algorithms/certificates/online_certificates.h"
#include "algorithms/gathering/gatherers.h"
#include "algorithms/parameter_binder.h"
#include "algorithms/ports/assert.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

class CertifiedGatherer final : public Gatherer, private FrameSetSink {
 public:
  CertifiedGatherer(const GatheringSetup& setup, const CertifiedRig& rig)
      : most_apart_(Picoseconds(setup.period) / 2),
        certificates_(rig),
        inner_(make_yoon2021_gatherer(setup)),
        waiting_(setup.sources, boost::circular_buffer<Waiting>(kMostWaiting)) {
    tickets_.reserve(setup.sources);
  }

  void push(const GatherFrame& frame, FrameSetSink& sink) override {
    SIMBENCH_ASSERT(frame.source < waiting_.size(), "a frame of a source that does not exist");
    boost::circular_buffer<Waiting>& frames = waiting_[frame.source];
    if (frames.full()) {
      certificates_.release(frames.front().ticket);
      frames.pop_front();
    }
    frames.push_back({frame.sensor, certificates_.on_frame(frame.source, frame.sensor)});
    outer_ = &sink;
    inner_->push(frame, *this);
    outer_ = nullptr;
  }

  std::uint64_t discarded() const override { return inner_->discarded() + withheld_frames_; }
  bool wants_evidence() const override { return true; }
  void on_adjustment(const ClockAdjustment& adjustment) override {
    certificates_.on_adjustment(adjustment);
  }
  void on_exchange(PeerId host, const Exchange& exchange) override {
    certificates_.on_exchange(host, exchange);
  }
  void on_poll(std::uint32_t source, const PollSample& poll) override {
    certificates_.on_poll(source, poll);
  }

 private:
  // Frames of a source that may wait for their set; older ones are not certified.
  static constexpr std::size_t kMostWaiting = 128;

  struct Waiting {
    DeviceTime sensor{};
    OnlineCertificates::Ticket ticket{};
  };

  void on_set(std::span<const GatherFrame> set) override {
    tickets_.clear();
    for (const GatherFrame& frame : set) take_ticket(frame);
    const bool is_certified =
        tickets_.size() == set.size() && certificates_.apart(tickets_) < most_apart_;
    for (const OnlineCertificates::Ticket& ticket : tickets_) certificates_.release(ticket);
    if (is_certified) return outer_->on_set(set);
    withheld_frames_ += set.size();
  }

  // Frames of the source before it are in no set any more.
  void take_ticket(const GatherFrame& frame) {
    boost::circular_buffer<Waiting>& frames = waiting_[frame.source];
    while (!frames.empty()) {
      const Waiting oldest = frames.front();
      frames.pop_front();
      if (oldest.sensor == frame.sensor) return tickets_.push_back(oldest.ticket);
      certificates_.release(oldest.ticket);
    }
  }

  Picoseconds most_apart_;
  OnlineCertificates certificates_;
  std::unique_ptr<Gatherer> inner_;
  FrameSetSink* outer_ = nullptr;
  std::vector<boost::circular_buffer<Waiting>> waiting_;  // by source
  std::vector<OnlineCertificates::Ticket> tickets_;
  std::uint64_t withheld_frames_ = 0;
};

const char* const kDataSheets = "data sheets of quartz oscillators; docs/certificates.md";

struct CertifiedSettings {
  double host_rate_ppm = 50;
  double camera_rate_ppm = 100;
  double host_stamp_error_us = 1;
  double estimated_stamp_error_us = 0;
  double sensor_stamp_error_us = 20;

  std::optional<Nanoseconds> estimate_error() const {
    if (estimated_stamp_error_us == 0) return std::nullopt;
    return from_us(estimated_stamp_error_us);
  }

  void bind(ParameterBinder& parameters) {
    parameters.number("host_rate_ppm", host_rate_ppm, 0, 1e5,
                      "rate error of a host's oscillator, at most", kDataSheets);
    parameters.number("camera_rate_ppm", camera_rate_ppm, 0, 1e5,
                      "rate error of a camera's clock, at most", kDataSheets);
    parameters.number("host_stamp_error_us", host_stamp_error_us, 0, 1e6,
                      "error of a host's stamp beyond its clock's granularity, at most, either way",
                      "assumption");
    parameters.number("estimated_stamp_error_us", estimated_stamp_error_us, 0, 1e6,
                      "that of a stamp which the host_sync estimated, as two_way and cards do; 0: "
                      "such exchanges prove nothing",
                      "assumption");
    parameters.number("sensor_stamp_error_us", sensor_stamp_error_us, 0, 1e6,
                      "distance of a sensor stamp from the middle of its exposure, at most",
                      "assumption");
  }
};

}  // namespace

std::unique_ptr<Gatherer> make_certified_gatherer(const GatheringSetup& setup,
                                                  const CertifiedRig& rig) {
  return std::make_unique<CertifiedGatherer>(setup, rig);
}

std::vector<GatheringEntry> gathering_certified() {
  return {with_settings<GatheringEntry>(
      {.name = "certified",
       .family = "certified",
       .summary = "the sets of yoon2021 whose frames are surely within half a period",
       .source = "Patt-Shamir and Rajsbaum, STOC 1994; docs/certificates.md"},
      CertifiedSettings{}, [](const CertifiedSettings& settings, const GatheringSetup& setup) {
        const bool knows_hosts = !setup.host_of_source.empty();
        return make_certified_gatherer(
            setup,
            {.hosts = knows_hosts ? setup.hosts : 1,
             .host_of_camera =
                 knows_hosts ? setup.host_of_source : std::vector<std::uint32_t>(setup.sources),
             .host_rate_ppm = settings.host_rate_ppm,
             .camera_rate_ppm = settings.camera_rate_ppm,
             .host_stamp_error = from_us(settings.host_stamp_error_us) + setup.host_clock_step,
             .estimate_error = settings.estimate_error(),
             .sensor_stamp_error = from_us(settings.sensor_stamp_error_us)});
      })};
}

}  // namespace simbench
