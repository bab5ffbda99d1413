# Names that are local to a file and that another file of its folder defines too. The files of a
# folder compile together (cmake/fast_build.cmake): equal names clash there, or, as overloads, are
# chosen among without a word. Reads .cc and .h files; a line for each finding. Aliases may repeat.

# sim, or tests/sim.
function folder(file) { return match(file, /^(tests\/)?[^\/]*/) ? substr(file, 1, RLENGTH) : file }

function note(name, key) {
  key = folder(FILENAME) SUBSEP name
  if (key in first && first[key] != FILENAME && (is_local || local[key]) && !((key, FILENAME) in seen)) {
    printf "%s:%d: %s is defined in %s too: names that are local to a file are distinct in its folder\n",
           FILENAME, FNR, name, first[key]
  }
  seen[key, FILENAME] = 1
  if (!(key in first)) first[key] = FILENAME
  if (is_local) local[key] = 1
}

FNR == 1 { is_local = 0 }
{ sub(/^\[\[[a-z]+\]\] /, "") }
/^namespace \{$/ { is_local = 1; next }
/^}  \/\/ namespace$/ { is_local = 0; next }
/^(class|struct|enum class|enum) [A-Za-z_0-9]+ (final )?[:{]/ {
  name = $0
  sub(/^(enum class|class|struct|enum) /, "", name)
  sub(/[^A-Za-z_0-9].*/, "", name)
  note(name)
  next
}
/^(inline |static )?const(expr)? / && match($0, / \**k[A-Z][A-Za-z0-9]*( =|\{|\()/) {
  name = substr($0, RSTART + 1, RLENGTH - 1)
  gsub(/[^A-Za-z0-9]/, "", name)
  note(name)
  next
}
# A function: a type, a name without a class, its parameters.
/^[A-Za-z].*[ *&>][a-z_0-9]+\(/ && !/^(using|namespace|template|typedef|return|TEST|MATCHER|INSTANTIATE)/ {
  name = $0
  while (gsub(/<[^<>]*>/, "", name)) continue
  sub(/\(.*/, "", name)
  if (name ~ /::[a-z_0-9~]+$/ || name ~ /=/) next
  sub(/.*[^a-z_0-9A-Z]/, "", name)
  if (name !~ /^(operator|main|decltype|sizeof)$/) note(name)
}
