#include "bags/checksum.h"

#include <zlib.h>

namespace simbench::bags {

void Checksum::add(std::string_view bytes) {
  if (bytes.empty()) return;
  const auto sum = crc32_z(value_, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  value_ = static_cast<std::uint32_t>(sum);
}

}  // namespace simbench::bags
