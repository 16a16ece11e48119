# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Lists the names that headers declare at namespace scope, outside of any namespace `detail`: `HEADER:LINE: NAME`, one for each name of a header.
# Relies on clang-format: such a declaration begins in the first column. Usage: awk -f public_names.awk HEADER...
FNR == 1 { depth = hidden = 0 }
/^(inline )?namespace .*{$/ { ++depth; if (/[ :]detail {$/ && !hidden) hidden = depth; next }
/^}  \/\/ namespace/ { if (hidden == depth) hidden = 0; --depth; next }
/^namespace .*{}/ { next }
hidden || /^($|[ \/#}:)]|public|private|protected|static_assert|extern|friend|requires|PULSECAST_UNIT)/ { next }
{
  line = $0
  gsub(/\[\[[^]]*\]\] */, "", line)
  sub(/ *\/\/.*/, "", line)
  if (line ~ /^template <.*>$/ || line ~ /^template <[^>]*,$/) next
  name = ""
  if (match(line, /^PULSECAST_OPTIONAL_[A-Z]*\([A-Za-z]+/)) {
    name = substr(line, RSTART, RLENGTH); sub(/.*\(/, "", name)
  } else if (match(line, /^(template <.*> )?(struct|class|union|enum class|enum|concept|using) (alignas\([^)]*\) )?[A-Za-z_0-9]+/)) {
    name = substr(line, RSTART, RLENGTH); sub(/.* /, "", name)
    rest = substr(line, RSTART + RLENGTH)
    if (rest ~ /^[<:]+[^ ]/ || rest ~ /^;/ || name == "namespace") next  # specialization, forward declaration
  } else if (line ~ /\) *->.*;$/ && line !~ /[ ]auto |^auto /) {
    next  # deduction guide
  } else {
    sub(/ = .*|{.*/, "", line)
    while (sub(/<[^<>()]*>/, "", line)) continue
    if (match(line, /[ &*][A-Za-z_0-9]+\(/)) { name = substr(line, RSTART + 1, RLENGTH - 2) }
    else if (line ~ /^(inline |constexpr |const )+/ && match(line, /[a-z_0-9A-Z]+;?$/)) { name = substr(line, RSTART, RLENGTH); sub(/;/, "", name) }
    else { if (debug) print "?? " FILENAME ":" FNR ": " $0; next }
  }
  if (name ~ /^PULSECAST_|^operator/ || (FILENAME, name) in seen) next
  seen[FILENAME, name] = 1
  print FILENAME ":" FNR ": " name
}
