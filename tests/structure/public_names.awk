# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Prints the names that headers declare at namespace scope, outside of any namespace `detail`, and that no page has as a word. Relies on
# clang-format: such a declaration begins in the first column. Usage: awk -f public_names.awk PAGE.md... HEADER...
FILENAME ~ /\.md$/ {
  gsub(/[^A-Za-z_0-9]+/, " ")
  for (i = 1; i <= NF; ++i) said[$i] = 1
  next
}
FNR == 1 { depth = hidden = 0 }
/^(inline )?namespace .*[^}]$/ {
  ++depth
  if (/[ :]detail {/ && !hidden) hidden = depth
  next
}
/^}  \/\/ namespace/ {
  if (hidden == depth) hidden = 0
  --depth
  next
}
hidden || /^($|[ \/#}:)>]|namespace|public|private|protected|static_assert|extern|friend|PULSECAST_UNIT|[a-z_0-9]+(\/[A-Za-z]+)?(\[\])? [a-z_]+$|using enum)/ { next }
{
  line = $0
  gsub(/\[\[[^]]*\]\] */, "", line)
  sub(/ *\/\/.*/, "", line)
  sub(/^template <.*> /, "", line)
  sub(/^requires.*\) using /, "using ", line)
  if (line ~ /^requires|>::/) next  # of a member: a definition outside its class
  if (match(line, /^PULSECAST_OPTIONAL_[A-Z]*\([A-Za-z]+/)) {
    name = substr(line, RSTART, RLENGTH)
  } else if (match(line, /^(struct|class|union|enum class|enum|concept|using) (alignas\([^)]*\) )?[A-Za-z_0-9]+/)) {
    name = substr(line, RSTART, RLENGTH)
    if (substr(line, RSTART + RLENGTH) ~ /^(<|::|;)/) next  # specialization, forward declaration
  } else {
    sub(/ = .*|{.*/, "", line)
    while (sub(/<[^<>()]*>/, "", line)) continue
    if (match(line, /[ &*][A-Za-z_0-9]+\(/)) name = substr(line, RSTART + 1, RLENGTH - 2)
    else if (match(line, /^(inline |constexpr |const )+.*[ &*][A-Za-z_0-9]+;?$/)) name = substr(line, RSTART, RLENGTH)
    else next
  }
  gsub(/.*[ (&*]|;/, "", name)
  if (name ~ /^[a-zA-Z]/ && name !~ /^(operator|PULSECAST_)/ && !(name in said)) print FILENAME ":" FNR ": " name
}
