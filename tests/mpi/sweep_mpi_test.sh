#!/usr/bin/env bash
# simbench sweep under mpirun: sweep_mpi_test.sh SIMBENCH, beside which simbench-mpi lies.
#
# Results must be those of one process, byte for byte; whatever fails ends the job with a status, and
# what was finished stays.
set -euo pipefail
simbench=$1
if [[ ! -x $(dirname "$simbench")/simbench-mpi ]] || ! command -v mpirun > /dev/null; then
  echo "not run: simbench-mpi was not built, or there is no mpirun (tools/setup check)"
  echo "[  SKIPPED ] 1 test."
  exit 0
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
# Tests run as root in containers and with fewer cores than ranks.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
ranks() { local n=$1; shift; mpirun --oversubscribe --bind-to none -n "$n" "$@"; }
fail() { printf 'FAILED: %s\n' "$*" >&2; tail -n 20 ./*.err >&2; exit 1; }
same() { diff -r "$1" "$2" > same.err || fail "$2 differs from $1"; }

small=(sweep --scenario 3cam_1host_30fps --sweep /usb/delivery_jitter_transfers=0:0.4:0.1
  --seeds 8 --pipelines raw_arrival,genlock)
"$simbench" "${small[@]}" -o one --jobs 1 > one.txt 2> one.err || fail "one process"
for n in 2 4; do
  ranks "$n" "$simbench" "${small[@]}" -o "ranks$n" > "$n.txt" 2> "$n.err" || fail "$n ranks"
  same one "ranks$n"
  same one.txt "$n.txt"
done
ranks 2 "$simbench" "${small[@]}" --jobs 2 -o threads > threads.txt 2> threads.err ||
  fail "two ranks with two threads each"
same one threads

clocks=(sweep --clocks --scenario 6host_star --pipelines chrony,free_running --duration-s 400
  --from-s 100 --seeds 3 --sweep /network/latency_exponential_ms=0.02,0.2)
"$simbench" "${clocks[@]}" -o clocks --jobs 1 > clocks.txt 2> clocks.err || fail "clocks alone"
ranks 3 "$simbench" "${clocks[@]}" -o clocks3 > clocks3.txt 2> clocks3.err || fail "clocks, 3 ranks"
same clocks clocks3
same clocks.txt clocks3.txt

# A launch on one rank, and a batch job without MPI, are no MPI jobs.
for variable in OMPI_COMM_WORLD_SIZE=1 SLURM_NTASKS=4 PMI_SIZE=1; do
  env "$variable" OMPI_COMM_WORLD_RANK=0 "$simbench" "${small[@]}" -o one > /dev/null 2> one.err ||
    fail "with $variable"
done

# Wrong input: the status of a single process, and one message.
status=0
ranks 3 "$simbench" sweep --scenario 3cam_1host_30fps --sweep /timline/frames=1 -o bad \
  > /dev/null 2> bad.err || status=$?
(( status == 2 )) || fail "wrong input: status $status"
(( $(grep -c 'did you mean timeline' bad.err) == 1 )) || fail "wrong input: not one message"

# Without simbench-mpi beside it.
mkdir alone
cp "$simbench" alone/simbench
status=0
ranks 2 alone/simbench "${small[@]}" -o bad > /dev/null 2> alone.err || status=$?
(( status == 2 )) || fail "without simbench-mpi: status $status"
(( $(grep -c 'simbench-mpi cannot be started' alone.err) == 1 )) || fail "without simbench-mpi"

# A rank that dies ends the job; what rank 0 had written counts in the next start.
large=(sweep --scenario 18cam_6host_45fps --sweep /hosts/load_log_sigma=0.2,0.6 --seeds 300
  --pipelines yoon2021_both,oracle)
mpirun --oversubscribe --bind-to none -n 3 "$simbench" "${large[@]}" -o killed > /dev/null 2> killed.err &
job=$!
for (( i = 0; i < 2000; i++ )); do
  [[ ! -e killed/runs.log ]] || (( $(wc -l < killed/runs.log) < 5 )) || break
  sleep 0.01
done
kill -KILL "$(pgrep -P "$job" | tail -n 1)"
status=0
wait "$job" || status=$?
(( status != 0 )) || fail "a rank was killed, and the job's status is 0"
finished=$(wc -l < killed/runs.log)
(( finished >= 5 && finished < 1200 )) || fail "$finished runs were finished"
ranks 2 "$simbench" "${large[@]}" -o killed > killed.txt 2> again.err || fail "the next start"
grep -q "^note: $finished of 1200 runs finished already" again.err ||
  grep -q 'damaged' again.err || fail "finished runs were lost"
"$simbench" "${large[@]}" -o whole > whole.txt 2> whole.err || fail "one process"
same whole killed
same whole.txt killed.txt
echo "sweep_mpi_test: passed"
