#include "sim/engine/virtual_executor.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace simbench::sim {

PendingWait::PendingWait(VirtualContext& context, std::string_view label,
                         std::optional<TrueTime> deadline)
    : context_(context), label_(label), since_(context.engine_.now()), deadline_(deadline) {
  context_.waits_.push_back(*this);
  if (deadline_) {
    timer_ = context_.engine_.call_at(std::max(*deadline_, since_), [this] {
      timer_ = {};
      complete(Outcome::kDeadline);
    });
  }
}

PendingWait::~PendingWait() {
  if (point_ != nullptr) point_->wait_ = nullptr;
  if (!timer_.is_none()) context_.engine_.cancel(timer_);
  context_.waits_.erase(context_.waits_.iterator_to(*this));
}

void PendingWait::finish(Outcome outcome) {
  if (is_finished()) return;
  outcome_ = outcome;
  if (point_ != nullptr) std::exchange(point_, nullptr)->wait_ = nullptr;
  Engine& engine = context_.engine_;
  if (!timer_.is_none()) engine.cancel(timer_);
  timer_ = engine.call_at(engine.now(), [this] {
    timer_ = {};
    complete(*outcome_);
  });
}

std::string PendingWait::describe() const {
  std::string text =
      fmt::format("{}, since {:.9g} s", label_, to_seconds(since_.time_since_epoch()));
  if (deadline_)
    text += fmt::format(", deadline {:.9g} s", to_seconds(deadline_->time_since_epoch()));
  return text;
}

VirtualContext::VirtualContext(Engine& engine)
    : engine_(engine), handler_id_(engine.attach(*this)) {
  engine_.set_wait_reporter([this] { return waiting(); });
}

VirtualContext::~VirtualContext() {
  engine_.set_wait_reporter({});
  // Destroying a wait makes Asio post the destruction of its coroutine, which may end other waits.
  while (!waits_.empty() || posted_.live() > 0) {
    if (!waits_.empty()) waits_.front().dispose();
    posted_.clear();
  }
}

std::vector<std::string> VirtualContext::waiting() const {
  std::vector<std::string> lines;
  for (const PendingWait& wait : waits_) {
    if (!wait.is_finished()) lines.push_back(wait.describe());
  }
  return lines;
}

WaitPoint::WaitPoint(VirtualContext& context, std::string label)
    : context_(context), label_(std::move(label)) {}

WaitPoint::~WaitPoint() {
  if (wait_ != nullptr) wait_->finish(PendingWait::Outcome::kAborted);
}

void WaitPoint::begin(PendingWait& wait) {
  SIMBENCH_ASSERT(wait_ == nullptr, "somebody already waits here");
  wait_ = &wait;
  wait.point_ = this;
}

void WaitPoint::notify() {
  if (wait_ != nullptr) wait_->finish(PendingWait::Outcome::kNotified);
}

}  // namespace simbench::sim
