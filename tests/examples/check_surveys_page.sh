#!/bin/sh
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Holds docs/surveys.md against the reader of surveys. Usage: check_surveys_page.sh [ROOT [PROGRAM]]; prints every fault and fails if there
# is one. Every name that the reader knows and every option of the survey program stand on the page in backticks, the names and ranges in
# its tables are those of the reader, and, with the program, every example runs without a note.
set -u
export LC_ALL=C
cd "${1:-.}" || exit 2
program=${2:-}
page=docs/surveys.md
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
xml=include/pulsecast/helios/detail/xml  # its number.hpp first, which has the units
cat $xml/number.hpp include/pulsecast/helios/document.hpp $xml/*.hpp | grep -v '^#include' | sed 's|//.*||' > "$code"
grep -o '"[A-Za-z][A-Za-z0-9_]*"' "$code" | tr -d '"' | sort -u > "$work/literals"
grep -vxF -f "$work/others" "$work/literals" > "$work/names"
grep -vxF -f "$work/literals" "$work/others" | sed 's|^|tests/examples/check_surveys_page.sh: this is no literal any more: |' >> "$faults"

awk '/^```/ { inside = !inside; next }
     inside { next }
     {
       n = split($0, piece, "`")
       for (i = 2; i <= n; i += 2) {
         gsub(/[^A-Za-z0-9_]+/, "\n", piece[i])
         print piece[i]
       }
     }' "$page" | sort -u > "$work/words"
grep -vxF -f "$work/words" "$work/names" | sed "s|^|$page does not name, in backticks: |" >> "$faults"

# Options are the names in the calls that add them, and in the list of those without effect.
grep -E 'add_(option|flag)\(|^ *(constexpr .*)?\{+"[A-Za-z]+", (true|false), "' examples/pulsecast/options.cpp |
  sed 's|type_name([^)]*)||' | grep -oE '"[-A-Za-z0-9,]+"' | tr -d '"' | tr ',' '\n' | sed 's|^-*||' | grep -vx survey |
  sort -u > "$work/options"
[ "$(wc -l < "$work/options")" -gt 30 ] || echo "examples/pulsecast/options.cpp: the options cannot be found" >> "$faults"
grep -vxF -f "$work/words" "$work/options" | sed "s|^|$page does not name, in backticks, the option: |" >> "$faults"

# ----------------------------------------------------------------------------------------------------------------- tables

# In tables of attributes, keys and elements, the first cell has names of the reader, and a range `0 to 1e6` in the second is that of a call
# `number("name", ..., units::metre, 0, 1e6)` or `whole("name", ..., 0, 1'000'000)`, with the unit before it.
awk -v page="$page" -v names="$work/names" '
  function is_number(text) { return text ~ /^-?[0-9]*\.?[0-9]+(e-?[0-9]+)?$/ }
  BEGIN { while ((getline name < names) > 0) known[name] = 1 }
  FNR == NR {
    text = $0
    while (match(text, /[a-z_]+\{"[A-Za-z\/ ]+"/)) {  # the units themselves
      split(substr(text, RSTART, RLENGTH), part, /[{"]+/)
      symbol["units::" part[1]] = part[2]
      text = substr(text, RSTART + RLENGTH)
    }
    if (!match($0, /(number|whole)\("[A-Za-z0-9_]+", .*\);/)) next
    text = substr($0, RSTART, RLENGTH - 2)
    is_whole = text ~ /^whole/
    name = text
    sub(/^[a-z]+\("/, "", name)
    sub(/".*/, "", name)
    n = split(text, part, ", ")
    gsub(/\047/, "", part[n - 1])
    gsub(/\047/, "", part[n])
    if (!is_number(part[n - 1]) || !is_number(part[n])) next
    ++ranges[name]
    least[name, ranges[name]] = part[n - 1] + 0
    most[name, ranges[name]] = part[n] + 0
    unit[name, ranges[name]] = is_whole ? "" : symbol[part[n - 2]]
    next
  }
  /^```/ { inside = !inside }
  inside || !/^\|/ { table = ""; next }
  table == "" { table = $0; counts = $0 ~ /^\| (attribute|key|element)( |s)/; next }
  /^\|---/ || !counts { next }
  {
    split($0, cell, / *\| */)
    has_range = match(cell[3], /-?[0-9.]+(e-?[0-9]+)? to -?[0-9.]+(e-?[0-9]+)?/)
    split(substr(cell[3], RSTART, RLENGTH), range, " to ")
    before = has_range ? substr(cell[3], 1, RSTART - 1) : ""
    sub(/,? *$/, "", before)
    sub(/\/s$/, before == "m/s" ? "/s" : "", before)  # rates have the unit of the angle
    n = split(cell[2], piece, "`")
    for (i = 2; i <= n; i += 2) {
      name = piece[i]
      gsub(/[<>]/, "", name)
      if (!(name in known)) print page ":" FNR ": the reader does not know " name
      if (!has_range || !(name in ranges)) continue
      right = 0
      for (k = 1; k <= ranges[name]; ++k)
        if (least[name, k] == range[1] + 0 && most[name, k] == range[2] + 0 && unit[name, k] == before) right = 1
      ++compared
      if (!right) print page ":" FNR ": " name " is said to be \"" cell[3] "\": the reader has " least[name, 1] " to " most[name, 1] " " \
        unit[name, 1]
    }
  }
  END { if (compared < 60) print page ": only " compared + 0 " ranges were compared" }' "$code" "$page" >> "$faults"

# --------------------------------------------------------------------------------------------------------------- examples

# A block that has a name, as in ```obj yard.obj, is a file; the first that is a document is what the others change. A block of XML
# without a name is a whole document if it begins with <?xml; else each element in it that is not indented takes the place of those of its
# name in the first document.
examples=$work/examples
mkdir "$examples"
awk -v folder="$examples" '
  /^```/ && file != "" { close(file); file = ""; next }
  /^```[a-z]+ [a-z_]+\.[a-z]+$/ { file = folder "/" $2; next }
  /^```xml$/ { file = folder "/" sprintf("line%04d.part", FNR); next }
  /^```/ { file = "/dev/null"; next }
  file != "" { print > file }' "$page"
[ -f "$examples/yard.xml" ] || echo "$page has no yard.xml, which the other examples change" >> "$faults"
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
    place="$page, example $document"
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
echo "The page is right: $(wc -l < "$work/names") names, $(find "$examples" -name '*.xml' | wc -l) examples."
