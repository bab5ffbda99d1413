// Runs coroutines of tests to their end on an io_context, never for longer than a minute.
#pragma once

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <chrono>
#include <exception>
#include <functional>
#include <stdexcept>
#include <utility>

#include "algorithms/ports/host.h"

namespace simbench::hardware {

// Runs the context until `done`. Throws if that does not come.
inline void run_until(boost::asio::io_context& context, const std::function<bool()>& done) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  context.restart();
  while (!done()) {
    if (context.run_one_until(deadline) == 0) throw std::runtime_error("nothing came of it");
  }
}

// Runs the task to its end; what it throws is thrown.
inline void await(boost::asio::io_context& context, Task<void> task) {
  bool done = false;
  std::exception_ptr thrown;
  boost::asio::co_spawn(context, std::move(task), [&](const std::exception_ptr& error) {
    done = true;
    thrown = error;
  });
  run_until(context, [&] { return done; });
  if (thrown) std::rethrow_exception(thrown);
}

template <class T>
T await(boost::asio::io_context& context, Task<T> task) {
  bool done = false;
  std::exception_ptr thrown;
  T result{};
  boost::asio::co_spawn(context, std::move(task), [&](const std::exception_ptr& error, T value) {
    done = true;
    thrown = error;
    result = std::move(value);
  });
  run_until(context, [&] { return done; });
  if (thrown) std::rethrow_exception(thrown);
  return result;
}

}  // namespace simbench::hardware
