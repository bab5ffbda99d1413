// The node: the long-running program of each host of a rig (`simbench node`).
//
// It owns the host's cameras, clock and sockets, keeps a journal of each session on disk, and does
// what the rig's conductor asks (protocol.h). It never acts on its own but to end a session whose
// conductor is gone. It survives whatever a peer, a conductor or a camera does.
//
// Contract
//  - One session at a time; a second conductor is told by whom and since when the node is busy.
//  - Every frame, adjustment, exchange and outcome is written to the session's journal, in order,
//    by one write() a batch of at most 20 ms: what was written survives a kill of the process. A
//    full disk is a note, told at once to the conductor, and frames are then counted, not kept; the
//    capture goes on on the other hosts.
//  - What happens is a line each for `log`.
//  - Arrival stamps are taken in the camera's thread; everything else runs on `context`'s thread.
//
//   Node node(context, settings, clock, cameras, make_host_sync, log);
//   node.start();
//   context.run();
#ifndef SIMBENCH_HARDWARE_NODE_NODE_H_
#define SIMBENCH_HARDWARE_NODE_NODE_H_

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>

#include "algorithms/ports/host_sync.h"
#include "hardware/camera/camera.h"
#include "hardware/clock/node_clock.h"
#include "hardware/net/secret_key.h"
#include "hardware/node/protocol.h"
#include "hardware/rig/rig.h"
#include "scenarios/scenario.h"

namespace simbench::hardware {

// The host_sync of a scenario's pipeline; throws scenarios::InputError. Which algorithms there are
// is not known in hardware/.
using HostSyncFactory = std::function<std::unique_ptr<HostSync>(const scenarios::Scenario& scenario,
                                                                const std::string& pipeline)>;

struct NodeSettings {
  Rig rig;
  PeerId me = 0;
  SecretKey key;
  std::string journal_folder;  // made if it is not there
  std::string clock_kind = "software";
  // How long a session outlives the last word of its conductor.
  Nanoseconds conductor_silence = kConductorSilence;
};

class Node {
 public:
  using Log = std::function<void(const std::string& line)>;

  // `clock` and `cameras` outlive the node and its context. Throws StreamError if the port is
  // taken, CameraError if a camera of the rig file is not there, JournalError if journals cannot be
  // kept, and scenarios::InputError for a rig that is open to everybody.
  Node(boost::asio::io_context& context, NodeSettings settings, NodeClock& clock,
       CameraDriver& cameras, HostSyncFactory make_host_sync, Log log);
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  void start();
  std::uint16_t port() const;
  // Ends the session, if there is one, and closes everything; the context then runs out of work,
  // and must be run until it has.
  void stop();

 private:
  class State;
  std::shared_ptr<State> state_;
};

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_NODE_NODE_H_
