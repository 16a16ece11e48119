# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Prints uses of the comma operator in formatted C++: statements joined by commas, and commas in parentheses that are no list. Those in the
# header of a `for` and fold expressions over the comma may stand. Usage: awk -f commas.awk FILE...

FNR == 1 { report(); file = FILENAME; text = ""; directive = 0; raw = "" }

# Without comments, literals and directives.
{
  line = $0
  if (raw != "") {
    at = index(line, raw)
    if (at == 0) next
    line = "\004" substr(line, at + length(raw))
    raw = ""
  }
  if (directive || line ~ /^ *#/) { directive = line ~ /\\$/; next }
  while (match(line, /R"[a-z]*\(/)) {
    before = substr(line, 1, RSTART - 1)
    raw = ")" substr(line, RSTART + 2, RLENGTH - 3) "\""
    line = substr(line, RSTART + RLENGTH)
    at = index(line, raw)
    if (at == 0) { line = before; break }
    line = before "\004" substr(line, at + length(raw))
    raw = ""
  }
  gsub(/'([^'\\]|\\.[0-9A-Fa-f]*)'/, "\004", line)
  gsub(/"([^"\\]|\\.)*"/, "\004", line)
  sub(/\/\/.*/, "", line)
  text = text line "\n"
}

END { report() }

function say(what) {
  gsub(/\002/, "()", what)
  gsub(/\003/, "[]", what)
  gsub(/\004/, "\"\"", what)
  gsub(/\005/, "{}", what)
  gsub(/[ \n]+/, " ", what)
  print file ": " what
}

# Collapses what is in brackets, from the innermost on, then looks at each statement.
function report(    before, rest, group, n, i, pieces, piece) {
  gsub(/->/, ".", text)
  gsub(/PULSECAST_OPTIONAL_MEMBER\([^;]*\)\n/, "", text)  # whose arguments hold a call's arguments
  gsub(/\/\*[^*]*\*\//, "", text)
  gsub(/template </, "template<", text)
  gsub(/<>/, "", text)
  gsub(/operator(<=>|[-+*\/%&|!=<>,]+)/, "operator", text)
  do {
    before = length(text)
    while (gsub(/template<[^<>(){};]*>/, "template ", text) + gsub(/<[^ <>(){};=][^<>(){};=]*>/, "", text) > 0) {}
    gsub(/\[[^\[\](){};]*\]/, "\003", text)
    rest = text
    while (match(rest, /([-+*\/%&|!=<?:,({};]|> |[^a-z_](if|while|switch|return))[ \n]*\([^(){};]*,[^(){};]*\)/)) {
      group = substr(rest, RSTART, RLENGTH)
      rest = substr(rest, RSTART + RLENGTH - 1)
      if (group !~ /,[ \n]*\.\.\./) say(group)
    }
    gsub(/\([^(){};]*\)/, "\002", text)
    gsub(/\{[^(){};]*\}/, "\005", text)
  } while (length(text) != before)
  gsub(/\005\n/, "}", text)

  gsub(/\{/, "{\001", text)
  gsub(/\}/, "}\001", text)
  gsub(/;/, ";\001", text)
  n = split(text, pieces, "\001")
  for (i = 1; i <= n; ++i) {
    piece = pieces[i]
    if (piece !~ /,.*;$/) continue
    gsub(/[ \n]+/, " ", piece)
    sub(/^.*\)/, "", piece)  # the end of a call or of the header of a `for`
    sub(/\(.*$/, "", piece)  # the begin of one
    while (sub(/^ *(else|do|\003|(if|while|switch|for)( constexpr)? ?\002|(case [^,:]*(::[^,:]*)*|[a-z]+):) /, "", piece)) {}
    sub(/^ /, "", piece)
    if (piece !~ /[^ ].*,/) continue
    if (piece ~ /^[A-Za-z_][A-Za-z0-9_:]*\002?[&*]* [&*]*[A-Za-z_\002\003]/ && piece !~ /^(return|throw|delete|co_[a-z]*) /) continue
    if (piece !~ /^,/) say(piece)
  }
}
