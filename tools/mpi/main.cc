// simbench-mpi: the same command line as simbench, whose sweeps are worked on by all ranks of an
// MPI job. `mpirun -n 64 simbench sweep ...` becomes this program (tools/mpi_launch.h).
//
// Rank 0 is the command: it reads the arguments, writes the folder and prints; it gives each rank a
// run, and the next one for every answer, so that a rank which is faster does more; and it works
// itself. The other ranks know nothing but their tasks: scenario files need only be where rank 0
// is. A rank that fails sends the reason as its answer; if a rank dies, the launcher ends the job,
// and what rank 0 has written stays for the next start.
//
// Only the main thread of a rank talks to MPI, as MPI_THREAD_FUNNELED asks; it looks for messages
// often instead of waiting for them, since waiting takes a whole core.
#include <algorithm>
#include <boost/mpi/communicator.hpp>
#include <boost/mpi/environment.hpp>
#include <boost/serialization/string.hpp>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <iostream>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "evaluation/task_farm.h"
#include "tools/command_line.h"
#include "tools/freed_memory.h"
#include "tools/sweep_command.h"

namespace simbench {
namespace {

namespace mpi = boost::mpi;
using evaluation::TaskQueue;

constexpr std::chrono::microseconds kBetweenLooks{200};
// Tasks that wait at a rank for each of its threads, while there are plenty: sending one takes as
// long as a look or two, and short runs are not much longer.
constexpr std::size_t kAhead = 3;
constexpr std::size_t kPlenty = 8;  // tasks left for each thread

enum Tag : int { kSetup, kTask, kStop, kAnswer };

struct Setup {
  unsigned threads = 1;
  std::string text;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    archive& threads& text;
  }
};

struct Task {
  std::size_t index = 0;
  std::string text;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    archive& index& text;
  }
};

struct Answer {
  std::size_t index = 0;
  bool failed = false;
  std::string text;  // why, if it failed
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    archive& index& failed& text;
  }
};

// Rank 0's side.
class MpiFarm final : public evaluation::TaskFarm {
 public:
  explicit MpiFarm(mpi::communicator world) : world_(std::move(world)) {}

  void run(const evaluation::Tasks& tasks, const evaluation::AnswerKeeper& keep) override {
    TaskQueue queue(tasks, keep);
    const unsigned threads = std::max(1U, tasks.threads);
    for (int rank = 1; rank < world_.size(); ++rank) {
      world_.send(rank, kSetup, Setup{threads, tasks.setup});
    }
    {
      std::vector<std::jthread> own;
      for (unsigned i = 0; i < threads; ++i) {
        own.emplace_back([&] { queue.work_off(tools::simulated_sweep_workers()); });
      }
      give_out(queue, threads);
    }
    queue.rethrow_failure();
  }

  // The others may go. Also where nothing was run.
  void dismiss() {
    for (int rank = 1; rank < world_.size(); ++rank) world_.send(rank, kStop);
  }

 private:
  void give_out(TaskQueue& queue, unsigned threads) {
    std::vector<std::size_t> given(static_cast<std::size_t>(world_.size()), 0);
    std::size_t away = 0;
    const auto fill = [&](int rank) {
      const std::size_t others = given.size() * threads;
      std::size_t& mine = given[static_cast<std::size_t>(rank)];
      while (mine < threads * (queue.left() > kPlenty * others ? 1 + kAhead : 1)) {
        std::optional<TaskQueue::Task> task = queue.next();
        if (!task) return;
        world_.send(rank, kTask, Task{task->index, std::move(task->text)});
        ++mine;
        ++away;
      }
    };
    for (int rank = 1; rank < world_.size(); ++rank) fill(rank);
    while (away > 0) {
      const auto waiting = world_.iprobe(mpi::any_source, kAnswer);
      if (!waiting) {
        std::this_thread::sleep_for(kBetweenLooks);
        continue;
      }
      Answer answer;
      world_.recv(waiting->source(), kAnswer, answer);
      --given[static_cast<std::size_t>(waiting->source())];
      --away;
      if (answer.failed) {
        queue.failed(std::make_exception_ptr(std::runtime_error(answer.text)));
      } else {
        queue.answered(answer.index, answer.text);
      }
      fill(waiting->source());
    }
  }

  mpi::communicator world_;
};

// Between a rank's main thread and its workers. An empty task ends a worker.
class Exchange {
 public:
  void add(std::optional<Task> task) {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
    added_.notify_one();
  }

  std::optional<Task> next() {
    std::unique_lock lock(mutex_);
    added_.wait(lock, [this] { return !tasks_.empty(); });
    std::optional<Task> task = std::move(tasks_.front());
    tasks_.pop_front();
    return task;
  }

  void answer(Answer answer) {
    const std::lock_guard lock(mutex_);
    answers_.push_back(std::move(answer));
  }

  std::deque<Answer> take_answers() {
    const std::lock_guard lock(mutex_);
    return std::exchange(answers_, {});
  }

 private:
  std::mutex mutex_;
  std::condition_variable added_;
  std::deque<std::optional<Task>> tasks_;
  std::deque<Answer> answers_;
};

void work(const std::string& setup, Exchange& exchange) {
  evaluation::TaskWorker worker;
  while (const std::optional<Task> task = exchange.next()) {
    Answer answer{task->index, false, ""};
    try {
      if (!worker) worker = tools::simulated_sweep_workers()(setup);
      answer.text = worker(task->text);
    } catch (const std::exception& error) {
      answer.failed = true;
      answer.text = error.what();
    }
    exchange.answer(std::move(answer));
  }
}

// The side of every other rank: until it is dismissed.
void serve(const mpi::communicator& world) {
  Exchange exchange;
  std::vector<std::jthread> workers;
  while (true) {
    for (const Answer& answer : exchange.take_answers()) world.send(0, kAnswer, answer);
    const auto waiting = world.iprobe(0, mpi::any_tag);
    if (!waiting) {
      std::this_thread::sleep_for(kBetweenLooks);
      continue;
    }
    if (waiting->tag() == kStop) break;
    if (waiting->tag() == kSetup) {
      Setup setup;
      world.recv(0, kSetup, setup);
      for (unsigned i = 0; i < setup.threads; ++i) {
        workers.emplace_back([&exchange, text = setup.text] { work(text, exchange); });
      }
    } else {
      Task task;
      world.recv(0, kTask, task);
      exchange.add(std::move(task));
    }
  }
  world.recv(0, kStop);
  for (std::size_t i = 0; i < workers.size(); ++i) exchange.add(std::nullopt);
}

}  // namespace
}  // namespace simbench

int main(int argc, char** argv) {
  simbench::tools::keep_freed_memory();
  const boost::mpi::environment environment(argc, argv, boost::mpi::threading::funneled);
  const boost::mpi::communicator world;
  if (world.rank() > 0) {
    simbench::serve(world);
    return 0;
  }
  simbench::MpiFarm farm(world);
  const int status = simbench::run_command_line(argc, argv, &farm);
  farm.dismiss();
  return status;
}
