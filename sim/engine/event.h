// The typed event of the simulation engine and the interface that receives it.
//
// An event is sixteen plain bytes: its time, its handler, and two numbers with a meaning of the
// handler's own (the kind of event, one of its objects). Models schedule events instead of closures
// on their hot paths, because an event costs no allocation and one virtual call, in two registers.
#pragma once

#include <cstdint>

#include "recording/true_time.h"

namespace simbench::sim {

// Number of a handler within its engine, given by Engine::attach().
using HandlerId = std::uint16_t;

struct Event {
  TrueTime time;
  HandlerId handler = 0;
  std::uint16_t kind = 0;     // what happened: the handler's own enumeration
  std::uint32_t subject = 0;  // to whom: the handler's own index
};

class EventHandler {
 public:
  virtual ~EventHandler() = default;
  virtual void handle(Event event) = 0;
};

}  // namespace simbench::sim
