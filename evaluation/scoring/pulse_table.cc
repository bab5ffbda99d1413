#include "evaluation/scoring/pulse_table.h"

namespace simbench::evaluation {

PulseTable::PulseTable(std::int64_t first_pulse, std::int64_t pulses, std::size_t sources)
    : first_pulse_(first_pulse),
      sources_(sources),
      rows_(static_cast<std::size_t>(pulses)),
      global_ns_(rows_.size() * sources, kNothing),
      reference_ns_(rows_.size() * sources) {}

void PulseTable::shift(Nanoseconds by) {
  for (std::int64_t& cell : global_ns_) {
    if (cell != kNothing) cell = clamped_ns(GlobalTime(Nanoseconds(cell) + by));
  }
}

}  // namespace simbench::evaluation
