# Sentences that open without their subject and must be read twice: "Of a host with one card, ...",
# "So a step ...", "Likewise ...", "Not so ...", "Nor ...". Reads C++ (comments that begin with //),
# Markdown (but for its blocks of code) and files whose comments begin with #; prints a line for each.
BEGIN { openers = "(Of|So|Likewise|Not so|Nor)([ ,:;]|$)" }

# What a line says to a reader; "" if it is code.
function prose(line) {
  if (FILENAME ~ /\.md$/) {
    if (line ~ /^ *```/) in_code = !in_code
    if (in_code || line ~ /^    /) return ""
    sub(/^ *([-*>]|[0-9]+\.) +/, "", line)
    gsub(/`[^`]*`/, "x", line)
    return line
  }
  if (FILENAME ~ /\.(h|cc)$/) return match(line, /(^|[^:"])\/\/ */) ? substr(line, RSTART + RLENGTH) : ""
  return match(line, /(^|[ \t])# +/) ? substr(line, RSTART + RLENGTH) : ""
}

FNR == 1 { in_code = 0 }
{
  text = prose($0)
  while (match(text, "^" openers) || match(text, "[.:;?!][*_)]* +" openers)) {
    found = substr(text, RSTART, RLENGTH)
    gsub(/^[^A-Z]*|[ ,:;]*$/, "", found)
    file = FILENAME
    sub(/^\.\//, "", file)
    printf "%s:%d: a sentence opens with \"%s\": begin with its subject\n", file, FNR, found
    text = substr(text, RSTART + RLENGTH)
  }
}
