// simbench-mpi: the same command line as simbench, whose sweeps are worked on by all ranks of an
// MPI job. `mpirun -n 64 simbench sweep ...` becomes this program (cli/process.h).
//
// Rank 0 is the command: it reads the arguments, writes the folder and prints. It gives each rank a
// run, and the next one for every answer, so that faster ranks do more, and works itself. The other
// ranks get only tasks: scenario files need only be where rank 0 is. A rank that fails answers with
// the reason. If a rank dies, the launcher ends the job, and rank 0's files stay for the next
// start.
//
// Only the main thread of a rank calls MPI, as MPI_THREAD_FUNNELED requires. It polls for messages,
// since waiting for them takes a whole core.
#include <fmt/format.h>

#include <algorithm>
#include <boost/mpi/communicator.hpp>
#include <boost/mpi/environment.hpp>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/sweep_workers.h"
#include "cli/command_line.h"
#include "cli/process.h"
#include "evaluation/sweep/task_farm.h"
#include "scenarios/loader.h"

namespace simbench {
namespace {

namespace mpi = boost::mpi;
using evaluation::JobQueue;

constexpr std::chrono::microseconds kShortestPause{100};
constexpr std::chrono::microseconds kLongestPause{1600};
// Tasks that wait at a rank for each of its threads, while there are plenty: sending one takes as
// long as a poll or two, and short runs are not much longer.
constexpr std::size_t kAhead = 3;
constexpr std::size_t kPlenty = 8;  // tasks left for each thread

enum Tag : int { kSetup, kTask, kStop, kAnswer, kFailure, kRefusal };

// A message between ranks: a number and a text, in one message of plain bytes. (Boost.MPI sends an
// object of several members as two messages, and waiting for the second takes a whole core.)
struct Message {
  std::size_t number = 0;  // of the task; of a setup: threads
  std::string text;        // of a setup, a task, an answer; of a failure: why
};

// Sends without waiting: a rank that sleeps takes its message later.
class Outbox {
 public:
  explicit Outbox(mpi::communicator world) : world_(std::move(world)) {}
  ~Outbox() {
    for (Sent& sent : sent_) sent.request.wait();
  }
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;

  void send(int rank, Tag tag, const Message& message) {
    while (!sent_.empty() && sent_.front().request.test()) sent_.pop_front();
    Sent& sent = sent_.emplace_back();
    sent.bytes = fmt::format("{} {}", message.number, message.text);
    sent.request = world_.isend(rank, tag, sent.bytes.data(), static_cast<int>(sent.bytes.size()));
  }

 private:
  struct Sent {
    std::string bytes;
    mpi::request request;
  };
  mpi::communicator world_;
  std::deque<Sent> sent_;
};

// Receives a message that has arrived.
Message receive(const mpi::communicator& world, const mpi::status& waiting) {
  std::string bytes(static_cast<std::size_t>(*waiting.count<char>()), '\0');
  world.recv(waiting.source(), waiting.tag(), bytes.data(), static_cast<int>(bytes.size()));
  Message message;
  const char* const end = bytes.data() + bytes.size();
  const char* const blank = std::from_chars(bytes.data(), end, message.number).ptr;
  message.text.assign(blank + 1, end);
  return message;
}

// The pause between two polls: short while messages arrive, longer while they do not.
class Pause {
 public:
  void take() {
    std::this_thread::sleep_for(length_);
    length_ = std::min(2 * length_, kLongestPause);
  }
  void end() { length_ = kShortestPause; }

 private:
  std::chrono::microseconds length_ = kShortestPause;
};

// Rank 0's side.
class MpiFarm final : public evaluation::TaskFarm {
 public:
  explicit MpiFarm(mpi::communicator world) : world_(std::move(world)), outbox_(world_) {}

  void run(const evaluation::Tasks& tasks, const evaluation::AnswerKeeper& keep) override {
    const evaluation::AnswerKeeper keep_safely = evaluation::one_at_a_time(keep);
    const evaluation::TaskWorkerFactory make_worker = app::simulated_sweep_workers();
    JobQueue queue(tasks.count);
    const unsigned threads = std::max(1U, tasks.threads);
    for (int rank = 1; rank < world_.size(); ++rank) {
      outbox_.send(rank, kSetup, {threads, tasks.setup});
    }
    {
      std::vector<std::jthread> own;
      for (unsigned i = 0; i < threads; ++i) {
        own.emplace_back(
            [&] { queue.work(evaluation::task_workers(tasks, make_worker, keep_safely)); });
      }
      give_out(tasks, queue, threads, keep_safely);
    }
    queue.finish();
  }

  // Ends the other ranks, also if nothing was run.
  void dismiss() {
    for (int rank = 1; rank < world_.size(); ++rank) outbox_.send(rank, kStop, {});
  }

 private:
  void give_out(const evaluation::Tasks& tasks, JobQueue& queue, unsigned threads,
                const evaluation::AnswerKeeper& keep) {
    std::vector<std::size_t> given(static_cast<std::size_t>(world_.size()), 0);
    std::size_t away = 0;
    const auto fill = [&](int rank) {
      const std::size_t others = given.size() * threads;
      std::size_t& mine = given[static_cast<std::size_t>(rank)];
      while (mine < threads * (queue.left() > kPlenty * others ? 1 + kAhead : 1)) {
        const std::optional<std::size_t> task = queue.next();
        if (!task) return;
        outbox_.send(rank, kTask, {*task, tasks.task(*task)});
        ++mine;
        ++away;
      }
    };
    for (int rank = 1; rank < world_.size(); ++rank) fill(rank);
    Pause pause;
    while (away > 0) {
      const auto waiting = world_.iprobe(mpi::any_source, mpi::any_tag);
      if (!waiting) {
        pause.take();
        continue;
      }
      pause.end();
      const Message answer = receive(world_, *waiting);
      --given[static_cast<std::size_t>(waiting->source())];
      --away;
      queue.attempt(answer.number, [&] {
        if (waiting->tag() == kFailure) throw std::runtime_error(answer.text);
        if (waiting->tag() == kRefusal) throw scenarios::InputError(answer.text);
        keep(answer.number, answer.text);
      });
      fill(waiting->source());
    }
  }

  mpi::communicator world_;
  Outbox outbox_;
};

struct TaskAnswer {
  Tag tag = kAnswer;
  Message message;
};

// Passes tasks and answers between a rank's main thread and its workers. An empty task ends a
// worker.
class TaskExchange {
 public:
  void add(std::optional<Message> task) {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
    added_.notify_one();
  }

  std::optional<Message> next() {
    std::unique_lock lock(mutex_);
    added_.wait(lock, [this] { return !tasks_.empty(); });
    std::optional<Message> task = std::move(tasks_.front());
    tasks_.pop_front();
    return task;
  }

  void answer(TaskAnswer answer) {
    const std::lock_guard lock(mutex_);
    answers_.push_back(std::move(answer));
  }

  std::deque<TaskAnswer> take_answers() {
    const std::lock_guard lock(mutex_);
    return std::exchange(answers_, {});
  }

 private:
  std::mutex mutex_;
  std::condition_variable added_;
  std::deque<std::optional<Message>> tasks_;
  std::deque<TaskAnswer> answers_;
};

void work(const std::string& setup, TaskExchange& exchange) {
  evaluation::TaskWorker worker;
  while (const std::optional<Message> task = exchange.next()) {
    try {
      if (!worker) worker = app::simulated_sweep_workers()(setup);
      exchange.answer({kAnswer, {task->number, worker(task->text)}});
    } catch (const scenarios::InputError& error) {
      exchange.answer({kRefusal, {task->number, error.what()}});
    } catch (const std::exception& error) {
      exchange.answer({kFailure, {task->number, error.what()}});
    }
  }
}

// The side of every other rank; returns when it is dismissed.
void serve(const mpi::communicator& world) {
  TaskExchange exchange;
  Outbox outbox(world);
  std::vector<std::jthread> workers;
  Pause pause;
  while (true) {
    for (const TaskAnswer& answer : exchange.take_answers()) {
      outbox.send(0, answer.tag, answer.message);
      pause.end();
    }
    const auto waiting = world.iprobe(0, mpi::any_tag);
    if (!waiting) {
      pause.take();
      continue;
    }
    pause.end();
    Message message = receive(world, *waiting);
    if (waiting->tag() == kStop) break;
    if (waiting->tag() == kTask) {
      exchange.add(std::move(message));
      continue;
    }
    for (std::size_t i = 0; i < message.number; ++i) {
      workers.emplace_back([&exchange, text = message.text] { work(text, exchange); });
    }
  }
  for (std::size_t i = 0; i < workers.size(); ++i) exchange.add(std::nullopt);
}

}  // namespace
}  // namespace simbench

int main(int argc, char** argv) {
  simbench::cli::keep_freed_memory();
  const boost::mpi::environment environment(argc, argv, boost::mpi::threading::funneled);
  const boost::mpi::communicator world;
  if (world.rank() > 0) {
    simbench::serve(world);
    return 0;
  }
  simbench::MpiFarm farm(world);
  const int status = simbench::run_command_line(argc, argv, {.farm = &farm});
  farm.dismiss();
  return status;
}
