// The readers of clock logs and what is calculated from them: any bytes are either refused with an
// InputError or have finite results, and exchanges that fit an evidence.
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "evaluation/certificates/capture_evidence.h"
#include "evaluation/certificates/fact_order.h"
#include "evaluation/stability/exchange_log.h"
#include "evaluation/stability/log_stability.h"
#include "scenarios/loader.h"

namespace {

using simbench::evaluation::Stability;

void expect_finite(const Stability& stability) {
  if (!std::isfinite(stability.time_error.rms_te_ms)) std::abort();
  for (const auto* curve : {&stability.adev, &stability.mdev, &stability.hdev, &stability.tdev_ms,
                            &stability.mtie_ms}) {
    for (const auto& point : *curve) {
      if (!std::isfinite(point.value) || point.terms < 1) std::abort();
    }
  }
}

// Each set of options gets its share of the inputs.
simbench::evaluation::ClockLogOptions options_of(std::size_t size) {
  simbench::evaluation::ClockLogOptions options;
  if (size % 2 != 0) options.interval_s = 1;
  if (size / 2 % 2 != 0) options.unit = simbench::kNanosecondUnit;
  options.frequencies = size / 4 % 2 != 0;
  options.locked = size / 8 % 2 != 0;
  return options;
}

// Two hosts that were recorded from 2024 on, for a day.
void use_exchanges(std::string_view text) {
  using simbench::ClockAdjustment;
  using simbench::HostTime;
  using simbench::SteadyTime;
  namespace evaluation = simbench::evaluation;
  const evaluation::ExchangeLog log = evaluation::parse_exchange_log(text, "fuzz.log");
  evaluation::Assumptions assumed;
  assumed.pulse_late_us = 50;
  assumed.estimated_stamp_ms = 1;
  evaluation::CaptureEvidence evidence(assumed, simbench::StreamKind::kDepth);
  evidence.on_start({.hosts = 2, .cameras = {{0}}});
  const HostTime begin(std::chrono::seconds(1'725'000'000));
  for (const std::uint32_t host : {0U, 1U}) {
    for (const auto at : {std::chrono::hours(0), std::chrono::hours(24)}) {
      evidence.on_event(ClockAdjustment{host, SteadyTime(at), begin + at, begin + at, 0});
    }
    evidence.add(host, log, {});
  }
  const evaluation::FactOrder order(evidence);
  if (order.clocks() < 3) std::abort();
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const auto log = simbench::evaluation::parse_clock_log(text, "fuzz.log", options_of(size));
    const auto found = simbench::evaluation::stability_of_log(log, {.remove_frequency = true});
    expect_finite(found.stability);
  } catch (const simbench::scenarios::InputError&) {
  }
  try {
    use_exchanges(text);
  } catch (const simbench::scenarios::InputError&) {
  }
  return 0;
}
