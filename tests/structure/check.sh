#!/bin/sh
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Checks what the architecture promises and no compiler sees. Usage: check.sh [ROOT [RULE]]; prints every violation and fails if there is one.
# With RULE, only the rule of that name is checked.
set -u
export LC_ALL=C
cd "${1:-.}" || exit 2
only=${2:-}
violations=$(mktemp) || exit 2
trap 'rm -f "$violations"' EXIT

# rule NAME COMMAND [ARGUMENT...]: each line that COMMAND prints is a violation of the rule.
rule() {
  name=$1
  shift
  [ -z "$only" ] || [ "$only" = "$name" ] || return 0
  "$@" | sed "s|^|$name: |" >> "$violations"
}

headers=$(find include -name '*.hpp' | sort)
sources=$(find include examples tests bench .ci CMakeLists.txt -type f \
          \( -name '*.[ch]pp' -o -name '*.cmake' -o -name '*.sh' -o -name CMakeLists.txt -o -path '.ci/*' \
             -o -name '*.js' -o -name '*.mjs' -o -name '*.css' -o -name '*.glsl' -o -name '*.html' \) | sort)

# Which rooms a room may include; its own is understood. Rooms of one layer meet through concepts.hpp.
includes_of_higher_layers() {
  # shellcheck disable=SC2086
  awk '
  BEGIN {
    words = "base geometry hit pulse echo reflection"
    may["base"] = "version"
    may["geometry"] = may["pulse"] = "base"
    may["hit"] = "base geometry"
    may["echo"] = may["hit"] " hit"
    may["reflection"] = may["echo"] " echo pulse"
    may["refinements"] = words
    may["material"] = "base geometry hit"
    may["concepts"] = words " refinements material"
    may["accel"] = may["detector"] = may["cloud"] = may["stage_arguments"] = may["pulse_lanes"] = words " concepts"
    may["scanner"] = words " concepts pulse_lanes"
    may["deflector"] = may["platform"] = words " concepts pulse_lanes stage_arguments"
    may["shape"] = words " concepts accel material"
    may["scene"] = may["shape"] " shape"
    may["transport"] = may["scene"] " scene scanner detector"
    may["sensor"] = words " concepts pulse_lanes stage_arguments scanner deflector detector platform"
    may["survey"] = may["scene"] " scene scanner deflector platform detector transport cloud stage_arguments pulse_lanes"
    may["any_survey"] = may["result_buffer"] = words " concepts"
    may["sample"] = words " concepts result_buffer any_survey"
    may["detail"] = may["sample"] " sample"
    may["run_errors"] = may["detail"] " detail"
    may["forecast"] = may["accuracy"] = may["run_errors"] " run_errors"
    may["run"] = may["uncertainty"] = may["survey"] " survey result_buffer detail"
    may["sensor_kit"] = may["run"] " run any_survey"
    may["pulsecast"] = may["run"] " run any_survey sample run_errors forecast accuracy uncertainty version"
    may["io"] = may["pulsecast"] " sensor"
    may["helios"] = may["mpi"] = may["page"] = may["python"] = may["io"] " io"
    may["version"] = ""
  }
  FNR == 1 { room = FILENAME; sub(/^include\/pulsecast\//, "", room); sub(/[\/.].*/, "", room)
             if (!(room in may)) print FILENAME ": there is no room `" room "`" }
  /^#include <pulsecast\// {
    other = $2; sub(/^<pulsecast\//, "", other); sub(/[\/.].*/, "", other)
    if (other != room && index(" " may[room] " ", " " other " ") == 0) print FILENAME ":" FNR ": " $0
  }' $headers
}
rule 'a header includes only from layers below its own' includes_of_higher_layers

# What stands in a detail/ is its own room's; that of geometry/ serves what answers rays.
includes_of_other_details() {
  # shellcheck disable=SC2086
  awk '
  FNR == 1 { room = FILENAME; sub(/^include\/pulsecast\//, "", room); sub(/[\/.].*/, "", room) }
  /^#include <pulsecast\/[a-z_]*\/detail\// {
    other = $2; sub(/^<pulsecast\//, "", other); sub(/\/.*/, "", other)
    if (other != room && !(other == "geometry" && room ~ /^(accel|shape|scene)$/)) print FILENAME ":" FNR ": " $0
  }' $headers
}
rule "no room includes another's detail/" includes_of_other_details

# Greps headers: found PATTERN [EXCEPTION], where EXCEPTION is a pattern of headers that may.
found() {
  # shellcheck disable=SC2086
  grep -nE "$1" $headers | grep -vE "^include/pulsecast/(${2:-no exception}):?"
}
rule 'GLM is named in base/vector.hpp only' found '<glm/|glm::' 'base/vector\.hpp'
rule 'threads live in run.hpp, its reorder buffer and three headers of base/ only' found \
     '#include <(thread|mutex|shared_mutex|condition_variable|atomic|future|semaphore|barrier|latch)>' '(run|detail/reorder_buffer|base/(parallel|scratch_memory|thread_pool)|page/(server|detail/local_server)|python/bind)\.hpp'
rule 'files are for the rooms beside the core' found '#include <(fstream|filesystem|cstdio|stdio\.h)>' '(io|helios|mpi|page|python)/[^:]*'
rule 'degrees and nanoseconds are for the rooms beside the core' found '[a-z]_(deg|ns)\>[^(]*[;=]' '(io|helios|mpi|page|python)/[^:]*|base/units\.hpp'
rule 'the library never prints and never exits' found '#include <iostream>|std::(cout|cerr|clog|exit|abort|terminate)\>|printf *\('
rule 'random numbers come from base/random.hpp only' found '#include <random>|\<s?rand *\('
rule 'lines and numbers are read from text by base/text.hpp only' found 'from_chars|\<(sto(d|f|i|u?ll?)|strto[a-z]+|ato[fil]|getline) *\(|xEF.xBB' 'base/text\.hpp'
rule 'concepts, never enable_if' found 'enable_if'
rule 'an optional member has a concept of its own' found \
     'if constexpr \((.*[ (!])?requires *[({]|constexpr bool [a-z_]+ = requires|requires requires|requires \{ requires'

# What a header reaches stays as it is: an include that another one brings is a line that says nothing. Those that a comment explains may
# stand, and two headers list others: the contract and the umbrella.
repeated_includes() {
  # shellcheck disable=SC2086
  awk '
  function visit(header, top,    n, k, names) {
    n = split(includes[header], names, " ")
    for (k = 1; k <= n; ++k)
      if (!((top, names[k]) in reached)) {
        reached[top, names[k]] = 1
        visit(names[k], top)
      }
  }
  FNR == 1 { depth = 0; header = substr(FILENAME, 9) }
  /^#if/ { ++depth }
  /^#endif/ { --depth }
  depth == 1 && match($0, /^#include <[^>]*>/) {
    name = substr($0, 11, RLENGTH - 11)
    includes[header] = includes[header] name " "
    if (RLENGTH == length($0) && name !~ /\.h$|^[^p].*\//) bare[header, name] = 1
  }
  END {
    for (header in includes) {
      n = split(includes[header], names, " ")
      for (k = 1; k <= n; ++k) visit(names[k], names[k])
      for (k = 1; k <= n; ++k)
        for (j = 1; j <= n; ++j)
          if ((header, names[k]) in bare && j != k && (names[j], names[k]) in reached)
            print "include/" header ": " names[k] " comes with " names[j]
    }
  }' $headers | grep -vE '^include/pulsecast/(concepts|pulsecast)\.hpp' | sort
}
rule 'a header includes nothing that its other includes bring' repeated_includes

# The single header keeps the guards of the headers that it holds, and so goes with all others in either order.
without_guard() {
  # shellcheck disable=SC2086
  awk '
  function finish() { if (file && (guards != 2 || last != "#endif")) print file ": " guard }
  FNR == 1 { finish(); file = FILENAME; guards = 0
             guard = toupper(file); sub(/^INCLUDE\//, "", guard); gsub(/[\/.]/, "_", guard) }
  FNR == 3 && $0 == "#ifndef " guard || FNR == 4 && $0 == "#define " guard { ++guards }
  /^#pragma once/ { guards = 0 }
  { last = $0 }
  END { finish() }' $headers
  echo "$headers" | tr '/' '_' | sort | uniq -d
}
rule 'a header has the include guard of its path' without_guard

# shellcheck disable=SC2086
rule 'a header has at most 350 lines' awk 'FNR == 351 { print FILENAME }' $headers

# A function begins with its statement, as clang-format sets it: at the line after the end of another. A body ends with its closing brace.
# The test of a packet of triangles is one loop over lanes, which parts would slow down.
long_functions() {
  find include examples bench tests/support -name '*.[ch]pp' -o -name '*.js' | sort | xargs awk -v limit=60 '
  FNR == 1 { depth = 0; statement = raw = ""; split("", begin); split("", name) }
  {
    line = $0
    if (raw != "") {  # in a raw string
      at = index(line, raw)
      if (at == 0) next
      line = "\"\"" substr(line, at + length(raw))
      raw = ""
    }
    gsub(/\\./, "", line)
    gsub(FILENAME ~ /js$/ ? "'"'[^']*'"'" : "'"'[^']'"'", "0", line)
    if (match(line, /R"[^(]*\(/)) {
      end = ")" substr(line, RSTART + 2, RLENGTH - 3) "\""
      if (index(line, end) == 0) raw = end
      line = substr(line, 1, RSTART - 1) "0" (raw == "" ? substr(line, index(line, end) + length(end)) : "")
    }
    gsub(/"[^"]*"/, "0", line)
    sub(/ *\/\/.*/, "", line)
    sub(/^ +/, "", line)
    if (line == "" || line ~ /^#|^(public|private|protected):$/) { statement = ""; next }
    if (statement == "") first = FNR
    statement = statement line " "
    while (gsub(/{[^{}]*}/, "", line)) continue
    closed = gsub(/}/, "}", line)
    opened = gsub(/{/, "{", line)
    for (d = depth; d > depth - closed; --d)
      if (d in begin) {
        if (name[d] != "" && FNR - begin[d] >= limit) print FILENAME ":" begin[d] ": " FNR - begin[d] + 1 " lines: " name[d]
        delete begin[d]
      }
    depth += opened - closed
    if (line ~ /{$/) {
      sub(/^} */, "", statement)
      begin[depth] = first
      name[depth] = statement
      if (statement !~ /\(/ || statement ~ /[=({,] *{ $/ || statement ~ /^(template <.*> )?(struct|class|union|enum) / ||
          statement ~ /^(if|for|while|switch|do|else|catch|try|namespace|case|return) /) name[depth] = ""
      sub(/ {.*/, "", name[depth])
    }
    if (line ~ /[;{}]$/) statement = ""
  }' | grep -v '^include/pulsecast/geometry/triangle.hpp:.* void intersect(const TrianglePacket&'
}
rule 'a function has at most 60 lines' long_functions

# shellcheck disable=SC2086
rule 'a file begins with two SPDX lines' awk '
  FNR <= 3 && /SPDX-FileCopyrightText: / { holder[FILENAME] = 1 }
  FNR <= 3 && /SPDX-License-Identifier: MIT( \*\/| -->)?$/ { licence[FILENAME] = 1 }
  END { for (i = 1; i < ARGC; ++i) if (!(ARGV[i] in holder && ARGV[i] in licence)) print ARGV[i] }' $sources

# shellcheck disable=SC2046
rule 'no statements joined by commas' awk -f tests/structure/commas.awk $(echo "$sources" | grep '\.[ch]pp$')

# shellcheck disable=SC2086
rule 'no open ends in the tree' grep -nE 'TO''DO|FIX''ME|(^|[^X])XX''X([^X]|$)' $sources

absolute_paths() {
  absolute='(^|[^A-Za-z0-9_.])/(home|root|work|tmp)/'
  # shellcheck disable=SC2086
  grep -nE "$absolute" $sources
  find . \( -path ./.git -o -path ./build \) -prune -o -type f \( -name '*.md' -o -name '*.json' \) -exec grep -HnE "$absolute" {} +
}
rule 'no absolute paths' absolute_paths

# The umbrella is the contract, and what most surveys need: bench/include_cost.sh says what it costs.
missing_in_umbrella() {
  for header in concepts cloud echo pulse run survey; do
    grep -qxF "#include <pulsecast/$header.hpp>" include/pulsecast/pulsecast.hpp || echo "include/pulsecast/$header.hpp"
  done
}
rule 'pulsecast.hpp includes the contract and the pipeline' missing_in_umbrella

# The other half of a header: change the prefix.
without_test() {
  for header in $headers; do
    case $header in */pulsecast.hpp | */version.hpp | */detail/*) continue ;; esac
    test=${header#include/pulsecast/}
    test=tests/${test%.hpp}.cpp
    [ -f "$test" ] || echo "$header has no $test"
  done
}
rule 'every header has its test' without_test

# A target with a library of its own brings the headers that include that library.
claimed=$(sed -n 's/^set(pulsecast_[a-z_]*_headers \(.*\))$/\1/p' CMakeLists.txt | tr '\n' ' ')
with_library=$(sed -n 's/^set(pulsecast_\([a-z_]*\) .*/\1/p' CMakeLists.txt | tr '\n' ' ')
unclaimed_includes() {
  without=
  for header in $(find include/pulsecast/io include/pulsecast/helios include/pulsecast/mpi include/pulsecast/page include/pulsecast/python -name '*.hpp'); do
    name=${header#include/pulsecast/}
    name=${name%.hpp}
    case " $claimed" in *" $name "* | *" ${name%/*}/* "*) continue ;; esac
    case " $with_library" in *" ${name%%/*} "*) continue ;; esac
    without="$without $header"
  done
  # shellcheck disable=SC2086
  grep -HnE '^#include (<.*[/.].*>|")' $without | grep -vE '#include <(pulsecast/|(fcntl|time|unistd|netinet/in|linux/(audit|filter|seccomp)|sys/(file|mman|prctl|resource|socket|stat|syscall|wait))\.h>)'
}
rule 'CMakeLists.txt knows what a header needs' unclaimed_includes

# The table of targets is the list of the public headers beside the core.
differences_of_table() {
  for header in include/pulsecast/io/*.hpp include/pulsecast/helios/*.hpp include/pulsecast/mpi/*.hpp include/pulsecast/page/*.hpp include/pulsecast/python/*.hpp; do
    name=${header#include/pulsecast/}
    grep -q "^|.*\`${name%.hpp}\`" docs/architecture.md || echo "$header"
  done
  sed -n '/^| target/,/^$/p' docs/architecture.md | grep -oE '`(io|helios|mpi|page|python)/[a-z_]+`' | tr -d '`' | while read -r name; do
    [ -f "include/pulsecast/$name.hpp" ] || echo "docs/architecture.md: there is no $name.hpp"
  done
}
rule 'the table of targets lists the public headers' differences_of_table

# shellcheck disable=SC2046
rule 'every public name stands on a page' awk -f tests/structure/public_names.awk README.md docs/*.md $(echo "$headers" | grep -v /detail/)

# Links from page to page, to headings of them, and to other files of the tree.
# shellcheck disable=SC2046
rule 'every link of a page leads somewhere' awk -f tests/structure/links.awk ./*.md $(find docs -name '*.md')

# shellcheck disable=SC2046
rule 'a page has at most 5,000 words' awk '
  FNR == 1 { words = 0 }
  (words += NF) > 5000 { print FILENAME ":" FNR; nextfile }' README.md CONTRIBUTING.md $(find docs -name '*.md' -not -path 'docs/tables/*')

# Every picture is shown and drawn by the gallery.
undrawn_pictures() {
  commands=$(awk '/^```/ { inside = !inside } inside' docs/gallery.md)
  for picture in docs/pictures/*; do
    name=${picture##*/}
    grep -qF "](pictures/$name)" docs/gallery.md && echo "$commands" | grep -qw "${name%.*}" || echo "$picture"
  done
}
rule 'docs/gallery.md shows every picture, and has the command of each' undrawn_pictures

# Every C++ block of the README is a whole example, without its licence lines.
blocks=$(mktemp -d) || exit 2
trap 'rm -rf "$violations" "$blocks"' EXIT
awk -v folder="$blocks" '/^```/ && inside { inside = 0; close(file); next }
                         inside { print > file }
                         /^```cpp$/ { inside = 1; file = folder "/" NR }' README.md
program() { sed 1,2d "$1" | sed '/./,$!d'; }
blocks_without_program() {
  for block in "$blocks"/*; do
    [ -f "$block" ] || continue
    for example in examples/*.cpp; do
      program "$example" | cmp -s - "$block" && continue 2
    done
    echo "README.md:${block##*/}: this block is no program in examples/"
  done
}
rule 'the code in the README is compiled' blocks_without_program
embed_without_block() {
  for block in "$blocks"/*; do
    program examples/embed.cpp | cmp -s - "$block" && return
  done
  echo examples/embed.cpp
}
rule 'the README shows examples/embed.cpp' embed_without_block

# Whoever asks for an older minor version gets none: the package's version file refuses it.
other_versions() {
  version=$(sed -nE 's/^#define PULSECAST_VERSION "(.*)"$/\1/p' include/pulsecast/version.hpp)
  grep -HnoE 'find_package\(pulsecast [0-9.]+' README.md docs/*.md docs/packaging/* tests/package/*.txt 2> /dev/null | grep -vF "pulsecast ${version%.*}"
  sed -nE 's/^## ([0-9.]+).*/CHANGELOG.md: \1/p' CHANGELOG.md | head -n 1 | grep -vxF "CHANGELOG.md: $version"
  grep -HnE '"?version"?[ =:]+"' CITATION.cff docs/packaging/*/*.py docs/packaging/*/*/*.json | grep -vF "\"$version\""
}
rule 'every page and recipe states the version of version.hpp' other_versions

if [ -s "$violations" ]; then
  cat "$violations"
  exit 1
fi
echo "The structure is as promised: $(echo "$headers" | wc -l) headers."
