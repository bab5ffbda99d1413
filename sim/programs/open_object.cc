#include "sim/programs/open_object.h"

#include <poll.h>

#include <algorithm>

#include "sim/programs/epoll_set.h"

namespace simbench::sim {
namespace {

constexpr int kMostDepth = 5;  // of sets within sets, as Linux has it

}  // namespace

OpenObject::OpenObject(What what) : what_(std::move(what)) {}

OpenObject::~OpenObject() = default;

void OpenObject::changed(int events, int depth) {
  if (depth > kMostDepth) return;
  std::erase_if(watchers_, [](const auto& each) { return each.expired(); });
  for (const auto& each : std::vector(watchers_)) {
    const std::shared_ptr<OpenObject> watcher = each.lock();
    if (watcher == nullptr) continue;
    if (watcher->set()->list(*this, events)) watcher->changed(POLLIN, depth + 1);
  }
}

void OpenObject::watch(const std::weak_ptr<OpenObject>& set) {
  const auto is_same = [&](const auto& each) {
    return !each.owner_before(set) && !set.owner_before(each);
  };
  if (!std::ranges::any_of(watchers_, is_same)) watchers_.push_back(set);
}

int readiness(OpenObject& object) {
  if (const UdpSocket* socket = object.socket()) return readiness_of(*socket);
  if (const StreamSocket* stream = object.stream()) return HostStreams::readiness(*stream);
  if (ProcessTimer* timer = object.timer()) return timer->expirations() > 0 ? POLLIN : 0;
  if (const DeviceFile* file = object.device()) return file->is_ready() ? POLLIN : 0;
  return object.set()->is_ready() ? POLLIN : 0;
}

}  // namespace simbench::sim
