#include "evaluation/replay/rig_frames.h"

#include <algorithm>
#include <chrono>
#include <tuple>

#include "algorithms/gathering/genlock_order.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

// T_int: "less than half a frame interval is sufficient" (paper).
constexpr std::int64_t kIntervalsPerPeriod = 2;

std::optional<Nanoseconds> rig_period(const RigMembers& members) {
  std::vector<double> periods;
  for (const CameraReplay* camera : members) {
    const Nanoseconds period = median_period(camera->frames);
    if (period >= Microseconds(1)) periods.push_back(to_ms(period));
  }
  return periods.empty() ? std::nullopt : std::optional(from_ms(median(periods)));
}

// The frames of each pulse that every camera delivered, by GenLock order; source after source.
std::vector<RigFrame> complete_pulses(const RigMembers& members, Nanoseconds period) {
  struct Indexed {
    std::int64_t index;
    RigFrame id;
  };
  std::vector<Indexed> all;
  for (std::uint32_t source = 0; source < members.size(); ++source) {
    GenlockOrder order(period, GenlockOrder::Variant::kReanchored);
    const std::vector<StampedFrame>& frames = members[source]->frames;
    for (std::uint32_t i = 0; i < frames.size(); ++i) {
      all.push_back({order.next(device_time_of(frames[i])), {source, i}});
    }
  }
  std::sort(all.begin(), all.end(), [](const Indexed& a, const Indexed& b) {
    return std::tie(a.index, a.id.source, a.id.frame) < std::tie(b.index, b.id.source, b.id.frame);
  });
  // Two frames of a camera with one index: the first counts.
  const auto same = [](const Indexed& a, const Indexed& b) {
    return a.index == b.index && a.id.source == b.id.source;
  };
  all.erase(std::unique(all.begin(), all.end(), same), all.end());
  std::vector<RigFrame> complete;
  for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
    while (end < all.size() && all[end].index == all[begin].index) ++end;
    if (end - begin != members.size()) continue;
    for (std::size_t i = begin; i < end; ++i) complete.push_back(all[i].id);
  }
  return complete;
}

// All frames in order of arrival. A camera's own frames stay in their order of delivery, even where
// the host's clock went back.
std::vector<RigFrame> order_of_arrival(const RigMembers& members) {
  struct Arrival {
    Nanoseconds latest;
    RigFrame id;
  };
  std::vector<Arrival> all;
  for (std::uint32_t source = 0; source < members.size(); ++source) {
    Nanoseconds latest = Nanoseconds::min();
    const std::vector<StampedFrame>& frames = members[source]->frames;
    for (std::uint32_t i = 0; i < frames.size(); ++i) {
      latest = std::max(latest, frames[i].arrival);
      all.push_back({latest, {source, i}});
    }
  }
  std::sort(all.begin(), all.end(), [](const Arrival& a, const Arrival& b) {
    return std::tie(a.latest, a.id.source, a.id.frame) <
           std::tie(b.latest, b.id.source, b.id.frame);
  });
  std::vector<RigFrame> order;
  order.reserve(all.size());
  for (const Arrival& arrival : all) order.push_back(arrival.id);
  return order;
}

}  // namespace

DeviceTime device_time_of(const StampedFrame& frame) {
  return DeviceTime(std::chrono::round<Microseconds>(frame.sensor));
}

std::optional<RigFrames> rig_of(const std::vector<CameraReplay>& all,
                                const std::vector<std::size_t>& cameras) {
  RigFrames rig;
  rig.cameras = cameras;
  for (const std::size_t index : cameras) rig.members.push_back(&all[index]);
  const std::optional<Nanoseconds> period = rig_period(rig.members);
  if (!period) return std::nullopt;
  rig.period = *period;
  rig.complete = complete_pulses(rig.members, rig.period);
  rig.order = order_of_arrival(rig.members);
  return rig;
}

GatheringSetup gathering_setup(const RigFrames& rig) {
  return {.sources = static_cast<std::uint32_t>(rig.members.size()),
          .period = rig.period,
          .interval = rig.period / kIntervalsPerPeriod};
}

}  // namespace simbench::evaluation
