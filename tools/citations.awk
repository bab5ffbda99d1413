# Citations of the project's own pages: prints FILE:LINE: what does not exist. For tools/lint, which
# gives it all pages (*.md) and sources, and all folders as `known`. A citation is the path of a
# page below docs/, or a link from one page to another, and may go on with sections: "section 2",
# "(sections 1 and 2)", "sections 5 to 7", also on the next line. A page's sections are its headings
# "## 2 Title". Sources that a page of docs/ or CONTRIBUTING names, as `sim/camera/device_clock.h`,
# are checked too.
{
  line = $0
  gsub(/^[ \t]*(\/\/|#|"|-|\*)?[ \t]*|"?[ \t]*$/, "", line)
  cite(last, last " " line)
  if (FILENAME !~ /\.md$/) note_bare(line)
  if (FILENAME ~ /^(docs\/|CONTRIBUTING)/) check_sources(line)
  last = line
  file = FILENAME
  row = FNR
}
FNR == 1 { page[FILENAME] = 1 }
/^#+ [0-9]+ / && FILENAME ~ /\.md$/ { section[FILENAME, $2 + 0] = 1 }

function cite(line, text,   from, path) {
  from = 1
  while (match(substr(text, from), /(docs\/|\]\()[A-Za-z0-9_.\/-]*\.md\)?/) &&
         from + RSTART - 1 <= length(line)) {
    path = substr(text, from + RSTART - 1, RLENGTH)
    from += RSTART + RLENGTH - 1
    if (path ~ /^\]/) path = folder_of(file) substr(path, 3)
    sub(/\)$/, "", path)
    while (sub(/[^\/]+\/\.\.\//, "", path)) {}
    ++citations
    place[citations] = file ":" row
    target[citations] = path
    if (match(substr(text, from), /^,? \(?sections? [0-9]+((, | and | to )[0-9]+)*/)) {
      wanted[citations] = substr(text, from, RLENGTH)
      gsub(/,? \(?sections? /, "", wanted[citations])
    }
  }
}

# A page by its bare name, without its folder: "paper.md section 3".
function note_bare(text,   name) {
  while (match(text, /(^|[^A-Za-z0-9_.\/-])[a-z][a-z0-9_]*\.md/)) {
    name = substr(text, RSTART, RLENGTH)
    sub(/^[^a-z]/, "", name)
    bare[FILENAME ":" FNR] = name
    text = substr(text, RSTART + RLENGTH)
  }
}

function check_sources(text,   path, dummy) {
  while (match(text, /`[a-z]+\/[A-Za-z0-9_.\/-]+\.(h|cc|json|awk|cmake)`/)) {
    path = substr(text, RSTART + 1, RLENGTH - 2)
    text = substr(text, RSTART + RLENGTH)
    if (!index(" " known " ", " " substr(path, 1, index(path, "/") - 1) " ")) continue  # not ours
    if ((getline dummy < path) < 0) print FILENAME ":" FNR ": there is no " path
    close(path)
  }
}

function folder_of(path) { return path ~ /\// ? substr(path, 1, match(path, /[^\/]*$/) - 1) : "" }

function check(where, path, number) {
  if (!((path, number) in section)) print where ": " path " has no section " number
}

END {
  cite(last, last)
  for (where in bare) {
    if (("docs/reference/" bare[where]) in page)
      print where ": write docs/reference/" bare[where] " for " bare[where]
  }
  for (i = 1; i <= citations; ++i) {
    if (!(target[i] in page)) {
      print place[i] ": there is no " target[i]
      continue
    }
    count = split(wanted[i], word, /,? +/)
    for (w = 1; w <= count; ++w) {
      if (word[w] == "to") {
        for (n = word[w - 1] + 1; n < word[w + 1]; ++n) check(place[i], target[i], n)
      } else if (word[w] != "and") {
        check(place[i], target[i], word[w] + 0)
      }
    }
  }
}
