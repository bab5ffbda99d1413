// A node's software clock as the system clock of real programs that run on its host.
//
// The programs read it from a page of memory (shim/clock_page.h), which is why a reading costs what
// one of the kernel's costs, and not a visit to the node; they set and adjust it by requests
// (shim/protocol.h), which cost what a change of the clock costs. What adjtimex() does is
// clocks/kernel_discipline.h, as on simulated hosts. One for each host, as the kernel's is.
//
// While this lives, nobody else changes the clock: the page would not know.
//
// Errors: std::runtime_error from the constructor without memory; processes::BadRequest for what is
// no request of such a program, or its last one, with what it says.
//
//   void serve(boost::asio::io_context& network, SoftwareClock& own) {
//     ProgramClock clock(network.get_executor(), own);
//     boost::asio::co_spawn(network, clock.run(), boost::asio::detached);
//     const ProgramClock::Answer answer = clock.answer(processes::ChildRequest{});
//   }
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>

#include "clocks/kernel_discipline.h"
#include "hardware/clock/software_clock.h"
#include "hardware/descriptor.h"
#include "processes/child.h"
#include "shim/clock_page.h"

namespace simbench::hardware {

class ProgramClock {
 public:
  struct Answer {
    std::int64_t value = 0;
    int error = 0;  // an errno
    Bytes data{};
  };

  // The clock must outlive this.
  ProgramClock(const boost::asio::any_io_executor& executor, SoftwareClock& clock);
  ~ProgramClock();
  ProgramClock(const ProgramClock&) = delete;
  ProgramClock& operator=(const ProgramClock&) = delete;

  // The descriptor of the page, for a program (processes::Child::Settings::clock_page).
  int page() const { return memory_.number(); }
  Answer answer(const processes::ChildRequest& request);
  // The kernel's own work, for ever: without it nothing is added to the phase.
  Task<void> run();
  // Whether a program has set or steered the clock.
  bool was_steered() const { return kernel_.was_steered(); }

 private:
  Answer set(std::int64_t clock, std::int64_t reading);
  Answer adjust(const processes::ChildRequest& request);
  // The clock goes on otherwise since then.
  void publish(MonotonicTime since);

  SoftwareClock& clock_;
  Descriptor memory_;
  shim::ClockPage* page_ = nullptr;
  clocks::KernelDiscipline kernel_;
  boost::asio::steady_timer next_second_;
};

}  // namespace simbench::hardware
