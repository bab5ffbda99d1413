// A rig inside the test program: real nodes on loopback ports, in a thread of their own, with
// cameras that deliver a frame at each period from their start.
#pragma once

#include <boost/asio/io_context.hpp>
#include <filesystem>
#include <memory>
#include <vector>

#include "hardware/camera/camera.h"
#include "hardware/clock/software_clock.h"
#include "hardware/node/node.h"
#include "hardware/rig/rig.h"
#include "scenarios/scenario.h"

namespace simbench::hardware {

// Two hosts of one camera each, at 45 frames a second, and a short capture.
scenarios::Scenario small_scenario(const std::vector<scenarios::Override>& more = {});

// A pipeline of small_scenario() and what it is called by.
inline constexpr const char* kTestPipeline = "test";
// Names the one with a capture_alignment.
inline constexpr const char* kAlignedPipeline = "aligned";

class TestRig {
 public:
  // `clock_offsets_ms`: one node for each.
  explicit TestRig(std::vector<double> clock_offsets_ms);
  ~TestRig();
  TestRig(const TestRig&) = delete;
  TestRig& operator=(const TestRig&) = delete;

  const Rig& rig() const { return rig_; }
  // Its node stops and is not there any more.
  void take_away(std::size_t host);
  // A node on the same port, over the same journals. Returns how many frames those had.
  std::size_t restart(std::size_t host);
  // From now on this host's cameras refuse to be opened.
  void break_cameras(std::size_t host);
  // They are opened, but have no frame.
  void silence_cameras(std::size_t host);
  // What its cameras have delivered so far.
  std::size_t frames_delivered(std::size_t host) const;

 private:
  struct Host;
  void start(std::size_t host);
  std::size_t frames_in_journals(std::size_t host) const;

  std::filesystem::path folder_;
  Rig rig_;
  std::vector<std::unique_ptr<Host>> hosts_;
};

}  // namespace simbench::hardware
