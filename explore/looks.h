// All that open pages look at, computed by one thread, a step at a time.
//
// The look with the fewest steps goes first, so that first pictures come before further seeds. A
// look whose page has gone, or shows another state by now, is cancelled within its step and
// forgotten: nothing is computed that nobody sees. A page that does not take what it was sent is
// given nothing new until it has.
//
// Cancelling a step raises the process's interrupt flag (app/interrupt.h), so nothing else may
// compute in the process meanwhile. At most kMostLooks are open; a further one is told so and ends.
//
//   Looks looks(subject);
//   looks.add(request, stream);
#pragma once

#include <condition_variable>
#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <thread>

#include "explore/look.h"
#include "explore/state.h"
#include "server/request.h"

namespace simbench::explore {

inline constexpr std::size_t kMostLooks = 16;

class Looks {
 public:
  // `subject` must outlive it.
  explicit Looks(const PageSubject& subject);
  // Cancels what runs.
  ~Looks();
  Looks(const Looks&) = delete;
  Looks& operator=(const Looks&) = delete;

  void add(LookRequest request, std::shared_ptr<server::PageStream> stream);
  // How many steps were begun; for tests.
  std::uint64_t steps() const;

 private:
  void work();
  std::shared_ptr<Look> next();
  void forget(const server::PageStream* stream);

  const PageSubject& subject_;
  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable news_;
  std::list<std::shared_ptr<Look>> waiting_;
  const server::PageStream* running_ = nullptr;
  std::uint64_t steps_ = 0;
  bool stopping_ = false;
  std::thread thread_;  // the last: it uses all the others
};

}  // namespace simbench::explore
