# One source file against the rules of the house; prints FILE:LINE: what is wrong. For tools/lint,
# which sets file, allowed (folders and files it may include from) and known (all folders).
BEGIN {
  split(allowed, list, " ")
  for (i in list) may[list[i]] = 1
  split(known, list, " ")
  for (i in list) folder[list[i]] = 1
  guard = "SIMBENCH_" toupper(file) "_"
  gsub(/[\/.]/, "_", guard)
}
function found(what) { printf "%s:%d: %s\n", file, FNR, what }

/[ \t]+$/ { found("white space at the end of the line") }

/^#include "/ {
  split($0, part, "\"")
  depth = split(part[2], path, "/")
  if (!(path[1] in folder) || depth < 2)
    found("include \"" part[2] "\" is not written from the root of the project")
  else if (!(path[1] in may) && !((path[1] "/" path[2]) in may) && !(part[2] in may))
    found("a file of " substr(file, 1, index(file, "/")) " may not include " part[2])
}

/^#ifndef / && !guarded { guarded = 1; if ($2 == guard) good_guard = 1 }

/std::(normal|lognormal|gamma|exponential|poisson|uniform_real|uniform_int)_distribution/ {
  found("a std:: distribution gives other numbers with another library; use Boost.Random")
}
/(^|[^A-Za-z_])(TODO|FIXME|XXX)([^A-Za-z_]|$)/ { found("unfinished: do it or leave it out") }

END {
  if (file ~ /\.h$/ && !good_guard) printf "%s:1: header guard is not %s\n", file, guard
  if (FNR > 600) printf "%s:%d: longer than 600 lines\n", file, FNR
}
