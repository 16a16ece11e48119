# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""Writes what C++ cannot ask of its own structs: the names of their members, their types as Python writes them, and what the comments
beside them say.

    describe_settings.py OUT.inc STUBS.pyi.in OUT.pyi HEADER...

A struct becomes a specialisation of `Described` with its name, doc and members; an enum one with the names of its values. So the
classes of the Python module have the members and docstrings of the headers, and a new member needs to be written in one place only. The
type stubs get the same classes, in place of the line `# settings`. Fails at a line of a header that it does not understand.
"""

import re
import sys

MEMBER = re.compile(r"  (?P<type>[\w:<>, ]+?) (?P<name>\w+)(?:\{.*\}| = [^;]*)?;(?:\s*///< (?P<doc>.*))?$")
BROKEN_MEMBER = re.compile(r"^(  [\w:<>]+(?: \w+ =)?)\n +", re.MULTILINE)  # after its type or `=`
NOT_A_MEMBER = re.compile(r"  (static constexpr |using |bool operator==|\[\[nodiscard\]\]|//[^/]|[\w:]+ \w+\()")
FUNCTION = re.compile(r"[^;]*\) (const )?(noexcept )?\{$")
TYPES = {"bool": "bool", "int": "int", "std::uint64_t": "int", "double": "float", "char": "str", "std::string": "str",
         "std::filesystem::path": "str | os.PathLike[str]", "Vec3": "tuple[float, float, float]",
         "Box": "tuple[tuple[float, float, float], tuple[float, float, float]]"}
ANGLES = {"float", "float | None", TYPES["Vec3"]}  # what may be in radians, as `is_angle` of settings.cpp


def quoted(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def annotation(cpp, known):
    """A type as Python writes it."""
    if cpp in known:
        return known[cpp]
    match = re.fullmatch(r"(?:std::)?(optional|vector|array|variant|SharedArray)<(.*)>", cpp)
    if not match:
        sys.exit(f"the type {cpp} is not known")
    of = [annotation(one, known) for one in match[2].split(", ") if not one.isdigit()]  # of those that are there, none has a comma inside
    if match[1] == "optional":
        return of[0] + " | None"
    return " | ".join(of) if match[1] == "variant" else f"list[{of[0]}]"


def describe(lines):
    """Yields (kind, name with its namespace, doc, [(member, type as Python writes it, doc)]) of each struct and enum."""
    known = dict(TYPES)
    for kind, name, doc, members in parse(lines, known):
        plain = plain_name(name)
        known[plain] = plain if kind == "struct" else "Literal[" + ", ".join(quoted(member) for member, _, _ in members) + "]"
        yield kind, name, doc, [(member, annotation(cpp, known) if kind == "struct" else "", what) for member, cpp, what in members]


def plain_name(name):
    return name.rpartition("::")[2]


def parse(lines, known):
    """As `describe`, with types as C++ writes them. Adds to `known` what they are called besides."""
    comment, at, inside_function, space, hidden = [], None, False, "", False
    for line in lines:
        if line in ("namespace detail {", "}  // namespace detail"):
            hidden = line.startswith("n")
        elif hidden:
            continue
        elif match := re.match(r"namespace PULSECAST_NAMESPACE(?:::(\w+))? \{$", line):
            space = match[1] + "::" if match[1] else ""
        elif line.startswith("///"):
            comment.append(line[3:].strip())
        elif match := re.match(r"(?:enum class|struct) (\w+)(?: : [\w:]+)? \{(.*)$", line):
            at = ("enum" if line.startswith("enum") else "struct", space + match[1], " ".join(comment), [])
            above = []
            if match[2]:  # an enum on one line
                at[3].extend((name.strip(), "", "") for name in match[2].removesuffix("};").split(","))
                yield at
                at = None
        elif at is None:
            if match := re.match(r"using (\w+) = (.*);$", line):
                known[match[1]] = annotation(match[2], known)
            comment = []
        elif line == "};":
            yield at
            at, comment = None, []
        elif inside_function:
            inside_function = line != "  }"
        elif line.startswith("  ///"):
            above.append(line[5:].strip())
        elif at[0] == "enum" and (match := re.match(r"  (\w+),?(?:\s*///< (.*))?$", line)):
            at[3].append((match[1], "", match[2] or ""))
        elif NOT_A_MEMBER.match(line):
            inside_function = bool(FUNCTION.match(line))
            above = []
        elif match := MEMBER.match(line):
            at[3].append((match["name"], match["type"], " ".join(above) or match["doc"] or ""))
            above = []
        elif line.strip():
            sys.exit(f"this line is not understood: {line}")


def cpp_of(described):
    structs = []
    for kind, name, doc, members in described:
        yield f"template <>\nstruct Described<{name}> {{\n  static constexpr const char* name = {quoted(plain_name(name))};\n"
        if kind == "enum":
            names = ", ".join(quoted(member) for member, _, _ in members)
            yield f"  static constexpr std::array<const char*, {len(members)}> values{{{names}}};\n}};\n\n"
            continue
        structs.append(name)
        yield f"  static constexpr const char* doc = {quoted(doc)};\n"
        yield "  template <class Settings, class Io>\n  static void members([[maybe_unused]] Settings& settings, [[maybe_unused]] Io&& io) {\n"
        for member, kind_of_member, what in members:
            yield f"    io({quoted(member)}, settings.{member}, {quoted(kind_of_member)}, {quoted(what)});\n"
        yield "  }\n};\n\n"
    yield "using AllSettings = std::tuple<" + ", ".join(structs) + ">;\n"


def stubs_of(described):
    for kind, name, doc, members in described:
        if kind == "enum":
            continue
        yield f"@dataclass(slots=True)\nclass {plain_name(name)}:\n"
        yield f"    {docstring(doc)}\n" if doc or not members else ""
        for member, annotated, what in members:
            yield f"    {member}: {annotated} = ...\n" + (f"    {docstring(what)}\n" if what else "")
        angles = [(member, annotated) for member, annotated, what in members if annotated in ANGLES and re.search(r"\[rad(/s)?\]$", what)]
        if angles:
            yield "    def __init__(\n        self,\n"
            yield from (f"        {member}: {annotated} = ...,\n" for member, annotated, _ in members)
            yield "        *,\n"
            yield from (f"        {member}_deg: {annotated.removesuffix(' | None')} | None = ...,\n" for member, annotated in angles)
            yield "    ) -> None: ...\n"
        for member, annotated in angles:
            yield f"    @property\n    def {member}_deg(self) -> {annotated}: ...\n"
            yield f"    @{member}_deg.setter\n    def {member}_deg(self, value: {annotated}) -> None: ...\n"
        yield "\n"


def docstring(text):
    return '"""' + text.replace("\\", "\\\\") + '"""'


def main(cpp_file, stub_template, stub_file, *headers):
    lines = []
    for header in headers:  # each after those whose types it names
        with open(header, encoding="utf-8") as file:
            lines += BROKEN_MEMBER.sub(r"\1 ", file.read()).splitlines()
    described = list(describe(lines))
    with open(cpp_file, "w", encoding="utf-8") as file:
        file.writelines(cpp_of(described))
    with open(stub_template, encoding="utf-8") as file:
        before, after = file.read().split("# settings\n")
    with open(stub_file, "w", encoding="utf-8") as file:
        file.writelines([before, *stubs_of(described), after.lstrip("\n")])


if __name__ == "__main__":
    main(*sys.argv[1:])
