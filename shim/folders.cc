// Folders: their names come in order, which is the machine's otherwise.
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <glob.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include "shim/link.h"
#include "shim/paths.h"
#include "shim/status.h"

namespace simbench::shim {
namespace {

constexpr int kMostFolders = 64;
constexpr std::size_t kMostNames = 16'384;

// The entries of an open folder, in order.
struct Listing {
  DIR* folder = nullptr;
  DIR* besides = nullptr;  // what it has the names of too
  dirent* entries = nullptr;
  std::size_t count = 0;
  std::size_t next = 0;
};
Listing listings[kMostFolders];

Listing* listing_of(DIR* folder) {
  for (Listing& each : listings) {
    if (each.folder == folder) return &each;
  }
  return nullptr;
}

int compare(const void* one, const void* other) {
  return strcmp(static_cast<const dirent*>(one)->d_name, static_cast<const dirent*>(other)->d_name);
}

void drop_listing(Listing& listing) {
  if (listing.entries != nullptr) munmap(listing.entries, kMostNames * sizeof(dirent));
  if (listing.besides != nullptr) SIMBENCH_REAL(closedir)(listing.besides);
  listing = {};
}

// As stat() has it; the machine's files keep their numbers.
void number_entries(const Listing& listing) {
  struct stat status {};
  const int folder = dirfd(listing.folder);
  const bool is_own = fstat(folder, &status) == 0 && status.st_dev == kOwnDevice;
  for (std::size_t i = 0; i < listing.count; ++i) {
    dirent& entry = listing.entries[i];
    entry.d_off = static_cast<off_t>(i) + 1;
    if (!is_own || fstatat(folder, entry.d_name, &status, AT_SYMLINK_NOFOLLOW) < 0) continue;
    entry.d_ino = status.st_ino;
  }
}

bool has_name(const Listing& listing, const char* name) {
  for (std::size_t i = 0; i < listing.count; ++i) {
    if (strcmp(listing.entries[i].d_name, name) == 0) return true;
  }
  return false;
}

void add_entries(Listing& listing, DIR* folder) {
  const auto next = SIMBENCH_REAL(readdir);
  while (const dirent* entry = next(folder)) {
    if (listing.count == kMostNames) break;
    if (folder == listing.besides && has_name(listing, entry->d_name)) continue;
    memcpy(&listing.entries[listing.count++], entry, entry->d_reclen);
  }
}

// Pages that are not used take no memory.
bool read_all(Listing& listing) {
  void* memory = mmap(nullptr, kMostNames * sizeof(dirent), PROT_READ | PROT_WRITE,
                      MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) return false;
  listing.entries = static_cast<dirent*>(memory);
  add_entries(listing, listing.folder);
  if (listing.besides != nullptr) add_entries(listing, listing.besides);
  qsort(listing.entries, listing.count, sizeof(dirent), compare);
  number_entries(listing);
  return true;
}

DIR* keep(DIR* folder) {
  if (folder == nullptr || !is_simulated()) return folder;
  Listing* place = listing_of(nullptr);
  if (place != nullptr) *place = {.folder = folder};
  return folder;
}

}  // namespace

SIMBENCH_CALL DIR* opendir(const char* path) {
  const OwnPath own(path);
  DIR* folder = keep(SIMBENCH_REAL(opendir)(own.text()));
  Listing* listing = folder != nullptr && own.besides() != nullptr ? listing_of(folder) : nullptr;
  if (listing != nullptr) listing->besides = SIMBENCH_REAL(opendir)(own.besides());
  return folder;
}

SIMBENCH_CALL DIR* fdopendir(int fd) { return keep(SIMBENCH_REAL(fdopendir)(fd)); }

SIMBENCH_CALL dirent* readdir(DIR* folder) {
  Listing* listing = is_simulated() ? listing_of(folder) : nullptr;
  if (listing == nullptr) return SIMBENCH_REAL(readdir)(folder);
  if (listing->entries == nullptr && !read_all(*listing)) return nullptr;
  if (listing->next == listing->count) return nullptr;
  return &listing->entries[listing->next++];
}

SIMBENCH_CALL dirent64* readdir64(DIR* folder) {
  return reinterpret_cast<dirent64*>(readdir(folder));
}

SIMBENCH_CALL void rewinddir(DIR* folder) {
  SIMBENCH_REAL(rewinddir)(folder);
  if (Listing* listing = listing_of(folder)) {
    DIR* besides = listing->besides;
    if (besides != nullptr) SIMBENCH_REAL(rewinddir)(besides);
    listing->besides = nullptr;
    drop_listing(*listing);
    *listing = {.folder = folder, .besides = besides};
  }
}

SIMBENCH_CALL long telldir(DIR* folder) {
  const Listing* listing = listing_of(folder);
  return listing != nullptr ? static_cast<long>(listing->next) : SIMBENCH_REAL(telldir)(folder);
}

SIMBENCH_CALL void seekdir(DIR* folder, long place) {
  Listing* listing = listing_of(folder);
  if (listing == nullptr) return SIMBENCH_REAL(seekdir)(folder, place);
  if (static_cast<std::size_t>(place) <= listing->count) {
    listing->next = static_cast<std::size_t>(place);
  }
}

SIMBENCH_CALL int closedir(DIR* folder) {
  if (Listing* listing = listing_of(folder)) drop_listing(*listing);
  return SIMBENCH_REAL(closedir)(folder);
}

namespace {

void* open_for_glob(const char* path) { return opendir(path); }
dirent* read_for_glob(void* folder) { return readdir(static_cast<DIR*>(folder)); }
void close_for_glob(void* folder) { closedir(static_cast<DIR*>(folder)); }

}  // namespace

// libc's own would look past these calls.
SIMBENCH_CALL int glob(const char* pattern, int flags, int (*on_error)(const char*, int),
                       glob_t* found) {
  if (is_simulated() && (flags & GLOB_ALTDIRFUNC) == 0) {
    found->gl_opendir = open_for_glob;
    found->gl_readdir = read_for_glob;
    found->gl_closedir = close_for_glob;
    found->gl_stat = stat;
    found->gl_lstat = lstat;
    flags |= GLOB_ALTDIRFUNC;
  }
  return SIMBENCH_REAL(glob)(pattern, flags, on_error, found);
}

SIMBENCH_CALL int glob64(const char*, int, int (*)(const char*, int), glob64_t*)
    __attribute__((alias("glob")));

SIMBENCH_CALL int scandir(const char* path, dirent*** names, int (*select)(const dirent*),
                          int (*order)(const dirent**, const dirent**)) {
  const auto in_order = order != nullptr || !is_simulated() ? order : alphasort;
  return SIMBENCH_REAL(scandir)(OwnPath(path).text(), names, select, in_order);
}

SIMBENCH_CALL int scandir64(const char*, dirent64***, int (*)(const dirent64*),
                            int (*)(const dirent64**, const dirent64**))
    __attribute__((alias("scandir")));

}  // namespace simbench::shim
