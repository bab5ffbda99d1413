#!/bin/sh
# Builds simbench's libraries from source for a program of your own in C++, once: later runs take them
# from the cache. docs/ci.md explains it. Prints what CMake needs:
#
#   libraries=$(SIMBENCH_SOURCE=https://... SIMBENCH_VERSION=0.1.0 sh simbench_libraries.sh)
#   cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$libraries"
#
#   SIMBENCH_SOURCE   where Git finds simbench: a URL, or a clone's folder
#   SIMBENCH_VERSION  which release: the tag vVERSION
#   SIMBENCH_CACHE    folder that is kept for the next run; .simbench
#
# For Debian 12, as root or with sudo: simbench's own tools/setup installs compiler and libraries, in
# every run, since a fresh machine lacks them. Exit status: 0 there, else not.
set -eu

say() { printf 'simbench_libraries: %s\n' "$*" >&2; }
fail() { say "$*"; exit 2; }

source=${SIMBENCH_SOURCE:-} version=${SIMBENCH_VERSION:-}
[ -n "$source" ] || fail "SIMBENCH_SOURCE is not set; the head of $0 says what it is"
[ -n "$version" ] || fail "SIMBENCH_VERSION is not set; the head of $0 says what it is"
mkdir -p "${SIMBENCH_CACHE:-.simbench}"
home=$(cd "${SIMBENCH_CACHE:-.simbench}" && pwd)/simbench-$version-$(uname -m)-libraries
# What is installed knows where it lies, so a cache that was moved does not count.
whole=$home/whole

if [ "$(cat "$whole" 2> /dev/null)" != "$home" ]; then
  rm -rf "$home"
  mkdir -p "$home"
  git -c advice.detachedHead=false clone --quiet --depth 1 --branch "v$version" -- "$source" \
    "$home/source" >&2 || fail "Git cannot get the tag v$version of simbench from $source"
  "$home/source/tools/setup" build >&2
  say "building simbench $version: some minutes, once"
  "$home/source/tools/build" release -DSIMBENCH_BUILD_TESTS=OFF -DSIMBENCH_BUILD_BENCH=OFF >&2
  cmake --install "$home/source/build/release" --prefix "$home/prefix" > /dev/null
  rm -rf "$home/source/build/release" "$home/source/.git"
  printf '%s\n' "$home" > "$whole"
else
  "$home/source/tools/setup" build >&2
fi
printf '%s;%s\n' "$home/prefix" "$home/source/build/deps/usr"
