# Precompiled headers: what most files spend their compile time on is read once.
#
# SIMBENCH_PRECOMPILE: off in the preset `clang`, so that a file that includes too little does not
# compile there.
option(SIMBENCH_PRECOMPILE "Compile the headers that many files include only once" ON)

# What every folder uses. The project's own headers are not among them: an edit of one is not to
# compile everything. A header that makes code in each file that includes it (CLI11 does) costs more
# than it saves where it is not needed, so folders name their own beside these.
set(SIMBENCH_PRECOMPILED
  <algorithm> <array> <charconv> <chrono> <cmath> <cstdint> <deque> <filesystem> <fstream>
  <functional> <map> <memory> <optional> <set> <span> <stdexcept> <string> <string_view> <utility>
  <variant> <vector> <fmt/format.h> <fmt/ranges.h>)

# simbench_precompile(TARGET [header...]): these and the headers above.
function(simbench_precompile target)
  if(SIMBENCH_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE ${SIMBENCH_PRECOMPILED} ${ARGN})
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:fmt::fmt>)
  endif()
endfunction()
