// The system log: a program's messages go to its own error output, and none to the machine's.
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <sys/syscall.h>
#include <syslog.h>
#include <unistd.h>

#include "shim/link.h"

namespace simbench::shim {
namespace {

constexpr int kMostMessage = 2048;

const char* log_name = nullptr;
int log_mask = LOG_UPTO(LOG_DEBUG);

void log_message(int priority, const char* format, va_list arguments) {
  if ((log_mask & LOG_MASK(LOG_PRI(priority))) == 0) return;
  char text[kMostMessage];
  const char* name = log_name != nullptr ? log_name : program_invocation_short_name;
  const int head = snprintf(text, sizeof text, "%s: ", name);
  const int begin = head < kMostMessage / 2 ? head : 0;
  const int body = vsnprintf(text + begin, sizeof text - begin - 1, format, arguments);
  int size = begin + (body < 0 ? 0 : body);
  if (size > kMostMessage - 2) size = kMostMessage - 2;
  if (size == 0 || text[size - 1] != '\n') text[size++] = '\n';
  machine_call(SYS_write, STDERR_FILENO, text, size);
}

}  // namespace

SIMBENCH_CALL void openlog(const char* name, int options, int facility) {
  if (!has_world()) return SIMBENCH_REAL(openlog)(name, options, facility);
  log_name = name;
}

SIMBENCH_CALL void closelog() {
  if (!has_world()) return SIMBENCH_REAL(closelog)();
  log_name = nullptr;
}

SIMBENCH_CALL int setlogmask(int mask) {
  if (!has_world()) return SIMBENCH_REAL(setlogmask)(mask);
  const int before = log_mask;
  if (mask != 0) log_mask = mask;
  return before;
}

SIMBENCH_CALL void vsyslog(int priority, const char* format, va_list arguments) {
  if (!has_world()) return SIMBENCH_REAL(vsyslog)(priority, format, arguments);
  log_message(priority, format, arguments);
}

SIMBENCH_CALL void syslog(int priority, const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  vsyslog(priority, format, arguments);
  va_end(arguments);
}

SIMBENCH_CALL void vsyslog_checked(int priority, int level, const char* format,
                                   va_list arguments) __asm__("__vsyslog_chk");
void vsyslog_checked(int priority, int /*level*/, const char* format, va_list arguments) {
  vsyslog(priority, format, arguments);
}

SIMBENCH_CALL void syslog_checked(int priority, int level, const char* format,
                                  ...) __asm__("__syslog_chk");
void syslog_checked(int priority, int /*level*/, const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  vsyslog(priority, format, arguments);
  va_end(arguments);
}

}  // namespace simbench::shim
