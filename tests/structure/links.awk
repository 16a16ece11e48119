# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Prints links of pages to files that are not there, or to headings that a page does not have. Usage: awk -f links.awk PAGE.md...
function resolved(path,   parts, n, i, kept, out) {
  n = split(path, parts, "/")
  for (i = 1; i <= n; ++i)
    if (parts[i] == "..") --kept
    else if (parts[i] != ".") out[++kept] = parts[i]
  path = out[1]
  for (i = 2; i <= kept; ++i) path = path "/" out[i]
  return path
}
FNR == 1 {
  page = resolved(FILENAME)
  folder = page ~ /\// ? page : ""
  sub(/[^\/]*$/, "", folder)
  pages[page] = 1
  code = 0
}
/^ *```/ { code = !code }
code { next }
/^#+ / {
  heading = tolower($0)
  sub(/^#+ /, "", heading)
  gsub(/[^a-z0-9_ -]/, "", heading)
  gsub(/ /, "-", heading)
  headings[page "#" heading] = 1
}
{
  line = $0
  gsub(/`[^`]*`/, "", line)
  while (match(line, /\]\([^) ]*\)/)) {
    target = substr(line, RSTART + 2, RLENGTH - 3)
    line = substr(line, RSTART + RLENGTH)
    if (target ~ /^[a-z]+:/) continue
    links[++count] = target ~ /^#/ ? page target : resolved(folder target)
    from[count] = FILENAME ":" FNR ": " target
  }
}
END {
  for (i = 1; i <= count; ++i) {
    target = links[i]
    sub(/#.*/, "", target)
    if (target in pages ? target != links[i] && !(links[i] in headings) : system("test -e '" target "'")) print from[i]
  }
}
