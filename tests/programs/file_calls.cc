// What man pages promise of files, their names and times, and of memory with names, on the host's
// own disk and by its clock.
#include <dirent.h>
#include <fcntl.h>
#include <ftw.h>
#include <glob.h>
#include <semaphore.h>
#include <signal.h>
#include <sys/inotify.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <utime.h>

#include <string>

#include "tests/programs/promises.h"

namespace {

using promises::expect;
using promises::expect_error;
using promises::is_about;
using promises::kMillisecond;
using promises::kSecond;
using promises::steady;
using promises::to_ns;

std::int64_t now() { return promises::read_clock(CLOCK_REALTIME); }

struct stat status_of(const char* path) {
  struct stat status {};
  expect(stat(path, &status) == 0, "stat");
  return status;
}
std::int64_t modified(const char* path) { return to_ns(status_of(path).st_mtim); }

void write_text(const char* path, const char* text) {
  const int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  expect(fd >= 0, "open to write");
  expect(write(fd, text, std::strlen(text)) == static_cast<ssize_t>(std::strlen(text)), "write");
  close(fd);
}

void check_times() {
  write_text("first", "1");
  const std::int64_t written = now();
  expect(is_about(modified("first"), written), "a file is from when it was written");
  usleep(100'000);
  expect(is_about(modified("first"), written), "and stays so");
  const int reader = open("first", O_RDWR);
  close(reader);
  expect(is_about(modified("first"), written), "who only opens it does not change it");
  const int fd = open("first", O_WRONLY | O_APPEND);
  expect(write(fd, "2", 1) == 1, "append");
  expect(is_about(modified("first"), now()), "what is written is seen before it is closed");
  usleep(100'000);
  expect(is_about(modified("first"), now() - 100 * kMillisecond), "and is no younger later");
  close(fd);
  utimbuf both{.actime = 1, .modtime = 1000};
  expect(utime("first", &both) == 0 && modified("first") == 1000 * kSecond, "utime");
  expect(utime("first", nullptr) == 0 && is_about(modified("first"), now()), "utime: now");
  timespec times[2] = {{.tv_sec = 0, .tv_nsec = UTIME_OMIT}, {.tv_sec = 5, .tv_nsec = 6}};
  expect(utimensat(AT_FDCWD, "first", times, 0) == 0 && modified("first") == 5 * kSecond + 6,
         "utimensat");
  times[1].tv_nsec = kSecond;
  expect_error(utimensat(AT_FDCWD, "first", times, 0), EINVAL, "no such nanosecond");
  expect_error(utime("/etc/passwd", &both), EROFS, "the machine's files keep their times");
}

void check_numbers() {
  write_text("second", "22");
  const struct stat first = status_of("first");
  const struct stat second = status_of("second");
  expect(first.st_ino != second.st_ino && first.st_dev == second.st_dev, "numbers differ");
  expect(rename("second", "third") == 0 && status_of("third").st_ino == second.st_ino,
         "a file keeps its number");
  expect(link("third", "fourth") == 0 && status_of("fourth").st_ino == second.st_ino,
         "links are one file");
  unlink("third");
  unlink("fourth");
  write_text("second", "222");
  expect(status_of("second").st_ino != second.st_ino, "numbers are not used again");
  expect(first.st_uid == 0 && first.st_gid == 0, "files are root's");
  DIR* folder = opendir(".");
  while (const dirent* each = readdir(folder)) {
    if (std::strcmp(each->d_name, "second") != 0) continue;
    expect(each->d_ino == status_of("second").st_ino, "folders have these numbers");
  }
  closedir(folder);
}

std::string walked;

int see(const char* path, const struct stat* status, int kind, FTW* place) {
  walked += std::string(path + place->base) + (kind == FTW_D || kind == FTW_DP ? "/ " : " ");
  expect(kind == FTW_D || kind == FTW_DP || status->st_size == 1, "what it is");
  return 0;
}

void check_names() {
  mkdir("tree", 0755);
  mkdir("tree/b", 0755);
  for (const char* each : {"tree/c", "tree/a", "tree/b/d"}) write_text(each, "x");
  expect(nftw("tree", see, 8, FTW_PHYS) == 0 && walked == "tree/ a b/ d c ", "nftw");
  walked.clear();
  expect(nftw("tree", see, 8, FTW_PHYS | FTW_DEPTH) == 0 && walked == "a d b/ c tree/ ",
         "nftw: folders last");
  glob_t found{};
  expect(glob("/files/tree/?", 0, nullptr, &found) == 0 && found.gl_pathc == 3 &&
             std::strcmp(found.gl_pathv[2], "/files/tree/c") == 0,
         "glob");
  globfree(&found);
  char room[64] = "";
  expect(getcwd(room, sizeof room) != nullptr && std::strcmp(room, "/files") == 0, "getcwd");
  expect(mkdir("/var/lib/own", 0755) == 0 && access("var/lib/own", F_OK) == 0, "/var is its own");
  expect(access("/run", F_OK) == 0 && opendir("/tmp") != nullptr, "so are /run and /tmp");
  expect_error(open("/proc/1/status", O_RDONLY), ENOENT, "there are no other processes");
  const int watch = inotify_init1(IN_NONBLOCK);
  expect(
      mkdir("/run/watched", 0755) == 0 && inotify_add_watch(watch, "/run/watched", IN_CREATE) >= 0,
      "inotify watches the host's folders");
  write_text("/run/watched/new", "1");
  char event[512];
  expect(read(watch, event, sizeof event) > 0, "and sees what is made there");
  expect_error(inotify_add_watch(watch, "/run/dbus", IN_CREATE), ENOENT, "not the machine's");
  close(watch);
  const int up = open("/proc/uptime", O_RDONLY);
  const ssize_t size = read(up, room, sizeof room - 1);
  expect(size > 0 && std::llabs(std::atoll(room) - steady() / kSecond) <= 1, "/proc/uptime");
  close(up);
}

int queued = 0;
void on_signal(int /*signal*/, siginfo_t* info, void* /*context*/) {
  queued = info->si_code == SI_QUEUE && info->si_pid == getpid() ? info->si_value.sival_int : -1;
}

// A semaphore, and memory, that a child shares by their names.
void check_names_of_memory() {
  sem_t* ready = sem_open("/ready", O_CREAT | O_EXCL, 0600, 0);
  expect(ready != SEM_FAILED, "sem_open");
  expect(sem_open("/ready", O_CREAT | O_EXCL, 0600, 0) == SEM_FAILED && errno == EEXIST,
         "it is there");
  expect(sem_open("/ready", 0) == ready, "one semaphore is at one place");
  const int memory = shm_open("/shared", O_RDWR | O_CREAT, 0600);
  expect(memory >= 0 && ftruncate(memory, sizeof(int)) == 0, "shm_open");
  void* mapped = mmap(nullptr, sizeof(int), PROT_READ | PROT_WRITE, MAP_SHARED, memory, 0);
  const pid_t child = fork();
  if (child == 0) {
    usleep(200'000);
    *static_cast<int*>(mapped) = 7;
    sem_post(sem_open("/ready", 0));
    _exit(0);
  }
  const std::int64_t begin = steady();
  expect(sem_wait(ready) == 0 && *static_cast<int*>(mapped) == 7, "sem_wait");
  expect(is_about(steady() - begin, 200 * kMillisecond), "it waits for the child");
  expect(waitpid(child, nullptr, 0) == child, "waitpid");
  timespec until{};
  clock_gettime(CLOCK_REALTIME, &until);
  until.tv_sec += 1;
  expect_error(sem_timedwait(ready, &until), ETIMEDOUT, "sem_timedwait");
  expect(is_about(now(), to_ns(until)), "until that time");
  expect(sem_unlink("/ready") == 0 && shm_unlink("/shared") == 0, "their names go");
  expect_error(shm_unlink("/shared"), ENOENT, "once");
  expect(sem_close(ready) == 0 && sem_close(ready) == 0, "as often as it was opened");
  expect_error(sem_close(ready), EINVAL, "and no more");
}

}  // namespace

int main() {
  check_times();
  check_numbers();
  check_names();
  check_names_of_memory();
  struct sigaction action {};
  action.sa_sigaction = on_signal;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGRTMIN, &action, nullptr);
  expect(sigqueue(getpid(), SIGRTMIN, {.sival_int = 12}) == 0, "sigqueue");
  usleep(1000);
  expect(queued == 12, "with its value, and its sender");
  promises::finish();
}
