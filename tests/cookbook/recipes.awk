# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Turns the recipes of pages, docs/cookbook.md first, into a test program. The first block of C++ is common to all; each further block is a test case, named by
# its heading, with at most 15 lines, of a page of extensions 12. A struct with a member template stands before its test case. The expression in a comment `<!-- check: ... -->` after a block must be true at its end.
function finish() {
  cases = cases hoisted
  hoisted = ""
  if (body != "") cases = cases "\nTEST_CASE(\"" heading "\") {\n  const support::Kitchen kitchen;\n" body "}\n"
  body = ""
}
FNR == 1 { limit = $2 == "Extensions" ? 12 : 15 }
/^#+ / { finish(); heading = $0; sub(/^#+ /, "", heading) }
/^```cpp$/ { inside = 1; lines = 0; if (++blocks > 1) body = "#line " FNR + 1 " \"" FILENAME "\"\n"; next }
/^```$/ && inside {
  inside = 0
  if (blocks > 1 && lines > limit) {
    print FILENAME ":" FNR ": " lines " lines; a recipe has at most " limit > "/dev/stderr"
    failed = 1
    exit 1
  }
  next
}
inside && /^#include / { includes = includes $0 "\n"; if (blocks > 1) body = body "\n"; next }
inside && blocks == 1 { common = common $0 "\n"; next }
inside && /^struct / { held = "#line " FNR " \"" FILENAME "\"\n"; blank = "" }
inside && held != "" {
  held = held $0 "\n"
  blank = blank "\n"
  if ($0 != "") ++lines
  if (/^};$/ || /^struct .*};$/) {
    if (held ~ /auto& [a-z]+\) const noexcept/) { hoisted = hoisted "\n" held; body = body blank } else body = body substr(held, index(held, "\n") + 1)
    held = ""
  }
  next
}
inside { body = body $0 "\n"; if ($0 != "") ++lines; next }
/^<!-- check: .* -->$/ {
  sub(/^<!-- check: /, ""); sub(/ -->$/, "")
  body = body "#line " FNR " \"" FILENAME "\"\n  CHECK((" $0 "));\n"
}
END {
  if (failed) exit 1
  finish()
  printf "#include <doctest/doctest.h>\n#include \"cookbook/kitchen.hpp\"\n%s\nnamespace cookbook {\n%s%s}  // namespace cookbook\n", includes, common, cases
}
