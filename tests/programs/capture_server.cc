// A capture server as a node of ROS is one: a camera's thread stamps frames, a bounded queue with
// condition variables hands them to workers, and a publisher sends what they make of it over UDP.
//
//   capture_server publish ADDRESS | capture_server subscribe
//
// The camera takes 50 frames a second, and none between its 2nd and 3rd second: the workers, who
// wait for 100 ms at most, then find nothing ten times each. Encoding takes 5 ms.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace {

using namespace std::chrono_literals;
using Steady = std::chrono::steady_clock;

constexpr std::uint16_t kPort = 5600;
constexpr int kFrames = 300;
constexpr auto kPeriod = 20ms;
constexpr int kPauseBegin = 100;  // the frame that comes late
constexpr auto kPause = 1s;
constexpr int kWorkers = 3;
constexpr std::size_t kMostWaiting = 4;

struct Frame {
  std::int64_t number = 0;
  std::int64_t stamp_ns = 0;  // by the system clock
};

template <class Item>
class BoundedQueue {
 public:
  // Waits for room.
  void push(const Item& item) {
    std::unique_lock lock(mutex_);
    has_room_.wait(lock, [this] { return items_.size() < kMostWaiting; });
    items_.push_back(item);
    has_item_.notify_one();
  }
  std::optional<Item> pop(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    if (!has_item_.wait_for(lock, patience, [this] { return !items_.empty(); })) return {};
    const Item item = items_.front();
    items_.pop_front();
    has_room_.notify_one();
    return item;
  }

 private:
  std::mutex mutex_;
  std::condition_variable has_item_;
  std::condition_variable has_room_;
  std::deque<Item> items_;
};

std::int64_t system_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

struct Server {
  BoundedQueue<Frame> captured{};
  BoundedQueue<Frame> encoded{};
  std::atomic<bool> is_over = false;
  std::atomic<int> found_nothing = 0;

  void capture() {
    auto next = Steady::now();
    for (int i = 0; i < kFrames; ++i) {
      if (i == kPauseBegin) next += kPause;
      std::this_thread::sleep_until(next += kPeriod);
      captured.push({.number = i, .stamp_ns = system_ns()});
    }
    std::this_thread::sleep_for(50ms);
    is_over = true;
  }
  void encode() {
    while (!is_over) {
      const std::optional<Frame> frame = captured.pop(100ms);
      if (frame) {
        std::this_thread::sleep_for(5ms);
        encoded.push(*frame);
      } else if (!is_over) {
        ++found_nothing;
      }
    }
  }
  void publish(const char* address) {
    const int link = socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(kPort);
    inet_pton(AF_INET, address, &to.sin_addr);
    int sent = 0;
    while (!is_over) {
      const std::optional<Frame> frame = encoded.pop(100ms);
      if (!frame) continue;
      sendto(link, &*frame, sizeof *frame, 0, reinterpret_cast<sockaddr*>(&to), sizeof to);
      ++sent;
    }
    std::printf("sent %d frames, found nothing %d times\n", sent, found_nothing.load());
    std::fflush(stdout);
    close(link);
  }
};

void serve(const char* address) {
  Server server;
  std::vector<std::thread> threads;
  for (int i = 0; i < kWorkers; ++i) threads.emplace_back([&] { server.encode(); });
  threads.emplace_back([&] { server.publish(address); });
  threads.emplace_back([&] { server.capture(); });
  for (std::thread& each : threads) each.join();
}

void subscribe() {
  const int link = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in own{};
  own.sin_family = AF_INET;
  own.sin_port = htons(kPort);
  if (bind(link, reinterpret_cast<sockaddr*>(&own), sizeof own) != 0) return std::perror("bind");
  Frame first{};
  auto arrived_first = Steady::now();
  for (;;) {
    Frame frame{};
    if (recv(link, &frame, sizeof frame, 0) != sizeof frame) continue;
    const auto arrived = Steady::now();
    if (frame.number == 0) {
      first = frame;
      arrived_first = arrived;
    }
    // How much later than the first, by the camera's stamps and by this host's clock.
    const double stamped_ms = static_cast<double>(frame.stamp_ns - first.stamp_ns) / 1e6;
    const double arrived_ms =
        std::chrono::duration<double, std::milli>(arrived - arrived_first).count();
    std::printf("%lld %.3f %.3f\n", static_cast<long long>(frame.number), stamped_ms, arrived_ms);
    std::fflush(stdout);
  }
}

}  // namespace

int main(int count, char** words) {
  if (count == 3 && std::strcmp(words[1], "publish") == 0) {
    serve(words[2]);
  } else {
    subscribe();
  }
  for (;;) sleep(3600);
}
