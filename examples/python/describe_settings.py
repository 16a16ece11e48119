# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""Writes what C++ cannot ask of its own structs: the names of their members and what the comments beside them say.

    describe_settings.py survey_settings.hpp OUT

A struct becomes a specialisation of `Described` with its name, doc and members; an enum one with the names of its values. So the
classes of the Python module have the members and docstrings of the header, and a new member needs to be written in one place only.
Fails at a line of the header that it does not understand.
"""

import re
import sys

MEMBER = re.compile(r"  (?P<type>[\w:<>, ]+?) (?P<name>\w+)(?:\{.*\}| = [^;]*)?;(?:\s*///< (?P<doc>.*))?$")
NOT_A_MEMBER = re.compile(r"  (static constexpr |using |bool operator==|\[\[nodiscard\]\]|//[^/]|void validate)")
FUNCTION = re.compile(r"[^;]*\) (const )?(noexcept )?\{$")


def quoted(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def describe(lines):
    """Yields (kind, name, doc, [(member, doc)]) of each struct and enum."""
    comment, at, inside_function = [], None, False
    for number, line in enumerate(lines, 1):
        if line.startswith("///"):
            comment.append(line[3:].strip())
        elif match := re.match(r"(?:enum class|struct) (\w+)(?: : [\w:]+)? \{(.*)$", line):
            at = ("enum" if line.startswith("enum") else "struct", match[1], " ".join(comment), [])
            above = []
            if match[2]:  # an enum on one line
                at[3].extend((name.strip(), "") for name in match[2].removesuffix("};").split(","))
                yield at
                at = None
        elif at is None:
            comment = []
        elif line == "};":
            yield at
            at, comment = None, []
        elif inside_function:
            inside_function = line != "  }"
        elif line.startswith("  ///"):
            above.append(line[5:].strip())
        elif at[0] == "enum" and (match := re.match(r"  (\w+),?(?:\s*///< (.*))?$", line)):
            at[3].append((match[1], match[2] or ""))
        elif NOT_A_MEMBER.match(line):
            inside_function = bool(FUNCTION.match(line))
            above = []
        elif match := MEMBER.match(line):
            at[3].append((match["name"], " ".join(above) or match["doc"] or ""))
            above = []
        elif line.strip():
            sys.exit(f"line {number} is not understood: {line}")


def main(header, out):
    with open(header, encoding="utf-8") as file:
        described = list(describe(file.read().splitlines()))
    with open(out, "w", encoding="utf-8") as file:
        structs = []
        for kind, name, doc, members in described:
            file.write(f"template <>\nstruct Described<adapters::{name}> {{\n  static constexpr const char* name = {quoted(name)};\n")
            if kind == "enum":
                names = ", ".join(quoted(member) for member, _ in members)
                file.write(f"  static constexpr std::array<const char*, {len(members)}> values{{{names}}};\n}};\n\n")
                continue
            structs.append(name)
            file.write(f"  static constexpr const char* doc = {quoted(doc)};\n")
            file.write("  template <class Settings, class Io>\n  static void members([[maybe_unused]] Settings& settings, [[maybe_unused]] Io&& io) {\n")
            for member, what in members:
                file.write(f"    io({quoted(member)}, settings.{member}, {quoted(what)});\n")
            file.write("  }\n};\n\n")
        file.write("using AllSettings = std::tuple<" + ", ".join("adapters::" + name for name in structs) + ">;\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
