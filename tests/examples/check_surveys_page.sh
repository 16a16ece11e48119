#!/bin/sh
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Holds the pages of surveys against their reader. Usage: check_surveys_page.sh [--update] [ROOT [TABLES [PROGRAM]]]; prints every fault
# and fails if there is one. Every name that the reader knows and every option of the survey program stand on a page in backticks. With
# TABLES, the program settings_tables, values and defaults in its tables are those of the reader; --update writes them. With PROGRAM, the
# survey program, every example runs without a note.
set -u
export LC_ALL=C
update=
if [ "${1:-}" = --update ]; then
  update=yes
  shift
fi
cd "${1:-.}" || exit 2
tables=${2:-}
program=${3:-}
documents='docs/surveys.md docs/survey-scenes.md'  # the first has the document that examples of all change
pages="$documents docs/program.md docs/results.md"
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
faults=$work/faults
: > "$faults"

# ------------------------------------------------------------------------------------------------------------------ names

# The headers describe elements by calls that name attributes, elements and words as string literals. Names are literals that are one word,
# but for these:
cat > "$work/others" << 'END'
Hz
W
deg
encoding
km
m
nW
nm
ns
rad
s
version
xmlns
END
code=$work/code
xml=include/pulsecast/helios/detail/xml
cat $xml/*.hpp include/pulsecast/helios/document.hpp include/pulsecast/helios/settings.hpp $xml/../settings/*.hpp | grep -v '^#include' | sed 's|//.*||' > "$code"
grep -o '"[A-Za-z][A-Za-z0-9_]*"' "$code" | tr -d '"' | sort -u > "$work/literals"
grep -vxF -f "$work/others" "$work/literals" > "$work/names"
grep -vxF -f "$work/literals" "$work/others" | sed 's|^|tests/examples/check_surveys_page.sh: this is no literal any more: |' >> "$faults"

# shellcheck disable=SC2086
awk '/^```/ { inside = !inside; next }
     inside { next }
     {
       n = split($0, piece, "`")
       for (i = 2; i <= n; i += 2) {
         gsub(/[^A-Za-z0-9_]+/, "\n", piece[i])
         print piece[i]
       }
     }' $pages | sort -u > "$work/words"
grep -vxF -f "$work/words" "$work/names" | sed 's|^|no page of surveys names, in backticks: |' >> "$faults"

# Options are the names in the calls that add them, and in the list of those without effect.
grep -E 'add_(option|flag)\(|^ *(constexpr .*)?\{+"[A-Za-z]+", (true|false), "' examples/pulsecast/options.cpp |
  sed 's|type_name([^)]*)||' | grep -oE '"[-A-Za-z0-9,]+"' | tr -d '"' | tr ',' '\n' | sed 's|^-*||' | grep -vx survey |
  sort -u > "$work/options"
[ "$(wc -l < "$work/options")" -gt 30 ] || echo "examples/pulsecast/options.cpp: the options cannot be found" >> "$faults"
grep -vxF -f "$work/words" "$work/options" | sed 's|^|no page of surveys names, in backticks, the option: |' >> "$faults"

# ----------------------------------------------------------------------------------------------------------------- tables

# In tables of attributes, keys and elements, the first cell has names of the reader.
# shellcheck disable=SC2086
awk -v names="$work/names" '
  BEGIN { while ((getline name < names) > 0) known[name] = 1 }
  /^```/ { inside = !inside }
  inside || !/^\|/ { table = ""; next }
  table == "" { table = $0; counts = $0 ~ /^\| (attribute|key|element)( |s)/; next }
  /^\|---/ || !counts { next }
  {
    split($0, cell, / *\| */)
    n = split(cell[2], piece, "`")
    for (i = 2; i <= n; i += 2) {
      gsub(/[<>]/, "", piece[i])
      if (!(piece[i] in known)) print FILENAME ":" FNR ": the reader does not know " piece[i]
    }
  }' $pages >> "$faults"

# The comment of a member names the attribute of its row, if it names any.
awk '/^struct / { split("", said) }
     match($0, /^  [A-Za-z_:<>0-9, ]+ [a-z_]+( =|{).*;.*\/\/\/< /) {
       member = substr($0, 1, match($0, /( =|{)/) - 1)
       sub(/.* /, "", member)
       said[member] = substr($0, index($0, "///< ") + 5)
     }
     match($0, /io\.[a-z]+\("[A-Za-z0-9_]+", [a-z_]+[,)]/) {
       split(substr($0, RSTART, RLENGTH), part, /[",)( ]+/)
       if (part[3] in said && said[part[3]] ~ /`/ && !index(said[part[3]], part[2]))
         print FILENAME ":" FNR ": the comment of " part[3] " does not name " part[2]
     }' include/pulsecast/helios/settings.hpp include/pulsecast/helios/detail/settings/*.hpp >> "$faults"

# Each struct with rows has its table, but for those whose attributes are told in words: of `<attribute>` and `<leg>`, which takes a
# negative `maxDuration_s`, too, and those without rows of their own.
awk '/^struct / { struct = $2 }
     /^  void fields\(FieldIo/ && struct !~ /^(AttributeSettings|LegSettings|ConicOptic|RotationList)$/ { print struct }' \
    include/pulsecast/helios/settings.hpp include/pulsecast/helios/detail/settings/*.hpp |
  while read -r struct; do
    # shellcheck disable=SC2086
    grep -qE "^<!-- rows of ([A-Za-z]+ )*$struct( [A-Za-z]+)* -->$" $documents || echo "no page of surveys has a table with the rows of $struct"
  done >> "$faults"

# A table below <!-- rows of STRUCT... --> has a row for each row of these settings, with the values and the default that the program
# of tables prints; texts, vectors and what an absent value means are described on the page. A row for several attributes has the values of each. A row that is
# missing gets the comment of the member in the header; its meaning may be told at more length on the page.
renewed_tables() {
  awk -v headers="$(printf '%s ' include/pulsecast/helios/settings.hpp include/pulsecast/helios/detail/settings/*.hpp)" '
    function comment(attribute,    n, file, k, line, member, said) {
      n = split(headers, file, " ")
      for (k = 1; k <= n; ++k) {
        while ((getline line < file[k]) > 0) {
          if (line ~ /^struct /) split("", said)
          if (match(line, /^  [A-Za-z_:<>0-9, ]+ [a-z_]+( =.*|{.*);.*\/\/\/< /)) {
            member = substr(line, 1, match(line, /( =|{)/) - 1)
            sub(/.* /, "", member)
            said[member] = substr(line, index(line, "///< ") + 5)
          }
          if (index(line, "(\"" attribute "\", ") && match(line, /", [a-z_]+/)) {
            member = substr(line, RSTART + 3, RLENGTH - 3)
            if (member in said) {
              close(file[k])
              sub(/ \[[^]]*\]$/, "", said[member])
              sub("[;.] `" attribute "`$", "", said[member])
              return said[member]
            }
          }
        }
        close(file[k])
      }
    }
    function finish(    i, name) {
      for (i = 1; i <= rows; ++i) {
        split(row[i], part, "|")
        if (index(" " wanted " ", " " part[1] " ") && !(part[2] in seen))
          print "| `" part[2] "` | " part[3] " | " part[4] " | " comment(part[2]) " |"
      }
      wanted = ""
    }
    FNR == NR { row[++rows] = $0; next }
    /^<!-- rows of .* -->$/ { wanted = $0; gsub(/^<!-- rows of | -->$/, "", wanted); split("", seen); begun = 0 }
    wanted != "" && begun && !/^\|/ { finish() }
    wanted != "" && /^\|/ {
      begun = 1
      split($0, cell, / *\| */)
      n = split(cell[2], piece, "`")
      values = defaults = ""
      for (k = 2; k <= n; k += 2)
        for (i = 1; i <= rows; ++i) {
          split(row[i], part, "|")
          if (part[2] != piece[k] || !index(" " wanted " ", " " part[1] " ")) continue
          seen[part[2]] = 1
          values = values == "" || values == part[3] ? part[3] : values "; " part[3]
          defaults = defaults == "" || defaults == part[4] ? part[4] : defaults ", " part[4]
        }
      if (values != "") {
        if (defaults == "none") defaults = cell[4]
        if (values ~ /^(text|vector)$/) values = cell[3]
        rest = $0
        for (k = 1; k <= 4; ++k) rest = substr(rest, index(rest, "|") + 1)
        $0 = "| " cell[2] " | " values " | " defaults " |" rest
      }
    }
    { print }
    END { if (wanted != "") finish() }' "$work/rows" "$1"
}
if [ -n "$tables" ]; then
  "$tables" > "$work/rows" || echo "$tables fails" >> "$faults"
  for page in $documents; do
    renewed_tables "$page" > "$work/page"
    [ -z "$update" ] || cat "$work/page" > "$page"
    diff "$page" "$work/page" > "$work/differences" || {
      sed "s|^|$page: |" "$work/differences"
      echo "check_surveys_page.sh --update writes the tables anew"
    } >> "$faults"
  done
fi

# --------------------------------------------------------------------------------------------------------------- examples

# A block that has a name, as in ```obj yard.obj, is a file; the first that is a document is what the others change. A block of XML
# without a name is a whole document if it begins with <?xml; else each element in it that is not indented takes the place of those of its
# name in the first document.
examples=$work/examples
mkdir "$examples"
# shellcheck disable=SC2086
awk -v folder="$examples" '
  /^```/ && file != "" { close(file); file = ""; next }
  FNR == 1 { page = FILENAME; gsub(/.*\/|\.md$/, "", page) }
  /^```[a-z]+ [a-z_]+\.[a-z]+$/ { file = folder "/" $2; next }
  /^```xml$/ { file = folder "/" sprintf("%s_line%04d.part", page, FNR); next }
  /^```/ { file = "/dev/null"; next }
  file != "" { print > file }' $documents
for file in examples/yard/*; do
  grep -v SPDX- "$file" | cmp -s - "$examples/${file##*/}" || echo "docs/surveys.md does not show $file, which the other examples change"
done >> "$faults"
for part in "$examples"/*.part; do
  if [ ! -f "$part" ] || [ ! -f "$examples/yard.xml" ]; then continue; fi
  whole=${part%.part}.xml
  if head -n 1 "$part" | grep -q '^<?xml'; then
    cp "$part" "$whole"
    continue
  fi
  awk '
    FNR == NR {
      if (/^<[A-Za-z]/) {
        match($0, /^<[A-Za-z]+/)
        name = substr($0, 2, RLENGTH - 1)
        if (!(name in text) && match($0, / id="[^"]*"/)) id[name] = substr($0, RSTART + 5, RLENGTH - 6)
      }
      text[name] = text[name] $0 "\n"
      next
    }
    function put(name) { if (name in text) printf "%s", text[name]; delete text[name] }
    skipped != "" { if ($0 ~ "</" skipped ">") skipped = ""; next }
    /<scene / && ("scene" in text) { skipped = "scene"; next }
    /<survey / {
      put("scannerSettings"); put("platformSettings"); put("scanner"); put("platform"); put("scene")
      if ("survey" in text) { put("survey"); skipped = "survey"; next }
      for (name in id) if (name ~ /^(scene|platform|scanner)$/) sub(" " name "=\"[^\"]*\"", " " name "=\"#" id[name] "\"")
      print
      next
    }
    /<leg>/ {
      for (name in text) if (name != "leg") put(name)
      if ("leg" in text) { put("leg"); skipped = "leg"; next }
    }
    { print }' "$part" "$examples/yard.xml" > "$whole"
done

if [ -n "$program" ]; then
  cd "$examples" || exit 2
  for document in *.xml; do
    place="the pages of surveys, example $document"
    for command in check run; do
      "$program" $command "$document" --output "$work/output" > "$work/said" 2>&1 || echo "$place: $command fails"
      grep -E '^(note|error):' "$work/said" | sed "s|^|$place: $command says |"
    done
    folder=$(sed -n 's/.*<survey.* name="\([^"]*\)".*/\1/p' "$document")
    find "$work/output/$folder" -name '*_points.xyz' -size +0 2> /dev/null | grep -q . || echo "$place: there are no points"
    rm -rf "$work/output"
  done >> "$faults"
fi

if [ -s "$faults" ]; then
  cat "$faults"
  exit 1
fi
echo "The pages are right: $(wc -l < "$work/names") names, $(find "$examples" -name '*.xml' | wc -l) examples."
