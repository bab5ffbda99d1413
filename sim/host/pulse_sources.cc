#include "sim/host/pulse_sources.h"

#include "sim/engine/random.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kReceiverJitter("host: error of the receiver's pulse");
constexpr Nanoseconds kSecond = std::chrono::seconds(1);

}  // namespace

PpsReceiver::PpsReceiver(const scenarios::PulseLines& lines, std::uint64_t run_seed, PeerId host)
    : run_seed_(run_seed),
      host_(host),
      jitter_sigma_us_(lines.pps_jitter_sigma_us),
      tells_time_(lines.gnss) {}

std::optional<std::int64_t> PpsReceiver::first_from(TrueTime at) const {
  const Nanoseconds gnss = at.time_since_epoch() + kGnssTimeAtTrueZero;
  return std::chrono::ceil<std::chrono::seconds>(gnss).count();
}

std::optional<TrueTime> PpsReceiver::pulse(std::int64_t number) const {
  RandomStream draw(run_seed_, kReceiverJitter, host_, static_cast<std::uint64_t>(number));
  return TrueTime(number * kSecond - kGnssTimeAtTrueZero) +
         from_ms(draw.normal(jitter_sigma_us_) * 1e-3);
}

std::optional<Nanoseconds> PpsReceiver::told_time(std::int64_t number) const {
  if (!tells_time_) return std::nullopt;
  return number * kSecond;
}

void TriggerLine::start(const TriggerTree& tree, std::int64_t last) {
  tree_ = &tree;
  last_ = last;
}

std::optional<std::int64_t> TriggerLine::first_from(TrueTime at) const {
  if (tree_ == nullptr) return std::nullopt;
  return tree_->first_slot_from(at);
}

}  // namespace simbench::sim
