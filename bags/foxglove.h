// The stamp of Foxglove's messages, in protobuf or JSON, from as much of a message as is at hand.
//
// Protobuf: field 1 is a google.protobuf.Timestamp (1: seconds, 2: nanoseconds). JSON:
// {"timestamp": {"sec", "nsec"}}. A frame id may stand behind the image, so it is not read.
//
//   const std::optional<Nanoseconds> stamp = foxglove_stamp(message.head, Encoding::kProtobuf);
//
// Sources: protobuf.dev (encoding), foxglove.dev (schemas).
#pragma once

#include <optional>
#include <string_view>

#include "algorithms/ports/time.h"
#include "bags/bag.h"

namespace simbench::bags {

// Nothing if there is none, or it makes no sense.
std::optional<Nanoseconds> foxglove_stamp(std::string_view head, Encoding encoding);

}  // namespace simbench::bags
