# Types of two folders that share a name. One word stands for one thing: a type of namespace scope in a
# header has its name alone among the folders of production code (sim, hardware, ...). Types within
# other types, and types that are local to a .cc file and that no header of another folder names, do
# not count. Reads .h and .cc files and the scenarios' schema, whose "x-type"s are the types of a
# generated header; prints a line for each finding. Declarations may repeat.

function folder(file) { return substr(file, 1, index(file, "/") - 1) }

function note(name) {
  if ((name, folder(file)) in seen) return
  seen[name, folder(file)] = 1
  places[name] = places[name] " " file ":" FNR
  ++folders_of[name]
  if (file !~ /\.cc$/) in_header[name] = 1
}

FNR == 1 { file = FILENAME; sub(/^\.\//, "", file) }
{ sub(/\[\[[a-z]+\]\] /, "") }
/^(class|struct|enum class|enum) [A-Za-z_0-9]+ (final )?[:{]/ {
  name = $0
  sub(/^(enum class|class|struct|enum) /, "", name)
  sub(/[^A-Za-z_0-9].*/, "", name)
  note(name)
}
file ~ /\.json$/ && match($0, /"x-type": "[A-Za-z_0-9]+"/) {
  note(substr($0, RSTART + 11, RLENGTH - 12))
}
END {
  for (name in in_header) {
    if (folders_of[name] < 2) continue
    count = split(places[name], place, " ")
    for (i = 2; i <= count; ++i) {
      printf "%s: %s names a type of another folder too (%s): a name means one thing\n",
             place[i], name, place[1]
    }
  }
}
