#!/bin/sh
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Meshes of foreign formats come by the program pulsecast-import, and large libraries with it or on demand: the survey program itself loads
# none, and says what is wrong where these are missing or fail. Usage: pulsecast_import.sh PROGRAM SURVEY FOLDER, where FOLDER is emptied.
set -u
export LC_ALL=C
program=$1 survey=$2 folder=$3
rm -rf "$folder"
mkdir -p "$folder/in a folder/bin" || exit 2
cp "$(dirname "$survey")"/plane.* "$folder" || exit 2
cd "$folder" || exit 2
export XDG_CACHE_HOME="$folder/cache"
binaries=$(dirname "$program")

fail() {
  echo "$*"
  exit 1
}

# The plane in other formats, as surveys: mesh.xml NAME.
mesh() {
  sed -e "s/objloader/meshloader/; s/plane\.obj/$1/; s/ onGround=\"true\"//" "$survey" > mesh.xml
}
facet() { printf 'facet normal 0 0 1\nouter loop\nvertex %s\nvertex %s\nvertex %s\nendloop\nendfacet\n' "$@"; }
stl() { printf 'solid plane\n' && facet "$1 -$2 0" "$2 -$2 0" "$2 $2 0" && facet "$1 -$2 0" "$2 $2 0" "$1 $2 0" && printf 'endsolid plane\n'; }
stl -20 20 > plane.stl
cat > "plane.obj" << 'END'
v -20 -20 0
v 20 -20 0
v 20 20 0
v -20 20 0
f 1 2 3
f 1 3 4
END
printf '\0\0\240\301\0\0\240\301\0\0\0\0\0\0\240\101\0\0\240\301\0\0\0\0\0\0\240\101\0\0\240\101\0\0\0\0\0\0\240\301\0\0\240\101\0\0\0\0' > "a b.bin"
printf '\0\0\1\0\2\0\0\0\2\0\3\0' >> "a b.bin"
cat > plane.gltf << 'END'
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}, {"attributes": {"POSITION": 0}, "mode": 0}]}],
 "buffers": [{"uri": "a%20b.bin", "byteLength": 60}],
 "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-20, -20, 0], "max": [20, 20, 0]},
               {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}]}
END

# Points of a survey by a program, without the time in the name of their folder.
points() { # points PROGRAM [OPTION...]
  by=$1
  shift
  rm -rf out
  "$by" mesh.xml --output out --seed 1 --gpsStartTime 0 --format xyz --quiet "$@" || return 1
  cat out/*/*/leg000_points.xyz
}
refused() { # refused PROGRAM WORDS [OPTION...]
  by=$1 words=$2
  shift 2
  "$by" mesh.xml --output refused --quiet "$@" > messages 2>&1
  [ $? = 1 ] || fail "$words: ended with another status than 1"
  grep -q -- "$words" messages || fail "expected '$words', not $(cat messages)"
  [ -z "$(find refused -name '*points*' 2> /dev/null)" ] || fail "$words: left points"
}

mesh plane.obj
expected=$(points "$program" | md5sum)
mesh plane.stl
[ "$(points "$program" | md5sum)" = "$expected" ] || fail "an STL file gives other points than the same OBJ file"
mesh plane.gltf
sed -i 's/value="plane.gltf"/&\/><param type="string" key="up" value="z"/' mesh.xml
"$program" info mesh.xml > scene 2> messages || fail "a glTF file cannot be read: $(cat messages)"
grep -q "x -20.000 to 20.000 m, y -20.000 to 20.000 m, z 0.000 to 0.000 m" scene && grep -q " 2 triangles" scene || fail "a glTF file gives $(cat scene)"
grep -q "points and lines are left out: 4 in all" messages || fail "a warning of the importer is missing: $(cat messages)"
refused "$program" "points and lines are left out" --strict
mv "a b.bin" elsewhere.bin
refused "$program" "could not open referenced file"
mv elsewhere.bin "a b.bin"

# Wherever it is started from: by a link, by PATH, from a folder with a blank in its name.
mesh plane.stl
[ -f "$program-import" ] || fail "there is no $program-import"
ln -s "$program" "in a folder/link"
[ "$(points "$folder/in a folder/link" | md5sum)" = "$expected" ] || fail "it is not found from a link"
[ "$(PATH=$binaries:$PATH points "$(basename "$program")" | md5sum)" = "$expected" ] || fail "it is not found from PATH"
copied="$folder/in a folder/bin/pulsecast"
cp "$program" "$copied"
cp "$program-import" "$copied-import"
for part in "$binaries"/../lib*/pulsecast "$binaries"/../lib*/*/pulsecast; do
  if [ -d "$part" ]; then
    to="$folder/in a folder/$(dirname "${part#"$binaries"/../}")"
    mkdir -p "$to" && cp -r "$part" "$to"
  fi
done
[ "$(points "$copied" | md5sum)" = "$expected" ] || fail "it is not found in a folder with a blank in its name"

# Importers that are not there, of another build, or that fail.
importer() { # importer COMMANDS: a program of these, in place of the importer
  printf '#!/bin/sh\n%s\n' "$1" > "$copied-import"
  chmod +x "$copied-import"
}
importer 'kill -SEGV $$'
refused "$copied" "plane.stl: cannot be imported, as .*in a folder/bin/pulsecast-import does not start"
importer 'exit 0'
refused "$copied" "does not start"
importer 'eval "exec >&$1"; printf "nonsense"'
refused "$copied" "plane.stl: its import ended without a result"
importer 'eval "exec >&$1"; printf "nonsense and more of it, pc done."'
refused "$copied" "plane.stl: its import in a child process gave an inconsistent result"
importer 'eval "exec >&$1"; : > "/proc/self/fd/$1"; kill -SEGV $$'
refused "$copied" "plane.stl: its import ended by signal 11"
importer 'eval "exec >&$1"; : > "/proc/self/fd/$1"; kill -KILL $$'
refused "$copied" "plane.stl: its import was killed"
chmod -x "$copied-import"
refused "$copied" "does not start: expected that program"
rm "$copied-import"
refused "$copied" "plane.stl: needs the program pulsecast-import, which is neither beside pulsecast nor in the PATH: expected OBJ or PLY, which need none"
"$copied" doctor | grep -q '^meshes .*missing: glTF.*convert to OBJ or PLY' || fail "without its importer, doctor says $("$copied" doctor)"
[ "$(PATH=$binaries:$PATH points "$copied" | md5sum)" = "$expected" ] || fail "an importer in the PATH is not found"
importer 'echo pulsecast-import 0.0.1'
"$copied" doctor | grep -q '^meshes .*missing: glTF.*of another version, pulsecast-import 0.0.1' || fail "with another importer, doctor says $("$copied" doctor)"
rm "$copied-import"
"$program-import" 2> messages
grep -q "pulsecast, which starts it" messages || fail "an importer started by hand says: $(cat messages)"
"$program-import" 1 > messages 2>&1 && fail "an importer with an output for a request ended well"
"$program-import" --version | grep -q '^pulsecast-import [0-9]' || fail "the importer has no version"

# Without it, and without the parts that are loaded on demand, what needs none of them works.
rm -rf "in a folder"/lib*
mesh plane.obj
[ "$(points "$copied" | md5sum)" = "$expected" ] || fail "an OBJ file needs more than the program"
"$copied" mesh.xml --output parts --quiet --live > messages 2>&1 && fail "a live page is served without its part"
grep -q "pulsecast-live.so: expected that of the same build" messages || fail "without its part, a live page says $(cat messages)"

# What the loader maps for the survey program.
if ldd "$program-import" 2> /dev/null | grep -q assimp; then
  ldd "$program" | grep -E "assimp|gdal|xerces|citygml|libproj|libsqlite|libcurl|libcrypto|libicu" && fail "the survey program loads the libraries above"
  [ "$(ldd "$program" | wc -l)" -lt 40 ] || fail "the survey program loads $(ldd "$program" | wc -l) shared objects"
fi
echo "meshes of foreign formats come by another program"
