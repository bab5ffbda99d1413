// Runs coroutines of a test in its io_context until they are done, bounded in time.
#pragma once

#include <gtest/gtest.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "hardware/clock/monotonic_time.h"
#include "hardware/net/secure_stream.h"

namespace simbench::hardware {

inline constexpr Nanoseconds kPatience = std::chrono::seconds(60);

inline MonotonicTime soon() { return monotonic_now() + kPatience; }
inline MonotonicTime in_ms(int ms) { return monotonic_now() + std::chrono::milliseconds(ms); }

inline Bytes bytes_of(std::string_view text) {
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return Bytes(begin, begin + text.size());
}
inline std::string text_of(const Bytes& bytes) {
  return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

// A coroutine that runs by itself, and its result.
template <class T>
class Running {
 public:
  Running(boost::asio::io_context& context, Task<T> task) : context_(context) {
    boost::asio::co_spawn(context, keep(std::move(task), end_),
                          [end = end_](const std::exception_ptr& error) {
                            end->error = error;
                            end->done = true;
                          });
  }
  bool done() const { return end_->done; }
  // Runs the context until this is done; throws what the coroutine threw.
  T get() {
    const MonotonicTime limit = soon();
    while (!end_->done && monotonic_now() < limit) {
      context_.restart();
      context_.run_one_for(std::chrono::milliseconds(100));
    }
    if (!end_->done) throw std::runtime_error("not done in time");
    if (end_->error) std::rethrow_exception(end_->error);
    return std::move(*end_->value);
  }

 private:
  struct End {
    std::exception_ptr error;
    std::optional<T> value;
    bool done = false;
  };
  static Task<void> keep(Task<T> task, std::shared_ptr<End> end) {
    end->value.emplace(co_await std::move(task));
  }
  boost::asio::io_context& context_;
  std::shared_ptr<End> end_ = std::make_shared<End>();
};

template <class T>
T in_time(boost::asio::io_context& context, Task<T> task) {
  return Running<T>(context, std::move(task)).get();
}

// Runs the context until `condition` holds; false if it does not in time.
inline bool until(boost::asio::io_context& context, const std::function<bool()>& condition,
                  Nanoseconds limit = kPatience) {
  const MonotonicTime end = monotonic_now() + limit;
  while (!condition()) {
    if (monotonic_now() >= end) return false;
    context.restart();
    context.run_one_for(std::chrono::milliseconds(10));
  }
  return true;
}

// Lets the context run for a while, whatever happens in it.
inline void pass(boost::asio::io_context& context, int ms) {
  until(
      context, [] { return false; }, std::chrono::milliseconds(ms));
}

// The failure of something that must fail.
template <class F>
StreamError stream_error(F&& fails) {
  try {
    std::forward<F>(fails)();
  } catch (const StreamError& error) {
    return error;
  }
  ADD_FAILURE() << "nothing was thrown";
  return StreamError(StreamError::Kind::kTimeout, "nothing was thrown");
}

}  // namespace simbench::hardware
