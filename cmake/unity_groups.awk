# Which source files can be compiled as one: awk -v size=N -f cmake/unity_groups.awk FILE...
#
# Prints a line "GROUP FILE" for each file, with at most N files in a group. In one translation unit the
# names that a file keeps to itself (in an unnamed namespace, or as macros) meet the words of the
# others, so two files are kept apart when one has a word that is a local name in the other: nobody has
# to give names with the neighbours in mind, and no name means another thing than in a build of
# single files. Reads code as clang-format leaves it: what is at a namespace's scope is in column 1.
FNR == 1 { file = ++files; path[file] = FILENAME; unnamed = 0 }
{
  gsub(/"([^"\\]|\\.)*"/, "")
  sub(/\/\/.*/, "")
}
/^namespace \{/ { unnamed = 1; next }
unnamed && /^\} *$/ { unnamed = 0; next }
/^#define / { add_name($2) }
unnamed && /^[A-Za-z_]/ { add_name(local_name($0)) }
{
  gsub(/[^A-Za-z0-9_]+/, " ")
  count = split($0, words_here, " ")
  for (i = 1; i <= count; ++i) words[file, words_here[i]] = 1
}
END {
  for (file = 1; file <= files; ++file) {
    group = 1
    while (!fits(file, group)) ++group
    members[group, ++member_count[group]] = file
    print group, path[file]
  }
}

function add_name(name) {
  sub(/\(.*/, "", name)
  if (name != "") names[file, ++name_count[file]] = name
}

# The name that a line at namespace scope declares, or nothing.
function local_name(line, i) {
  if (line ~ /^(TEST|TEST_F|TEST_P|TYPED_TEST|INSTANTIATE[A-Z_]*|static_assert)\(/) return ""
  if (line ~ /^(template|namespace|using namespace)/ || line ~ /^using [A-Za-z0-9_:]+;/) return ""
  while (sub(/<[^<>]*>/, "", line)) {}
  if (line ~ /^(using|struct|class|union|enum class|enum) /) {
    sub(/^(using|struct|class|union|enum class|enum) /, "", line)
    sub(/[^A-Za-z0-9_].*/, "", line)
    return line
  }
  if (!match(line, /[A-Za-z_][A-Za-z0-9_]* *[({=;[]/)) return ""
  line = substr(line, RSTART, RLENGTH)
  sub(/[^A-Za-z0-9_].*/, "", line)
  return line
}

function fits(file, group, i) {
  if (member_count[group] >= size) return 0
  for (i = 1; i <= member_count[group]; ++i) {
    if (meet(file, members[group, i]) || meet(members[group, i], file)) return 0
  }
  return 1
}

# Whether one of the local names of `a` is a word of `b`.
function meet(a, b, i) {
  for (i = 1; i <= name_count[a]; ++i) {
    if ((b, names[a, i]) in words) return 1
  }
  return 0
}
