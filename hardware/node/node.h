// The node: the long-running program of each host of a rig (`simbench node`).
//
// It owns the host's cameras, clock and sockets, keeps a journal of each session on disk, and
// carries out the requests of the rig's conductor (protocol.h). By itself it only ends a session
// whose conductor is silent. It survives any failure of a peer, a conductor or a camera.
//
// Contract
//  - One session at a time; a second conductor gets the name of the first and since when it
//    conducts.
//  - Every frame, adjustment, exchange, outcome and report goes to the session's journal, in
//    order, by one write() a batch of at most 20 ms: written data survives a kill of the process.
//    A full disk is a note to the conductor at once; frames are then counted, not kept, and the
//    other hosts go on.
//  - `log` gets a line for each event.
//  - Arrival stamps are taken in the camera's thread; everything else runs on `context`'s thread.
//
//   Node node(context, settings, clock, cameras, make_pipeline, log);
//   node.start();
//   context.run();
#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>

#include "hardware/camera/camera.h"
#include "hardware/clock/node_clock.h"
#include "hardware/net/secret_key.h"
#include "hardware/node/protocol.h"
#include "hardware/node/session.h"
#include "hardware/rig/rig.h"
#include "scenarios/scenario.h"

namespace simbench::hardware {

// Makes the algorithms of a scenario's pipeline; throws scenarios::InputError. hardware/ does not
// know the algorithms.
using PipelineFactory =
    std::function<NodePipeline(const scenarios::Scenario& scenario, const std::string& pipeline)>;

struct NodeSettings {
  Rig rig;
  PeerId me = 0;
  SecretKey key;
  std::string journal_folder;  // made if it is not there
  std::string clock_kind = "software";
  // How long a session outlives the last request of its conductor.
  Nanoseconds conductor_silence = kConductorSilence;
};

class Node {
 public:
  using Log = std::function<void(const std::string& line)>;

  // `clock` and `cameras` outlive the node and its context. Throws StreamError if the port is
  // taken, CameraError if a camera of the rig file is missing, JournalError if journals cannot be
  // written, scenarios::InputError for a rig without a key that leaves this machine.
  Node(boost::asio::io_context& context, NodeSettings settings, NodeClock& clock,
       CameraDriver& cameras, PipelineFactory make_pipeline, Log log);
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  void start();
  std::uint16_t port() const;
  // Ends the session, if there is one, and closes everything. Run the context until it has no more
  // work.
  void stop();

 private:
  class State;
  std::shared_ptr<State> state_;
};

}  // namespace simbench::hardware
