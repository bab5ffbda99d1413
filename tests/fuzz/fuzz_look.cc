// What a page sends to simbench explore: any bytes are answered, and no world that is refused is
// run. Only whether the world can be is asked, since running one takes too long for a fuzzer.
#include <cstddef>
#include <cstdint>
#include <string>

#include "explore/look.h"
#include "explore/state.h"

namespace simbench::explore {

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const PageSubject subject{.name = "3cam_1host_30fps"};
  try {
    const reports::Json json = reports::Json::parse(data, data + size);
    const LookRequest request = request_of(json, subject);
    for (const State& state : request.states) {
      command_of(state, subject, request.seeds);
      python_of(state, subject, request.seeds);
      world_of(state, subject);
    }
  } catch (const reports::Json::exception&) {
  } catch (const StateRefused&) {
  }
  return 0;
}

}  // namespace simbench::explore
