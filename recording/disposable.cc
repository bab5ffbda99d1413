#include "recording/disposable.h"

#include <mutex>
#include <set>

#include "recording/distrusted_folder.h"

namespace simbench {
namespace {

namespace fs = std::filesystem;

struct DisposablePaths {
  std::mutex mutex;
  std::set<fs::path> paths;
};

// Never destroyed: threads may use it until the process ends.
DisposablePaths& disposable_paths() {
  static auto* const all = new DisposablePaths;
  return *all;
}

}  // namespace

Disposable::Disposable(const std::function<fs::path()>& make) {
  DisposablePaths& all = disposable_paths();
  const std::lock_guard lock(all.mutex);
  path_ = make();
  all.paths.insert(path_);
}

Disposable::~Disposable() {
  if (path_.empty()) return;
  DisposablePaths& all = disposable_paths();
  const std::lock_guard lock(all.mutex);
  remove_tree(path_);
  all.paths.erase(path_);
}

void Disposable::change(const std::function<void()>& change) const {
  const std::lock_guard lock(disposable_paths().mutex);
  change();
}

void Disposable::keep(const std::function<void()>& publish) {
  DisposablePaths& all = disposable_paths();
  const std::lock_guard lock(all.mutex);
  publish();
  all.paths.erase(path_);
  path_.clear();
}

void dispose_of_all() {
  DisposablePaths& all = disposable_paths();
  all.mutex.lock();  // for good
  for (const fs::path& path : all.paths) remove_tree(path);
}

}  // namespace simbench
