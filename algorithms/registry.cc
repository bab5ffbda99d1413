#include "algorithms/registry.h"

#include <cstddef>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <utility>

// simbench's own algorithms, in the order in which they are listed: a line for each file that
// defines some. A line FILE below stands for a function of that file,
// std::vector<HostSyncEntry> host_sync_FILE() (or device_time_, gathering_).
#define SIMBENCH_HOST_SYNC(FILE) \
  FILE(yoon2021)                 \
  FILE(limits)                   \
  FILE(two_way)                  \
  FILE(ptp)                      \
  FILE(sptp)                     \
  FILE(huygens)                  \
  FILE(common_view)              \
  FILE(gnss)                     \
  FILE(ntp)                      \
  FILE(w32time)                  \
  FILE(chrony)
#define SIMBENCH_CAPTURE_ALIGNMENT(FILE) \
  FILE(limits)                           \
  FILE(libsoftwaresync)                  \
  FILE(rpi_sync)                         \
  FILE(scheduled_action)                 \
  FILE(periodic_ptp)                     \
  FILE(pid_frame_rate)                   \
  FILE(phase_rate)
#define SIMBENCH_DEVICE_TIME(FILE) \
  FILE(yoon2021)                   \
  FILE(hull)                       \
  FILE(two_way_poll)               \
  FILE(offset_filters)             \
  FILE(librealsense_global)        \
  FILE(host_stamps)                \
  FILE(rocsync_led)
#define SIMBENCH_GATHERING(FILE) \
  FILE(yoon2021)                 \
  FILE(genlock)                  \
  FILE(approximate_time)         \
  FILE(epsilon)                  \
  FILE(librealsense)             \
  FILE(k4a)                      \
  FILE(phase_binning)            \
  FILE(oracle)

namespace simbench {

#define SIMBENCH_DECLARE(file) std::vector<HostSyncEntry> host_sync_##file();
SIMBENCH_HOST_SYNC(SIMBENCH_DECLARE)
#undef SIMBENCH_DECLARE
#define SIMBENCH_DECLARE(file) std::vector<CaptureAlignmentEntry> capture_alignment_##file();
SIMBENCH_CAPTURE_ALIGNMENT(SIMBENCH_DECLARE)
#undef SIMBENCH_DECLARE
#define SIMBENCH_DECLARE(file) std::vector<DeviceTimeEntry> device_time_##file();
SIMBENCH_DEVICE_TIME(SIMBENCH_DECLARE)
#undef SIMBENCH_DECLARE
#define SIMBENCH_DECLARE(file) std::vector<GatheringEntry> gathering_##file();
SIMBENCH_GATHERING(SIMBENCH_DECLARE)
#undef SIMBENCH_DECLARE

namespace {

// The algorithms of one stage, in order of registration.
template <class Entry>
class Stage {
 public:
  Stage(std::string name, std::initializer_list<std::vector<Entry>> own) : name_(std::move(name)) {
    for (const std::vector<Entry>& file : own) {
      for (const Entry& entry : file) add(entry);
    }
    own_ = entries_.size();
  }

  void add(Entry entry) {
    if (find(entry.info.name) != nullptr) {
      throw std::invalid_argument(name_ + " algorithm \"" + entry.info.name +
                                  "\" is registered twice");
    }
    entries_.push_back(std::move(entry));
  }

  void replace(Entry entry) {
    const Entry* const former = find(entry.info.name);
    if (former == nullptr) return add(std::move(entry));
    const auto place = static_cast<std::size_t>(former - entries_.data());
    if (place < own_) {
      throw std::invalid_argument(name_ + " algorithm \"" + entry.info.name +
                                  "\" is one of simbench's own; choose another name");
    }
    entries_[place] = std::move(entry);
  }

  const Entry* find(const std::string& name) const {
    for (const Entry& entry : entries_) {
      if (entry.info.name == name) return &entry;
    }
    return nullptr;
  }

  const std::vector<Entry>& entries() const { return entries_; }

 private:
  std::string name_;
  std::vector<Entry> entries_;
  std::size_t own_ = 0;  // the first so many are simbench's own
};

Stage<HostSyncEntry>& host_sync_stage() {
#define SIMBENCH_ENTRIES(file) host_sync_##file(),
  static Stage<HostSyncEntry> stage("host_sync", {SIMBENCH_HOST_SYNC(SIMBENCH_ENTRIES)});
#undef SIMBENCH_ENTRIES
  return stage;
}
Stage<CaptureAlignmentEntry>& capture_alignment_stage() {
#define SIMBENCH_ENTRIES(file) capture_alignment_##file(),
  static Stage<CaptureAlignmentEntry> stage("capture_alignment",
                                            {SIMBENCH_CAPTURE_ALIGNMENT(SIMBENCH_ENTRIES)});
#undef SIMBENCH_ENTRIES
  return stage;
}
Stage<DeviceTimeEntry>& device_time_stage() {
#define SIMBENCH_ENTRIES(file) device_time_##file(),
  static Stage<DeviceTimeEntry> stage("device_time", {SIMBENCH_DEVICE_TIME(SIMBENCH_ENTRIES)});
#undef SIMBENCH_ENTRIES
  return stage;
}
Stage<GatheringEntry>& gathering_stage() {
#define SIMBENCH_ENTRIES(file) gathering_##file(),
  static Stage<GatheringEntry> stage("gathering", {SIMBENCH_GATHERING(SIMBENCH_ENTRIES)});
#undef SIMBENCH_ENTRIES
  return stage;
}

}  // namespace

void register_host_sync(HostSyncEntry entry) { host_sync_stage().add(std::move(entry)); }
void register_capture_alignment(CaptureAlignmentEntry entry) {
  capture_alignment_stage().add(std::move(entry));
}
void register_device_time(DeviceTimeEntry entry) { device_time_stage().add(std::move(entry)); }
void register_gathering(GatheringEntry entry) { gathering_stage().add(std::move(entry)); }

void replace_host_sync(HostSyncEntry entry) { host_sync_stage().replace(std::move(entry)); }
void replace_capture_alignment(CaptureAlignmentEntry entry) {
  capture_alignment_stage().replace(std::move(entry));
}
void replace_device_time(DeviceTimeEntry entry) { device_time_stage().replace(std::move(entry)); }
void replace_gathering(GatheringEntry entry) { gathering_stage().replace(std::move(entry)); }

const std::vector<HostSyncEntry>& host_sync_algorithms() { return host_sync_stage().entries(); }
const std::vector<CaptureAlignmentEntry>& capture_alignment_algorithms() {
  return capture_alignment_stage().entries();
}
const std::vector<DeviceTimeEntry>& device_time_algorithms() {
  return device_time_stage().entries();
}
const std::vector<GatheringEntry>& gathering_algorithms() { return gathering_stage().entries(); }

const HostSyncEntry* find_host_sync(const std::string& name) {
  return host_sync_stage().find(name);
}
const CaptureAlignmentEntry* find_capture_alignment(const std::string& name) {
  return capture_alignment_stage().find(name);
}
const DeviceTimeEntry* find_device_time(const std::string& name) {
  return device_time_stage().find(name);
}
const GatheringEntry* find_gathering(const std::string& name) {
  return gathering_stage().find(name);
}

}  // namespace simbench
