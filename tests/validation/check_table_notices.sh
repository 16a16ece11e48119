#!/bin/sh
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Breaks a page, one cell at a time, and fails if check_table.sh misses it, or takes another rounding for a fault.
set -u
here=$(cd "$(dirname "$0")" && pwd) || exit 2
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
missed=0

cat > "$work/test_fake" << 'END'
#!/bin/sh
echo '| a slope | closed form | 2.000 | 2.003 | 3.1e-03 | 0.01 |'
echo 'a line of the test program'
echo '| a zero | closed form | 0.0000000 | 3.0e-17 | 3.0e-17 | 1e-06 |'
echo '| a count | consistency | 7 | 7 | 0 | 0 |'
echo '| a limit | refused | Laser::divergence is 31, but must be at most 30 | | |'
END
chmod +x "$work/test_fake"

fresh() {
  cat > "$work/page.md" << 'END'
# A page

| case | kind | expected | simulated | error | tolerance |
|---|---|---:|---:|---:|---:|
| a slope | closed form | 2.000 | 2.003 | 3.1e-03 | 0.01 |
| a zero | closed form | 0.0000000 | 3.0e-17 | 3.0e-17 | 1e-06 |
| a count | consistency | 7 | 7 | 0 | 0 |
| a limit | refused | Laser::divergence is 31, but must be at most 30 | | |
END
}

# passes|notices COMMAND: check.sh finds the page as it should, or not, once COMMAND was run on it.
passes() {
  fresh
  eval "$1"
  sh "$here/check_table.sh" "$work/test_fake" "$work/page.md" > "$work/said" && return
  echo "taken for a fault, after: $1"
  cat "$work/said"
  missed=1
}
notices() {
  fresh
  eval "$1"
  sh "$here/check_table.sh" "$work/test_fake" "$work/page.md" > "$work/said" || return
  echo "not noticed, after: $1"
  missed=1
}
change() { sed -i "$1" "$work/page.md"; }

passes true
passes "change 's/2.003 | 3.1e-03/2.004 | 4.0e-03/'"
passes "change 's/3.0e-17 | 3.0e-17/0.0000000 | 0/'"
passes "change 's/3.0e-17 | 3.0e-17/-1.1e-16 | 1.1e-16/'"
notices "change 's/2.003/2.005/'"
notices "change 's/3.1e-03/8.1e-03/'"
notices "change 's/| 2.000/| 2.002/'"
notices "change 's/3.0e-17 | 3.0e-17/2.0e-07 | 2.0e-07/'"
notices "change 's/0.01 |/0.02 |/'"
notices "change 's/| 7 | 7/| 7 | 8/'"
notices "change 's/is 31/is 32/'"
notices "change 's/a slope | closed form/a slope | peer/'"
notices "change 's/a slope/a steep slope/'"
notices "change '/a zero/d'"
notices "change 's/^| a zero.*/&\n&/'"
notices "change '/^|---/d'"
notices "printf '#!/bin/sh\nexit 1\n' > '$work/test_fake'"
cat > "$work/test_fake" << 'END'
#!/bin/sh
echo '| a slope | closed form | 2.000 | 2.100 | 1.0e-01 | 0.01 |'
END
notices "change 's/2.003 | 3.1e-03/2.100 | 1.0e-01/; /a zero/d; /a count/d; /a limit/d'"

fresh
sh "$here/check_table.sh" --update "$work/test_fake" "$work/page.md"
[ "$(grep -c '^|' "$work/page.md")" = 3 ] && [ "$(head -n 1 "$work/page.md")" = '# A page' ] && tail -n 1 "$work/page.md" | grep -q '2.100' ||
  { echo "not written anew:"; cat "$work/page.md"; missed=1; }
exit $missed
