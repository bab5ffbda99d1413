#!/bin/sh
# Takes a release of simbench and holds an algorithm to its baselines: in anyone's repository, on any
# CI, or by hand. docs/ci.md explains it.
#
#   SIMBENCH_RELEASES=/srv/simbench SIMBENCH_VERSION=0.1.0 SIMBENCH_SCENARIOS=18cam_6host_45fps_lan \
#     sh simbench_gate.sh run --python my_algorithm.py --pipelines yoon2021_both+mine+yoon2021
#
# The arguments are `run` or `clocks` and the options of that command of simbench, all but --scenario
# and --output. With --python the wheel of the release is taken, for the python3 that is there.
#
#   SIMBENCH_RELEASES   where the files of the release are: a folder, or a URL before their names
#   SIMBENCH_VERSION    which release
#   SIMBENCH_SCENARIOS  names or files, separated by blanks; each has a gate
#   SIMBENCH_BASELINES  folder of the committed baselines, SCENARIO.json each; simbench_baselines
#   SIMBENCH_RESULTS    folder for all that is written; simbench_results
#   SIMBENCH_CACHE      folder that is kept for the next run; .simbench
#   SIMBENCH_SUMS       file with the checksums; SHA256SUMS beside the release, which tells a broken
#                       file. A copy that you committed tells a forged one too
#   SIMBENCH_HEADER     sent to the URL, such as "JOB-TOKEN: ..."
#   SIMBENCH            a program of your own that has simbench in it (C++), in place of a release
#
# Writes of each scenario: SCENARIO/ (the archive), SCENARIO.xml (JUnit), SCENARIO.baseline.json (what
# to commit if the numbers are to be so), SCENARIO.log; and summary.md. Exit status: 0 all passed, or
# that of the first scenario that did not: 3 worse, 4 no baseline yet, 2 bad usage or input, others of
# `simbench run`.
set -eu

say() { printf 'simbench_gate: %s\n' "$*" >&2; }
# Says it in the log and in the summary, and ends.
fail() {
  say "$*"
  [ ! -d "${results:-}" ] || printf '## simbench gate: not run\n\n%s\n' "$*" >> "$results/summary.md"
  exit 2
}
# setting NAME VALUE: ends if there is no value.
setting() { [ -n "$2" ] || fail "$1 is not set; the head of $0 says what it is"; }

# get NAME FILE: copies or downloads a file of the release.
get() {
  case $releases in
    *://*) download "$releases/$1" "$2" ;;
    *) cp -- "$releases/$1" "$2" ;;
  esac 2> "$fetched/why" ||
    fail "cannot get $1 of simbench $version from $releases: $(tail -n 1 "$fetched/why")"
}
download() {
  set -- -fsSL --retry 3 --connect-timeout 30 -o "$2" "$1"
  [ -n "${SIMBENCH_HEADER:-}" ] || { curl "$@"; return; }
  printf '%s\n' "$SIMBENCH_HEADER" | curl -H @- "$@"
}

# listed: checksum and name of the file of this version, machine and kind; nothing if there is none.
listed() {
  awk -v start="simbench-$version-" -v machine="$machine" -v kind="$kind" '
    { name = $2; sub(/^\*/, "", name); rest = substr(name, length(start) + 1) }
    index(name, start) != 1 { next }
    kind == "program" && rest == "linux-" machine ".tar.gz" { print $1, name; exit }
    kind == "python" && rest ~ /\.whl$/ && index(rest, "_" machine ".whl") { print $1, name; exit }
  ' "$sums"
}

# Puts the release into the cache if it is not there. What is there is whole: it is renamed at last.
fetch() {
  [ ! -d "$home" ] || return 0
  mkdir -p "$cache"
  fetched=$(mktemp -d "$cache/fetched.XXXXXX")
  # Nothing stays of what failed: a service would keep an empty cache for good.
  trap 'rm -rf "$fetched"; rmdir "$cache" 2> /dev/null || true' EXIT
  sums=${SIMBENCH_SUMS:-}
  if [ -z "$sums" ]; then
    sums=$fetched/SHA256SUMS
    get SHA256SUMS "$sums"
  fi
  line=$(listed)
  [ -n "$line" ] || fail "no simbench $version for $machine ($kind) in ${SIMBENCH_SUMS:-$releases};" \
    "there are: $(awk '{ sub(/^\*/, "", $2); printf "%s%s", comma, $2; comma = ", " }' "$sums")"
  file=${line#* } expected=${line%% *}
  say "getting $file from $releases"
  get "$file" "$fetched/$file"
  found=$(sha256sum "$fetched/$file" | cut -d ' ' -f 1)
  [ "$found" = "$expected" ] || fail "$file from $releases is damaged or not the one that was released:" \
    "its SHA-256 is $found, that of SHA256SUMS $expected; nothing of it was used"
  unpack "$fetched/$file"
  "$run" --version > "$fetched/said" 2>&1 ||
    fail "simbench $version does not run on this machine: $(tail -n 1 "$fetched/said")"
  mv -T "$fetched/unpacked" "$home" || [ -d "$home" ] # another run may have been faster
}

# unpack FILE: makes `unpacked`, with `unpacked/run`, which starts simbench.
unpack() {
  mkdir "$fetched/unpacked"
  run=$fetched/unpacked/run
  if [ "$kind" = program ]; then
    tar -xzo -f "$1" -C "$fetched/unpacked" --strip-components=1 || fail "$file cannot be unpacked"
    cat > "$run" << 'END'
#!/bin/sh
exec "$(dirname "$0")/bin/simbench" "$@"
END
  else
    python3 -m pip --isolated install --quiet --disable-pip-version-check --no-index --no-deps \
      --target "$fetched/unpacked/python" "$1" > "$fetched/why" 2>&1 ||
      fail "python3 cannot install $file: $(tail -n 1 "$fetched/why")"
    # By the job's own interpreter, whose packages an algorithm may need.
    cat > "$run" << 'END'
#!/bin/sh
export PYTHONPATH="$(dirname "$0")/python${PYTHONPATH:+:$PYTHONPATH}"
exec python3 -m simbench "$@"
END
  fi
  chmod +x "$run"
}

# logged LOG COMMAND...: shows what it says and adds that to LOG; returns its status.
logged() {
  log=$1
  shift
  { status=0; "$@" 2>&1 || status=$?; echo "$status" > "$log.status"; } | tee -a "$log"
  status=$(cat "$log.status")
  rm "$log.status"
  return "$status"
}

# gate SCENARIO OPTION...: runs it and holds it to its baseline; returns the status.
gate() {
  scenario=$1
  shift
  name=$(basename "$scenario" .json)
  result=$results/$name baseline=$baselines/$name.json status=0
  rm -rf "$result" "$result.log" "$result.xml" "$result.md" "$result.baseline.json"
  logged "$result.log" "$simbench" "$command" --scenario "$scenario" "$@" --output "$result" || status=$?
  if [ "$status" -ne 0 ]; then
    summarise_log "$name: \`simbench $command\` ended with status $status"
    return "$status"
  fi
  # Its margins are kept, which may have been edited.
  [ ! -f "$baseline" ] || cp "$baseline" "$result.baseline.json"
  "$simbench" gate "$result" --save-baseline "$result.baseline.json" > /dev/null 2>&1 ||
    rm -f "$result.baseline.json"
  logged "$result.log" "$simbench" gate "$result" --baseline "$baseline" --junit "$result.xml" \
    --markdown "$result.md" || status=$?
  commands="mkdir -p $baselines && cp $result.baseline.json $baseline && git add $baseline"
  case $status in
    0) cat "$result.md" >> "$summary" ;;
    3)
      say "$name became worse. If that is meant: $commands"
      { cat "$result.md"; printf '\nIf that is meant:\n\n    %s\n' "$commands"; } >> "$summary" ;;
    4)
      say "$name has no baseline yet, so nothing was compared. To make this run the baseline: $commands"
      printf '## %s: no baseline yet\n\nTo make this run the baseline:\n\n    %s\n' "$name" "$commands" \
        >> "$summary" ;;
    *) summarise_log "$name: \`simbench gate\` ended with status $status" ;;
  esac
  echo >> "$summary"
  rm -f "$result.md"
  return "$status"
}

# summarise_log TITLE: the end of the scenario's log in the summary.
summarise_log() {
  { printf '## %s\n\n' "$1"; tail -n 20 "$result.log" | sed 's/^/    /'; echo; } >> "$summary"
}

results=${SIMBENCH_RESULTS:-simbench_results}
baselines=${SIMBENCH_BASELINES:-simbench_baselines}
mkdir -p "$results"
summary=$results/summary.md
: > "$summary"
command=${1:-}
case $command in
  run | clocks) shift ;;
  *) fail "the first argument is '$command'; allowed: run, clocks" ;;
esac
setting SIMBENCH_SCENARIOS "${SIMBENCH_SCENARIOS:-}"

if [ -n "${SIMBENCH:-}" ]; then
  simbench=$SIMBENCH
else
  releases=${SIMBENCH_RELEASES:-} version=${SIMBENCH_VERSION:-}
  setting SIMBENCH_RELEASES "$releases"
  setting SIMBENCH_VERSION "$version"
  releases=${releases%/}
  machine=$(uname -m) kind=program
  for argument; do
    case $argument in --python | --python=*) kind=python ;; esac
  done
  cache=${SIMBENCH_CACHE:-.simbench}
  case $cache in /*) ;; *) cache=$PWD/$cache ;; esac
  home=$cache/simbench-$version-$machine-$kind
  fetch
  simbench=$home/run
fi

# All scenarios are gated before the end, so that one look shows all there is.
first=0
for scenario in $SIMBENCH_SCENARIOS; do
  status=0
  gate "$scenario" "$@" || status=$?
  [ "$first" -ne 0 ] || first=$status
done
exit "$first"
