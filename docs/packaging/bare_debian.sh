#!/bin/sh
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Installs the Debian package, or the wheel, on a bare Debian 12, and uses what it brings: program, man page, catalogue, Python module, headers.
# The wheel has python3-venv and python3-numpy there, no compiler and no network. Needs root, debootstrap and a mirror of Debian; takes a few
# minutes. Usage: bare_debian.sh PACKAGE.deb [FOLDER], or PACKAGE.whl; the system is left in FOLDER, if that is given, and taken from there the next time.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
package=$1
root=${2:-$(mktemp -d)}
leave() {
  umount "$root/proc" || return
  [ -n "$kept" ] || rm -rf "$root"
}
kept=${2:-}
[ -d "$root/usr" ] || debootstrap --variant=minbase bookworm "$root"
mount -t proc proc "$root/proc"
trap leave EXIT

within() { chroot "$root" env LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive HOME=/root sh -euc "$1"; }
step() { printf '\n=== %s\n' "$1"; }

rm -rf "$root/opt/try"
mkdir -p "$root/opt/try"
cat > "$root/opt/try/floor.obj" <<'OBJ'
v -50 -50 0
v 50 -50 0
v 50 50 0
v -50 50 0
f 1 2 3 4
OBJ
cat > "$root/opt/try/survey.xml" <<'XML'
<document>
  <scene id="floor" name="floor"><part id="1"><filter type="objloader"><param type="string" key="filepath" value="floor.obj"/></filter></part></scene>
  <survey name="bare" scene="#floor" platform="data/platforms.xml#tripod" scanner="data/scanners_tls.xml#riegl_vz400" seed="1">
    <leg><platformSettings x="0" y="0" z="0"/><scannerSettings pulseFreq_hz="100000" scanFreq_hz="50" headRotatePerSec_deg="60" headRotateStop_deg="60"/></leg>
  </survey>
</document>
XML

case $package in
  *.whl)
    step "the wheel, offline"
    within 'apt-get update -qq && apt-get install --yes -qq --no-install-recommends python3-venv python3-numpy > /dev/null'
    cp "$package" "$here/../../tests/package/check_wheel.sh" "$root/opt/try/"
    unshare --net chroot "$root" env LC_ALL=C.UTF-8 HOME=/root sh /opt/try/check_wheel.sh "/opt/try/$(basename "$package")" /opt/try/wheel
    exit
    ;;
esac

step "installing"
cp "$package" "$root/opt/try/pulsecast.deb"
cp "$here/../../examples/embed.cpp" "$here/../../tests/examples/python/typed_survey.py" "$root/opt/try/"
within 'apt-get update -qq && apt-get install --yes -qq --no-install-recommends /opt/try/pulsecast.deb'

step "program, man page, catalogue"
within 'pulsecast --version; pulsecast-import --version; test -s /usr/share/man/man1/pulsecast.1*; pulsecast catalogue | grep -q riegl_vz400; pulsecast doctor'

step "a survey with the catalogue"
within 'cd /opt/try && pulsecast survey.xml --format laz --output out --threads 1 --quiet && ls out/bare/*/*.laz'

step "Python"
within 'cd /opt/try && python3 -c "
import pulsecast
survey = pulsecast.read_survey(\"survey.xml\")
points = pulsecast.Simulation(survey, assets=[\".\"]).run().points
print(len(points), \"points\", points.dtype.names)
assert len(points) > 10_000 and abs(points[\"z\"]).max() < 0.1
" && python3 typed_survey.py && test -s /usr/lib/python3/dist-packages/pulsecast/_core.pyi'

step "a program of a user's own"
cat > "$root/opt/try/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(user LANGUAGES CXX)
find_package(pulsecast 0.3 REQUIRED COMPONENTS io)
add_executable(embed embed.cpp)
target_link_libraries(embed PRIVATE pulsecast::pulsecast pulsecast::io)
CMAKE
within 'apt-get install --yes -qq --no-install-recommends g++ cmake make > /dev/null
cd /opt/try && cmake -B build -DCMAKE_BUILD_TYPE=Release > /dev/null && cmake --build build && build/embed'

step "removing"
within 'apt-get purge --yes -qq pulsecast && ! ls /usr/lib/python3/dist-packages/pulsecast /usr/include/pulsecast 2> /dev/null'
