# One source file against the rules of the house; prints FILE:LINE: what is wrong. For tools/lint,
# which sets file, allowed (folders and files it may include from), known (all folders) and rooms
# (those of its folder, from the lowest to the highest).
BEGIN {
  split(allowed, list, " ")
  for (i in list) may[list[i]] = 1
  split(known, list, " ")
  for (i in list) folder[list[i]] = 1
  count = split(rooms, list, " ")
  for (i = 1; i <= count; ++i) {
    split(list[i], beside, "+")
    for (j in beside) level[beside[j]] = i
  }
}
function level_of(path,  part) { split(path, part, "/"); return level[part[2] in level ? part[2] : "."] }
function found(what) { printf "%s:%d: %s\n", file, FNR, what }

/[ \t]+$/ { found("white space at the end of the line") }

/^#include "/ {
  split($0, part, "\"")
  depth = split(part[2], path, "/")
  if (!(path[1] in folder) || depth < 2)
    found("include \"" part[2] "\" is not written from the root of the project")
  else if (!(path[1] in may) && !((path[1] "/" path[2]) in may) && !(part[2] in may))
    found("a file of " substr(file, 1, index(file, "/")) " may not include " part[2])
  else if (rooms && index(file, path[1] "/") == 1 && level_of(part[2]) > level_of(file))
    found(part[2] " stands above this room")
}

/^#pragma once$/ { once = 1 }

/std::(normal|lognormal|gamma|exponential|poisson|uniform_real|uniform_int)_distribution/ {
  found("a std:: distribution gives other numbers with another library; use Boost.Random")
}
/(^|[^A-Za-z_])(TODO|FIXME|XXX)([^A-Za-z_]|$)/ { found("unfinished: do it or leave it out") }

END {
  if (file ~ /\.h$/ && !once) printf "%s:1: a header without #pragma once\n", file
  if (FNR > 600) printf "%s:%d: longer than 600 lines\n", file, FNR
}
