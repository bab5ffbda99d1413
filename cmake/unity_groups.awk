# Which source files can be compiled as one: awk -v size=N -f cmake/unity_groups.awk FILE...
#
# Run at the root of the project; prints a line "GROUP FILE" for each file, at most N files in a
# group. In one translation unit the names that a file keeps to itself (in an unnamed namespace, or
# as macros) meet the words of the others and what their headers declare. So two files are kept
# apart when a local name of one is such a word of the other: nobody has to choose names with the
# neighbours in mind, and no name means another thing than in a build of single files. Reads code as
# clang-format leaves it: what is at a namespace's scope begins in column 1. An alias that both files
# have (using Json = ...) keeps nobody apart.
FNR == 1 { file = ++files; path[file] = FILENAME; unnamed = in_raw_string = 0 }
in_raw_string { in_raw_string = !/\)[a-z_]*"/; next }
/R"[a-z_]*\(/ && !/\)[a-z_]*"/ { in_raw_string = 1 }
/^#include "/ { split($0, part, "\""); declares(file, part[2]) }
/^\}  \/\/ namespace$/ { unnamed = 0 }
{ code = without_text($0) }
/^namespace \{/ { unnamed = 1 }
/^#define / { split($2, part, "("); names[file, ++name_count[file]] = part[1] }
unnamed && (name = declared(code)) != "" { names[file, ++name_count[file]] = name }
/^using .*;$/ { aliases[file, $0] = 1; alias_of[file, name] = $0 }
{
  gsub(/[^A-Za-z0-9_]+/, " ", code)
  count = split(code, part, " ")
  for (i = 1; i <= count; ++i) words[file, part[i]] = 1
}
END {
  for (file = 1; file <= files; ++file) {
    group = 1
    while (!fits(file, group)) ++group
    members[group, ++member_count[group]] = file
    print group, path[file]
  }
}

function without_text(line) {
  gsub(/"([^"\\]|\\.)*"/, "", line)
  sub(/\/\/.*/, "", line)
  return line
}

# The name that a line at a namespace's scope declares, or nothing.
function declared(line) {
  sub(/^\[\[[a-z]+\]\] */, "", line)
  if (line !~ /^[A-Za-z_]/ || line ~ /^(TEST[_A-Z]*|INSTANTIATE[_A-Z]*|static_assert)\(/) return ""
  if (line ~ /^(template|namespace|using namespace)/ || line ~ /^using [A-Za-z0-9_:]+;/) return ""
  while (sub(/<[^<>]*>/, "", line)) {}
  if (sub(/^(using|struct|class|union|enum class|enum) /, "", line)) {
    sub(/[^A-Za-z0-9_].*/, "", line)
    return line
  }
  if (!match(line, /[A-Za-z_][A-Za-z0-9_]* *[({=;[]/)) return ""
  line = substr(line, RSTART, RLENGTH)
  sub(/[^A-Za-z0-9_].*/, "", line)
  return line
}

# Adds to the words of a file what a header that it includes declares, and those that this includes.
function declares(file, header, i) {
  if ((file, header) in seen) return
  seen[file, header] = 1
  if (!(header in content_count)) read_header(header)
  for (i = 1; i <= content_count[header]; ++i) words[file, content[header, i]] = 1
  for (i = 1; i <= include_count[header]; ++i) declares(file, includes[header, i])
}

function read_header(header, line, name, part) {
  content_count[header] = 0
  while ((getline line < header) > 0) {
    if (line ~ /^#include "/) {
      split(line, part, "\"")
      includes[header, ++include_count[header]] = part[2]
    } else if ((name = declared(without_text(line))) != "") {
      content[header, ++content_count[header]] = name
    }
  }
  close(header)
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
    if ((b, names[a, i]) in words && !((b, alias_of[a, names[a, i]]) in aliases)) {
      if (explain) print path[a], names[a, i], path[b] > "/dev/stderr"
      return 1
    }
  }
  return 0
}
