// The messages between the conductor of a rig and its nodes, over a SecureStream.
//
// The conductor is the command (`simbench --backend hardware`). It sends requests; a node replies
// to them in order of arrival and reports events by notices. All are JSON objects in UTF-8, one a
// message. Both sides check the protocol number of the handshake first (secure_stream.h).
//
//   request  {"id": 7, "do": "begin", ...arguments}
//   reply    {"id": 7, "result": {...}}   or   {"id": 7, "error": "one line for the user"}
//   notice   {"notice": "synchronised", ...}
//
// clang-format off
// do           arguments                        result, or what happens
// hello                                         version, commit, name, clock {kind, monotonic_zero_ns,
//                                               steady_zero_ns, skew_ppm}, cameras [{serial, model,
//                                               firmware, connection, problem}], session (of a live
//                                               one, or null)
// begin        session, conductor, scenario,    a session begins: journal opened, clock restarted,
//              pipeline                         channels emptied. Refused while another conductor's
//                                               session lives, and if the pipeline's algorithms are
//                                               not known to the node
// synchronise  role "master" or "slave",        host_sync started; notice "synchronised" {error: text
//              [slaves]                         or null} when it has returned
// prepare                                       cameras opened and set: problems [{camera, text}]
// start                                         cameras started: problems; capture_alignment runs
// stop                                          it is ended, cameras stopped, what they delivered is on disk
// read         session, offset                  text (of the journal from there, whole lines, at most
//                                               256 KiB), size (of the journal's whole lines), closed
// end          session                          everything stopped, journal closed
// ping                                          {}
// clang-format on
//
// A connection belongs to the session that it began, or that one of its requests named: any request
// may carry "session". A request without it is about the connection's session. A conductor that
// has lost its connection opens another and names its session. A begin over a connection that has a
// session ends that one first.
//
// Read, synchronise and ping are answered at once; the others one after the other in order of
// arrival, and some take seconds (opening cameras). Replies are matched by id. Other notices:
// "note" {text}. Unknown notices are ignored.
//
// A session's id is 16 hexadecimal digits, drawn by the conductor. A node that gets no request from
// its conductor for kConductorSilence ends the session by itself: cameras stop, the journal is
// closed and kept. Journals are files of event_text.h lines (and "note,text" lines) named after
// their session; "read" works for any session whose journal still exists, also after a restart of
// the node.
//
// Errors: ProtocolError for any other bytes. Any bytes are safe to parse.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>

#include "algorithms/ports/host.h"

namespace simbench::hardware {

inline constexpr Nanoseconds kConductorSilence = std::chrono::seconds(5);
inline constexpr std::size_t kJournalChunkBytes = 256u << 10;

class ProtocolError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct NodeRequest {
  std::uint64_t id = 0;
  std::string verb;
  nlohmann::json arguments;  // an object
};

// A reply if `notice` is empty.
struct NodeAnswer {
  std::uint64_t id = 0;
  std::string error;  // empty: it worked
  std::string notice;
  nlohmann::json details;  // an object: the result, or the notice's content
};

Bytes encode(const NodeRequest& request);
Bytes encode(const NodeAnswer& answer);
NodeRequest parse_request(std::span<const std::byte> message);
NodeAnswer parse_answer(std::span<const std::byte> message);

// 16 hexadecimal digits.
bool is_session_id(const std::string& text);

}  // namespace simbench::hardware
