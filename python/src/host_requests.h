// What a coroutine in Python asks of its host, and the answers.
//
// A coroutine yields a tuple, its name first, for each operation that takes time; simbench/host.py
// has them. The driver (python_coroutine.cc) awaits the operation and sends the answer back.
//
//   const HostRequest request = host_request(tuple, port);   // with the GIL
//   const HostAnswer answer = co_await answered(request, port);
//   const Object value = python_value(answer);           // with the GIL
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <set>
#include <utility>
#include <variant>

#include "algorithms/capture_alignment/steered_camera.h"
#include "algorithms/host_sync/outcome.h"
#include "algorithms/ports/host.h"
#include "python/src/object.h"

namespace simbench::python {

// The host of a run as Python sees it, shared by the coroutines of that host. It outlives the run
// if the algorithm keeps it, but has no host then. That of a capture alignment has the host's
// cameras and sets no clock.
struct HostPort {
  // `datagrams_of_run`: Transport::kAlignment for a capture alignment, else kDatagram.
  HostPort(Host& of_run, std::set<PeerId> peers_of_run, Transport datagrams_of_run);

  Host& get() const;  // throws std::runtime_error after the run
  bool steers() const { return datagrams == Transport::kAlignment; }

  Host* host;
  std::set<PeerId> peers;  // to which it may open a channel
  Transport datagrams;
  std::deque<SteeredCamera> cameras{};  // in the order of Host::frame_controls()
  OutcomeReport outcome;
  std::uint32_t exchanges = 0;
  // The last index of a question to a peer.
  std::uint64_t index = 0;
  // On which a coroutine waits; one at a time may.
  std::set<std::pair<PeerId, Transport>> receiving{};
  std::set<std::uint32_t> watching{};  // cameras, by their place; likewise
};

using SharedPort = std::shared_ptr<HostPort>;

struct HostOperation;  // host_requests.cc has a table of them

struct HostRequest {
  const HostOperation* operation = nullptr;
  std::int64_t ns = 0;  // a time, an offset, an interval, a length or a timeout
  double ppb = 0;
  PeerId peer = 0;
  Transport transport = Transport::kDatagram;
  MessageId message = 0;
  Bytes bytes{};
  std::uint32_t camera = 0;  // its place on the host
};

// A frame, and whether it shows what the last control did (steered_camera.h).
struct SteeredFrame {
  ExposedFrame frame;
  bool settled = false;
};

// An exchange with the answerer (answer_questions()); t1 and t4 on the own clock.
struct ExchangeReply {
  Bytes bytes;
  HostTime t1{};
  HostTime t2{};
  HostTime t3{};
  HostTime t4{};
};

// Nothing: the operation has no value, or its deadline has passed. A bool: a control was accepted.
using HostAnswer = std::variant<std::monostate, std::int64_t, bool, ReceivedMessage, ExchangeReply,
                                CrossStamp, SteeredFrame>;

// Throws PythonError or std::exception for a request that is none.
HostRequest host_request(const Object& request, const HostPort& port);
Task<HostAnswer> answered(HostRequest request, SharedPort port);
Object python_value(const HostAnswer& answer);

// The other end of kExchange: answers the questions of a client with the own clock's times, until
// it says that it has done (or for ever).
Task<void> answer_questions(Host& host, PeerId client);
Task<void> say_done(Host& host, PeerId server);

// Parts of simbench/host.py that take no time.
void bind_host_port(const Object& module);

}  // namespace simbench::python
