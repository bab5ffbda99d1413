// Options of sockets that concern groups and interfaces, which are no numbers.
//
//   const ip_mreqn wanted{};
//   const int fd = socket(AF_INET, SOCK_DGRAM, 0);
//   set_group_option(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &wanted, sizeof wanted);  // EINVAL
#pragma once

#include <sys/socket.h>

namespace simbench::shim {

// What is no option of a kind.
inline constexpr int kIsNone = 1;

// As setsockopt(); kIsNone for an option that is none of these.
int set_group_option(int fd, int level, int option, const void* value, socklen_t size);
// As getsockopt().
int get_group_option(int fd, int level, int option, void* value, socklen_t* size);

}  // namespace simbench::shim
