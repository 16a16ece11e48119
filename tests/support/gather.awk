# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Joins test sources to one translation unit: the headers that they include, each once, then every source in a namespace of its own.
# Messages and the names of tests keep file and line. Usage: awk -f gather.awk SOURCE...
FNR == 1 { source = FILENAME; sources[++count] = source }
/^#include / {
  if (!($0 in included)) {
    included[$0] = 1
    print
  }
  $0 = ""
}
/^namespace pulsecast/ {  # names of the room stay in reach
  sub(/^namespace [a-z_:]+/, "&::gathered_" count)
  inside[source] = 1
}
/^namespace PULSECAST_NAMESPACE/ { inside[source] = 1 }  # macros of the library expand in its own namespace only
{ text[source] = text[source] $0 "\n" }
END {
  for (i = 1; i <= count; ++i) {
    source = sources[i]
    printf "%s\n#line 1 \"%s\"\n%s%s\n", inside[source] ? "" : "namespace gathered_" i " {", source, text[source], inside[source] ? "" : "}"
  }
}
