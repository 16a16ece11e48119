#!/bin/sh
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Breaks copies of the tree, one promise at a time, and fails if check.sh misses one. Usage: check_notices.sh [ROOT]
set -u
root=$(cd "${1:-.}" && pwd) || exit 2
copy=$(mktemp -d) || exit 2
trap 'rm -rf "$copy"' EXIT
missed=0
tried=0

fresh() {
  rm -rf "$copy/tree" && mkdir "$copy/tree" && cd "$copy/tree" || exit 2
  cp -R "$root/include" "$root/examples" "$root/tests" "$root/bench" "$root/.ci" "$root/CMakeLists.txt" . || exit 2
  mkdir docs && cp -R "$root"/docs/*.md "$root/docs/packaging" "$root/docs/tables" "$root/docs/for" "$root/docs/tutorials" docs && ln -s "$root/docs/pictures" docs || exit 2
  cp "$root"/*.md "$root"/*.json "$root"/*.cff . 2> /dev/null
}

# notices RULE COMMAND: check.sh says RULE once COMMAND was run in a copy, and does not say it of the tree as it is. Of the copy, the check
# asks for this rule alone.
notices() {
  tried=$((tried + 1))
  if grep -qF "$1: " "$copy/before"; then
    echo "already broken: $1"
    missed=1
  fi
  fresh
  eval "$2"
  if ! sh tests/structure/check.sh . "$1" | grep -qF "$1: "; then
    echo "not noticed: $1, after: $2"
    missed=1
  fi
}

fresh
sh tests/structure/check.sh . > "$copy/before"

below='a header includes only from layers below its own'
add='sed -i "/^#define PULSECAST_.*_HPP/a'
notices "$below" "$add #include <pulsecast/concepts.hpp>\" include/pulsecast/base/frame.hpp"
notices "$below" "$add #include <pulsecast/scanner/scanner.hpp>\" include/pulsecast/platform/platform.hpp"
notices "$below" "$add #include <pulsecast/scene/scene.hpp>\" include/pulsecast/detector/radiometry.hpp"
notices "$below" "$add #include <pulsecast/io/las.hpp>\" include/pulsecast/run.hpp"
notices "$below" "$add #include <pulsecast/page/page.hpp>\" include/pulsecast/mpi/run.hpp"
notices "no room includes another's detail/" "$add #include <pulsecast/io/detail/las/settings.hpp>\" include/pulsecast/mpi/las.hpp"
notices 'the table of targets lists the public headers' 'cp include/pulsecast/io/las.hpp include/pulsecast/io/other.hpp'
notices 'the table of targets lists the public headers' 'rm include/pulsecast/io/text_files.hpp'
notices "$below" "mkdir include/pulsecast/utils && cp include/pulsecast/pulse.hpp include/pulsecast/utils"
notices 'GLM is named in base/vector.hpp only' "echo 'inline glm::dvec3 v;' >> include/pulsecast/pulse.hpp"
threads='threads live in run.hpp, its reorder buffer and three headers of base/ only'
notices "$threads" "$add #include <mutex>\" include/pulsecast/survey.hpp"
notices "$threads" "$add #include <thread>\" include/pulsecast/base/shared_array.hpp"
notices 'files are for the rooms beside the core' "$add #include <fstream>\" include/pulsecast/survey.hpp"
notices 'degrees and nanoseconds are for the rooms beside the core' "echo 'inline double angle_deg = 1;' >> include/pulsecast/pulse.hpp"
notices 'the library never prints and never exits' "echo 'inline void f() { std::exit(1); }' >> include/pulsecast/pulse.hpp"
notices 'random numbers come from base/random.hpp only' "$add #include <random>\" include/pulsecast/io/text_files.hpp"
text_rule='lines and numbers are read from text by base/text.hpp only'
notices "$text_rule" "echo 'inline double f() { return std::stod(\"1\"); }' >> include/pulsecast/io/las.hpp"
notices "$text_rule" "echo 'inline const char* mark = \"\\xEF\\xBB\\xBF\";' >> include/pulsecast/io/las.hpp"
notices 'concepts, never enable_if' "echo 'template <class T, class = std::enable_if_t<true>> struct A;' >> include/pulsecast/echo.hpp"
hook='an optional member has a concept of its own'
notices "$hook" "echo 'void f(const auto& a) { if constexpr (requires { a.soon(); }) a.soon(); }' >> include/pulsecast/echo.hpp"
notices "$hook" "echo 'template <class T> constexpr bool soon = requires(T a) { a.soon(); };' >> include/pulsecast/echo.hpp"
notices "$hook" "echo 'template <class T> requires requires(T a) { a.soon(); } void f(T);' >> include/pulsecast/echo.hpp"
notices 'a header includes nothing that its other includes bring' "$add #include <pulsecast/base/vector.hpp>\" include/pulsecast/shape/mesh_data.hpp"
guard='a header has the include guard of its path'
notices "$guard" 'sed -i "s/PULSECAST_ECHO_HPP/PULSECAST_PULSE_HPP/" include/pulsecast/echo.hpp'
notices "$guard" 'sed -i "/^#endif/d" include/pulsecast/echo.hpp'
notices "$guard" "$add #pragma once\" include/pulsecast/echo.hpp"
notices "$guard" 'mkdir -p include/pulsecast/io/text && cp include/pulsecast/io/text_files.hpp include/pulsecast/io/text/files.hpp'
notices 'a header has at most 350 lines' 'seq 351 | sed "s|^|// |" >> include/pulsecast/echo.hpp'
# long FUNCTION: one of 61 lines
long() {
  echo "$1 {"
  seq 59 | sed 's/.*/  int a{0}, b = "}"[0];  \/\/ }/'
  echo '}'
}
short='a function has at most 60 lines'
notices "$short" "long 'inline int f()' >> include/pulsecast/echo.hpp"
notices "$short" "long 'template <class T> inline T intersect(T t)' >> include/pulsecast/geometry/triangle.hpp"
notices "$short" "long 'A::A() : a_{1}, b_(2)' >> examples/embed.cpp"
notices "$short" "long 'auto f = [](int a) noexcept -> int' >> tests/support/las_reader.hpp"
notices "$short" "long 'function f(a)' >> include/pulsecast/page/web/panel.js"
notices 'a file begins with two SPDX lines' 'sed -i 2d tests/base/frame.cpp'
notices 'a file begins with two SPDX lines' 'sed -i 2d include/pulsecast/page/web/page.css'
notices 'no statements joined by commas' "echo 'inline void f(int& x, int& y) { x = 1, y = 2; }' >> include/pulsecast/echo.hpp"
notices 'no open ends in the tree' 'echo "// TO""DO" >> include/pulsecast/echo.hpp'
notices 'no absolute paths' 'echo "see /ho""me/me" >> CHANGELOG.md'
notices 'pulsecast.hpp includes the contract and the pipeline' 'sed -i "/run.hpp/d" include/pulsecast/pulsecast.hpp'
notices 'every header has its test' 'rm tests/base/frame.cpp'
notices 'CMakeLists.txt knows what a header needs' "$add #include <pugixml.hpp>\" include/pulsecast/io/las.hpp"
public='every public name stands on a page'
notices "$public" "echo 'struct Unmentioned {};' >> include/pulsecast/echo.hpp"
notices "$public" "echo '[[nodiscard]] inline std::array<int, 2> unmentioned(int a) noexcept;' >> include/pulsecast/echo.hpp"
notices "$public" "echo 'template <class T> inline constexpr bool unmentioned = true;' >> include/pulsecast/echo.hpp"
notices "$public" "sed -i 's/LinkBudget//g' docs/*.md"
links='every link of a page leads somewhere'
notices "$links" 'rm docs/tables/extremes.md'
notices "$links" 'sed -i "s/^## Ray queries/## Queries/" docs/scenes.md && echo "[queries](docs/scenes.md#ray-queries)" >> README.md'
notices 'a page has at most 5,000 words' 'cat docs/architecture.md >> docs/io.md'
notices 'docs/gallery.md shows every picture, and has the command of each' 'sed -i s/rotating_head// docs/gallery.md'
notices 'the code in the README is compiled' "printf '\140\140\140cpp\nint x;\n\140\140\140\n' >> README.md"
notices 'the README shows examples/embed.cpp' 'echo "// more" >> examples/embed.cpp'
versions='every page and recipe states the version of version.hpp'
notices "$versions" 'sed -i "s/find_package(pulsecast [0-9.]*/find_package(pulsecast 0.0/" README.md'
notices "$versions" 'sed -i "s/find_package(pulsecast [0-9.]*/find_package(pulsecast 0.0/" tests/package/CMakeLists.txt'
notices "$versions" 'sed -i "0,/^## [0-9.]*/s//## 0.0.1/" CHANGELOG.md'
notices "$versions" 'sed -i "s/version = .*/version = \"0.0.1\"/" docs/packaging/conan/conanfile.py'
notices "$versions" 'sed -i "s/^version: .*/version: \"0.0.1\"/" CITATION.cff'

# commas LINE: what commas.awk prints of a line of C++.
commas() {
  printf '%s\n' "$1" > "$copy/line.cpp"
  awk -f "$root/tests/structure/commas.awk" "$copy/line.cpp"
}
while read -r line; do
  tried=$((tried + 1))
  [ -n "$(commas "void f() { $line }")" ] && continue
  echo "not noticed: $line"
  missed=1
done << 'END'
++x, y = 2;
if (x < y) x = 1, y = 2; else g();
for (;; ++x, --y) g(x), g(y);
switch (x) { case 1: y = 2, x = 3; }
return ++x, y;
throw ++x, y;
g([&] { std::swap(x, y), g(); }, x);
x = (g(x, y), y);
while (g(x), x < y) {}
x = y<0, y = x> 0;
END
while read -r line; do
  [ -z "$(commas "$line")" ] && continue
  echo "no comma operator: $line"
  missed=1
done << 'END'
void f() { for (int i = 0, j = 9; i < j; ++i, --j) g(i, j); }
void f() { double x = 1, y(2), *z = &x; const auto [u, v] = g(x, y); (g(xs), ...); }
void f() { std::map<int, std::pair<int, int>> m, n{{1, {2, 3}}}; m = {{1, {2, 3}}, {4, {5, 6}}}; alignas(64) Column x, y; }
void f() { g(x, [&](int i, int j) -> std::pair<int, int> { return {i, j}; }, y); throw E(x, y); }
void f() { if (const auto [x, y] = g(1, 2); x < y) g("x, y; z", R"(x = 1, y = 2;)", 1'000, ','); } // x, y;
struct S : A, B { S() : x(1), y{2}, z(3) {} };
struct S : A, B { friend bool operator==(const S&, const S&) = default; };
template <class T, class U = int> using P = std::pair<T, U>; enum class E { x, y }; using F = std::function<void(int, int)>;
END

[ $missed = 0 ] && echo "The check notices all $tried violations."
exit $missed
