#include "tests/recording/random_events.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

namespace simbench {
namespace {

using Random = std::mt19937_64;

// Extremes, small numbers and any numbers, about a third each.
template <class Number>
Number any_number(Random& random) {
  using Limits = std::numeric_limits<Number>;
  switch (random() % 6) {
    case 0:
      return Limits::min();
    case 1:
      return Limits::max();
    case 2:
    case 3:
      return static_cast<Number>(static_cast<int>(random() % 21) - (Limits::is_signed ? 10 : 0));
    default:
      return static_cast<Number>(random());
  }
}

template <class Time>
void set_any(Time& time, Random& random) {
  time = Time(Nanoseconds(any_number<std::int64_t>(random)));
}

double any_double(Random& random) {
  const double value = std::bit_cast<double>(random());
  if (std::isfinite(value)) return value;
  constexpr double kSpecial[] = {0.0,
                                 -0.0,
                                 std::numeric_limits<double>::max(),
                                 std::numeric_limits<double>::lowest(),
                                 std::numeric_limits<double>::denorm_min(),
                                 0.1};
  return kSpecial[random() % std::size(kSpecial)];
}

std::string any_text(Random& random) {
  constexpr const char* kPieces[] = {"a", ",",  "\n", "\r\n", "\\", "\\n", "\"",
                                     "'", "ä€", "\t", ";",    " ",  "x=",  "\xff"};
  std::string text;
  for (std::uint64_t left = random() % 12; left > 0; --left) {
    text += kPieces[random() % std::size(kPieces)];
  }
  if (random() % 16 == 0) text += '\0';
  return text;
}

FrameEvent any_frame(Random& random, std::uint32_t cameras) {
  FrameEvent event;
  FrameRecord& record = event.record;
  record.camera = any_number<std::uint32_t>(random) % cameras;
  record.stream = static_cast<StreamKind>(random() % 2);
  record.domain = static_cast<StampDomain>(random() % 3);
  record.counter = any_number<std::uint32_t>(random);
  record.exposure_us = any_number<std::uint32_t>(random);
  record.sensor.us = any_number<std::uint32_t>(random);
  record.frame.us = any_number<std::uint32_t>(random);
  set_any(record.backend, random);
  set_any(record.arrival, random);
  set_any(record.arrival_steady, random);
  if (random() % 2 == 0) return event;
  FrameTruth& truth = event.truth.emplace();
  truth.pulse = any_number<std::int64_t>(random);
  set_any(truth.exposure_start, random);
  set_any(truth.exposure_end, random);
  set_any(truth.reference, random);
  set_any(truth.own_host, random);
  set_any(truth.own_steady, random);
  set_any(truth.delivered, random);
  return event;
}

std::optional<HostTime> maybe_time(Random& random) {
  if (random() % 4 == 0) return std::nullopt;
  return HostTime(Nanoseconds(any_number<std::int64_t>(random)));
}

template <class... Members>
auto members(const Members&... values) {
  return std::make_tuple(values...);
}

struct Same {
  bool operator()(const RecordingEvent& a, const RecordingEvent& b) const {
    return std::visit(*this, a, b);
  }
  bool operator()(const FrameEvent& a, const FrameEvent& b) const {
    const auto record = [](const FrameRecord& r) {
      return members(r.camera, r.stream, r.domain, r.counter, r.exposure_us, r.sensor.us,
                     r.frame.us, r.backend, r.arrival, r.arrival_steady);
    };
    const auto truth = [](const FrameTruth& t) {
      return members(t.pulse, t.exposure_start, t.exposure_end, t.reference, t.own_host,
                     t.own_steady, t.delivered);
    };
    return record(a.record) == record(b.record) && a.truth.has_value() == b.truth.has_value() &&
           (!a.truth || truth(*a.truth) == truth(*b.truth));
  }
  bool operator()(const PulseTruth& a, const PulseTruth& b) const {
    return a.pulse == b.pulse && a.at == b.at && a.host_errors == b.host_errors;
  }
  bool operator()(const ClockAdjustment& a, const ClockAdjustment& b) const {
    const auto all = [](const ClockAdjustment& c) {
      return members(c.host, c.at, c.before, c.after, std::bit_cast<std::uint64_t>(c.rate_ppb));
    };
    return all(a) == all(b);
  }
  bool operator()(const DevicePoll& a, const DevicePoll& b) const {
    const auto all = [](const DevicePoll& p) {
      return members(p.camera, p.device.us, p.t0, p.t1, p.t0_steady, p.t1_steady);
    };
    return all(a) == all(b);
  }
  bool operator()(const ExchangeEvent& a, const ExchangeEvent& b) const {
    const auto all = [](const ExchangeEvent& e) {
      const Exchange& x = e.exchange;
      return members(e.host, x.peer, x.t1, x.t2, x.t3, x.t4, x.is_estimated);
    };
    return all(a) == all(b);
  }
  bool operator()(const SyncOutcome& a, const SyncOutcome& b) const {
    const auto all = [](const SyncOutcome& o) {
      return members(o.slave, o.synchronised, o.passes, o.message);
    };
    return all(a) == all(b);
  }
  bool operator()(const AlignmentReport& a, const AlignmentReport& b) const {
    const auto all = [](const AlignmentReport& r) {
      return members(r.camera, r.aligned, r.controls, r.message);
    };
    return all(a) == all(b);
  }
  bool operator()(const LedSighting& a, const LedSighting& b) const {
    const auto all = [](const LedSighting& s) {
      return members(s.camera, s.sensor.us, s.led_start_ns, s.led_end_ns);
    };
    return all(a) == all(b);
  }
  bool operator()(const SessionDelays& a, const SessionDelays& b) const {
    const auto all = [](const SessionDelays& d) {
      return members(d.slave, d.pass, d.begin, d.end, d.t_l, d.t_t, d.t_d, d.get, d.set);
    };
    return all(a) == all(b);
  }
  bool operator()(const ProgramFailure& a, const ProgramFailure& b) const {
    const auto all = [](const ProgramFailure& f) {
      return members(f.host, f.program, f.at, f.how, f.last_words, f.log);
    };
    return all(a) == all(b);
  }
  bool operator()(const PulseSighting& a, const PulseSighting& b) const {
    const auto all = [](const PulseSighting& p) { return members(p.host, p.seen, p.gnss); };
    return all(a) == all(b);
  }
  template <class A, class B>
  bool operator()(const A&, const B&) const {
    return false;
  }
};

}  // namespace

KeptEvent random_event(Random& random, const RandomEventBounds& bounds) {
  const auto host = [&] { return any_number<std::uint32_t>(random) % bounds.hosts; };
  switch (random() % 11) {
    case 0: {
      PulseTruth event;
      event.pulse = any_number<std::int64_t>(random);
      set_any(event.at, random);
      const std::uint64_t errors = bounds.hosts < 100 ? bounds.hosts : random() % 5;
      for (std::uint64_t left = errors; left > 0; --left) {
        event.host_errors.emplace_back(any_number<std::int64_t>(random));
      }
      return event;
    }
    case 1: {
      ClockAdjustment event;
      event.host = host();
      set_any(event.at, random);
      set_any(event.before, random);
      set_any(event.after, random);
      event.rate_ppb = any_double(random);
      return event;
    }
    case 2: {
      DevicePoll event;
      event.camera = any_number<std::uint32_t>(random) % bounds.cameras;
      event.device.us = any_number<std::uint32_t>(random);
      set_any(event.t0, random);
      set_any(event.t1, random);
      set_any(event.t0_steady, random);
      set_any(event.t1_steady, random);
      return event;
    }
    case 3: {
      ExchangeEvent event{host(), {host(), {}, {}, {}, {}}};
      event.exchange.t1 = maybe_time(random);
      event.exchange.t2 = maybe_time(random);
      event.exchange.t3 = maybe_time(random);
      event.exchange.t4 = maybe_time(random);
      event.exchange.is_estimated = random() % 2 == 0;
      return event;
    }
    case 4:
      return SyncOutcome{host(), random() % 2 == 0, any_number<std::uint32_t>(random),
                         any_text(random)};
    case 5:
      return AlignmentReport{any_number<std::uint32_t>(random) % bounds.cameras, random() % 2 == 0,
                             any_number<std::uint32_t>(random), any_text(random)};
    case 6:
      return LedSighting{any_number<std::uint32_t>(random) % bounds.cameras,
                         {any_number<std::uint32_t>(random)},
                         any_number<std::int64_t>(random),
                         any_number<std::int64_t>(random)};
    case 7: {
      SessionDelays event;
      event.slave = host();
      event.pass = any_number<std::uint32_t>(random);
      set_any(event.begin, random);
      set_any(event.end, random);
      for (Nanoseconds* delay : {&event.t_l, &event.t_t, &event.t_d, &event.get, &event.set}) {
        *delay = Nanoseconds(any_number<std::int64_t>(random));
      }
      return event;
    }
    case 8:
      return ProgramFailure{
          host(),           any_text(random), Nanoseconds(any_number<std::int64_t>(random)),
          any_text(random), any_text(random), any_text(random)};
    case 9: {
      PulseSighting event;
      event.host = host();
      set_any(event.seen, random);
      event.gnss = Nanoseconds(any_number<std::int64_t>(random));
      return event;
    }
    default:
      return any_frame(random, bounds.cameras);
  }
}

bool same(const KeptEvent& a, const KeptEvent& b) { return std::visit(Same{}, a, b); }

bool same(const RigLayout& a, const RigLayout& b) {
  const auto all = [](const RigLayout& l) {
    return members(l.hosts, std::bit_cast<std::uint64_t>(l.frame_rate_hz), l.first_pulse, l.pulses);
  };
  return all(a) == all(b) &&
         std::equal(a.cameras.begin(), a.cameras.end(), b.cameras.begin(), b.cameras.end(),
                    [](const CameraLayout& x, const CameraLayout& y) { return x.host == y.host; });
}

}  // namespace simbench
