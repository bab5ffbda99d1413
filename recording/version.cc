#include "recording/version.h"

#include <fmt/format.h>

#include "recording/text_fields.h"

namespace simbench {

std::string advice_on_newer_format(std::string_view writer) {
  constexpr std::size_t kLongest = 40;
  const std::string named = writer.empty() ? "" : printable_name(writer.substr(0, kLongest));
  return fmt::format("a newer simbench{} wrote this and reads it; this is simbench {}",
                     named.empty() ? "" : fmt::format(" ({})", named), version());
}

}  // namespace simbench
