// The events of a recording as the fields of a line; event_text.h has the columns.
//
// Shared by single lines (event_text.h) and by the files of a recording folder, whose lines begin
// with a field of their own, so that a message names the column of the file.
//
//   append_event(line, event);                        // "poll,3,..." behind what `line` has
//   FieldReader fields(line);
//   const RecordingEvent event = read_event(fields);  // TextFieldError
#ifndef SIMBENCH_RECORDING_EVENT_FIELDS_H_
#define SIMBENCH_RECORDING_EVENT_FIELDS_H_

#include <string>
#include <string_view>

#include "recording/event.h"
#include "recording/text_fields.h"

namespace simbench {

// The columns of a frame after its kind, without and with truth.
inline constexpr std::string_view kFrameColumns =
    "camera,stream,domain,counter,exposure_us,sensor_us,frame_us,backend_ns,arrival_ns,"
    "arrival_steady_ns";
inline constexpr std::string_view kFrameTruthColumns =
    "pulse,exposure_start_ns,exposure_end_ns,reference_ns,own_host_ns,own_steady_ns,delivered_ns";
inline constexpr std::size_t kFrameTruthColumnCount = 7;

// The kind, then the members.
void append_event(std::string& line, const RecordingEvent& event);
RecordingEvent read_event(FieldReader& fields);

// The members of a frame, without the kind, and those of its truth.
void append_frame(std::string& line, const FrameRecord& record);
void append_truth(std::string& line, const FrameTruth& truth);
FrameRecord read_frame(FieldReader& fields);
FrameTruth read_truth(FieldReader& fields);

}  // namespace simbench

#endif  // SIMBENCH_RECORDING_EVENT_FIELDS_H_
