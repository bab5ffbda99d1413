#include "sim/rig/frame_feeds.h"

#include "sim/host/sim_frame_feed.h"

namespace simbench::sim {

FrameFeeds::FrameFeeds(const scenarios::Scenario& scenario, HostGroup& hosts)
    : hosts_(hosts),
      scored_(scenario.evaluation.stream == "colour" ? StreamKind::kColour : StreamKind::kDepth),
      traffic_share_(scenario.network.capture_traffic_share) {}

void FrameFeeds::on_delivery(std::uint32_t host, const FrameRecord& frame, double bytes) {
  if (traffic_share_ > 0) hosts_.network().send_capture_traffic(host, traffic_share_ * bytes);
  if (frame.stream != scored_) return;
  SimFrameFeed* feed = hosts_.host(host).opened_frame_feed();
  if (feed == nullptr) return;
  feed->push({.camera = frame.camera,
              .counter = frame.counter,
              .exposure_us = frame.exposure_us,
              .sensor = frame.sensor,
              .arrival = frame.arrival,
              .arrival_steady = frame.arrival_steady});
}

}  // namespace simbench::sim
