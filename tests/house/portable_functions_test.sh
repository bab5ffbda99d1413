#!/usr/bin/env bash
# portable_functions_test.sh PROGRAM...: of the system's libm, programs and modules use only functions
# that are exact on every machine; cmake/elementary.cmake has the others.
set -euo pipefail

# Without rounding, or rounded as IEEE 754 prescribes.
readonly exact='ceil floor fma fmax fmin fmod frexp ldexp llrint llround lrint lround modf nearbyint nextafter
  remainder remquo rint round scalbln scalbn sqrt trunc'

libm=$(ldd "$1" | sed -n 's/^.*libm\.so\.6 => \([^ ]*\).*/\1/p')
[[ -r $libm ]] || { echo "$1 uses no libm; is it linked statically?" >&2; exit 1; }
names() { awk '{print $NF}' | sed 's/@.*//' | sort -u; }
status=0
for program in "$@"; do
  used=$(comm -12 <(nm -D --undefined-only "$program" | names) <(nm -D --defined-only "$libm" | names))
  [[ -n $used ]] || { echo "$program: no function of libm was found; is it stripped?" >&2; status=1; }
  for name in $used; do
    # Also those of float, whose names end in f.
    if [[ " ${exact//$'\n'/ } " != *" $name "* && " ${exact//$'\n'/ } " != *" ${name%f} "* ]]; then
      echo "$program uses the system's $name, which differs between processors" >&2
      status=1
    fi
  done
done
exit "$status"
