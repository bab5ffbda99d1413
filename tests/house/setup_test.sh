#!/usr/bin/env bash
# tools/setup on machines that are made up: in a folder of its own, with stand-ins for apt-get and
# dpkg-deb that write down what they are asked for, and of npm, so nothing on this machine changes.
set -euo pipefail
source_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() { printf '%s: %s\n' "$case" "$*" >&2; sed 's/^/  | /' "$work/said" "$work/asked" >&2; exit 1; }

# machine NAME: a fresh one, which has compilers but no libraries.
machine() {
  case=$1
  rm -rf "${work:?}"/*
  mkdir -p "$work"/{bin,usr/include,project/tools,build}
  cp "$source_root/tools/setup" "$work/project/tools/setup"
  : > "$work/asked"
  : > "$work/removes"
  cat > "$work/provide" <<'PROVIDE'
prove() { mkdir -p "$(dirname "$1")" && : > "$1"; }
# provide FOLDER PACKAGE: makes the files that prove the package.
provide() {
  case $2 in
    libeigen3-dev) prove "$1/include/eigen3/Eigen/Dense" ;;
    nlohmann-json3-dev) prove "$1/include/nlohmann/json.hpp" ;;
    libsodium-dev) prove "$1/include/sodium.h" ;;
    libsqlite3-dev) prove "$1/include/sqlite3.h" ;;
    liblz4-dev) prove "$1/include/lz4frame.h" ;;
    libzstd-dev) prove "$1/include/zstd.h" ;;
    libbz2-dev) prove "$1/include/bzlib.h" ;;
    zlib1g-dev) prove "$1/include/zlib.h" ;;
    libcli11-dev) prove "$1/include/CLI/CLI.hpp" ;;
    libfmt-dev) prove "$1/include/fmt/core.h" ;;
    libembree-dev) prove "$1/include/embree3/rtcore.h" ;;
    libopen3d-dev) prove "$1/include/open3d/Open3D.h" ;;
    chrony) prove "$1/sbin/chronyd" ;;
    linuxptp) prove "$1/sbin/ptp4l" ;;
    ntpsec) prove "$1/sbin/ntpd" ;;
    ntpsec-ntpdig) prove "$1/bin/ntpdig" ;;
    openntpd | ptpd | rdate) prove "$1/sbin/$2" ;;
    systemd-timesyncd) prove "$1/../lib/systemd/systemd-timesyncd" ;;
    newlib-source) prove "$1/src/newlib/newlib-3.3.0.tar.xz" ;;
    libboost1.81-dev)
      prove "$1/include/boost/asio/awaitable.hpp"
      echo '#define BOOST_VERSION 108100' > "$1/include/boost/version.hpp" ;;
  esac
}
PROVIDE
  # Simulated, it says what would be removed: what the test wrote in `removes`.
  cat > "$work/bin/apt-get" <<'APT'
#!/usr/bin/env bash
work=$(dirname "$0")/..
source "$work/provide"
if [[ " $* " == *' -s '* ]]; then
  sed -n "s/^${*: -1} \(.*\)/Remv \1 [1]/p" "$work/removes"
  exit 0
fi
echo "$*" >> "$work/asked"
case " $* " in
  *' download '*) for package in "${@:3}"; do : > "$package.deb"; done ;;
  *' install '*) for package in "$@"; do provide "$work/usr" "$package"; done ;;
esac
APT
  cat > "$work/bin/dpkg-deb" <<'DPKG'
#!/usr/bin/env bash
source "$(dirname "$0")/../provide"
provide "$3/usr" "$(basename "$2" .deb)"
DPKG
  # The package that is fetched, and its checksum: right, or whatever `checksum` says.
  mkdir -p "$work/package/dist"
  : > "$work/package/LICENSE"
  tar -czf "$work/package.tgz" -C "$work" package
  cat > "$work/bin/npm" <<'NPM'
#!/usr/bin/env bash
cp "$(dirname "$0")/../package.tgz" "$PWD/package-1.0.0.tgz"
NPM
  printf '#!/bin/sh\ncat > /dev/null; exit "$(cat "%s")"\n' "$work/checksum" > "$work/bin/sha512sum"
  echo 0 > "$work/checksum"
  printf '#!/bin/sh\nexec "$@"\n' > "$work/bin/sudo"
  chmod +x "$work"/bin/*
}

setup() {
  status=0
  PATH=$work/bin:$PATH SIMBENCH_SYSTEM_USR=$work/usr "$work/project/tools/setup" "$@" \
    > /dev/null 2> "$work/said" || status=$?
}
expect_status() { (( status == $1 )) || fail "exit status $status, expected $1"; }
expect_asked() { grep -qE -- "$1" "$work/asked" || fail "apt-get was not asked: $1"; }
expect_not_asked() { ! grep -qE -- "$1" "$work/asked" || fail "apt-get was asked: $1"; }
deps() { printf '%s' "$work/project/build/deps/usr/include/$1"; }

machine "a bare machine"
setup
expect_status 0
expect_asked 'install .*libeigen3-dev .*libfmt-dev'
expect_asked '--no-remove'
expect_not_asked 'install .*boost'
[[ -e $(deps boost/version.hpp) ]] || fail "Boost was not unpacked"
[[ -e $work/project/build/deps/usr/src/newlib ]] || fail "newlib was not unpacked"
[[ -e $work/project/build/deps/usr/share/javascript/uplot/LICENSE ]] || fail "uPlot was not unpacked"
: > "$work/asked"
setup
expect_status 0
[[ ! -s $work/asked && ! -s $work/said ]] || fail "the second call was not silent"

machine "a bare machine that is to reconstruct"
setup build --with-reconstruction
expect_status 0
expect_asked 'install .*libembree-dev libopen3d-dev'
: > "$work/asked"
setup --with-reconstruction
expect_status 0
[[ ! -s $work/asked && ! -s $work/said ]] || fail "the second call was not silent"
rm "$work/usr/include/open3d/Open3D.h"
setup
expect_status 0
expect_not_asked 'open3d'
setup build --with-reconstruction
expect_status 0
expect_asked 'install .*libopen3d-dev'
expect_not_asked 'install .*libembree-dev'

machine "a program whose files have another's names"
setup --with-programs
expect_status 0
expect_asked 'download openntpd'
[[ -e $work/project/build/deps/apart/openntpd/usr/sbin/openntpd ]] || fail "it is not apart"
: > "$work/asked"
setup --with-programs
expect_not_asked 'download openntpd'

machine "an old Boost of the user's"
mkdir -p "$work/usr/include/boost/asio"
: > "$work/usr/include/boost/asio/awaitable.hpp"
echo '#define BOOST_VERSION 107400' > "$work/usr/include/boost/version.hpp"
setup
expect_status 0
[[ -e $(deps boost/version.hpp) ]] || fail "Boost 1.81 was not unpacked"
grep -q 107400 "$work/usr/include/boost/version.hpp" || fail "the user's Boost was touched"

machine "a new Boost of the user's"
mkdir -p "$work/usr/include/boost/asio"
: > "$work/usr/include/boost/asio/awaitable.hpp"
echo '#define BOOST_VERSION 108100' > "$work/usr/include/boost/version.hpp"
setup
expect_status 0
expect_not_asked 'boost'

machine "a library whose package would remove another"
echo "libfmt-dev libspdlog-dev" > "$work/removes"
setup
expect_status 0
expect_not_asked 'install .*libfmt-dev'
[[ -e $(deps fmt/core.h) ]] || fail "fmt was not unpacked"

machine "a program whose package would remove another"
echo "libgtest-dev googletest" > "$work/removes"
setup check
expect_status 2
expect_not_asked 'install'
grep -q 'libgtest-dev would remove googletest' "$work/said" || fail "the message does not say what"

machine "an unpacking that was interrupted"
mkdir -p "$(deps boost/asio)"
: > "$(deps boost/asio/awaitable.hpp)"
echo '#define BOOST_VERSION 108100' > "$(deps boost/version.hpp)"
setup
expect_status 0
expect_asked 'download libboost1.81-dev'

machine "a fetched package that is not the expected one"
echo 1 > "$work/checksum"
setup
expect_status 1
grep -q 'not the file that is expected' "$work/said" || fail "the message does not say so"
[[ ! -e $work/project/build/deps/usr/share/javascript/uplot ]] || fail "it was kept"

# Where packages are is for the machine's owner to say, to apt and npm.
machine "a script that names no host"
! grep -nE 'https?://' "$source_root/tools/setup" > "$work/said" || fail "it does"

machine "a level or an option that does not exist"
setup everything
expect_status 2
setup build --with-everything
expect_status 2
grep -q "unknown option '--with-everything'" "$work/said" || fail "the message does not say what"
expect_not_asked 'install'

echo "setup_test: 11 cases passed"
