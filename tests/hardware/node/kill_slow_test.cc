// Nodes that are killed at random moments of captures lose nothing that was recorded: a hundred
// kills of the real program, and what its journals say after each restart.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/use_future.hpp>
#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <random>
#include <sstream>
#include <thread>

#include "hardware/net/secure_stream.h"
#include "hardware/node/protocol.h"
#include "recording/event_text.h"
#include "scenarios/loader.h"
#include "tests/hardware/node/node_process.h"

namespace simbench::hardware {
namespace {

namespace asio = boost::asio;
using nlohmann::json;

constexpr int kNodes = 4;
constexpr int kKillsPerNode = 25;
constexpr Nanoseconds kLongestCapture = std::chrono::milliseconds(500);
// What a kill may cost: a batch of the journal, and the ways to it.
constexpr Nanoseconds kMargin = std::chrono::milliseconds(100);

// A conductor that waits for each answer.
class BlockingConductor {
 public:
  explicit BlockingConductor(std::uint16_t port) {
    stream_ = result_of(SecureStream::connect(context_, "127.0.0.1", port, {}, {}, limit()));
  }

  json ask(const std::string& verb, json arguments = json::object()) {
    result_of(stream_->send(encode(NodeRequest{1, verb, std::move(arguments)})));
    for (;;) {
      const NodeAnswer answer = parse_answer(result_of(stream_->receive(limit())).bytes);
      if (!answer.notice.empty()) continue;
      if (!answer.error.empty()) throw std::runtime_error(verb + ": " + answer.error);
      return answer.details;
    }
  }

 private:
  static MonotonicTime limit() { return monotonic_now() + std::chrono::seconds(20); }

  template <class Result>
  Result result_of(Task<Result> task) {
    std::future<Result> result = asio::co_spawn(context_, std::move(task), asio::use_future);
    context_.restart();
    while (result.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
      context_.run_one();
    }
    return result.get();
  }

  asio::io_context context_;
  std::unique_ptr<SecureStream> stream_;
};

// How late this machine wakes who sleeps, at the worst: a busy one delivers frames late, too.
class Lateness {
 public:
  Lateness() : thread_([this] { watch(); }) {}
  ~Lateness() {
    ended_ = true;
    thread_.join();
  }
  Lateness(const Lateness&) = delete;
  Lateness& operator=(const Lateness&) = delete;
  Nanoseconds worst() const { return Nanoseconds(worst_ns_.load()); }

 private:
  void watch() {
    while (!ended_) {
      const MonotonicTime due = monotonic_now() + std::chrono::milliseconds(5);
      std::this_thread::sleep_until(for_timer(due));
      worst_ns_ = std::max(worst_ns_.load(), (monotonic_now() - due).count());
    }
  }

  std::atomic<bool> ended_{false};
  std::atomic<std::int64_t> worst_ns_{0};
  std::thread thread_;
};

std::string journal_of(BlockingConductor& conductor, const std::string& session) {
  std::string text;
  for (;;) {
    const json chunk = conductor.ask("read", {{"session", session}, {"offset", text.size()}});
    EXPECT_TRUE(chunk.at("closed").get<bool>());
    text += chunk.at("text").get<std::string>();
    if (text.size() >= chunk.at("size").get<std::size_t>()) return text;
  }
}

// The counters of each camera, which must follow each other without a gap.
std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> counters_in(
    const std::string& journal) {
  std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> first_and_last;
  std::istringstream lines(journal);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("frame,")) continue;
    const FrameRecord frame = std::get<FrameEvent>(from_line(line)).record;
    const auto [found, is_first] =
        first_and_last.try_emplace(frame.camera, frame.counter, frame.counter);
    if (is_first) continue;
    EXPECT_EQ(frame.counter, found->second.second + 1) << "of camera " << frame.camera;
    found->second.second = frame.counter;
  }
  return first_and_last;
}

// A capture that is killed, and what is left of it.
class KilledCapture {
 public:
  KilledCapture(NodeProcess& node, std::string session, Nanoseconds kill_after)
      : node_(node), session_(std::move(session)), kill_after_(kill_after) {}

  void run(const std::string& scenario) {
    BlockingConductor conductor(node_.port());
    zero_ = monotonic_now() + std::chrono::milliseconds(30);
    node_.set_trigger(zero_);
    conductor.ask("begin", {{"session", session_},
                            {"conductor", "kill_slow_test"},
                            {"scenario", scenario},
                            {"pipeline", "free_running"}});
    conductor.ask("prepare");
    const json started = conductor.ask("start");
    EXPECT_TRUE(started.at("problems").empty()) << started;
    started_ = std::max(monotonic_now(), zero_);
    std::this_thread::sleep_until(for_timer(started_ + kill_after_));
    killed_ = node_.kill();
  }

  // The number of frames that were kept, of all cameras.
  std::uint64_t check(Nanoseconds margin) {
    BlockingConductor conductor(node_.port());
    const auto counters = counters_in(journal_of(conductor, session_));
    const auto first_due = due_at_or_after(started_ + NodeProcess::kPeriod);
    const auto last_due = due_at_or_after(killed_ - margin) - 1;
    std::uint64_t kept = 0;
    for (std::uint32_t camera = 0; camera < 3; ++camera) {
      const auto found = counters.find(camera);
      if (found == counters.end()) {
        EXPECT_LT(last_due, first_due) << "camera " << camera << " has no frame";
        continue;
      }
      const auto [first, last] = found->second;
      if (last_due >= first_due) {
        EXPECT_LE(first, first_due) << "camera " << camera;
        EXPECT_GE(last, last_due) << "camera " << camera;
      }
      // None is there that was not due.
      EXPECT_LE(last, due_at_or_after(killed_));
      kept += last - first + 1;
    }
    return kept;
  }

 private:
  // The number of the first frame that is due then or later.
  std::int64_t due_at_or_after(MonotonicTime at) const {
    const std::int64_t period = NodeProcess::kPeriod.count();
    return std::max<std::int64_t>((at - zero_).count() + period - 1, 0) / period + 1;
  }

  NodeProcess& node_;
  std::string session_;
  Nanoseconds kill_after_;
  MonotonicTime zero_{};
  MonotonicTime started_{};
  MonotonicTime killed_{};
};

// One node, killed again and again.
std::uint64_t kill_often(NodeProcess& node, unsigned seed, const std::string& scenario,
                         const Lateness& lateness) {
  std::mt19937 random(seed);
  node.start();
  std::uint64_t kept = 0;
  for (int kill = 0; kill < kKillsPerNode; ++kill) {
    SCOPED_TRACE(fmt::format("kill {} of the node at port {}", kill, node.port()));
    const Nanoseconds after(static_cast<std::int64_t>(random()) % kLongestCapture.count());
    KilledCapture capture(node, fmt::format("{:08x}{:08x}", seed, kill), after);
    capture.run(scenario);
    node.start();
    kept += capture.check(kMargin + 2 * lateness.worst());
    if (testing::Test::HasFailure()) break;
  }
  return kept;
}

TEST(KilledNodes, LoseNothingThatWasRecorded) {
  const unsigned seed = std::random_device()();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  const std::string scenario = scenarios::load_scenario("3cam_1host_30fps").resolved_json();
  const auto root = std::filesystem::temp_directory_path() /
                    fmt::format("simbench_kill_{}_{:08x}", getpid(), seed);
  std::uint64_t kept = 0;
  Nanoseconds worst{};
  {
    const Lateness lateness;
    // All have their ports before the first starts: its process would inherit the sockets with
    // which another thread just then looks for a free one.
    std::vector<std::unique_ptr<NodeProcess>> nodes;
    for (int node = 0; node < kNodes; ++node) {
      const auto folder = root / fmt::format("node{}", node);
      std::filesystem::create_directories(folder);
      nodes.push_back(std::make_unique<NodeProcess>(folder));
    }
    std::vector<std::future<std::uint64_t>> kept_by_node;
    for (unsigned node = 0; node < kNodes; ++node) {
      kept_by_node.push_back(std::async(std::launch::async, [&, node] {
        return kill_often(*nodes[node], seed + node, scenario, lateness);
      }));
    }
    for (auto& of_node : kept_by_node) EXPECT_NO_THROW(kept += of_node.get());
    worst = lateness.worst();
  }
  std::filesystem::remove_all(root);
  // On average a capture is killed after a quarter of a second: some 20 frames of 3 cameras.
  EXPECT_GT(kept, 100U * 3 * 5);
  RecordProperty("frames_kept", static_cast<int>(kept));
  std::printf("%d kills, %llu frames kept, this machine was %.1f ms late at the worst; seed %u\n",
              kNodes * kKillsPerNode, static_cast<unsigned long long>(kept), to_ms(worst), seed);
}

}  // namespace
}  // namespace simbench::hardware
