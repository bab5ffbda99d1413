// Random bytes of the world.
//
//   unsigned char key[16];
//   take_chance(key, sizeof key);
#pragma once

#include <sys/types.h>

#include <cstddef>

namespace simbench::shim {

// Whether it is one of the devices that give them.
bool is_chance(const char* path);
// Returns the size, or -1 with errno.
ssize_t take_chance(void* data, std::size_t size);

}  // namespace simbench::shim
