#include "algorithms/host_sync/join.h"

#include <boost/asio/cancellation_state.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/deferred.hpp>
#include <boost/asio/experimental/parallel_group.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cstddef>
#include <exception>
#include <utility>

namespace simbench {

namespace asio = boost::asio;

namespace {

struct JoinState {
  std::size_t unfinished = 0;
  std::exception_ptr failure;  // the first
};

// Asio posts the cancellations of a group that has a failure, and they must not arrive after the
// group. The last task to end therefore does not fail the group, and one that ends after a failure
// waits for its own cancellation.
Task<void> joined(Task<void> task, JoinState& state) {
  std::exception_ptr failure;
  try {
    co_await std::move(task);
  } catch (...) {
    failure = std::current_exception();
  }
  --state.unfinished;
  if (!state.failure) {
    state.failure = failure;
    if (failure && state.unfinished > 0) std::rethrow_exception(failure);
    co_return;
  }
  while (true) {
    const asio::cancellation_state own = co_await asio::this_coro::cancellation_state;
    if (own.cancelled() != asio::cancellation_type::none) co_return;
    co_await asio::post(asio::use_awaitable);
  }
}

}  // namespace

Task<void> join_all(std::vector<Task<void>> tasks) {
  if (tasks.empty()) co_return;
  const asio::any_io_executor executor = co_await asio::this_coro::executor;
  using Operation = decltype(asio::co_spawn(executor, std::declval<Task<void>>(), asio::deferred));
  std::vector<Operation> operations;
  operations.reserve(tasks.size());
  JoinState state{.unfinished = tasks.size(), .failure = nullptr};
  for (Task<void>& task : tasks) {
    operations.push_back(asio::co_spawn(executor, joined(std::move(task), state), asio::deferred));
  }
  auto group = asio::experimental::make_parallel_group(std::move(operations));
  co_await group.async_wait(asio::experimental::wait_for_one_error(), asio::use_awaitable);
  if (state.failure) std::rethrow_exception(state.failure);
}

}  // namespace simbench
