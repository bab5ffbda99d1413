#include "algorithms/registry.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "algorithms/device_time/registration.h"
#include "algorithms/gathering/registration.h"
#include "algorithms/host_sync/registration.h"

namespace simbench {
namespace {

// The algorithms of one stage, in order of registration.
template <class Entry>
class Stage {
 public:
  Stage(std::string name, std::vector<Entry> builtin) : name_(std::move(name)) {
    for (Entry& entry : builtin) add(std::move(entry));
  }

  void add(Entry entry) {
    if (find(entry.info.name) != nullptr) {
      throw std::invalid_argument(name_ + " algorithm \"" + entry.info.name +
                                  "\" is registered twice");
    }
    entries_.push_back(std::move(entry));
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
};

Stage<HostSyncEntry>& host_sync_stage() {
  static Stage<HostSyncEntry> stage("host_sync", builtin_host_sync_algorithms());
  return stage;
}
Stage<DeviceTimeEntry>& device_time_stage() {
  static Stage<DeviceTimeEntry> stage("device_time", builtin_device_time_algorithms());
  return stage;
}
Stage<GatheringEntry>& gathering_stage() {
  static Stage<GatheringEntry> stage("gathering", builtin_gathering_algorithms());
  return stage;
}

}  // namespace

void register_host_sync(HostSyncEntry entry) { host_sync_stage().add(std::move(entry)); }
void register_device_time(DeviceTimeEntry entry) { device_time_stage().add(std::move(entry)); }
void register_gathering(GatheringEntry entry) { gathering_stage().add(std::move(entry)); }

const std::vector<HostSyncEntry>& host_sync_algorithms() { return host_sync_stage().entries(); }
const std::vector<DeviceTimeEntry>& device_time_algorithms() {
  return device_time_stage().entries();
}
const std::vector<GatheringEntry>& gathering_algorithms() { return gathering_stage().entries(); }

const HostSyncEntry* find_host_sync(const std::string& name) {
  return host_sync_stage().find(name);
}
const DeviceTimeEntry* find_device_time(const std::string& name) {
  return device_time_stage().find(name);
}
const GatheringEntry* find_gathering(const std::string& name) {
  return gathering_stage().find(name);
}

}  // namespace simbench
