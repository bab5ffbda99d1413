// Attacks on files: those outside the program's folder, in which the second word is a folder into
// which everybody may write; those that simbench reads; and the disk.
//
//   file_attacks ATTEMPT FOLDER
#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <sys/inotify.h>
#include <sys/mman.h>
#include <sys/mount.h>
#include <sys/sendfile.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/sysmacros.h>
#include <sys/un.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <string>
#include <thread>

#include "tests/programs/attempts.h"

namespace {

using attempts::Attempt;
using attempts::path;
using attempts::say;

std::string there(const char* name) { return std::string(path) + "/" + name; }
int own() { return open("own", O_RDWR | O_CREAT, 0600); }
int try_to_read(const std::string& name) { return open(name.c_str(), O_RDONLY | O_NONBLOCK); }
int try_to_write(const std::string& name) { return open(name.c_str(), O_WRONLY | O_NONBLOCK); }

void write_outside() {
  say("new", open(there("new").c_str(), O_WRONLY | O_CREAT, 0600));
  say("old", try_to_write(there("file")));
  say("append", open(there("file").c_str(), O_WRONLY | O_APPEND));
  say("unnamed", open(path, O_RDWR | O_TMPFILE, 0600));
}
void truncate_outside() { say("truncate", truncate(there("file").c_str(), 0)); }
void remove_outside() {
  say("unlink", unlink(there("file").c_str()));
  say("rmdir", rmdir(there("sub").c_str()));
}
void make_outside() {
  say("mkdir", mkdir(there("new").c_str(), 0700));
  say("symlink", symlink("/etc", there("new").c_str()));
  say("mkfifo", mkfifo(there("new").c_str(), 0600));
  sockaddr_un name{.sun_family = AF_UNIX, .sun_path = {}};
  there("new").copy(name.sun_path, sizeof name.sun_path - 1);
  say("bind",
      bind(socket(AF_UNIX, SOCK_DGRAM, 0), reinterpret_cast<sockaddr*>(&name), sizeof name));
}
void move_outside() {
  close(own());
  say("out", rename("own", there("new").c_str()));
  say("in", rename(there("file").c_str(), "own"));
  say("exchange",
      syscall(SYS_renameat2, AT_FDCWD, "own", AT_FDCWD, there("file").c_str(), RENAME_EXCHANGE));
}
void hard_links() {
  close(own());
  say("out", link("own", there("new").c_str()));
  say("in", link(there("file").c_str(), "linked"));
}
void through_links() {
  say("link", symlink(there("file").c_str(), "link"));
  say("write", try_to_write("link"));
  say("read", try_to_read("link"));
  say("folder", symlink(path, "folder"));
  say("below", open("folder/new", O_WRONLY | O_CREAT, 0600));
}
// A name that is now a file of its own, now a link to another's: none of the opened is the other.
void swap_links() {
  close(own());
  symlink(there("file").c_str(), "link");
  close(open("swapped", O_RDWR | O_CREAT, 0600));
  long wrong = 0;
  for (int i = 0; i < 20'000; ++i) {
    syscall(SYS_renameat2, AT_FDCWD, "link", AT_FDCWD, "swapped", RENAME_EXCHANGE);
    const int file = open("swapped", O_RDWR);
    if (file < 0) continue;
    struct stat status {};
    fstat(file, &status);
    wrong += status.st_size > 0;
    close(file);
  }
  std::printf("%ld of others\n", wrong);
}
void up() {
  say("above", open("../new", O_WRONLY | O_CREAT, 0600));
  say("list above", open("..", O_RDONLY | O_DIRECTORY));
  const int root = open("/", O_PATH);
  say("from the root", openat(root, "etc/shadow", O_RDONLY));
  say("go there", fchdir(root));
  say("and read", open("etc/shadow", O_RDONLY));
}
void devices() {
  for (const char* device : {"/dev/tty", "/dev/mem", "/dev/kmsg", "/dev/ptmx", "/dev/console",
                             "/dev/fuse", "/dev/net/tun", "/dev/urandom"}) {
    const long file = syscall(SYS_openat, AT_FDCWD, device, O_RDWR | O_NONBLOCK | O_NOCTTY);
    if (file >= 0 || (errno != EACCES && errno != ENOENT)) say(device, file);
  }
  say("block device", mknod("disk", S_IFBLK | 0600, makedev(8, 0)));
  say("character device", mknod("memory", S_IFCHR | 0600, makedev(1, 1)));
  char letter = 'x';
  constexpr unsigned long kTypeForIt = 0x5412;  // TIOCSTI
  say("type", syscall(SYS_ioctl, 0, kTypeForIt, &letter));
}
void read_others() {
  say("in a shared folder", try_to_read(there("file")));
  say("the shared folder", try_to_read(path));
  for (const char* each : {"/etc/shadow", "/etc/machine-id", "/etc/ssh", "/root", "/home", "/tmp",
                           "/var/log", "/run", "/boot", "/"}) {
    const int file = try_to_read(each);
    if (file >= 0 || (errno != EACCES && errno != ENOENT)) say(each, file);
  }
}
void read_machine() {
  for (const char* each :
       {"/proc/uptime", "/proc/stat", "/proc/cpuinfo", "/proc/net/tcp", "/proc/self/net/dev",
        "/proc/self/mem", "/proc/self/root/etc/shadow", "/proc/self/cwd/../..", "/proc/1/environ",
        "/proc/1/mem", "/proc/sys/kernel/hostname", "/proc", "/sys",
        "/sys/devices/system/clocksource/clocksource0/current_clocksource"}) {
    const int file = try_to_read(each);
    if (file >= 0 || (errno != EACCES && errno != ENOENT)) say(each, file);
  }
  const std::string parent = "/proc/" + std::to_string(getppid());
  say("parent's memory", open((parent + "/mem").c_str(), O_RDWR));
  say("parent's environment", try_to_read(parent + "/environ"));
  say("parent's descriptors", try_to_read(parent + "/fd"));
  say("own map", try_to_read("/proc/self/maps"));
  say("own descriptors", try_to_read("/proc/self/fd"));
}
void write_program() {
  std::array<char, 4096> name{};
  readlink("/proc/self/exe", name.data(), name.size() - 1);
  say("by name", try_to_write(name.data()));
  say("by link", try_to_write("/proc/self/exe"));
  say("maps", open("/proc/self/maps", O_RDWR));
}
void handles() {
  std::array<char, sizeof(file_handle) + MAX_HANDLE_SZ> room{};
  auto* handle = reinterpret_cast<file_handle*>(room.data());
  handle->handle_bytes = MAX_HANDLE_SZ;
  int mount = 0;
  say("name_to_handle_at", name_to_handle_at(AT_FDCWD, "/etc/shadow", handle, &mount, 0));
  say("open_by_handle_at", open_by_handle_at(AT_FDCWD, handle, O_RDONLY));
}
void attributes() {
  say("owner", chown(there("file").c_str(), 0, 0));
  say("mode", chmod(there("file").c_str(), 04777));
  say("times", utimensat(AT_FDCWD, there("file").c_str(), nullptr, 0));
  say("attribute", setxattr(there("file").c_str(), "user.x", "x", 1, 0));
}
void sockets() {
  sockaddr_un name{.sun_family = AF_UNIX, .sun_path = {}};
  there("socket").copy(name.sun_path, sizeof name.sun_path - 1);
  say("root's socket",
      connect(socket(AF_UNIX, SOCK_STREAM, 0), reinterpret_cast<sockaddr*>(&name), sizeof name));
  constexpr char kAbstract[] = "\0simbench-test-abstract";
  sockaddr_un abstract{.sun_family = AF_UNIX, .sun_path = {}};
  std::memcpy(abstract.sun_path, kAbstract, sizeof kAbstract - 1);
  say("abstract socket",
      connect(socket(AF_UNIX, SOCK_STREAM, 0), reinterpret_cast<sockaddr*>(&abstract),
              static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + sizeof kAbstract - 1)));
}
void by_pipe() {
  int ends[2] = {};
  say("pipe", pipe(ends));
  char text[] = "text";
  const iovec piece{.iov_base = text, .iov_len = sizeof text};
  say("vmsplice", vmsplice(ends[1], &piece, 1, 0));
  say("splice", splice(ends[0], nullptr, try_to_write(there("file")), nullptr, 4, 0));
  say("sendfile", sendfile(try_to_write("/dev/kmsg"), own(), nullptr, 4));
  say("copy", copy_file_range(own(), nullptr, try_to_write(there("file")), nullptr, 4, 0));
}

// The log, which simbench reads when the program has ended.

constexpr char kLog[] = "program0.log";
void end_badly() { _exit(3); }
void log_pipe() {
  unlink(kLog);
  mkfifo(kLog, 0600);
  end_badly();
}
void log_link() {
  unlink(kLog);
  symlink(there("file").c_str(), kLog);
  end_badly();
}
void log_folder() {
  unlink(kLog);
  mkdir(kLog, 0700);
  end_badly();
}
void log_gone() {
  std::puts("last words");
  std::fflush(stdout);
  unlink(kLog);
  end_badly();
}
void log_truncated() {
  std::puts("last words");
  std::fflush(stdout);
  ftruncate(1, 0);
  end_badly();
}
void log_hole() {
  std::puts("last words");
  std::fflush(stdout);
  ftruncate(1, 1 << 25);
  end_badly();
}

// The disk.

void fill(int file, std::size_t bytes) {
  static char block[1 << 16];
  std::memset(block, 'x', sizeof block);
  for (std::size_t written = 0; written < bytes; written += sizeof block) {
    if (write(file, block, sizeof block) < 0) return;
  }
}
void many_files() {
  for (int i = 0; i < 20'000; ++i) close(creat(std::to_string(i).c_str(), 0600));
}
void much_in_files() {
  for (int i = 0; i < 64; ++i) {
    const int file = creat(std::to_string(i).c_str(), 0600);
    fill(file, std::size_t{16} << 20);
    close(file);
  }
}
void holes() {
  for (int i = 0; i < 64; ++i) {
    const int file = creat(std::to_string(i).c_str(), 0600);
    ftruncate(file, 16 << 20);
    close(file);
  }
  say("beyond a file's most", ftruncate(own(), off_t{1} << 40));
}
void reserved() { say("reserve", syscall(SYS_fallocate, own(), 1, off_t{0}, off_t{1} << 40)); }
void unnamed_files() {
  for (int i = 0; i < 64; ++i) {
    const int file = open("file", O_RDWR | O_CREAT, 0600);
    unlink("file");
    fill(file, std::size_t{16} << 20);
  }
  for (volatile unsigned int i = 0;;) i = i + 1;
}
void deep_folders() {
  for (int i = 0; i < 1'000; ++i) {
    if (mkdir("d", 0700) != 0 || chdir("d") != 0) break;
  }
}
void closed_folders() {
  mkdir("closed", 0700);
  mkdir("closed/sub", 0700);
  close(creat("closed/sub/file", 0));
  umask(0777);
  mkdir("none", 0777);
  mkdir("enter", 0300);
  close(creat("enter/file", 0600));
}
void odd_names() {
  for (const char* name : {"-rf", "new\nline", "\x1b[31mred", "\xff\xfe", " ", "*", "host1"}) {
    close(creat(name, 0600));
  }
  symlink("/", "root");
  symlink("loop", "loop");
}

constexpr Attempt kAttempts[] = {{"write_outside", write_outside},
                                 {"truncate_outside", truncate_outside},
                                 {"remove_outside", remove_outside},
                                 {"make_outside", make_outside},
                                 {"move_outside", move_outside},
                                 {"hard_links", hard_links},
                                 {"through_links", through_links},
                                 {"swap_links", swap_links},
                                 {"up", up},
                                 {"devices", devices},
                                 {"read_others", read_others},
                                 {"read_machine", read_machine},
                                 {"write_program", write_program},
                                 {"handles", handles},
                                 {"attributes", attributes},
                                 {"sockets", sockets},
                                 {"by_pipe", by_pipe},
                                 {"log_pipe", log_pipe},
                                 {"log_link", log_link},
                                 {"log_folder", log_folder},
                                 {"log_gone", log_gone},
                                 {"log_truncated", log_truncated},
                                 {"log_hole", log_hole},
                                 {"many_files", many_files},
                                 {"much_in_files", much_in_files},
                                 {"holes", holes},
                                 {"reserved", reserved},
                                 {"unnamed_files", unnamed_files},
                                 {"deep_folders", deep_folders},
                                 {"closed_folders", closed_folders},
                                 {"odd_names", odd_names}};

}  // namespace

int main(int count, char** words) { return attempts::make(kAttempts, count, words); }
