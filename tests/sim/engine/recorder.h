// An event handler that writes down what it gets, for the tests of the engine.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sim/engine/engine.h"

namespace simbench::sim {

inline TrueTime at_ns(std::int64_t time_ns) { return TrueTime(Nanoseconds(time_ns)); }

class Recorder : public EventHandler {
 public:
  explicit Recorder(Engine& engine) : engine_(engine), id_(engine.attach(*this)) {}

  void schedule(std::int64_t time_ns, std::uint32_t subject = 0, std::uint16_t kind = 0) {
    engine_.schedule(at_ns(time_ns), id_, kind, subject);
  }

  void handle(Event event) override {
    events.push_back(event);
    subjects.push_back(event.subject);
    if (on_event) on_event(event);
  }

  std::vector<Event> events;
  std::vector<std::uint32_t> subjects;
  std::function<void(const Event&)> on_event;

 private:
  Engine& engine_;
  HandlerId id_;
};

}  // namespace simbench::sim
