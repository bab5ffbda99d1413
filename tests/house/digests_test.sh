#!/usr/bin/env bash
# digests_test.sh SIMBENCH: this machine computes what every other does. Then as a processor without
# fused multiply-add: the C library is told not to use it, which processors of other kinds ignore.
# A change that is meant changes tests/data/digests.txt:
#
#   tools/digests > tests/data/digests.txt
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

compare() {
  if ! diff tests/data/digests.txt -; then
    printf '%s: < tests/data/digests.txt, > this build\n' "$1" >&2
    exit 1
  fi
}
tools/digests "$1" | compare 'on this processor'
GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2 tools/digests "$1" | compare 'without fused multiply-add'
[[ $(tools/digests "$1" trigger lan | wc -l) == 2 ]]
if tools/digests "$1" no_such_case > /dev/null 2>&1; then echo 'an unknown case passed' >&2; exit 1; fi
