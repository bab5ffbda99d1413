#include "sim/engine/virtual_executor.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/associated_cancellation_slot.hpp>
#include <boost/asio/async_result.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/use_awaitable.hpp>

namespace simbench::sim {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

// A wait and the handler that resumes its coroutine, called with (error) or (error, notified).
template <class Handler>
class HandlerWait : public PendingWait {
 public:
  HandlerWait(VirtualContext& context, std::string_view label, std::optional<TrueTime> deadline,
              Handler handler)
      : PendingWait(context, label, deadline),
        handler_(std::move(handler)),
        cancellation_(asio::get_associated_cancellation_slot(handler_)) {
    if (cancellation_.is_connected()) {
      cancellation_.assign([this](asio::cancellation_type) { finish(Outcome::kAborted); });
    }
  }
  ~HandlerWait() override { cancellation_.clear(); }

 private:
  void complete(Outcome outcome) override {
    Handler handler = std::move(handler_);
    delete this;
    const error_code error =
        outcome == Outcome::kAborted ? error_code(asio::error::operation_aborted) : error_code();
    if constexpr (std::is_invocable_v<Handler, error_code, bool>) {
      std::move(handler)(error, outcome == Outcome::kNotified);
    } else {
      std::move(handler)(error);
    }
  }

  Handler handler_;
  asio::cancellation_slot cancellation_;
};

template <class Handler>
PendingWait& start_wait(VirtualContext& context, std::string_view label,
                        std::optional<TrueTime> deadline, Handler handler) {
  return *new HandlerWait<Handler>(context, label, deadline, std::move(handler));
}

}  // namespace

PendingWait::PendingWait(VirtualContext& context, std::string_view label,
                         std::optional<TrueTime> deadline)
    : context_(context), label_(label), since_(context.engine_.now()), deadline_(deadline) {
  context_.waits_.push_back(*this);
  if (deadline_) {
    timer_ = context_.engine_.call_at(std::max(*deadline_, since_),
                                      [this] { complete(Outcome::kDeadline); });
  }
}

PendingWait::~PendingWait() {
  if (point_ != nullptr) point_->wait_ = nullptr;
  context_.engine_.cancel(timer_);
  context_.waits_.erase(context_.waits_.iterator_to(*this));
}

void PendingWait::finish(Outcome outcome) {
  if (is_finished()) return;
  outcome_ = outcome;
  if (point_ != nullptr) std::exchange(point_, nullptr)->wait_ = nullptr;
  Engine& engine = context_.engine_;
  engine.cancel(timer_);
  timer_ = engine.call_at(engine.now(), [this] { complete(*outcome_); });
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
    if (!waits_.empty()) delete &waits_.front();
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

asio::awaitable<void> sleep_until(VirtualContext& context, TrueTime at, std::string_view label) {
  return asio::async_initiate<const asio::use_awaitable_t<>, void(error_code)>(
      [&context, at, label](auto handler) { start_wait(context, label, at, std::move(handler)); },
      asio::use_awaitable);
}

WaitPoint::WaitPoint(VirtualContext& context, std::string label)
    : context_(context), label_(std::move(label)) {}

WaitPoint::~WaitPoint() {
  if (wait_ != nullptr) wait_->finish(PendingWait::Outcome::kAborted);
}

asio::awaitable<bool> WaitPoint::wait(std::optional<TrueTime> deadline) {
  return asio::async_initiate<const asio::use_awaitable_t<>, void(error_code, bool)>(
      [this, deadline](auto handler) {
        begin(start_wait(context_, label_, deadline, std::move(handler)));
      },
      asio::use_awaitable);
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
