// Camera recordings of the International Brain Laboratory's rigs (Point Grey USB3 cameras), read
// as a stream of stamps.
//
// Two kinds of file:
//   *.timestamps.ssv   text: ISO local time with seven fractional digits and UTC offset (arrival at
//                      the host), a blank, the camera clock as an unsigned 32-bit number
//   *.frameData.bin    little-endian 64-bit floats in rows of four: host ticks of 100 ns, camera
//                      clock, frame counter, GPIO bits
//
// The camera clock is an IEEE 1394 cycle clock: seconds in the upper 7 bits, cycles of 1/8000 s in
// the next 13, offsets of 1/3072 cycle in the lower 12. It starts again every 128 s; the stamps
// returned here are unwrapped (half-range rule).
//
// Source: the README of the recordings; github.com/int-brain-lab/ibllib.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "recording/recorded_streams.h"

namespace simbench::app {

// Whether the name is that of such a file.
bool is_ibl_recording(const std::string& path);

// The file's name tells its kind. Sensor stamps count from the camera clock's last zero before the
// first frame, arrivals from the first frame. Frames without a counter are numbered from 0. Throws
// CsvError, "FILE:LINE: ..." or "FILE: row N: ...".
std::vector<StampedFrame> read_ibl_recording(const std::string& path);

// Reads the content of a *.frameData.bin.
std::vector<StampedFrame> parse_ibl_frame_data(std::string_view bytes, const std::string& path);

// Its frames as a stream, for rs_csv_text().
RecordedStream ibl_stream(std::vector<StampedFrame> frames);

}  // namespace simbench::app
