// The cameras of one host, worked on in a thread of their own.
//
// Opening, setting, starting and stopping a camera may take seconds and block; the node's thread,
// which serves host synchronisation and its conductor meanwhile, waits for none of it. Calls are
// worked on one after the other, in the order in which they were made.
//
// A camera that refuses is a problem in the result, and the others go on. Cameras are numbered as
// in the whole rig.
//
//   CameraBench bench(driver, {{"018322071234", 11}});
//   for (const CameraProblem& problem : co_await bench.prepare(settings)) ...
//   co_await bench.start(feed);
//   co_await bench.stop();
#ifndef SIMBENCH_HARDWARE_NODE_CAMERA_BENCH_H_
#define SIMBENCH_HARDWARE_NODE_CAMERA_BENCH_H_

#include <boost/asio/thread_pool.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "algorithms/ports/host.h"
#include "hardware/camera/camera.h"
#include "hardware/node/camera_feed.h"

namespace simbench::hardware {

struct CameraPlace {
  std::string serial;
  std::uint32_t number = 0;  // in the rig
};

struct CameraProblem {
  std::string camera;  // its serial
  std::string text;
};
using CameraProblems = std::vector<CameraProblem>;

// A camera of the rig file, and whether it is there.
struct CameraState {
  CameraInfo info;      // the serial only, if it is not
  std::string problem;  // empty: it is
};

class CameraBench {
 public:
  // `driver` outlives this.
  CameraBench(CameraDriver& driver, std::vector<CameraPlace> places);
  ~CameraBench();  // joins
  CameraBench(const CameraBench&) = delete;
  CameraBench& operator=(const CameraBench&) = delete;

  // Of a camera by its number in the rig.
  std::string serial_of(std::uint32_t number) const;

  // At once, in the caller's thread; before anything else.
  std::vector<CameraState> look();
  Task<std::vector<CameraState>> look_again();
  // Opens and sets the cameras, after closing those that are open.
  Task<CameraProblems> prepare(CameraSettings settings);
  // Starts those that are prepared.
  Task<CameraProblems> start(std::shared_ptr<CameraFeed> feed);
  // Idempotent. No handler runs after it.
  Task<CameraProblems> stop();
  // Stops and lets go of them.
  Task<CameraProblems> close();
  // Waits until what was called is done and closes the cameras; the last call.
  void join();

 private:
  class Worker;

  std::vector<CameraPlace> places_;
  std::shared_ptr<Worker> worker_;
  boost::asio::thread_pool thread_{1};
};

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_NODE_CAMERA_BENCH_H_
