// The requests that concern the network card's clock.
#include <linux/ptp_clock.h>

#include <cerrno>

#include "sim/programs/process.h"

namespace simbench::sim {

Task<Process::Answer> Process::read_card(std::int64_t count) {
  if (count < 0 || count > PTP_MAX_SAMPLES) throw BadRequest("asked for too many readings");
  Answer answer;
  for (std::int64_t i = 0; i < count; ++i) {
    const CardClock::Reading reading = co_await card_.read();
    if (reading.error != 0) co_return Answer{.error = reading.error};
    const Bytes sample = bytes_of(reading.sample);
    answer.data.insert(answer.data.end(), sample.begin(), sample.end());
  }
  co_return answer;
}

Process::Answer Process::card_stamping(std::int64_t wanted) {
  if (host_.nic() == nullptr) return {.error = EOPNOTSUPP};
  if (wanted >= 0) {
    network_.set_card_stamping({.arrivals = (wanted & 1) != 0, .departures = (wanted & 2) != 0});
  }
  const CardStamping now = network_.card_stamping();
  return {.value = (now.arrivals ? 1 : 0) | (now.departures ? 2 : 0)};
}

}  // namespace simbench::sim
