# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Prepares a header or the README for Doxygen: `awk -f docs/reference_filter.awk HEADER`. Lines keep their numbers.
# - Functions that a concept or convention explains once for all of its models are given that explanation.
# - Links of the README to other files, which the reference does not have, become their text.
# - A comment after several variables of one declaration is given to each of them.
BEGIN {
  says["validate"] = "Refuses settings outside of their limits. Errors: `SettingError`."
  says["operator=="] = "Compares member by member."
  says["archive"] = "Names the members that a scene cache keeps."
  says["memory"] = "Memory that this occupies [bytes]."
  says["bounds"] = "Smallest box around all that can be met [m]."
  of["at"] = "Motion"; of["open"] = "Gated"; of["pulse"] = of["duration"] = "PulseSource"; of["share"] = of["offset"] = "Footprint"
  of["closest"] = "Target, and as the concept Geometry,"; of["surface"] = of["material_count"] = "Geometry"; of["order"] = "Accelerator"
  of["workspace"] = of["detect"] = "Detector"; of["width"] = "EchoWidth"
  for (name in of) says[name] = "As the concept " of[name] " requires."
  says["size"] = "Number of elements."
  says["sample_interval"] = "Time between two samples of a waveform [s]."
}
FILENAME ~ /\.md$/ {
  while (match($0, /\]\((docs\/[A-Za-z\/_-]*(\.md|\.ipynb)|examples\/[a-z_.]*|[A-Z]*\.md)\)/)) {
    start = RSTART
    length_of_link = RLENGTH
    match(substr($0, 1, start), /.*\[/)
    $0 = substr($0, 1, RLENGTH - 1) substr($0, RLENGTH + 1, start - RLENGTH - 1) substr($0, start + length_of_link)
  }
  print
  next
}
{
  line = $0
  documented = before ~ /^ *\/\/\// || before ~ /^ *template <.*>$/ || line ~ /\/\/\/</
  if (!documented && match(line, /^ +(\[\[[a-z:]+\]\] |static |constexpr |friend |inline )*[A-Za-z_][A-Za-z0-9_:<>, ]*[&* ]+[a-z_]+(==)?\(/)) {
    name = substr(line, RSTART, RLENGTH - 1)
    sub(/.*[&* ]/, "", name)
    if (name in says && line !~ /^ *(return|else|throw|if|for) /) {
      match(line, /^ +/)
      line = substr(line, 1, RLENGTH) "/** " says[name] " */ " substr(line, RLENGTH + 1)
    }
  } else if (match(line, /; *\/\/\/< /) && line ~ /^ +[A-Za-z_][A-Za-z0-9_:<>]* [a-z_]+[^(;]*, [a-z_]/ ) {
    text = substr(line, RSTART + RLENGTH)
    list = substr(line, 1, RSTART - 1)
    match(list, /^ +[A-Za-z_][A-Za-z0-9_:<>]* /)
    type = substr(list, 1, RLENGTH)
    if (list !~ /[{(]/ && type !~ /</) {
      n = split(substr(list, RLENGTH + 1), one, /, /)
      line = ""
      for (i = 1; i <= n; ++i) line = line type one[i] "; /**< " text " */ "
    }
  }
  print line
  before = $0
}
