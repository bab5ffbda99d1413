#include "explore/looks.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "app/interrupt.h"

namespace simbench::explore {
namespace {

constexpr std::size_t kMostUnread = 4 * 1024 * 1024;  // bytes
constexpr std::chrono::milliseconds kLookAgain(50);

}  // namespace

Looks::Looks(const PageSubject& subject) : subject_(subject), thread_([this] { work(); }) {}

Looks::~Looks() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    if (running_ != nullptr) app::InterruptHandler::set(true);
  }
  news_.notify_all();
  thread_.join();
  app::InterruptHandler::set(false);
}

void Looks::add(LookRequest request, std::shared_ptr<server::PageStream> stream) {
  auto look = std::make_shared<Look>(std::move(request), subject_, stream);
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() >= kMostLooks) {
      stream->send("{\"event\": \"failed\", \"message\": \"too many pages are open\"}\n");
      stream->end();
      return;
    }
    waiting_.push_back(std::move(look));
  }
  stream->when_closed([this, which = stream.get()] { forget(which); });
  news_.notify_all();
}

std::uint64_t Looks::steps() const {
  const std::lock_guard lock(mutex_);
  return steps_;
}

void Looks::forget(const server::PageStream* stream) {
  const std::lock_guard lock(mutex_);
  std::erase_if(waiting_, [stream](const auto& look) { return &look->stream() == stream; });
  if (running_ == stream) app::InterruptHandler::set(true);
}

// The look that is next, which is marked as running; null: stop.
std::shared_ptr<Look> Looks::next() {
  std::unique_lock lock(mutex_);
  for (;;) {
    if (stopping_) return nullptr;
    std::shared_ptr<Look> chosen;
    for (const std::shared_ptr<Look>& look : waiting_) {
      if (look->stream().waiting_bytes() > kMostUnread) continue;
      if (!chosen || look->steps() < chosen->steps()) chosen = look;
    }
    if (chosen) {
      waiting_.remove(chosen);
      running_ = &chosen->stream();
      ++steps_;
      app::InterruptHandler::set(false);
      return chosen;
    }
    if (waiting_.empty()) {
      news_.wait(lock);
    } else {
      news_.wait_for(lock, kLookAgain);
    }
  }
}

void Looks::work() {
  while (const std::shared_ptr<Look> look = next()) {
    bool goes_on = false;
    try {
      goes_on = look->step();
    } catch (const std::exception&) {  // cancelled: nobody looks any more
    }
    const std::lock_guard lock(mutex_);
    running_ = nullptr;
    if (goes_on && !look->stream().is_closed()) waiting_.push_back(look);
  }
}

}  // namespace simbench::explore
