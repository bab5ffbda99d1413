# The examples in the headers' comments as one C++ file, to be compiled: awk -f FILE HEADER...
#
# An example is a block of comment lines that are indented by three blanks and of which one ends a
# statement (`;` or `{`, a comment may follow). It becomes the body of a function in the header's
# namespace; paragraphs that begin with a class, a template or a function stand beside it. What it
# takes as given (scenario, engine, ...) is declared in tests/house/header_examples.h; `...` stands
# for whatever fits. Errors name the header and the line.

function flush_block(   i, code) {
  for (i = 1; i <= lines; ++i) if (block[i] ~ /[;{]([ ]+\/\/.*)?$/) code = 1
  if (block[1] ~ /^([0-9]+\. |\{?"|\{$)/) code = 0  # a list, JSON
  if (code) write_example()
  lines = 0
}

function write_example(   i, beside, body, text, returns) {
  beside = body = ""
  returns = "void"
  outside = 0
  for (i = 1; i <= lines; ++i) {
    text = block[i]
    if (i == 1 || block[i - 1] == "") outside = is_definition(text)
    gsub(/\{ ?\.\.\. ?\}/, "{}", text)
    sub(/ \.\.\.( |$)/, " whatever; ", text)
    gsub(/, \.\.\./, "", text)
    gsub(/\.\.\./, "whatever", text)
    text = "#line " first + i - 1 " \"" file "\"\n" text "\n"
    if (outside) { beside = beside text; continue }
    body = body text
    if (block[i] ~ /co_return [^;]/) returns = "Task<Returned>"
    else if (block[i] ~ /co_(await|return)/ && returns == "void") returns = "Task<void>"
    else if (block[i] ~ /^(if .*)?return / && returns == "void") returns = "auto"
  }
  text = body beside
  if (gsub(/[({]/, "&", text) != gsub(/[)}]/, "&", text)) {
    # It would take the next examples with it.
    examples = examples "#line " first " \"" file "\"\n#error brackets do not match\n"
    return
  }
  examples = examples "namespace " space " {\n" beside
  if (body != "") examples = examples "inline " returns " example_" ++count "() {\n" body "}\n"
  examples = examples "}\n"
}

function is_definition(text) {
  return text ~ /^(template|class|struct|namespace) / || \
    (text ~ /^[A-Za-z_:<>]+ [a-z_0-9]+\(.*\) (const )?\{$/ && text !~ /^(if|for|while|switch|else|return)|\(\[/)
}

# The namespace comes after the examples at the top, so the file is read ahead for it.
function namespace_of(name,   line, found) {
  found = "simbench"
  while ((getline line < name) > 0) {
    if (line ~ /^namespace simbench[a-z_0-9:]* \{/) { split(line, word, " "); found = word[2] }
  }
  close(name)
  return found
}

FNR == 1 { print "#include \"" FILENAME "\"" }
FNR == 1 { if (lines) flush_block(); file = FILENAME; space = namespace_of(file); blanks = 0 }
/^ *\/\/   [^ ]/ || (lines && /^ *\/\/    /) {
  if (!lines) first = FNR
  else while (blanks > 0) { block[++lines] = ""; --blanks }
  text = $0
  sub(/^ *\/\/   /, "", text)
  block[++lines] = text
  blanks = 0
  next
}
lines && /^ *\/\/$/ { ++blanks; next }
{ if (lines) flush_block(); blanks = 0 }
END {
  if (lines) flush_block()
  print "#include \"tests/house/header_examples.h\""
  printf "%s", examples
  # Whoever breaks the reading of examples is to notice.
  print "static_assert(" count + 0 " > 100, \"examples in headers are no longer found\");"
}
