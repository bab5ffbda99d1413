#include "hardware/conductor/journals.h"

#include <queue>
#include <utility>

#include "hardware/node/journal.h"
#include "recording/event_text.h"

namespace simbench::hardware {

void HostJournal::append(std::string_view text) {
  bytes_ += text.size();
  rest_ += text;
  std::size_t begin = 0;
  for (std::size_t end = rest_.find('\n'); end != std::string::npos;
       end = rest_.find('\n', begin)) {
    const std::string_view text_so_far = rest_;
    take(text_so_far.substr(begin, end - begin));
    begin = end + 1;
  }
  rest_.erase(0, begin);
}

void HostJournal::take(std::string_view line) {
  if (const auto note = note_of_line(line)) {
    notes_.push_back(*note);
    return;
  }
  try {
    events_.push_back(from_line(line));
  } catch (const EventTextError&) {
    ++damaged_;
    return;
  }
  const auto* frame = event_as<FrameEvent>(events_.back());
  if (frame == nullptr) return;
  ++frames_;
  const FrameRecord& record = frame->record;
  const auto [found, is_first] = counters_.try_emplace({record.camera, record.stream});
  Counters& counters = found->second;
  // The counter is of 32 bits and may wrap; a step back is its restart.
  const std::uint32_t step = is_first ? 1 : record.counter - counters.last;
  if (step < 0x80000000) counters.covered += step;
  counters.last = record.counter;
}

std::int64_t HostJournal::covered(std::uint32_t camera, StreamKind stream) const {
  const auto found = counters_.find({camera, stream});
  return found == counters_.end() ? 0 : found->second.covered;
}

void play_in_order(const std::vector<HostJournal>& journals, RecordingSink& sink) {
  // The next event of each host; one that is no frame goes before all frames.
  using Head = std::pair<HostTime, std::size_t>;
  std::priority_queue<Head, std::vector<Head>, std::greater<>> heads;
  std::vector<std::size_t> next(journals.size(), 0);
  const auto push = [&](std::size_t host) {
    const std::vector<KeptEvent>& events = journals[host].events();
    if (next[host] == events.size()) return;
    const auto* frame = event_as<FrameEvent>(events[next[host]]);
    heads.emplace(frame != nullptr ? frame->record.arrival : HostTime::min(), host);
  };
  for (std::size_t host = 0; host < journals.size(); ++host) push(host);
  while (!heads.empty()) {
    const std::size_t host = heads.top().second;
    heads.pop();
    notify(journals[host].events()[next[host]++], sink);
    push(host);
  }
}

}  // namespace simbench::hardware
