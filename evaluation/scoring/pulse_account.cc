#include "evaluation/scoring/pulse_account.h"

#include <algorithm>

#include "laws/saturate.h"

namespace simbench::evaluation {
namespace {

constexpr std::uint32_t kNoFrame = 0;
constexpr std::int64_t kMostLostAtTheEnd = 2;

}  // namespace

PulseAccount::PulseAccount(std::int64_t first_pulse, std::int64_t pulses, std::size_t cameras,
                           std::int64_t due_every)
    : first_pulse_(first_pulse),
      due_every_(due_every),
      pulses_(static_cast<std::size_t>(pulses)),
      ends_(cameras),
      frames_(pulses_ * cameras, kNoFrame) {}

void PulseAccount::add(std::uint32_t camera, std::int64_t pulse, std::uint32_t counter) {
  if (pulse < 0) return;
  Ends& ends = ends_[camera];
  if (pulse < first_pulse_) {
    if (!ends.before || ends.before->pulse < pulse) ends.before = {pulse, counter};
    return;
  }
  const auto row = static_cast<std::uint64_t>(pulse - first_pulse_);
  if (row >= pulses_) {
    if (!ends.after || ends.after->pulse > pulse) ends.after = {pulse, counter};
    return;
  }
  // The largest counter shares its place with none, once in four billion frames.
  frames_[camera * pulses_ + row] = counter + 1;
}

void PulseAccount::take_out(const Frame& last, const Frame& next,
                            std::vector<bool>& exposed) const {
  const std::int64_t first = last.pulse + 1;
  const std::int64_t missing = next.pulse - first;
  if (missing <= 0) return;
  const std::int64_t lost = std::uint32_t{next.counter - last.counter} - std::int64_t{1};
  const std::int64_t shot = lost < 0 || lost > missing ? 0 : lost;
  // The k-th of them is this one in the gap. A pulse may have any number.
  const auto place_of = [&](std::int64_t k) {
    return (Int128{k} * (Int128{missing} + 1) + shot / 2) / (shot + 1);
  };
  const std::int64_t begin = std::max(first, first_pulse_);
  const std::int64_t end = std::min(next.pulse, first_pulse_ + static_cast<std::int64_t>(pulses_));
  // The first of them that is due from `begin` on.
  const Int128 before = Int128{begin - last.pulse} * (shot + 1) - shot / 2;
  auto next_shot =
      static_cast<std::int64_t>(std::max<Int128>(1, (before + missing) / (Int128{missing} + 1)));
  for (std::int64_t pulse = begin; pulse < end; ++pulse) {
    if (next_shot <= shot && pulse - last.pulse == place_of(next_shot)) {
      ++next_shot;
      continue;
    }
    exposed[static_cast<std::size_t>(pulse - first_pulse_)] = false;
  }
}

void PulseAccount::add_to(SetCounts& counts) const {
  std::vector<bool> exposed(pulses_, true);
  const auto end = first_pulse_ + static_cast<std::int64_t>(pulses_);
  for (std::size_t camera = 0; camera < ends_.size(); ++camera) {
    const Ends& ends = ends_[camera];
    // Before its first frame it exposed nothing, as behind its last.
    std::optional<Frame> last = ends.before;
    const auto go_on = [&](const Frame& frame) {
      take_out(last.value_or(Frame{first_pulse_ - 1, frame.counter - 1}), frame, exposed);
      last = frame;
    };
    for (std::size_t row = 0; row < pulses_; ++row) {
      const std::uint32_t stored = frames_[camera * pulses_ + row];
      if (stored == kNoFrame) continue;
      go_on({first_pulse_ + static_cast<std::int64_t>(row), stored - 1});
    }
    if (ends.after) {
      go_on(*ends.after);
    } else if (!last || end - last->pulse - 1 > kMostLostAtTheEnd) {
      go_on({end, last ? last->counter + 1 : 0});
    }
  }
  counts.due_pulses = 0;
  counts.exposed_pulses = 0;
  for (std::size_t row = 0; row < pulses_; ++row) {
    if ((first_pulse_ + static_cast<std::int64_t>(row)) % due_every_ != 0) continue;
    ++counts.due_pulses;
    if (exposed[row]) ++counts.exposed_pulses;
  }
}

}  // namespace simbench::evaluation
