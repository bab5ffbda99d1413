// Runs a program as an older kernel would: simbench_older_kernel CALL... -- PROGRAM ARGUMENT...
//
// CALL: seccomp, landlock or close_range, which the kernel then does not have (ENOSYS).
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <vector>

namespace {

void refuse(std::vector<sock_filter>& filter, unsigned call) {
  filter.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, call, 0, 1));
  filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | ENOSYS));
}

void refuse_named(std::vector<sock_filter>& filter, const char* name) {
  if (std::strcmp(name, "seccomp") == 0) refuse(filter, SYS_seccomp);
  if (std::strcmp(name, "landlock") == 0) refuse(filter, SYS_landlock_create_ruleset);
  if (std::strcmp(name, "close_range") == 0) refuse(filter, SYS_close_range);
}

}  // namespace

int main(int count, char** words) {
  std::vector<sock_filter> filter = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr))};
  int at = 1;
  for (; at < count && std::strcmp(words[at], "--") != 0; ++at) refuse_named(filter, words[at]);
  filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  const sock_fprog program{.len = static_cast<unsigned short>(filter.size()),
                           .filter = filter.data()};
  if (at + 1 >= count || prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
      prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0) {
    std::perror("simbench_older_kernel");
    return 126;
  }
  execv(words[at + 1], words + at + 1);
  return 127;
}
