#include "algorithms/registry.h"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

// simbench's own algorithms, in the order in which they are listed: a line for each file that
// defines some, with the function of that file that returns them.
#define SIMBENCH_ALGORITHMS(FILE)                                 \
  FILE(HostSyncEntry, host_sync_yoon2021)                         \
  FILE(HostSyncEntry, host_sync_limits)                           \
  FILE(HostSyncEntry, host_sync_two_way)                          \
  FILE(HostSyncEntry, host_sync_ptp)                              \
  FILE(HostSyncEntry, host_sync_gptp)                             \
  FILE(HostSyncEntry, host_sync_sptp)                             \
  FILE(HostSyncEntry, host_sync_huygens)                          \
  FILE(HostSyncEntry, host_sync_common_view)                      \
  FILE(HostSyncEntry, host_sync_gnss)                             \
  FILE(HostSyncEntry, host_sync_wifi)                             \
  FILE(HostSyncEntry, host_sync_ntp)                              \
  FILE(HostSyncEntry, host_sync_w32time)                          \
  FILE(HostSyncEntry, host_sync_chrony)                           \
  FILE(CaptureAlignmentEntry, capture_alignment_limits)           \
  FILE(CaptureAlignmentEntry, capture_alignment_libsoftwaresync)  \
  FILE(CaptureAlignmentEntry, capture_alignment_rpi_sync)         \
  FILE(CaptureAlignmentEntry, capture_alignment_scheduled_action) \
  FILE(CaptureAlignmentEntry, capture_alignment_periodic_ptp)     \
  FILE(CaptureAlignmentEntry, capture_alignment_pid_frame_rate)   \
  FILE(CaptureAlignmentEntry, capture_alignment_phase_rate)       \
  FILE(DeviceTimeEntry, device_time_yoon2021)                     \
  FILE(DeviceTimeEntry, device_time_hull)                         \
  FILE(DeviceTimeEntry, device_time_two_way_poll)                 \
  FILE(DeviceTimeEntry, device_time_offset_filters)               \
  FILE(DeviceTimeEntry, device_time_librealsense_global)          \
  FILE(DeviceTimeEntry, device_time_host_stamps)                  \
  FILE(DeviceTimeEntry, device_time_rocsync_led)                  \
  FILE(DeviceTimeEntry, device_time_coded)                        \
  FILE(GatheringEntry, gathering_yoon2021)                        \
  FILE(GatheringEntry, gathering_genlock)                         \
  FILE(GatheringEntry, gathering_approximate_time)                \
  FILE(GatheringEntry, gathering_epsilon)                         \
  FILE(GatheringEntry, gathering_librealsense)                    \
  FILE(GatheringEntry, gathering_k4a)                             \
  FILE(GatheringEntry, gathering_phase_binning)                   \
  FILE(GatheringEntry, gathering_coded_trigger)                   \
  FILE(GatheringEntry, gathering_certified)                       \
  FILE(GatheringEntry, gathering_oracle)

namespace simbench {

#define SIMBENCH_DECLARE(Entry, function) std::vector<Entry> function();
SIMBENCH_ALGORITHMS(SIMBENCH_DECLARE)
#undef SIMBENCH_DECLARE

namespace {

// The algorithms of one stage, in order of registration.
template <class Entry>
class Registry {
 public:
  Registry() {
#define SIMBENCH_ADD(Listed, function) add_own(function);
    SIMBENCH_ALGORITHMS(SIMBENCH_ADD)
#undef SIMBENCH_ADD
    own_ = entries_.size();
  }

  void add(Entry entry) {
    if (find(entry.info.name) != nullptr) refuse(entry, "is registered twice");
    entries_.push_back(std::move(entry));
  }

  void replace(Entry entry) {
    const Entry* const former = find(entry.info.name);
    if (former == nullptr) return add(std::move(entry));
    const auto place = static_cast<std::size_t>(former - entries_.data());
    if (place < own_) refuse(entry, "is one of simbench's own; choose another name");
    entries_[place] = std::move(entry);
  }

  const Entry* find(const std::string& name) const {
    const auto found = std::ranges::find_if(
        entries_, [&name](const Entry& entry) { return entry.info.name == name; });
    return found == entries_.end() ? nullptr : &*found;
  }

  const std::vector<Entry>& entries() const { return entries_; }
  // The first so many are simbench's own.
  std::size_t own() const { return own_; }

 private:
  template <class Listed>
  void add_own(std::vector<Listed> (*listed)()) {
    if constexpr (std::is_same_v<Listed, Entry>) {
      for (Entry& entry : listed()) add(std::move(entry));
    }
  }

  [[noreturn]] static void refuse(const Entry& entry, const std::string& why) {
    throw std::invalid_argument(std::string(name_of(Entry::kStage)) + " algorithm \"" +
                                entry.info.name + "\" " + why);
  }

  std::vector<Entry> entries_;
  std::size_t own_ = 0;
};

template <class Entry>
Registry<Entry>& registry() {
  static Registry<Entry> registry;
  return registry;
}

// The first `most` of a stage.
template <class Entry>
std::vector<const AlgorithmInfo*> infos_of(const Registry<Entry>& registry, std::size_t most) {
  std::vector<const AlgorithmInfo*> infos;
  for (const Entry& entry : registry.entries()) {
    if (infos.size() == most) break;
    infos.push_back(&entry.info);
  }
  return infos;
}

// action(the stage's registry).
template <class Action>
auto at_registry(PipelineStage stage, const Action& action) {
  switch (stage) {
    case PipelineStage::kHostSync:
      return action(registry<HostSyncEntry>());
    case PipelineStage::kCaptureAlignment:
      return action(registry<CaptureAlignmentEntry>());
    case PipelineStage::kDeviceTime:
      return action(registry<DeviceTimeEntry>());
    case PipelineStage::kGathering:
      break;
  }
  return action(registry<GatheringEntry>());
}

}  // namespace

template <class Entry>
void register_algorithm(Entry entry) {
  registry<Entry>().add(std::move(entry));
}
template <class Entry>
void replace_algorithm(Entry entry) {
  registry<Entry>().replace(std::move(entry));
}
template <class Entry>
const std::vector<Entry>& algorithms() {
  return registry<Entry>().entries();
}
template <class Entry>
const Entry* find_algorithm(const std::string& name) {
  return registry<Entry>().find(name);
}

#define SIMBENCH_STAGE(Entry)                             \
  template void register_algorithm<Entry>(Entry);         \
  template void replace_algorithm<Entry>(Entry);          \
  template const std::vector<Entry>& algorithms<Entry>(); \
  template const Entry* find_algorithm<Entry>(const std::string&);
SIMBENCH_STAGE(HostSyncEntry)
SIMBENCH_STAGE(CaptureAlignmentEntry)
SIMBENCH_STAGE(DeviceTimeEntry)
SIMBENCH_STAGE(GatheringEntry)
#undef SIMBENCH_STAGE

std::vector<const AlgorithmInfo*> algorithms_of(PipelineStage stage) {
  return at_registry(stage, [](const auto& all) { return infos_of(all, all.entries().size()); });
}

std::vector<const AlgorithmInfo*> own_algorithms_of(PipelineStage stage) {
  return at_registry(stage, [](const auto& all) { return infos_of(all, all.own()); });
}

const AlgorithmInfo* find_algorithm(PipelineStage stage, const std::string& name) {
  for (const AlgorithmInfo* const info : algorithms_of(stage)) {
    if (info->name == name) return info;
  }
  return nullptr;
}

}  // namespace simbench
