// The clock of a host's Wi-Fi radio, as programs can use it in a wireless cell.
//
// The access point counts: its time synchronisation function, TSF. Beacons tell the count, each
// station's copy is set by them, and a program can read that copy (read_tsf). A radio that can do
// fine timing measurement (FTM, 802.11mc) stamps the frames of a session of exchanges itself, the
// station's by the counter of its own radio and the access point's by the TSF:
//
//   access point  t1 --frame-->            t4
//   station             t2    t3 --answer-->
//
// Contract: calls take the time that they take on the host; one coroutine may be in a call at a
// time. Stamps and counts are nanoseconds of their own time base.
//
// Source: IEEE 802.11-2020, 11.1.3 (TSF), 11.21.6 (FTM); ESP-IDF, esp_wifi_get_tsf_time(),
// esp_wifi_ftm_initiate_session(); docs/reference/wifi_time.md.
//
//   RadioClock* const radio = host.radio_clock();
//   const std::optional<TsfReading> reading = co_await radio->read_tsf();
//   const std::vector<FtmExchange> exchanges = co_await radio->measure_ftm();
#pragma once

#include <optional>
#include <vector>

#include "algorithms/ports/host.h"
#include "algorithms/ports/time.h"

namespace simbench {

// A reading of the TSF between two of the host's steady clock.
struct TsfReading {
  SteadyTime before{};
  TsfTime tsf{};
  SteadyTime after{};
};

// A reading of the counter by which the radio stamps, between two of the host's steady clock.
struct CounterReading {
  SteadyTime before{};
  HardwareTime counter{};
  SteadyTime after{};
};

struct FtmExchange {
  TsfTime t1{};       // the access point's frame leaves it
  HardwareTime t2{};  // and comes to the station
  HardwareTime t3{};  // whose answer leaves it
  TsfTime t4{};       // and comes to the access point
};

class RadioClock {
 public:
  virtual ~RadioClock() = default;
  // Whether the host is the access point: its radio's counter is the TSF, and it asks nobody.
  virtual bool is_access_point() const = 0;
  // Nothing where programs cannot read it, or no beacon was heard.
  virtual Task<std::optional<TsfReading>> read_tsf() = 0;
  // Nothing where the radio cannot measure.
  virtual Task<std::optional<CounterReading>> read_counter() = 0;
  // A session with the access point, in order of time; empty if it failed or the radio cannot.
  virtual Task<std::vector<FtmExchange>> measure_ftm() = 0;
};

}  // namespace simbench
