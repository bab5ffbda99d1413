// The algorithms as they are, over real sockets and clocks: they must do here what they do in the
// simulator. Bounds are generous: the point is that the conversation works, not how well a busy
// machine does it.
#include <gtest/gtest.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <cmath>
#include <optional>

#include "algorithms/ports/host_sync.h"
#include "algorithms/registry.h"
#include "tests/hardware/await.h"
#include "tests/hardware/node/host_pair.h"

namespace simbench::hardware {
namespace {

std::unique_ptr<HostSync> make(const std::string& name, const ParameterValues& values = {}) {
  const HostSyncEntry* entry = find_algorithm<HostSyncEntry>(name);
  if (entry == nullptr) throw std::invalid_argument("no host_sync " + name);
  return entry->make(check_parameters(entry->info.parameters, values));
}

Task<void> note_end(Task<void> task, bool& ended) {
  co_await std::move(task);
  ended = true;
}

// Runs it between both hosts to its end, or a service for its warm-up.
void synchronise(HostPair& pair, HostSync& host_sync) {
  pair.connect();
  bool master_ended = false;
  bool slave_ended = false;
  boost::asio::co_spawn(pair.context(),
                        note_end(host_sync.run_master(pair.host(0), {1}), master_ended),
                        boost::asio::detached);
  boost::asio::co_spawn(pair.context(), note_end(host_sync.run_slave(pair.host(1), 0), slave_ended),
                        boost::asio::detached);
  if (const auto warm_up = host_sync.warm_up()) {
    await(pair.context(), pair.host(0).sleep_for(*warm_up));
  } else {
    run_until(pair.context(), [&] { return master_ended && slave_ended; });
  }
}

double error_ms(const HostPair& pair) { return std::abs(to_ms(pair.true_error())); }

bool is_synchronised(const HostPair& pair) {
  for (const PeerId host : {0u, 1u}) {
    for (const RecordingEvent& event : pair.events(host)) {
      const auto* outcome = std::get_if<SyncOutcome>(&event);
      if (outcome != nullptr && outcome->slave == 1 && outcome->synchronised) return true;
    }
  }
  return false;
}

// What the slave reported of its last pass; nothing if it has reported none.
std::optional<SessionDelays> last_delays(const HostPair& pair) {
  std::optional<SessionDelays> last;
  for (const RecordingEvent& event : pair.events(1)) {
    if (const auto* delays = std::get_if<SessionDelays>(&event)) last = *delays;
  }
  return last;
}

TEST(HostSyncOverSockets, Yoon2021) {
  for (const char* const row : {"yoon2021_both", "yoon2021_time", "yoon2021_network"}) {
    HostPair pair(from_ms(300), 20, -30);
    EXPECT_GT(error_ms(pair), 290);
    synchronise(pair, *make(row));
    EXPECT_TRUE(is_synchronised(pair)) << row;
    EXPECT_LT(error_ms(pair), 5) << row;
    const std::optional<SessionDelays> delays = last_delays(pair);
    ASSERT_TRUE(delays) << row;
    EXPECT_EQ(delays->slave, 1U);
    EXPECT_GT(delays->t_l.count(), 0) << row;
    EXPECT_GT(delays->set.count(), 0) << row;
    EXPECT_LE(std::abs((delays->t_t - (delays->get + delays->set) / 2).count()), 2) << row;
    EXPECT_LT(delays->begin, delays->end) << row;
  }
}

TEST(HostSyncOverSockets, NtpClientAndService) {
  HostPair pair(from_ms(-250), -10, 25);
  synchronise(pair, *make("ntp", {{"min_poll", 3.0}, {"max_poll", 3.0}, {"service_hours", 0.005}}));
  EXPECT_LT(error_ms(pair), 5);
}

TEST(HostSyncOverSockets, TwoWayHull) {
  HostPair pair(from_ms(300), 30, -30);
  synchronise(pair, *make("two_way_hull", {{"warm_up_s", 6.0}}));
  EXPECT_TRUE(is_synchronised(pair));
  EXPECT_LT(error_ms(pair), 2);
}

}  // namespace
}  // namespace simbench::hardware
