# Counts the test cases in CTest's LastTest.log: "passed failed skipped". For tools/check.
#
# A GoogleTest program (run with --gtest_brief=1) counts by its own lines, any other test as one
# case. A program that dies has no closing lines and counts as one failure.
function close_entry() {
  if (!open) return
  if (cases == 0) { if (good) passed++; else failed++ }
  else { passed += p; failed += f; skipped += s; if (!good && f == 0) failed++ }
  open = 0
}
/^[0-9]+\/[0-9]+ Testing: / { close_entry(); open = 1; good = 0; cases = 0; p = f = s = 0 }
/^\[  PASSED  \] [0-9]+ tests?\.$/ { p += $4; cases = 1 }
/^\[  SKIPPED \] [0-9]+ tests?\.$/ { s += $4; cases = 1 }
/^\[  FAILED  \] .* \([0-9]+ ms\)$/ { f++; cases = 1 }
/^Test Passed\.$/ { good = 1 }
END { close_entry(); print passed + 0, failed + 0, skipped + 0 }
