// An event of a recording as one line of text, and back.
//
// The lines of a node's journal and of a recording folder's events.csv: comma-separated, the kind
// first, then the members in the order of their structs. Stamps are integer nanoseconds of their
// own base (device stamps: microseconds), absent ones empty, doubles in the shortest form that
// reads back as the same number; texts have backslash, comma and line ends escaped by a backslash.
// from_line(to_line(e)) is therefore e, bit for bit.
//
//   frame,camera,stream,domain,counter,exposure_us,sensor_us,frame_us,backend_ns,arrival_ns,
//     arrival_steady_ns[,pulse,exposure_start_ns,exposure_end_ns,reference_ns,own_host_ns,
//     own_steady_ns,delivered_ns]
//   pulse,pulse,at_ns,error_ns;error_ns;...
//   adjustment,host,at_steady_ns,before_ns,after_ns,rate_ppb
//   poll,camera,device_us,t0_ns,t1_ns,t0_steady_ns,t1_steady_ns
//   exchange,host,peer,t1_ns,t2_ns,t3_ns,t4_ns[,estimated]
//   outcome,slave,synchronised,passes,message
//   alignment,camera,aligned,controls,message
//   led,camera,sensor_us,led_start_ns,led_end_ns
//   delays,slave,pass,begin_steady_ns,end_steady_ns,t_l_ns,t_t_ns,t_d_ns,get_ns,set_ns
//   program,host,at_ns,program,how,last_words,log
//
// Errors: from_line throws EventTextError, with the column and what was found, for whatever to_line
// does not write. Any bytes are safe to give to it. Complexity: linear in the line.
//
// The lines of a recording folder's files begin with a field of their own, before the event's, so
// that a message names the column of the file.
//
//   const std::string line = to_line(event);      // "poll,3,..."
//   const KeptEvent same = from_line(line);
//
//   std::string numbered = "17,";
//   append_event(numbered, event);
//   FieldReader fields(numbered);
//   const auto order = fields.whole<std::uint64_t>("order");
//   const KeptEvent again = read_event(fields);  // TextFieldError
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "recording/event.h"
#include "recording/text_fields.h"

namespace simbench {

class EventTextError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Without an end of line.
std::string to_line(const KeptEvent& event);
KeptEvent from_line(std::string_view line);

// The columns of a frame after its kind, without and with truth.
inline constexpr std::string_view kFrameColumns =
    "camera,stream,domain,counter,exposure_us,sensor_us,frame_us,backend_ns,arrival_ns,"
    "arrival_steady_ns";
inline constexpr std::string_view kFrameTruthColumns =
    "pulse,exposure_start_ns,exposure_end_ns,reference_ns,own_host_ns,own_steady_ns,delivered_ns";
inline constexpr std::size_t kFrameTruthColumnCount = 7;

// The kind, then the members.
void append_event(std::string& line, const KeptEvent& event);
void append_event(std::string& line, const RecordingEvent& event);
KeptEvent read_event(FieldReader& fields);

// The members of a frame, without the kind, and those of its truth; each after a comma.
void append_frame(std::string& line, const FrameRecord& record);
void append_truth(std::string& line, const FrameTruth& truth);
FrameRecord read_frame(FieldReader& fields);
FrameTruth read_truth(FieldReader& fields);

}  // namespace simbench
